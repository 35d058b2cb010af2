// TriangleMesh: the arrays of one triangle mesh, and what is done to them between reading and building the scene.
//
// Conventions: flat arrays, so that they go to Embree as they are. Triangle t has the corners indices[3t .. 3t+2];
// vertex v the position positions[3v .. 3v+2]. Which side is the front is the builder's business: nothing here turns
// triangles round.
//
// Memory: meshes are big and the process has to stay small, so everything moves or works in place; no function holds a
// second copy of an array (but the signed indices of a scene file, while they become unsigned).
//
// Invariants (whoever fills a mesh sees to them): indices.size() is a multiple of 3 and every index is below
// vertexCount(); normals, uvs, tangents are empty or complete; faceIndices is empty or has one entry a triangle;
// positions has spare capacity (reserveVertices).
//
// Thread safety: a mesh is plain data.
#pragma once

#include "core/base/warnings.h"
#include "core/math/matrix.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace penumbra {

struct TriangleMesh {
    std::vector<float> positions;  ///< 3 a vertex
    std::vector<float> normals;    ///< 3 a vertex or empty; of any length: longer ones weigh more where interpolated
    std::vector<float> uvs;        ///< 2 a vertex or empty
    std::vector<float> tangents;   ///< 3 a vertex or empty
    std::vector<std::uint32_t> indices;     ///< 3 a triangle
    std::vector<std::int32_t> faceIndices;  ///< 1 a triangle or empty: the file's number of the face it is cut from

    std::size_t vertexCount() const { return positions.size() / 3; }
    std::size_t triangleCount() const { return indices.size() / 3; }
};

/// Embree reads a vertex by a load of 16 bytes, so the last one of a buffer needs readable bytes behind it.
inline constexpr std::size_t kSpareFloats = 16 / sizeof(float);

/// Makes room for `count` vertices and the spare bytes behind them. Every buffer of positions that Embree is to see,
/// the scene-wide one included, is reserved with this before it is filled. The spare bytes have no value and need none.
void reserveVertices(std::vector<float>& positions, std::size_t count);

/// The parameters of a trianglemesh as a scene file gives them; empty = absent.
struct MeshArrays {
    std::vector<float> P, N, S, uv;
    std::vector<std::int32_t> indices, faceIndices;
};

/// Checks and adopts the arrays by the rules of the pbrt format: indices may be missing where there are exactly three
/// points; normals, tangents, uvs or face indices of a wrong length are dropped, surplus indices are cut off, both with
/// a warning; anything else (no points, half a point, an index out of range) is Error(BadData). `where`
/// ("file:line:column") opens every message.
TriangleMesh meshFromArrays(MeshArrays arrays, const std::string& where, Warnings& warnings);

/// Positions as points, tangents as vectors, normals by the inverse transpose; computed in double and rounded once.
/// Normals come out scaled by one common factor (their largest possible growth is 1), which no interpolation sees: so
/// matrices of any scale, and singular ones, give finite normals.
void transform(TriangleMesh& mesh, const Matrix4& matrix);

/// Removes, and counts, the triangles that nothing can be rendered of: a corner that is not finite or beyond
/// kLargestCoordinate (Embree would leave them out without a word), a repeated corner, or an area of zero or so small
/// (below 5e-20) that the squared length of its normal is no normal float. Vertices stay. Call it on final positions.
std::size_t dropBadTriangles(TriangleMesh& mesh);
inline constexpr float kLargestCoordinate = 1.844e18f;

/// The cross product of the edges from a to b and from a to c: the front's normal, twice the area long.
Vec3d triangleNormal(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c);

struct MeshBounds {
    std::array<float, 3> lower, upper;  ///< lower > upper (the infinities) where there is no triangle
};
/// Of the vertices that triangles use.
MeshBounds bounds(const TriangleMesh& mesh);

double totalArea(const TriangleMesh& mesh);

}  // namespace penumbra
