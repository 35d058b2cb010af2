// Triangle meshes: the rules for arrays of a scene file, transforms, and which triangles are dropped.

#include "core/geometry/mesh.h"

#include "core/base/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace penumbra {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A unit square in the plane z = 0 of two triangles, facing +z.
MeshArrays square() {
    MeshArrays arrays;
    arrays.P = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    arrays.indices = {0, 1, 2, 0, 2, 3};
    return arrays;
}

TriangleMesh meshOf(MeshArrays arrays) {
    Warnings strict(true);
    return meshFromArrays(std::move(arrays), "scene.pbrt:3:1", strict);
}

/// The text of the BadData error that the arrays give, empty where they give none.
std::string errorOf(MeshArrays arrays) {
    try {
        meshOf(std::move(arrays));
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::BadData);
        return error.what();
    }
    return {};
}

TEST(Mesh, ArraysAreAdoptedNotCopied) {
    MeshArrays arrays = square();
    reserveVertices(arrays.P, 4);
    arrays.N.assign(12, 1.f);
    arrays.S.assign(12, 2.f);
    arrays.uv.assign(8, 3.f);
    arrays.faceIndices = {7, 8};
    const float* const memory[] = {arrays.P.data(), arrays.N.data(), arrays.S.data(), arrays.uv.data()};
    const TriangleMesh mesh = meshOf(std::move(arrays));
    EXPECT_EQ(mesh.vertexCount(), 4u);
    EXPECT_EQ(mesh.triangleCount(), 2u);
    EXPECT_EQ(mesh.positions.data(), memory[0]);
    EXPECT_EQ(mesh.normals.data(), memory[1]);
    EXPECT_EQ(mesh.tangents.data(), memory[2]);
    EXPECT_EQ(mesh.uvs.data(), memory[3]);
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(mesh.faceIndices, (std::vector<std::int32_t>{7, 8}));
}

TEST(Mesh, PositionsHaveSixteenSpareBytes) {
    MeshArrays arrays = square();
    arrays.P.shrink_to_fit();
    const TriangleMesh mesh = meshOf(std::move(arrays));
    EXPECT_GE((mesh.positions.capacity() - mesh.positions.size()) * sizeof(float), 16u);
}

TEST(Mesh, IndicesMayBeMissingWithThreePointsOnly) {
    MeshArrays arrays;
    arrays.P = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    EXPECT_EQ(meshOf(arrays).indices, (std::vector<std::uint32_t>{0, 1, 2}));
    arrays.P.resize(12);
    EXPECT_EQ(errorOf(arrays), "scene.pbrt:3:1: \"indices\" are missing; they may be only with 3 points, not with 4");
}

TEST(Mesh, PointsAreChecked) {
    MeshArrays arrays = square();
    arrays.P.push_back(0);
    EXPECT_NE(errorOf(arrays).find("\"P\" has 13 numbers"), std::string::npos);
    arrays.P.clear();
    EXPECT_NE(errorOf(arrays).find("needs \"P\""), std::string::npos);
}

TEST(Mesh, IndicesOutOfRangeAreErrorsWithTheirPlace) {
    for (const std::int32_t index : {4, -1, 1 << 30, std::numeric_limits<std::int32_t>::min()}) {
        MeshArrays arrays = square();
        arrays.indices[5] = index;
        EXPECT_EQ(errorOf(arrays), "scene.pbrt:3:1: \"indices\"[5] is " + std::to_string(index) + ", outside 0 to 3");
    }
}

TEST(Mesh, DataOfWrongLengthAreDroppedWithAWarning) {
    MeshArrays arrays = square();
    arrays.N.assign(9, 1.f);
    arrays.S.assign(13, 1.f);
    arrays.uv.assign(12, 1.f);
    arrays.faceIndices.assign(1, 1);
    arrays.indices.push_back(0);
    Warnings warnings;
    const TriangleMesh mesh = meshFromArrays(arrays, "a.pbrt:1:2", warnings);
    EXPECT_TRUE(mesh.normals.empty() && mesh.tangents.empty() && mesh.uvs.empty() && mesh.faceIndices.empty());
    EXPECT_EQ(mesh.triangleCount(), 2u);
    ASSERT_EQ(warnings.all().size(), 5u);
    EXPECT_EQ(warnings.all()[1], "a.pbrt:1:2: \"N\" has 9 numbers where 12 were expected; ignored");
}

TEST(Mesh, TransformMovesPointsNormalsAndTangents) {
    MeshArrays arrays = square();
    for (int v = 0; v < 4; ++v) {
        arrays.N.insert(arrays.N.end(), {1, 0, 1});
        arrays.S.insert(arrays.S.end(), {1, 0, -1});
    }
    TriangleMesh mesh = meshOf(arrays);
    transform(mesh, translation(10, 0, 0) * scaling(2, 1, 1));
    EXPECT_EQ(mesh.positions, (std::vector<float>{10, 0, 0, 12, 0, 0, 12, 1, 0, 10, 1, 0}));
    EXPECT_EQ(mesh.tangents[0], 2.f);
    EXPECT_EQ(mesh.tangents[2], -1.f);
    EXPECT_FLOAT_EQ(mesh.normals[2] / mesh.normals[0], 2.f);  // (1/2, 0, 1): still at right angles to the tangent
    EXPECT_GT(mesh.normals[0], 0.f);
}

