// Bilinear patches as triangles, against the definition of a patch in double: how far they are from it, their normals
// and uv, and that neighbours share every vertex.
#include "core/geometry/patches.h"

#include "core/geometry/mesh_topology.h"
#include "core/geometry/ply.h"
#include "tests/geometry_fixture.h"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

/// p00, p10, p01, p11.
using Corners = std::array<Vec3d, 4>;

Vec3d bilinear(const Corners& c, double u, double v) {
    return c[0] * ((1 - u) * (1 - v)) + c[1] * (u * (1 - v)) + c[2] * ((1 - u) * v) + c[3] * (u * v);
}
Vec3d normalOf(const Corners& c, double u, double v) {
    return cross((c[1] - c[0]) * (1 - v) + (c[3] - c[2]) * v, (c[2] - c[0]) * (1 - u) + (c[3] - c[1]) * u);
}
double twistOf(const Corners& c) {
    return length(c[0] - c[1] - c[2] + c[3]);
}
double longestEdge(const Corners& c) {
    return std::max({length(c[1] - c[0]), length(c[3] - c[2]), length(c[2] - c[0]), length(c[3] - c[1])});
}

/// Each patch has four vertices of its own.
PatchMesh patchesOf(const std::vector<Corners>& list) {
    PatchMesh patches;
    reserveVertices(patches.mesh.positions, 4 * list.size());
    for (const Corners& c : list) {
        const auto first = std::uint32_t(patches.mesh.vertexCount());
        for (const Vec3d& p : c)
            patches.mesh.positions.insert(patches.mesh.positions.end(), {float(p.x), float(p.y), float(p.z)});
        patches.quads.push_back(std::uint32_t(patches.mesh.triangleCount()));
        patches.mesh.indices.insert(patches.mesh.indices.end(),
                                    {first, first + 1, first + 3, first, first + 3, first + 2});
    }
    return patches;
}

DiceOptions withUv() {
    DiceOptions options;
    options.needsUv = true;
    return options;
}

/// The value of a table in the middle of a triangle's corners, weighted.
Vec3d within(const std::vector<float>& table, const TriangleMesh& mesh, std::size_t triangle, const double (&b)[3],
             std::size_t width = 3) {
    double sum[3] = {};
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < width; ++i)
            sum[i] += b[k] * table[width * mesh.indices[3 * triangle + k] + i];
    return {sum[0], sum[1], sum[2]};
}

const Corners kSaddle{{{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 0}}};
const Corners kWing{{{-1, -2, 3}, {4, -1, 2}, {0, 3, 2.5}, {3, 2, 5}}};
const Corners kRectangle{{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {2, 3, 0}}};
const Corners kTrapezium{{{0, 0, 0}, {4, 0, 0}, {1, 2, 0}, {2, 2, 0}}};

TEST(Patches, AreMissedByNoMoreThanTheBound) {
    for (const Corners& c : {kSaddle, kWing}) {
        const TriangleMesh mesh = dice(patchesOf({c}), withUv());
        const double n = std::sqrt(double(mesh.triangleCount()) / 2), bound = twistOf(c) / (4 * n * n);
        ASSERT_EQ(n, std::floor(n));
        EXPECT_LE(bound, kDiceTolerance * longestEdge(c));
        EXPECT_GT(twistOf(c) / (4 * (n - 1) * (n - 1)), kDiceTolerance * longestEdge(c)) << "finer than need be";
        double worst = 0;
        for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
            for (const double b : {0., 0.1, 0.5, 0.8}) {
                const double weights[3] = {b, (1 - b) * 0.5, (1 - b) * 0.5};
                const Vec3d uv = within(mesh.uvs, mesh, t, weights, 2);
                worst =
                    std::max(worst, length(within(mesh.positions, mesh, t, weights) - bilinear(c, uv.x, uv.y)));
                const double back[3] = {(1 - b) * 0.5, b, (1 - b) * 0.5};
                const Vec3d other = within(mesh.uvs, mesh, t, back, 2);
                worst =
                    std::max(worst, length(within(mesh.positions, mesh, t, back) - bilinear(c, other.x, other.y)));
            }
        EXPECT_LE(worst, bound + 1e-6);
        EXPECT_GE(worst, 0.95 * bound) << "in the middle of a diagonal";
    }
}

