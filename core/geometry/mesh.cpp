#include "core/geometry/mesh.h"

#include "core/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra {

namespace {

double doubleAreaSquared(const TriangleMesh& mesh, const std::uint32_t* corner) {
    const Vec3d n = triangleNormal(mesh, corner[0], corner[1], corner[2]);
    return n.x * n.x + n.y * n.y + n.z * n.z;
}

bool isUsableVertex(const TriangleMesh& mesh, std::uint32_t vertex) {
    const float* p = &mesh.positions[3 * std::size_t{vertex}];
    // Comparisons are false for NaN.
    return std::abs(p[0]) < kLargestCoordinate && std::abs(p[1]) < kLargestCoordinate &&
           std::abs(p[2]) < kLargestCoordinate;
}

bool isUsableTriangle(const TriangleMesh& mesh, const std::uint32_t* corner) {
    return corner[0] != corner[1] && corner[1] != corner[2] && corner[2] != corner[0] &&
           isUsableVertex(mesh, corner[0]) && isUsableVertex(mesh, corner[1]) && isUsableVertex(mesh, corner[2]) &&
           doubleAreaSquared(mesh, corner) >= std::numeric_limits<float>::min();
}

template <class T>
void dropUnlessLength(std::vector<T>& values, std::size_t expected, const char* name, const std::string& where,
                      Warnings& warnings) {
    if (values.empty() || values.size() == expected) return;
    warnings.add(where + ": \"" + name + "\" has " + std::to_string(values.size()) + " numbers where " +
                 std::to_string(expected) + " were expected; ignored");
    values = {};
}

/// The checked indices as unsigned numbers; the signed ones are freed.
std::vector<std::uint32_t> takeIndices(std::vector<std::int32_t> indices, std::size_t vertexCount,
                                       const std::string& where, Warnings& warnings) {
    if (indices.empty()) {
        if (vertexCount == 3) return {0, 1, 2};
        throw Error(ErrorKind::BadData, where + ": \"indices\" are missing; they may be only with 3 points, not with " +
                                            std::to_string(vertexCount));
    }
    if (const std::size_t surplus = indices.size() % 3) {
        warnings.add(where + ": \"indices\" has " + std::to_string(indices.size()) +
                     " numbers, not a multiple of 3; the last " + std::to_string(surplus) + " ignored");
        indices.resize(indices.size() - surplus);
    }
    const auto outside = std::find_if(indices.begin(), indices.end(), [&](std::int32_t index) {
        return index < 0 || static_cast<std::size_t>(index) >= vertexCount;
    });
    if (outside != indices.end())
        throw Error(ErrorKind::BadData, where + ": \"indices\"[" + std::to_string(outside - indices.begin()) + "] is " +
                                            std::to_string(*outside) + ", outside 0 to " +
                                            std::to_string(vertexCount - 1));
    return {indices.begin(), indices.end()};
}

void transformEach(std::vector<float>& triples, const Matrix4& matrix, Vec3d (*apply)(const Matrix4&, Vec3d)) {
    for (std::size_t i = 0; i + 2 < triples.size(); i += 3) {
        const Vec3d v = apply(matrix, {triples[i], triples[i + 1], triples[i + 2]});
        triples[i] = static_cast<float>(v.x);
        triples[i + 1] = static_cast<float>(v.y);
        triples[i + 2] = static_cast<float>(v.z);
    }
}

/// The inverse transpose up to a positive factor, as the cofactors (which singular matrices have too), of norm at
/// most 1.
Matrix4 normalMatrix(const Matrix4& a) {
    double largest = 0;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            largest = std::max(largest, std::abs(a.m[r][c]));
    if (!(largest > 0) || !std::isfinite(largest)) return {};  // no triangle is left of the mesh
    const auto m = [&](int r, int c) { return a.m[r % 3][c % 3] / largest; };
    Matrix4 cofactors;
    double normSquared = 0, determinant = 0;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) {
            const double cofactor = m(r + 1, c + 1) * m(r + 2, c + 2) - m(r + 1, c + 2) * m(r + 2, c + 1);
            cofactors.m[r][c] = cofactor;
            normSquared += cofactor * cofactor;
            if (r == 0) determinant += m(r, c) * cofactor;
        }
    if (normSquared == 0) return {};
    const double factor = (determinant < 0 ? -1 : 1) / std::sqrt(normSquared);
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            cofactors.m[r][c] *= factor;
    return cofactors;
}

}  // namespace