TEST(Mesh, NormalsSurviveMirrorsAndAnyScale) {
    const Matrix4 matrices[] = {scaling(-1, 1, 1),
                                scaling(1, 1, -3),
                                scaling(1e-30, 1e-30, 1e-30),
                                scaling(1e30, 1e30, 1e30),
                                scaling(1e-100, 1e-100, -1e-100),
                                scaling(1, 1, 0)};
    for (const Matrix4& matrix : matrices) {
        MeshArrays arrays = square();
        for (int v = 0; v < 4; ++v)
            arrays.N.insert(arrays.N.end(), {0, 0, 1});
        TriangleMesh mesh = meshOf(arrays);
        transform(mesh, matrix);
        // The inverse transpose keeps the sign of the axis; where the axis is squashed, either is as good.
        const float sign = matrix.m[2][2] < 0 ? -1.f : 1.f;
        EXPECT_EQ(mesh.normals[0], 0.f);
        EXPECT_GT(sign * mesh.normals[2], .1f);
        EXPECT_LE(sign * mesh.normals[2], 1.f);
    }
}

TEST(Mesh, NormalsKeepTheirRelativeLengths) {
    MeshArrays arrays = square();
    arrays.N = {0, 0, 1, 0, 0, 2, 0, 1, 0, 0, 0, 5};
    TriangleMesh mesh = meshOf(arrays);
    transform(mesh, rotation(30, 1, 2, 3) * scaling(4, 4, 4));
    const auto length = [&](int v) {
        return std::hypot(mesh.normals[3 * v], mesh.normals[3 * v + 1], mesh.normals[3 * v + 2]);
    };
    EXPECT_NEAR(length(1) / length(0), 2, 1e-6);
    EXPECT_NEAR(length(2) / length(0), 1, 1e-6);
    EXPECT_NEAR(length(3) / length(0), 5, 1e-6);
}

TEST(Mesh, BadTrianglesAreDroppedAndCounted) {
    MeshArrays arrays = square();
    arrays.P.insert(arrays.P.end(),
                    {kNan, 0, 0, 0, kInfinity, 0, 0, 0, 2e18f, 2, 0, 0, 1, 0, 0, 1e-10f, 0, 0, 0, 1e-10f, 0});
    arrays.indices = {0, 1, 4,   // not a number
                      0, 1, 2,   // good
                      0, 5, 1,   // infinite
                      0, 1, 6,   // beyond what Embree takes
                      0, 0, 2,   // the same corner twice
                      0, 1, 7,   // on one line
                      1, 2, 8,   // two corners in one place
                      0, 9, 10,  // too small to have a normal
                      0, 2, 3};  // good
    for (int i = 0; i < 9; ++i)
        arrays.faceIndices.push_back(i);
    TriangleMesh mesh = meshOf(arrays);
    EXPECT_EQ(dropBadTriangles(mesh), 7u);
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(mesh.faceIndices, (std::vector<std::int32_t>{1, 8}));
    EXPECT_EQ(mesh.vertexCount(), 11u);
    EXPECT_EQ(dropBadTriangles(mesh), 0u);
}

TEST(Mesh, SmallAndLargeMeshesAreKept) {
    for (const double scale : {1e-8, 1e-4, 1e6, 1e17}) {
        TriangleMesh mesh = meshOf(square());
        transform(mesh, translation(scale, 0, 0) * scaling(scale, scale, scale));
        EXPECT_EQ(dropBadTriangles(mesh), 0u) << scale;
    }
}

TEST(Mesh, BoundsAreThoseOfTheTriangles) {
    MeshArrays arrays = square();
    arrays.P.insert(arrays.P.end(), {100, 100, 100});  // used by no triangle
    TriangleMesh mesh = meshOf(arrays);
    transform(mesh, translation(-3, 0, 5));
    const MeshBounds box = bounds(mesh);
    EXPECT_EQ(box.lower, (std::array<float, 3>{-3, 0, 5}));
    EXPECT_EQ(box.upper, (std::array<float, 3>{-2, 1, 5}));
    mesh.indices.clear();
    EXPECT_GT(bounds(mesh).lower[0], bounds(mesh).upper[0]);
}

TEST(Mesh, AreaAndNormal) {
    TriangleMesh mesh = meshOf(square());
    EXPECT_EQ(totalArea(mesh), 1);
    const Vec3d n = triangleNormal(mesh, 0, 1, 2);
    EXPECT_EQ(n.x, 0);
    EXPECT_EQ(n.y, 0);
    EXPECT_EQ(n.z, 1);
    transform(mesh, scaling(3, 5, 1));
    EXPECT_EQ(totalArea(mesh), 15);
}

}  // namespace
}  // namespace penumbra
