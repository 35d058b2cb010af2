#include "core/geometry/mesh_topology.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>

namespace penumbra {
namespace {

using Neighbours = MeshNeighbours;

/// Disjoint sets of the numbers below a count, by path halving; the root of a set is its least member.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

bool isDegenerate(std::span<const std::uint32_t> indices, std::size_t triangle) {
    const std::uint32_t a = indices[3 * triangle], b = indices[3 * triangle + 1], c = indices[3 * triangle + 2];
    return a == b || b == c || c == a;
}

struct Edge {
    std::uint32_t from, to;
    std::uint32_t low() const { return std::min(from, to); }
    std::uint32_t high() const { return std::max(from, to); }
    bool joins(const Edge& other) const { return low() == other.low() && high() == other.high(); }
};

Edge edgeOf(std::span<const std::uint32_t> indices, std::uint32_t halfEdge) {
    return {indices[halfEdge], indices[Neighbours::next(halfEdge)]};
}

/// Stable counting sort of `items` by key(item) < keyCount.
template <class Key>
void sortBy(std::vector<std::uint32_t>& items, std::size_t keyCount, const Key& key) {
    std::vector<std::uint32_t> place(keyCount + 1, 0);
    for (const std::uint32_t i : items)
        ++place[std::size_t(key(i)) + 1];
    std::partial_sum(place.begin(), place.end(), place.begin());
    std::vector<std::uint32_t> sorted(items.size());
    for (const std::uint32_t i : items)
        sorted[place[key(i)]++] = i;
    items = std::move(sorted);
}

/// The half-edges of all triangles that are not degenerate, those of one edge side by side, in the order of their numbers.
std::vector<std::uint32_t> halfEdgesByEdge(std::span<const std::uint32_t> indices, std::size_t vertexCount) {
    std::vector<std::uint32_t> order;
    order.reserve(indices.size());
    for (std::size_t t = 0; t < indices.size() / 3; ++t)
        if (!isDegenerate(indices, t))
            for (std::uint32_t k = 0; k < 3; ++k)
                order.push_back(std::uint32_t(3 * t) + k);
    sortBy(order, vertexCount, [&](std::uint32_t h) { return edgeOf(indices, h).high(); });
    sortBy(order, vertexCount, [&](std::uint32_t h) { return edgeOf(indices, h).low(); });
    return order;
}

/// Calls f(corner, corner of the neighbour) for both ends of every edge that two triangles share; a corner has the number of
/// the half-edge that leaves it.
template <class Function>
void forEachSharedCorner(const Neighbours& n, const Function& f) {
    for (std::uint32_t h = 0; h < n.across.size(); ++h) {
        if (!n.hasNeighbour(h) || n.neighbour(h) < h) continue;
        const std::uint32_t g = n.neighbour(h), end = Neighbours::next(g);
        f(h, n.isTurned(h) ? g : end);
        f(Neighbours::next(h), n.isTurned(h) ? end : g);
    }
}

/// The corners of a mesh, in sets that are one vertex by way of neighbours: one set a fan of triangles.
DisjointSets fansOf(const Neighbours& n) {
    DisjointSets fans(n.across.size());
    forEachSharedCorner(n, [&](std::uint32_t a, std::uint32_t b) { fans.join(a, b); });
    return fans;
}

}  // namespace

MeshNeighbours findNeighbours(std::span<const std::uint32_t> indices, std::size_t vertexCount) {
    Neighbours n;
    n.across.assign(indices.size(), Neighbours::kDegenerate);
    const std::vector<std::uint32_t> order = halfEdgesByEdge(indices, vertexCount);
    for (std::size_t i = 0; i < order.size();) {
        const Edge edge = edgeOf(indices, order[i]);
        std::size_t end = i + 1;
        while (end < order.size() && edgeOf(indices, order[end]).joins(edge))
            ++end;
        ++n.edges;
        if (end - i == 2) {
            const std::uint32_t turned = edgeOf(indices, order[i + 1]).from == edge.from ? Neighbours::kTurned : 0u;
            n.across[order[i]] = order[i + 1] | turned;
            n.across[order[i + 1]] = order[i] | turned;
        } else {
            const bool alone = end - i == 1;
            n.crowdedEdges += !alone;
            for (std::size_t k = i; k < end; ++k)
                n.across[order[k]] = alone ? Neighbours::kBorder : Neighbours::kCrowded;
        }
        i = end;
    }
    return n;
}

std::vector<std::uint32_t> indicesOf(const MeshNeighbours& n) {
    DisjointSets fans = fansOf(n);
    std::vector<std::uint32_t> indices(n.across.size());
    std::uint32_t vertices = 0;
    for (std::uint32_t corner = 0; corner < indices.size(); ++corner) {
        if (n.across[corner] == Neighbours::kDegenerate && corner % 3 != 0) {
            indices[corner] = indices[corner - 1];
            continue;
        }
        const std::uint32_t first = fans.root(corner);   // the least corner of the fan, so it has its number already
        indices[corner] = first == corner ? vertices++ : indices[first];
    }
    return indices;
}

MeshTopology topologyOf(std::span<const std::uint32_t> indices, std::size_t vertexCount) {
    const Neighbours n = findNeighbours(indices, vertexCount);
    MeshTopology t;
    t.edges = n.edges;
    t.crowdedEdges = n.crowdedEdges;
    {
        // A vertex of two fans is pinched. (So are most ends of crowded edges, which are no manifold anyway.)
        DisjointSets fans = fansOf(n);
        std::vector<std::uint8_t> fanCount(vertexCount, 0);
        for (std::uint32_t corner = 0; corner < indices.size(); ++corner) {
            if (n.across[corner] == Neighbours::kDegenerate || fans.root(corner) != corner) continue;
            std::uint8_t& count = fanCount[indices[corner]];
            t.vertices += count == 0;
            t.pinchedVertices += count == 1;
            count = std::min<std::uint8_t>(2, count + 1);
        }
    }
    DisjointSets connected(vertexCount), borders(vertexCount);
    std::vector<std::uint8_t> onBorder(vertexCount, 0), used(vertexCount, 0);
    for (std::uint32_t h = 0; h < indices.size(); ++h) {
        const std::uint32_t beyond = n.across[h];
        if (beyond == Neighbours::kDegenerate) {
            t.degenerateTriangles += h % 3 == 0;
            continue;
        }
        t.triangles += h % 3 == 0;
        const Edge edge = edgeOf(indices, h);
        used[edge.from] = 1;
        connected.join(edge.from, edge.to);
        if (beyond == Neighbours::kBorder) {
            ++t.borderEdges;
            onBorder[edge.from] = onBorder[edge.to] = 1;
            borders.join(edge.from, edge.to);
        } else if (n.hasNeighbour(h)) {
            t.turnedEdges += n.isTurned(h) && n.neighbour(h) > h;
        }
    }
    for (std::uint32_t v = 0; v < vertexCount; ++v) {
        t.components += used[v] && connected.root(v) == v;
        t.borders += onBorder[v] && borders.root(v) == v;
    }
    return t;
}

std::vector<std::uint32_t> weldedIndices(std::span<const std::uint32_t> indices, std::span<const float> positions) {
    // Equal coordinates are brought together by sorting by 16-bit digits of all three, so that no mesh is slow.
    const std::size_t count = positions.size() / 3;
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    const auto bits = [&](std::uint32_t vertex, std::size_t axis) {
        return std::bit_cast<std::uint32_t>(positions[3 * std::size_t(vertex) + axis] + 0.f);   // -0 becomes 0
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const int shift : {0, 16})
            sortBy(order, 1u << 16, [&](std::uint32_t v) { return bits(v, axis) >> shift & 0xFFFFu; });
    std::vector<std::uint32_t> first(count);
    const auto same = [&](std::uint32_t a, std::uint32_t b) {
        return bits(a, 0) == bits(b, 0) && bits(a, 1) == bits(b, 1) && bits(a, 2) == bits(b, 2);
    };
    for (std::size_t i = 0; i < count; ++i)
        first[order[i]] = i > 0 && same(order[i], order[i - 1]) ? first[order[i - 1]] : order[i];
    std::vector<std::uint32_t> welded(indices.begin(), indices.end());
    for (std::uint32_t& i : welded)
        i = first[i];
    return welded;
}

}  // namespace penumbra