TEST(Patches, HaveTheirOwnNormalsEverywhere) {
    for (const Corners& c : {kSaddle, kWing}) {
        const TriangleMesh mesh = dice(patchesOf({c}), withUv());
        ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
        for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
            const double weights[3] = {0.2, 0.5, 0.3};
            const Vec3d uv = within(mesh.uvs, mesh, t, weights, 2), n = within(mesh.normals, mesh, t, weights);
            EXPECT_LT(length(normalized(n) - normalized(normalOf(c, uv.x, uv.y))), 1e-5);
        }
    }
}

TEST(Patches, SpanGivenNormalsAndUv) {
    PatchMesh patches = patchesOf({kRectangle});
    const Corners n{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {-1, -1, 1}}};
    const Corners uv{{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 3, 0}}};
    for (std::size_t i = 0; i < 4; ++i) {
        patches.mesh.normals.insert(patches.mesh.normals.end(), {float(n[i].x), float(n[i].y), float(n[i].z)});
        patches.mesh.uvs.insert(patches.mesh.uvs.end(), {float(uv[i].x), float(uv[i].y)});
    }
    const TriangleMesh mesh = dice(patches, withUv());
    EXPECT_GT(mesh.triangleCount(), 2u);
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const double weights[3] = {0.3, 0.3, 0.4};
        const Vec3d p = within(mesh.positions, mesh, t, weights);
        const double u = p.x / 2, v = p.y / 3;
        EXPECT_LE(length(within(mesh.normals, mesh, t, weights) - bilinear(n, u, v)), kDiceTolerance * std::sqrt(3) + 1e-6);
        EXPECT_LE(length(within(mesh.uvs, mesh, t, weights, 2) - bilinear(uv, u, v)), kDiceTolerance * std::sqrt(13) + 1e-6);
    }
    // Without a look at uv the normals alone decide, and where they agree the rectangle is two triangles.
    patches.mesh.uvs = {};
    for (std::size_t i = 0; i < 12; ++i)
        patches.mesh.normals[i] = i % 3 == 2 ? 1.f : 0.f;
    EXPECT_EQ(dice(patches, {}).triangleCount(), 2u);
}

TEST(Patches, ThatArePlanarAreTwoTrianglesWhereTheyCan) {
    for (const Vec3d& far : {Vec3d{}, Vec3d{1000, -3000, 500}}) {
        const auto moved = [&](Corners c) {
            for (Vec3d& p : c)
                p = Vec3d{p.z, p.x, p.y} + far;
            return c;
        };
        EXPECT_EQ(dice(patchesOf({moved(kRectangle)}), {}).triangleCount(), 2u);
        EXPECT_EQ(dice(patchesOf({moved(kRectangle)}), withUv()).triangleCount(), 2u);
        EXPECT_EQ(dice(patchesOf({moved(kTrapezium)}), {}).triangleCount(), 2u);
    }
    const TriangleMesh rectangle = dice(patchesOf({kRectangle}), withUv());
    EXPECT_EQ(rectangle.uvs, (std::vector<float>{0, 0, 1, 0, 0, 1, 1, 1}));
    EXPECT_TRUE(rectangle.normals.empty());
    // u and v do not go evenly across a trapezium.
    const TriangleMesh diced = dice(patchesOf({kTrapezium}), withUv());
    EXPECT_GT(diced.triangleCount(), 200u);
    EXPECT_TRUE(diced.normals.empty());
    EXPECT_NEAR(totalArea(diced), 5, 1e-5);
    for (std::size_t t = 0; t < diced.triangleCount(); ++t) {
        const double weights[3] = {0.2, 0.4, 0.4};
        const Vec3d uv = within(diced.uvs, diced, t, weights, 2);
        EXPECT_LE(length(within(diced.positions, diced, t, weights) - bilinear(kTrapezium, uv.x, uv.y)),
                  kDiceTolerance * 4 + 1e-6);
    }
}

TEST(Patches, FoldWhereTheyAreNotConvex) {
    // An arrow head: the patch covers more than the polygon, once from each side.
    const Corners arrow{{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {.5, .5, 0}}};
    double folded = 0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j)
            folded += std::abs(normalOf(arrow, (i + .5) / kSteps, (j + .5) / kSteps).z) / (kSteps * kSteps);
    EXPECT_NEAR(totalArea(dice(patchesOf({arrow}), {})), folded, 0.01 * folded);
}

TEST(Patches, HaveTheirArea) {
    double area = 0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j)
            area += length(normalOf(kSaddle, (i + .5) / kSteps, (j + .5) / kSteps)) / (kSteps * kSteps);
    EXPECT_NEAR(totalArea(dice(patchesOf({kSaddle}), {})), area, 1e-3 * area);
}