void reserveVertices(std::vector<float>& positions, std::size_t count) {
    positions.reserve(3 * count + kSpareFloats);
}

TriangleMesh meshFromArrays(MeshArrays arrays, const std::string& where, Warnings& warnings) {
    if (arrays.P.empty()) throw Error(ErrorKind::BadData, where + ": a triangle mesh needs \"P\"");
    if (arrays.P.size() % 3 != 0)
        throw Error(ErrorKind::BadData,
                    where + ": \"P\" has " + std::to_string(arrays.P.size()) + " numbers, not a multiple of 3");
    TriangleMesh mesh;
    mesh.positions = std::move(arrays.P);
    reserveVertices(mesh.positions, mesh.vertexCount());
    mesh.indices = takeIndices(std::move(arrays.indices), mesh.vertexCount(), where, warnings);
    dropUnlessLength(arrays.N, 3 * mesh.vertexCount(), "N", where, warnings);
    dropUnlessLength(arrays.S, 3 * mesh.vertexCount(), "S", where, warnings);
    dropUnlessLength(arrays.uv, 2 * mesh.vertexCount(), "uv", where, warnings);
    dropUnlessLength(arrays.faceIndices, mesh.triangleCount(), "faceIndices", where, warnings);
    mesh.normals = std::move(arrays.N);
    mesh.tangents = std::move(arrays.S);
    mesh.uvs = std::move(arrays.uv);
    mesh.faceIndices = std::move(arrays.faceIndices);
    return mesh;
}

void transform(TriangleMesh& mesh, const Matrix4& matrix) {
    transformEach(mesh.positions, matrix, transformPoint);
    transformEach(mesh.tangents, matrix, transformVector);
    transformEach(mesh.normals, normalMatrix(matrix), transformVector);
}

std::size_t dropBadTriangles(TriangleMesh& mesh) {
    const std::size_t count = mesh.triangleCount();
    std::size_t kept = 0;
    for (std::size_t t = 0; t < count; ++t) {
        if (!isUsableTriangle(mesh, &mesh.indices[3 * t])) continue;
        std::copy_n(&mesh.indices[3 * t], 3, &mesh.indices[3 * kept]);
        if (!mesh.faceIndices.empty()) mesh.faceIndices[kept] = mesh.faceIndices[t];
        ++kept;
    }
    mesh.indices.resize(3 * kept);
    if (!mesh.faceIndices.empty()) mesh.faceIndices.resize(kept);
    return count - kept;
}

Vec3d triangleNormal(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const float* const p = &mesh.positions[3 * std::size_t{a}];
    // In double: differences of floats are exact there but for extreme ratios.
    const auto edgeTo = [&](std::uint32_t vertex) {
        const float* const q = &mesh.positions[3 * std::size_t{vertex}];
        return Vec3d{double{q[0]} - p[0], double{q[1]} - p[1], double{q[2]} - p[2]};
    };
    const Vec3d e = edgeTo(b), f = edgeTo(c);
    return {e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x};
}

MeshBounds bounds(const TriangleMesh& mesh) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    MeshBounds box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (const std::uint32_t vertex : mesh.indices)
        for (int axis = 0; axis < 3; ++axis) {
            const float value = mesh.positions[3 * std::size_t{vertex} + axis];
            box.lower[axis] = std::min(box.lower[axis], value);
            box.upper[axis] = std::max(box.upper[axis], value);
        }
    return box;
}

double totalArea(const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
        sum += 0.5 * std::sqrt(doubleAreaSquared(mesh, &mesh.indices[3 * t]));
    return sum;
}

}  // namespace penumbra
