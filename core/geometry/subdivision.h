// Loop's subdivision surfaces: a triangle mesh refined some levels, then moved to the limit of refining for ever.
//
// The rules are those of PBRT-v4, which differ from the textbook's in two places: end points of a border are pushed to
// the limit with weight 1/5 (1/6 would be the limit of a cubic B-spline), and the tangents of the limit surface are
// taken from neighbours that are in the limit already. Normals are tangent x tangent in the order of the format, which
// is against the winding of the faces.
//
// Two faces are neighbours where they walk an edge in opposite directions; any other edge is a border, be it shared by
// more faces or by faces of different winding. A vertex where several fans of faces touch follows the fan of its last
// face.
//
// Thread safety: pure functions.
#pragma once

#include "core/geometry/mesh.h"

namespace penumbra {

/// More triangles than this are refused (Error(BadData)): some three quarters of a gigabyte while they are made.
inline constexpr std::size_t kMostSubdividedTriangles = std::size_t(1) << 24;

/// The limit positions of the mesh after `levels` >= 0 refinements, with limit normals. Of the control mesh only
/// positions and indices matter; faces with a repeated corner are left out. `where` opens the message of an error.
TriangleMesh subdivideLoop(TriangleMesh&& control, int levels, const std::string& where);

}  // namespace penumbra