TEST(Patches, MeasureTheToleranceWhereTheyStand) {
    DiceOptions flattened;
    flattened.place = scaling(1, 1, 0.001);
    EXPECT_EQ(dice(patchesOf({kSaddle}), flattened).triangleCount(), 2u);
    DiceOptions drawn;
    drawn.place = scaling(1, 1, 1e6);
    EXPECT_GT(dice(patchesOf({kSaddle}), drawn).triangleCount(), dice(patchesOf({kSaddle}), {}).triangleCount());
}

/// The faces of a cube with its corners moved about, each face begun at any corner, no vertex shared.
std::vector<Corners> crookedCube(std::uint32_t seed) {
    Random random(seed);
    Vec3d corner[8];
    for (int i = 0; i < 8; ++i)
        corner[i] = Vec3d{double(i & 1), double(i >> 1 & 1), double(i >> 2)} + random.inCube(0.3);
    constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::vector<Corners> list;
    for (const auto& face : kFaces) {
        const std::uint32_t start = random.bits();
        const auto at = [&](std::uint32_t i) { return corner[face[(start + i) % 4]]; };
        list.push_back({{at(0), at(1), at(3), at(2)}});
    }
    return list;
}

MeshTopology weldedTopology(const TriangleMesh& mesh) {
    return topologyOf(weldedIndices(mesh.indices, mesh.positions), mesh.vertexCount());
}

TEST(Patches, ShareEveryVertexOfAnEdgeWithTheirNeighbours) {
    for (std::uint32_t seed = 1; seed <= 50; ++seed) {
        const TriangleMesh mesh = dice(patchesOf(crookedCube(seed)), withUv());
        EXPECT_GT(mesh.triangleCount(), 12u * 9);
        const MeshTopology topology = weldedTopology(mesh);
        EXPECT_TRUE(topology.isClosed() && topology.isOriented());
        EXPECT_EQ(topology.eulerCharacteristic(), 2);
    }
}

TEST(Patches, ShareThemWithTriangles) {
    for (std::uint32_t seed = 1; seed <= 50; ++seed) {
        // A tent of triangles in the place of the first face.
        const std::vector<Corners> cube = crookedCube(seed);
        PatchMesh patches = patchesOf({cube.begin() + 1, cube.end()});
        TriangleMesh& mesh = patches.mesh;
        const auto add = [&](Vec3d p) {
            mesh.positions.insert(mesh.positions.end(), {float(p.x), float(p.y), float(p.z)});
        };
        const Corners& c = cube[0];
        const Vec3d ring[4] = {c[0], c[1], c[3], c[2]}, top = (c[0] + c[1] + c[2] + c[3]) * 0.25 + Vec3d{0, 0, -0.4};
        for (std::uint32_t i = 0; i < 4; ++i) {
            const auto first = std::uint32_t(mesh.vertexCount());
            add(top), add(ring[i]), add(ring[(i + 1) % 4]);
            mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2});
        }
        DiceOptions options = withUv();
        options.polygons = true;
        options.numbersFaces = true;
        const TriangleMesh diced = dice(std::move(patches), options);
        const MeshTopology topology = weldedTopology(diced);
        EXPECT_TRUE(topology.isClosed() && topology.isOriented()) << seed;
        EXPECT_EQ(diced.faceIndices.front(), 0);
        EXPECT_EQ(diced.faceIndices.back(), 8);
        EXPECT_TRUE(std::is_sorted(diced.faceIndices.begin(), diced.faceIndices.end()));
        EXPECT_EQ(diced.normals.size(), diced.positions.size());
    }
}

