// Strips and fans: what they mean, and that each way back gives the triangles that went in.
#include "core/geometry/mesh_strips.h"

#include "tests/geometry_fixture.h"

#include <gtest/gtest.h>

#include <numeric>

namespace penumbra {
namespace {

using test::Random;
using Indices = std::vector<std::uint32_t>;

VertexLists oneList(const Indices& vertices) {
    return {vertices, {std::uint32_t(vertices.size())}};
}

TEST(MeshStrips, AlternateAndFaceOneWay) {
    EXPECT_EQ(trianglesOfStrips(oneList({5, 6, 7, 8, 9})), (Indices{5, 6, 7, 7, 6, 8, 7, 8, 9}));
    EXPECT_EQ(trianglesOfFans(oneList({5, 6, 7, 8})), (Indices{5, 6, 7, 5, 7, 8}));
    // Too short for a triangle.
    for (const Indices& few : {Indices{}, Indices{1}, Indices{1, 2}}) {
        EXPECT_TRUE(trianglesOfStrips(oneList(few)).empty());
        EXPECT_TRUE(trianglesOfFans(oneList(few)).empty());
    }
}

/// A vertex said twice is a joint: it makes no triangle, and the alternation goes on over it.
TEST(MeshStrips, ReadOverJoints) {
    EXPECT_EQ(trianglesOfStrips(oneList({0, 1, 2, 2, 2, 3, 3, 4, 5})), (Indices{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(trianglesOfStrips(oneList({0, 1, 2, 2, 3, 3, 4, 5})), (Indices{0, 1, 2, 4, 3, 5}));
    EXPECT_EQ(trianglesOfStrips(oneList({0, 1, 2, 2, 3, 4, 5})), (Indices{0, 1, 2, 3, 2, 4, 3, 4, 5}));
    EXPECT_EQ(trianglesOfFans(oneList({0, 1, 2, 2, 3, 0, 4, 5})), (Indices{0, 1, 2, 0, 2, 3, 0, 4, 5}));
}

TEST(MeshStrips, SplitAtSeparators) {
    constexpr std::uint32_t kEnd = 0xFFFFFFFFu;
    const VertexLists lists = splitLists(Indices{kEnd, 0, 1, 2, kEnd, kEnd, 3, 4, 5, 6});
    ASSERT_EQ(lists.count(), 2u);
    EXPECT_EQ(Indices(lists.list(0).begin(), lists.list(0).end()), (Indices{0, 1, 2}));
    EXPECT_EQ(Indices(lists.list(1).begin(), lists.list(1).end()), (Indices{3, 4, 5, 6}));
    EXPECT_EQ(splitLists(Indices{}).count(), 0u);
    EXPECT_EQ(splitLists(Indices{kEnd}).count(), 0u);
    EXPECT_EQ(splitLists(Indices{1, 2, 3, 9}, 9).count(), 1u);
}

/// The triangles of a list, each begun at its least corner, sorted: equal where orientation and number are.
std::vector<std::array<std::uint32_t, 3>> triangleSet(const Indices& indices) {
    std::vector<std::array<std::uint32_t, 3>> set;
    for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
        std::array<std::uint32_t, 3> t{indices[i], indices[i + 1], indices[i + 2]};
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        set.push_back(t);
    }
    std::sort(set.begin(), set.end());
    return set;
}

struct Made {
    VertexLists strips, fans;
};
Made made(const Indices& indices) {
    const std::size_t vertices = indices.empty() ? 0 : *std::max_element(indices.begin(), indices.end()) + std::size_t(1);
    const MeshNeighbours n = findNeighbours(indices, vertices);
    return {makeStrips(indices, n), makeFans(indices, n)};
}

void expectRoundTrip(const Indices& indices) {
    const Made lists = made(indices);
    EXPECT_EQ(triangleSet(trianglesOfStrips(lists.strips)), triangleSet(indices));
    EXPECT_EQ(triangleSet(trianglesOfFans(lists.fans)), triangleSet(indices));
    // The other way: what was read makes lists that read the same.
    const Indices read = trianglesOfStrips(lists.strips);
    EXPECT_EQ(triangleSet(trianglesOfStrips(made(read).strips)), triangleSet(read));
}

/// Crowded edges, triangles twice, opposite ways, degenerate ones: everything is likely in so few vertices.
TEST(MeshStrips, GiveRandomListsBack) {
    Random random(1);
    for (int round = 0; round < 2000; ++round) {
        Indices indices;
        const std::uint32_t triangles = random.bits() % 20, vertices = 1 + random.bits() % 12;
        for (std::uint32_t i = 0; i < 3 * triangles; ++i)
            indices.push_back(random.bits() % vertices);
        expectRoundTrip(indices);
    }
}

/// A sphere with some triangles taken out, and some turned: borders, and neighbours that face opposite ways.
TEST(MeshStrips, GivePiecesOfSpheresBack) {
    Random random(2);
    for (const double missing : {0.0, 0.1, 0.6})
        for (const double turned : {0.0, 0.2}) {
            const TriangleMesh sphere = test::icosphere(3);
            Indices indices;
            for (std::size_t i = 0; i < sphere.indices.size(); i += 3) {
                if (random() < missing) continue;
                indices.insert(indices.end(), &sphere.indices[i], &sphere.indices[i] + 3);
                if (random() < turned) std::swap(indices[indices.size() - 1], indices[indices.size() - 2]);
            }
            expectRoundTrip(indices);
        }
}

TEST(MeshStrips, AreLong) {
    // A band is one strip, a wheel one fan, wherever their triangles stand in the list.
    Indices band, wheel;
    for (std::uint32_t i = 0; i < 50; ++i) {
        const bool odd = i % 2 != 0;
        band.insert(band.end(), {odd ? i + 1 : i, odd ? i : i + 1, i + 2});
        wheel.insert(wheel.end(), {0, 1 + i, 1 + (i + 1) % 50});
    }
    EXPECT_EQ(made(band).strips.count(), 1u);
    EXPECT_EQ(made(wheel).fans.count(), 1u);
    EXPECT_EQ(made(wheel).fans.vertices.size(), 52u);
    std::rotate(wheel.begin(), wheel.begin() + 60, wheel.end());
    EXPECT_EQ(made(wheel).fans.count(), 1u);

    const TriangleMesh sphere = test::icosphere(4);
    const Made lists = made(sphere.indices);
    EXPECT_LT(double(lists.strips.vertices.size()), 1.5 * double(sphere.triangleCount()));   // indices: 3 a triangle
    EXPECT_LT(double(lists.fans.vertices.size()), 1.7 * double(sphere.triangleCount()));
}

TEST(MeshStrips, OfManyTrianglesAtOneVertexAreMadeInLinearTime) {
    constexpr std::uint32_t kMany = 300000;
    Indices wheel;
    for (std::uint32_t i = 0; i < kMany; ++i)
        wheel.insert(wheel.end(), {0, 1 + i, 1 + (i + 1) % kMany});
    const Made lists = made(wheel);
    EXPECT_EQ(lists.fans.count(), 1u);
    EXPECT_EQ(trianglesOfStrips(lists.strips).size(), wheel.size());
}

}  // namespace
}  // namespace penumbra
