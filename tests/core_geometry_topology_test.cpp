// The topology of meshes: figures known from textbooks, a slow search by definition on random lists, and the way back from
// neighbours to indices.
#include "core/geometry/mesh_topology.h"

#include "tests/geometry_fixture.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>

namespace penumbra {
namespace {

using test::Random;
using Indices = std::vector<std::uint32_t>;

std::uint32_t vertexCountOf(const Indices& indices) {
    return indices.empty() ? 0 : *std::max_element(indices.begin(), indices.end()) + 1;
}
MeshTopology topology(const Indices& indices) {
    return topologyOf(indices, vertexCountOf(indices));
}
MeshNeighbours neighbours(const Indices& indices) {
    return findNeighbours(indices, vertexCountOf(indices));
}

/// A grid of quads, each two triangles; joined at the ends where asked, a joint turned by reversing its rows.
Indices grid(std::uint32_t columns, std::uint32_t rows, bool joinColumns, bool joinRows, bool turned = false) {
    const std::uint32_t width = joinColumns ? columns : columns + 1, height = joinRows ? rows : rows + 1;
    const auto vertex = [&](std::uint32_t x, std::uint32_t y) {
        if (x == width) {
            x = 0;
            if (turned) y = height - 1 - y % height;
        }
        return y % height * width + x;
    };
    Indices indices;
    for (std::uint32_t y = 0; y < rows; ++y)
        for (std::uint32_t x = 0; x < columns; ++x) {
            const std::uint32_t a = vertex(x, y), b = vertex(x + 1, y), c = vertex(x + 1, y + 1), d = vertex(x, y + 1);
            indices.insert(indices.end(), {a, b, c, a, c, d});
        }
    return indices;
}

Indices shifted(Indices indices, std::uint32_t by) {
    for (std::uint32_t& i : indices)
        i += by;
    return indices;
}
Indices together(Indices a, const Indices& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

const Indices kTetrahedron{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};

struct Figure {
    const char* name;
    Indices indices;
    bool manifold, closed, oriented;
    std::int64_t euler;
    std::size_t components, borders;
};

const Figure kFigures[] = {
    {"nothing", {}, true, false, true, 0, 0, 0},
    {"a triangle", {0, 1, 2}, true, false, true, 1, 1, 1},
    {"two triangles", {0, 1, 2, 0, 2, 3}, true, false, true, 1, 1, 1},
    {"two that face opposite ways", {0, 1, 2, 0, 3, 2}, true, false, false, 1, 1, 1},
    {"a pillow of two triangles", {0, 1, 2, 0, 2, 1}, true, true, true, 2, 1, 0},
    {"the same triangle twice", {0, 1, 2, 0, 1, 2}, true, true, false, 2, 1, 0},
    {"a tetrahedron", kTetrahedron, true, true, true, 2, 1, 0},
    {"a tetrahedron without a side", {0, 2, 1, 0, 1, 3, 1, 2, 3}, true, false, true, 1, 1, 1},
    {"a sphere", test::icosphere(3).indices, true, true, true, 2, 1, 0},
    {"a plane", grid(5, 4, false, false), true, false, true, 1, 1, 1},
    {"a ring", grid(5, 4, true, false), true, false, true, 0, 1, 2},
    {"a torus", grid(5, 4, true, true), true, true, true, 0, 1, 0},
    {"Moebius' strip", grid(5, 4, true, false, true), true, false, false, 0, 1, 1},
    {"Klein's bottle", grid(5, 4, true, true, true), true, true, false, 0, 1, 0},
    {"two tetrahedra", together(kTetrahedron, shifted(kTetrahedron, 4)), true, true, true, 4, 2, 0},
    {"two tetrahedra that share a vertex", together(kTetrahedron, shifted(kTetrahedron, 3)), false, false, true, 3, 1, 0},
    {"two triangles that share a vertex", {0, 1, 2, 0, 3, 4}, false, false, true, 1, 1, 1},
    {"three triangles at an edge", {0, 1, 2, 0, 1, 3, 0, 1, 4}, false, false, true, 1, 1, 1},
    {"vertices that no triangle has", {7, 9, 11}, true, false, true, 1, 1, 1},
    {"degenerate triangles beside one", {0, 0, 1, 0, 1, 2, 2, 3, 2, 4, 4, 4}, true, false, true, 1, 1, 1},
};

TEST(MeshTopology, OfKnownFigures) {
    for (const Figure& f : kFigures) {
        const MeshTopology t = topology(f.indices);
        EXPECT_EQ(t.isManifold(), f.manifold) << f.name;
        EXPECT_EQ(t.isClosed(), f.closed) << f.name;
        EXPECT_EQ(t.isOriented(), f.oriented) << f.name;
        EXPECT_EQ(t.eulerCharacteristic(), f.euler) << f.name;
        EXPECT_EQ(t.components, f.components) << f.name;
        EXPECT_EQ(t.borders, f.borders) << f.name;
    }
}

/// Renames vertices, reorders triangles, and begins each at another corner.
Indices disguised(const Indices& indices, Random& random) {
    std::vector<std::uint32_t> name(vertexCountOf(indices)), order(indices.size() / 3);
    std::iota(name.begin(), name.end(), 0u);
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(name.begin(), name.end(), random.generator());
    std::shuffle(order.begin(), order.end(), random.generator());
    Indices out;
    for (const std::uint32_t t : order) {
        const std::uint32_t start = random.bits() % 3;
        for (std::uint32_t k = 0; k < 3; ++k)
            out.push_back(name[indices[3 * t + (start + k) % 3]]);
    }
    return out;
}

auto counts(const MeshTopology& t) {
    return std::array{t.triangles,    t.vertices,    t.edges,           t.degenerateTriangles, t.borderEdges,
                      t.crowdedEdges, t.turnedEdges, t.pinchedVertices, t.components,          t.borders};
}

TEST(MeshTopology, AsksForNoNamesAndNoOrder) {
    Random random(1);
    for (const Figure& f : kFigures)
        for (int i = 0; i < 10; ++i)
            EXPECT_EQ(counts(topology(disguised(f.indices, random))), counts(topology(f.indices))) << f.name;
}

/// Half-edges by their two vertices, straight from the definition.
std::map<std::set<std::uint32_t>, std::vector<std::uint32_t>> edgesOf(const Indices& indices) {
    std::map<std::set<std::uint32_t>, std::vector<std::uint32_t>> edges;
    for (std::uint32_t t = 0; t < indices.size() / 3; ++t) {
        const std::set<std::uint32_t> corners{indices[3 * t], indices[3 * t + 1], indices[3 * t + 2]};
        if (corners.size() < 3) continue;
        for (std::uint32_t k = 0; k < 3; ++k)
            edges[{indices[3 * t + k], indices[3 * t + (k + 1) % 3]}].push_back(3 * t + k);
    }
    return edges;
}

Indices randomList(Random& random) {
    const std::uint32_t triangles = random.bits() % 12, vertices = 3 + random.bits() % 9;
    Indices indices;
    for (std::uint32_t i = 0; i < 3 * triangles; ++i)
        indices.push_back(random.bits() % vertices);
    return indices;
}

/// Number of fans at a vertex: triangles there, joined where an edge at the vertex belongs to just the two.
std::size_t fansAt(std::uint32_t vertex, const Indices& indices) {
    std::set<std::uint32_t> left;
    for (const auto& [ends, halfEdges] : edgesOf(indices))
        if (ends.contains(vertex))
            for (const std::uint32_t h : halfEdges)
                left.insert(h / 3);
    std::size_t fans = 0;
    while (!left.empty()) {
        ++fans;
        std::vector<std::uint32_t> fan{*left.begin()};
        left.erase(left.begin());
        while (!fan.empty()) {
            const std::uint32_t t = fan.back();
            fan.pop_back();
            for (const auto& [ends, h] : edgesOf(indices)) {
                if (!ends.contains(vertex) || h.size() != 2) continue;
                for (const int i : {0, 1})
                    if (h[std::size_t(i)] / 3 == t && left.erase(h[std::size_t(1 - i)] / 3)) fan.push_back(h[std::size_t(1 - i)] / 3);
            }
        }
    }
    return fans;
}

TEST(MeshTopology, AgreesWithTheDefinitionOnRandomLists) {
    Random random(2);
    std::size_t crowded = 0, pinched = 0, turned = 0;
    for (int round = 0; round < 500; ++round) {
        const Indices indices = randomList(random);
        const MeshNeighbours n = neighbours(indices);
        const auto edges = edgesOf(indices);
        MeshTopology expected;
        expected.edges = edges.size();
        std::vector<std::uint32_t> across(indices.size(), MeshNeighbours::kDegenerate);
        std::set<std::uint32_t> used;
        for (const auto& [ends, h] : edges) {
            used.insert(ends.begin(), ends.end());
            expected.borderEdges += h.size() == 1;
            expected.crowdedEdges += h.size() > 2;
            for (const std::uint32_t half : h)
                across[half] = h.size() == 1 ? MeshNeighbours::kBorder : MeshNeighbours::kCrowded;
            if (h.size() != 2) continue;
            const bool isTurned = indices[h[0]] == indices[h[1]];
            expected.turnedEdges += isTurned;
            across[h[0]] = h[1] | (isTurned ? MeshNeighbours::kTurned : 0u);
            across[h[1]] = h[0] | (isTurned ? MeshNeighbours::kTurned : 0u);
        }
        expected.vertices = used.size();
        for (const std::uint32_t v : used)
            expected.pinchedVertices += fansAt(v, indices) > 1;
        EXPECT_EQ(n.across, across);
        const MeshTopology t = topology(indices);
        EXPECT_EQ(t.edges, expected.edges);
        EXPECT_EQ(t.vertices, expected.vertices);
        EXPECT_EQ(t.borderEdges, expected.borderEdges);
        EXPECT_EQ(t.crowdedEdges, expected.crowdedEdges);
        EXPECT_EQ(t.turnedEdges, expected.turnedEdges);
        EXPECT_EQ(t.pinchedVertices, expected.pinchedVertices);
        EXPECT_EQ(t.triangles + t.degenerateTriangles, indices.size() / 3);
        crowded += t.crowdedEdges > 0;
        pinched += t.pinchedVertices > 0;
        turned += t.turnedEdges > 0;
    }
    EXPECT_GT(std::min({crowded, pinched, turned}), 50u);   // the lists are worth the name
}

/// Whether b is a under other names of the vertices.
bool isRenamed(const Indices& a, const Indices& b) {
    std::map<std::uint32_t, std::uint32_t> forth, back;
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (forth.try_emplace(a[i], b[i]).first->second != b[i] || back.try_emplace(b[i], a[i]).first->second != a[i]) return false;
    return true;
}

TEST(MeshTopology, NeighboursGiveAManifoldBack) {
    Random random(3);
    for (const Figure& f : kFigures) {
        if (!f.manifold || topology(f.indices).degenerateTriangles > 0) continue;
        for (int i = 0; i < 10; ++i) {
            const Indices indices = disguised(f.indices, random);
            EXPECT_TRUE(isRenamed(indices, indicesOf(neighbours(indices)))) << f.name;
        }
    }
}

TEST(MeshTopology, IndicesHaveTheNeighboursTheyAreMadeOf) {
    Random random(4);
    std::size_t tried = 0;
    for (int round = 0; round < 2000; ++round) {
        const MeshNeighbours n = neighbours(randomList(random));
        if (n.crowdedEdges > 0) continue;
        ++tried;
        EXPECT_EQ(neighbours(indicesOf(n)).across, n.across);
    }
    EXPECT_GT(tried, 300u);
}

/// Whatever is slower than linear would not end: all triangles at one vertex, at one edge, and one vertex far away.
TEST(MeshTopology, HasNoSlowMeshes) {
    constexpr std::uint32_t kMany = 300000;
    Indices wheel, book;
    for (std::uint32_t i = 0; i < kMany; ++i) {
        wheel.insert(wheel.end(), {0, 1 + i, 1 + (i + 1) % kMany});
        book.insert(book.end(), {i % 2, 1 - i % 2, 2 + i});
    }
    const MeshTopology w = topology(wheel), b = topology(book);
    EXPECT_TRUE(w.isManifold());
    EXPECT_EQ(w.borders, 1u);
    EXPECT_EQ(w.eulerCharacteristic(), 1);
    EXPECT_EQ(b.crowdedEdges, 1u);
    EXPECT_EQ(b.borderEdges, 2 * kMany);
}

TEST(MeshTopology, WeldingJoinsWhatHasOnePlace) {
    const TriangleMesh sphere = test::icosphere(2);
    Random random(5);
    const std::size_t corners = sphere.indices.size();
    std::vector<std::uint32_t> place(corners);   // every corner a vertex of its own, in any order
    std::iota(place.begin(), place.end(), 0u);
    std::shuffle(place.begin(), place.end(), random.generator());
    std::vector<float> positions(3 * corners);
    for (std::size_t i = 0; i < corners; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const float x = sphere.positions[3 * sphere.indices[i] + k];
            positions[3 * place[i] + k] = x == 0 && random.bits() % 2 ? -x : x;
        }
    EXPECT_EQ(topologyOf(place, corners).components, sphere.triangleCount());
    const Indices welded = weldedIndices(place, positions);
    EXPECT_EQ(counts(topologyOf(welded, corners)), counts(topology(sphere.indices)));
    EXPECT_EQ(weldedIndices(welded, positions), welded);
}

}  // namespace
}  // namespace penumbra
