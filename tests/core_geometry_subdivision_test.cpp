// Subdivision surfaces: values known on paper, what refining must not change, whole topology, and hostile meshes.
#include "core/geometry/subdivision.h"

#include "core/math/double_vector.h"
#include "tests/expect_error.h"
#include "tests/geometry_fixture.h"

#include <gtest/gtest.h>

#include <map>

namespace penumbra {
namespace {

using namespace test;

TriangleMesh meshOf(std::vector<float> positions, std::vector<std::uint32_t> indices) {
    TriangleMesh mesh;
    mesh.positions = std::move(positions);
    mesh.indices = std::move(indices);
    return mesh;
}
TriangleMesh tetrahedron() {
    return meshOf({1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1}, {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2});
}
/// A pyramid whose tip has `sides` neighbours; open below.
TriangleMesh pyramid(std::uint32_t sides) {
    TriangleMesh mesh = meshOf({0, 0, 1}, {});
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        mesh.positions.insert(mesh.positions.end(),
                              {float(std::cos(angle)), float(std::sin(angle)), 0.2f * float(i % 2)});
        mesh.indices.insert(mesh.indices.end(), {0, 1 + i, 1 + (i + 1) % sides});
    }
    return mesh;
}
Vec3d at(const std::vector<float>& table, std::size_t i) {
    return {table[3 * i], table[3 * i + 1], table[3 * i + 2]};
}
TriangleMesh refinedMesh(TriangleMesh mesh, int levels) {
    return subdivideLoop(std::move(mesh), levels, "here");
}

TEST(Subdivision, LimitOfATetrahedron) {
    // Valence 3: weight 1/5 of each neighbour, and the others' sum is the opposite of a corner.
    for (const int levels : {0, 1, 3}) {
        const TriangleMesh mesh = refinedMesh(tetrahedron(), levels);
        for (std::size_t v = 0; v < 4; ++v) {
            EXPECT_LT(length(at(mesh.positions, v) - at(tetrahedron().positions, v) * 0.2), 1e-6) << levels;
            const Vec3d n = normalized(at(mesh.normals, v)), out = normalized(at(mesh.positions, v));
            EXPECT_LT(length(n + out), 1e-5) << "normals are against the winding";
        }
    }
}

/// The limit does not depend on where refining stops: of points inside, whatever their valence.
TEST(Subdivision, RefiningDoesNotMoveTheLimit) {
    for (const std::uint32_t sides : {3u, 4u, 5u, 6u, 7u, 12u}) {
        const Vec3d tip = at(refinedMesh(pyramid(sides), 0).positions, 0);
        for (const int levels : {1, 2, 5}) {
            const TriangleMesh mesh = refinedMesh(pyramid(sides), levels);
            EXPECT_LT(length(at(mesh.positions, 0) - tip), 2e-6) << sides << " sides, " << levels << " levels";
        }
    }
}

/// Weights by hand: the corner, an edge on the border, and the middle edge of two triangles, before the limit is taken.
TEST(Subdivision, BordersFollowTheirOwnRule) {
    const TriangleMesh one = refinedMesh(meshOf({0, 0, 0, 4, 0, 0, 0, 8, 0}, {0, 1, 2}), 0);
    EXPECT_FLOAT_EQ(one.positions[3], 3 * 4.f / 5);
    EXPECT_FLOAT_EQ(one.positions[1], 8.f / 5);
    // Level 1: corners at 3/4 and 1/8 of the others, edges in the middle; then the limit along the border of six.
    const TriangleMesh finer = refinedMesh(meshOf({0, 0, 0, 4, 0, 0, 0, 8, 0}, {0, 1, 2}), 1);
    ASSERT_EQ(finer.vertexCount(), 6u);
    const double corner = 0.125 * 4, nextCorner = 0.75 * 4, middle = 2;  // x of vertices 0, 1 and of the edge 0 1
    EXPECT_FLOAT_EQ(finer.positions[0], float(0.6 * corner + 0.2 * (middle + 0)));
    EXPECT_FLOAT_EQ(finer.positions[9], float(0.6 * middle + 0.2 * (corner + nextCorner)));
}

TEST(Subdivision, PlanesStayPlanes) {
    TriangleMesh grid;
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x) {
            grid.positions.insert(grid.positions.end(), {float(x), float(y) + 0.3f * float(x), 2});
            const std::uint32_t v = std::uint32_t(5 * y + x);
            if (x < 4 && y < 4) grid.indices.insert(grid.indices.end(), {v, v + 1, v + 5, v + 1, v + 6, v + 5});
        }
    const TriangleMesh mesh = refinedMesh(grid, 3);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
        EXPECT_EQ(mesh.positions[3 * v + 2], 2);
        EXPECT_LT(normalized(at(mesh.normals, v)).z, -0.99999) << v;
    }
    // Inside it reproduces linear functions, so the lattice stays where it is.
    EXPECT_NEAR(mesh.positions[3 * 12], 2, 1e-6);
    EXPECT_NEAR(mesh.positions[3 * 12 + 1], 2.6, 1e-6);
}

