#include "core/geometry/mesh_strips.h"

#include <algorithm>

namespace penumbra {
namespace {

using Neighbours = MeshNeighbours;
constexpr std::uint32_t kNothing = Neighbours::kBorder;

void addTriangle(std::vector<std::uint32_t>& indices, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) indices.insert(indices.end(), {a, b, c});
}

/// Which triangles are in a list already, or in the one that is being tried.
class Walker {
public:
    Walker(std::span<const std::uint32_t> indices, const Neighbours& neighbours)
        : indices_(indices), neighbours_(neighbours), taken_(indices.size() / 3, 0) {
        for (std::uint32_t t = 0; t < taken_.size(); ++t)
            if (neighbours.across[3 * t] == Neighbours::kDegenerate) taken_[t] = kTaken;
    }
    bool isTaken(std::uint32_t triangle) const { return taken_[triangle] == kTaken; }
    void take(std::uint32_t halfEdge) { taken_[halfEdge / 3] = kTaken; }
    std::uint32_t from(std::uint32_t halfEdge) const { return indices_[halfEdge]; }

    /// Follows step(half-edge by which a triangle is entered, its number on the walk), which names the half-edge to go across, from
    /// triangle to triangle, over such as are in no list and on this walk no second time. Gives what it entered by.
    template <class Step>
    void walk(std::uint32_t start, const Step& step, std::vector<std::uint32_t>& entered) {
        entered.clear();
        ++walkNumber_;
        for (std::uint32_t at = start; at != kNothing; at = across(step(at, entered.size() - 1))) {
            if (taken_[at / 3] == kTaken || taken_[at / 3] == walkNumber_) return;
            taken_[at / 3] = walkNumber_;
            entered.push_back(at);
        }
    }

private:
    static constexpr std::uint32_t kTaken = 0xFFFFFFFFu;
    std::uint32_t across(std::uint32_t halfEdge) const {
        return neighbours_.hasNeighbour(halfEdge) && !neighbours_.isTurned(halfEdge) ? neighbours_.neighbour(halfEdge) : kNothing;
    }

    std::span<const std::uint32_t> indices_;
    const Neighbours& neighbours_;
    std::vector<std::uint32_t> taken_;
    std::uint32_t walkNumber_ = 0;
};

/// A strip enters a triangle by the edge of its first two vertices.
std::uint32_t stripStep(std::uint32_t entry, std::size_t number) {
    return number % 2 == 0 ? Neighbours::next(entry) : Neighbours::previous(entry);
}
/// A fan enters a triangle by the edge that leaves its centre.
std::uint32_t fanStep(std::uint32_t entry, std::size_t) {
    return Neighbours::previous(entry);
}

/// The vertices of a list whose triangles were entered by these half-edges: those of the first edge, then the corner opposite
/// to each.
void write(const Walker& walker, std::span<const std::uint32_t> entered, std::vector<std::uint32_t>& vertices) {
    vertices.insert(vertices.end(), {walker.from(entered[0]), walker.from(Neighbours::next(entered[0]))});
    for (const std::uint32_t entry : entered)
        vertices.push_back(walker.from(Neighbours::previous(entry)));
}

/// Lists that begin at each triangle that is left, at the best of its three edges. A try costs no more than what is taken in
/// the end, so all together is linear. `begin` may move the start of a try.
template <class Step, class Begin>
VertexLists makeLists(std::span<const std::uint32_t> indices, const Neighbours& neighbours, const Step& step, const Begin& begin) {
    VertexLists lists;
    Walker walker(indices, neighbours);
    std::vector<std::uint32_t> tried, best;
    for (std::uint32_t t = 0; t < indices.size() / 3; ++t) {
        if (walker.isTaken(t)) continue;
        best.clear();
        for (std::uint32_t k = 0; k < 3; ++k) {
            walker.walk(begin(walker, 3 * t + k, tried), step, tried);
            if (tried.size() > best.size()) std::swap(tried, best);
        }
        for (const std::uint32_t entry : best)
            walker.take(entry);
        write(walker, best, lists.vertices);
        lists.ends.push_back(std::uint32_t(lists.vertices.size()));
    }
    return lists;
}

}  // namespace

VertexLists splitLists(std::span<const std::uint32_t> vertices, std::uint32_t separator) {
    VertexLists lists;
    const auto endList = [&] {
        if (lists.vertices.size() > (lists.ends.empty() ? 0 : lists.ends.back())) lists.ends.push_back(std::uint32_t(lists.vertices.size()));
    };
    for (const std::uint32_t v : vertices) {
        if (v == separator) endList();
        else lists.vertices.push_back(v);
    }
    endList();
    return lists;
}

std::vector<std::uint32_t> trianglesOfStrips(const VertexLists& strips) {
    std::vector<std::uint32_t> indices;
    for (std::size_t s = 0; s < strips.count(); ++s) {
        const std::span<const std::uint32_t> v = strips.list(s);
        for (std::size_t i = 2; i < v.size(); ++i) {
            const bool odd = i % 2 != 0;
            addTriangle(indices, v[odd ? i - 1 : i - 2], v[odd ? i - 2 : i - 1], v[i]);
        }
    }
    return indices;
}

std::vector<std::uint32_t> trianglesOfFans(const VertexLists& fans) {
    std::vector<std::uint32_t> indices;
    for (std::size_t f = 0; f < fans.count(); ++f) {
        const std::span<const std::uint32_t> v = fans.list(f);
        for (std::size_t i = 2; i < v.size(); ++i)
            addTriangle(indices, v[0], v[i - 1], v[i]);
    }
    return indices;
}

VertexLists makeStrips(std::span<const std::uint32_t> indices, const MeshNeighbours& neighbours) {
    const auto begin = [](Walker&, std::uint32_t start, std::vector<std::uint32_t>&) { return start; };
    return makeLists(indices, neighbours, stripStep, begin);
}

VertexLists makeFans(std::span<const std::uint32_t> indices, const MeshNeighbours& neighbours) {
    // Back to where the fan begins, entering each triangle by the edge that leads to the centre, then forth.
    const auto begin = [](Walker& walker, std::uint32_t start, std::vector<std::uint32_t>& back) {
        walker.walk(Neighbours::previous(start), [](std::uint32_t entry, std::size_t) { return Neighbours::next(entry); }, back);
        return Neighbours::next(back.back());
    };
    return makeLists(indices, neighbours, fanStep, begin);
}

}  // namespace penumbra
