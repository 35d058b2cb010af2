// Bilinear patches, and meshes of polygons with quads among them, become triangles.
//
// A patch spans its corners by p(u, v) = (1-u)(1-v) p00 + u (1-v) p10 + (1-u) v p01 + u v p11, and so its uv and normals.
// Its one second derivative is the twist p00 - p10 - p01 + p11. Cut into n x n cells of two triangles each, which are
// flat, it is missed by at most |twist| / (4 n^2), in the middle of a cell. n is chosen so that this is no more than
// kDiceTolerance of the patch's longest edge; likewise for uv, by their longest edge, and for given normals, by the
// longest of them. Normals nobody gave are the patch's own dp/du x dp/dv. They are linear in u and v, so that triangles
// interpolate them without any error.
//
// A mesh of polygons is mostly a fine one, of quads that are barely bent. There the bound is kPolygonTolerance of the
// whole mesh's diagonal, and uv and normals are as fine as they come.
//
// One n serves all faces of a mesh. Edges of patches are straight, and a vertex on one is computed from the two ends
// alone, with the same rounding from either side: neighbours have the very same vertices, and nothing leaks. n is
// smaller where the bound would take more triangles than DiceOptions allow; what is left is never worse than one cell.
//
// Thread safety: pure functions.
#pragma once

#include "core/geometry/mesh.h"

namespace penumbra {

/// A mesh of triangles, pairs of which are the faces of four corners that the file has.
struct PatchMesh {
    TriangleMesh mesh;
    /// The first triangle of each pair, ascending. A face with the corners a b c d in order round it (p00 = a, p10 = b,
    /// p11 = c, p01 = d) is the triangles a b c and a c d, or a b d and b c d.
    std::vector<std::uint32_t> quads;
};

inline constexpr double kDiceTolerance = 5e-4, kPolygonTolerance = 1e-3;
/// Cells along an edge, whatever the bound asks for: it asks for 45 at most, where the numbers are sane.
inline constexpr int kMostCells = 64;

struct DiceOptions {
    Matrix4 place;         ///< what the tolerance is measured behind; the mesh stays in its own space
    bool needsUv = false;  ///< where the mesh has none, quads get the parameters of their patch
    /// Quads are polygons: where one is planar, within the tolerance of the mesh, it is its two triangles, and so are its
    /// uv and normals.
    bool polygons = false;
    bool numbersFaces = false;  ///< faceIndices tell which triangles are of one face, in any case
    std::size_t mostTriangles = std::size_t(1) << 20;  ///< unless the mesh has more
};

/// The triangles of the mesh; without quads they are as they were. Vertices may be new ones.
TriangleMesh dice(PatchMesh patches, const DiceOptions& options);

}  // namespace penumbra