/// Limit normals are those of the faces around, the finer the nearer.
TEST(Subdivision, NormalsAreThoseOfTheSurface) {
    for (const int levels : {3, 5}) {
        const TriangleMesh mesh = refinedMesh(pyramid(7), levels);
        std::vector<Vec3d> sums(mesh.vertexCount());
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const std::uint32_t* c = &mesh.indices[i];
            const Vec3d n = triangleNormal(mesh, c[0], c[1], c[2]);
            for (std::size_t k = 0; k < 3; ++k)
                sums[c[k]] = sums[c[k]] + normalized(n);
        }
        double worst = 0;
        for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
            worst = std::max(worst, length(normalized(at(mesh.normals, v)) + normalized(sums[v])));
        EXPECT_LT(worst, levels == 3 ? 0.5 : 0.15);
    }
}

/// Every edge of a refined closed mesh is walked once each way, and Euler's formula holds.
TEST(Subdivision, ClosedMeshesStayClosed) {
    for (const TriangleMesh& control : {tetrahedron(), icosphere(0), icosphere(1)}) {
        const TriangleMesh mesh = refinedMesh(control, 3);
        EXPECT_EQ(mesh.triangleCount(), 64 * control.triangleCount());
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
        for (std::size_t i = 0; i < mesh.indices.size(); ++i)
            ++edges[{mesh.indices[i], mesh.indices[i % 3 == 2 ? i - 2 : i + 1]}];
        for (const auto& [edge, times] : edges) {
            ASSERT_EQ(times, 1);
            ASSERT_TRUE(edges.contains({edge.second, edge.first}));
        }
        EXPECT_EQ(mesh.vertexCount() + mesh.triangleCount(), edges.size() / 2 + 2);
    }
}

/// Three faces at an edge, fans that touch in a point, faces of other winding, on each other or with a repeated corner,
/// and points of no face: no crash, no hang, nothing that is not finite.
TEST(Subdivision, TakesAnyMesh) {
    const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1, 3, 3, 3, -1, 0, 0};
    for (const std::vector<std::uint32_t>& indices :
         std::vector<std::vector<std::uint32_t>>{{0, 1, 2, 1, 0, 3, 0, 1, 4},
                                                 {0, 1, 2, 0, 3, 4},
                                                 {0, 1, 2, 0, 1, 3},
                                                 {0, 1, 2, 0, 1, 2},
                                                 {0, 1, 2, 0, 2, 1},
                                                 {0, 1, 2, 2, 1, 0, 0, 1, 2, 3, 1, 0},
                                                 {0, 0, 1, 2, 2, 2},
                                                 {0, 1, 2, 1, 0, 3, 6, 1, 2, 2, 1, 3, 0, 2, 6}}) {
        const TriangleMesh mesh = refinedMesh(meshOf(points, indices), 3);
        for (const std::vector<float>* table : {&mesh.positions, &mesh.normals})
            for (const float x : *table)
                ASSERT_TRUE(std::isfinite(x));
        for (const std::uint32_t i : mesh.indices)
            ASSERT_LT(i, mesh.vertexCount());
    }
}

TEST(Subdivision, RefusesWhatWouldFillTheMemory) {
    EXPECT_EQ(messageOf([] { refinedMesh(tetrahedron(), 12); }),
              "here: 12 levels of subdivision make more than 16777216 triangles of the 4 given");
}

}  // namespace
}  // namespace penumbra
