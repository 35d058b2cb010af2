// CurveSet: curves as Embree reads them, and how the scene format's curves become one.
//
// A curve is a row of segments, each a cubic with a parameter u of its own from 0 to 1. Embree draws a cubic as
// kCurveQuads flat pieces, so a segment that bends too much for that is halved `level` times first: all segments of a
// set equally often, and a set holds whole segments only, so that piece i belongs to segment i >> level.
//
// Cubic B-splines stay what they are (one control point a segment); all others become Bezier curves that share their
// end points (three a segment). The radius is linear in u over the whole curve, which both bases reproduce.
//
// Invariants: indices point to the first of four consecutive control points; normals are empty or one a control point.
// Thread safety: plain data.
#pragma once

#include "core/base/warnings.h"
#include "core/math/matrix.h"

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra {

/// Flat and cylinder face the ray as ribbons; a cylinder is shaded as one (see PBRT-v4). A ribbon has normals of its
/// own.
enum class CurveType { Flat, Cylinder, Ribbon };

/// Pieces into which Embree cuts a cubic that faces the ray: as many as it intersects at once.
inline constexpr int kCurveQuads = 8;
/// Of CurveSet::level: 1024 quads a segment.
inline constexpr std::uint32_t kMostCurveLevel = 7;

/// A curve as a scene file gives it.
struct CurveArrays {
    std::vector<float> P, N;  ///< 3 a point
    CurveType type = CurveType::Flat;
    bool spline = false;  ///< uniform B-spline, else Bezier
    int degree = 3;       ///< or 2
    float width0 = 1, width1 = 1;
};

struct CurveSet {
    std::vector<float> vertices;         ///< 4 a control point: x, y, z, radius
    std::vector<float> normals;          ///< 3 a control point of a ribbon, else empty
    std::vector<std::uint32_t> indices;  ///< 1 a piece
    bool spline = false;                 ///< the basis of the control points
    unsigned level = 0;                  ///< log2 of the pieces of a segment

    /// Joins another set of the same basis, level and type to this one.
    void append(const CurveSet& other);
};

/// Number of points or normals that makes no curve: Error(BadData) with `where` ("file:line:column: shape 'curve'").
/// Segments of no length and curves that no float can hold are left out.
CurveSet curvesFromArrays(const CurveArrays& arrays, const std::string& where, Warnings& warnings);

/// Whether the matrix keeps angles, so that widths are scaled by the same factor everywhere; mirrors count.
bool isSimilarity(const Matrix4& matrix);
/// REQUIRES: isSimilarity(matrix).
void transform(CurveSet& curves, const Matrix4& matrix);

}  // namespace penumbra