TEST(Patches, WithoutAnEdgeHaveNoTrianglesWithoutArea) {
    const Corners cone{{{0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {0, 1, -1}}};
    TriangleMesh mesh = dice(patchesOf({cone, kSaddle}), withUv());
    EXPECT_GT(mesh.triangleCount(), 1000u);
    EXPECT_EQ(dropBadTriangles(mesh), 0u);
}

TEST(Patches, TakeNoMoreTrianglesThanAllowed) {
    DiceOptions options;
    options.mostTriangles = 100;
    EXPECT_EQ(dice(patchesOf({kSaddle}), options).triangleCount(), 98u);
    options.mostTriangles = 0;
    EXPECT_EQ(dice(patchesOf({kSaddle, kWing}), options).triangleCount(), 4u);
    const std::vector<Corners> many(100000, kSaddle);
    EXPECT_LE(dice(patchesOf(many), {}).triangleCount(), std::size_t(1) << 20);
}

TEST(Patches, OfAnyNumbersAreFewAndSound) {
    const double nan = std::nan(""), infinity = HUGE_VAL, huge = 3e38, tiny = 1e-44;
    Random random(5);
    const double values[] = {0, 1, -1, nan, infinity, -infinity, huge, -huge, tiny, 1e-20, 1e19};
    for (int round = 0; round < 2000; ++round) {
        const auto any = [&] { return values[random.bits() % std::size(values)]; };
        Corners c;
        for (Vec3d& p : c)
            p = {any(), any(), any()};
        PatchMesh patches = patchesOf({c, kTrapezium});
        for (std::size_t i = 0; round % 2 && i < 24; ++i)
            patches.mesh.normals.push_back(float(any()));
        for (std::size_t i = 0; round % 3 && i < 16; ++i)
            patches.mesh.uvs.push_back(float(any()));
        DiceOptions options = withUv();
        options.polygons = round % 5 == 0;
        options.place = scaling(1, round % 7 ? 1 : 0, 1);
        TriangleMesh mesh = dice(std::move(patches), options);
        ASSERT_LE(mesh.triangleCount(), std::size_t(4 * kMostCells * kMostCells));
        ASSERT_EQ(mesh.normals.size() % 3, 0u);
        for (const std::uint32_t i : mesh.indices)
            ASSERT_LT(i, mesh.vertexCount());
        dropBadTriangles(mesh);
    }
}

TEST(Patches, OfPlyFilesArePolygonsWherePlanar) {
    const auto read = [](const std::string& vertices, const std::string& faces, int faceCount) {
        Warnings strict(true);
        return readPlyBytes("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                            "property float z\nelement face " +
                                std::to_string(faceCount) +
                                "\nproperty list uchar int vertex_indices\nend_header\n" + vertices + faces,
                            "m.ply", strict);
    };
    DiceOptions options;
    options.polygons = true;
    // Planar, and no parallelogram; concave; and bent by less than the tolerance.
    EXPECT_EQ(dice(read("0 0 0 4 0 0 2 2 0 1 2 0\n", "4 0 1 2 3\n", 1), options).indices,
              (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(dice(read("0 0 0 .5 .5 0 3 0 0 0 3 0\n", "4 0 1 2 3\n", 1), options).indices,
              (std::vector<std::uint32_t>{0, 1, 3, 1, 2, 3}));
    EXPECT_EQ(dice(read("0 0 0 1 0 0 1 1 .001 0 1 0\n", "4 0 1 2 3\n", 1), options).triangleCount(), 2u);
    // The saddle: corners in order round it.
    const TriangleMesh saddle = dice(read("0 0 0 1 0 1 1 1 0 0 1 1\n", "4 0 1 2 3\n", 1), options);
    const double n = std::sqrt(double(saddle.triangleCount()) / 2);
    EXPECT_LE(twistOf(kSaddle) / (4 * n * n), kPolygonTolerance * std::sqrt(3));
    EXPECT_GT(twistOf(kSaddle) / (4 * (n - 1) * (n - 1)), kPolygonTolerance * std::sqrt(3));
    DiceOptions alike;
    alike.mostTriangles = saddle.triangleCount();
    EXPECT_EQ(saddle.positions, dice(patchesOf({kSaddle}), alike).positions);
    EXPECT_EQ(saddle.normals, dice(patchesOf({kSaddle}), alike).normals);
    // But not where it is a small part of a large mesh.
    PatchMesh among = patchesOf({kSaddle, kRectangle});
    for (std::size_t i = 12; i < 24; ++i)
        among.mesh.positions[i] *= 1000;
    EXPECT_EQ(dice(among, options).triangleCount(), 4u);
    // uv that nobody gave, but somebody needs, are the patch's.
    options.needsUv = true;
    const TriangleMesh square = dice(read("0 0 0 1 0 0 1 1 0 0 1 0\n", "4 0 1 2 3\n", 1), options);
    ASSERT_EQ(square.triangleCount(), 2u);
    for (std::uint32_t v = 0; v < square.vertexCount(); ++v) {
        EXPECT_EQ(square.uvs[2 * v], square.positions[3 * v]);
        EXPECT_EQ(square.uvs[2 * v + 1], square.positions[3 * v + 1]);
    }
}

}  // namespace
}  // namespace penumbra::test
