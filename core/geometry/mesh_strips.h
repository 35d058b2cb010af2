// Triangle strips and fans: index lists that share vertices between neighbours, made of a mesh and read back.
//
// Conventions: of a strip v0 v1 v2 ... every vertex from the third on makes a triangle with the two before it, (v0 v1 v2),
// (v2 v1 v3), (v2 v3 v4), ...: each other one with its first two corners exchanged, so that all face the same way. Of a fan v0
// v1 v2 ... the triangles are (v0 v1 v2), (v0 v2 v3), ... A triangle that names a vertex twice is none: strips use such to join
// pieces, and they keep the alternation going. They are left out by whoever makes lists and by whoever reads them.
//
// What is made covers each triangle of the mesh once, with its orientation, whatever the mesh: a list never goes across an
// edge of three triangles, nor to a neighbour that faces the other way. It is greedy, so lists are long, not the fewest
// (finding those is NP-hard: Arkin et al. 1996). Linear time. Thread safety: pure functions.
#pragma once

#include "core/geometry/mesh_topology.h"

namespace penumbra {

/// Lists of vertices, one behind the other.
struct VertexLists {
    std::vector<std::uint32_t> vertices;
    std::vector<std::uint32_t> ends;   ///< of each list, in `vertices`

    std::size_t count() const { return ends.size(); }
    std::span<const std::uint32_t> list(std::size_t i) const {
        const std::size_t begin = i == 0 ? 0 : ends[i - 1];
        return std::span(vertices).subspan(begin, ends[i] - begin);
    }
};

/// The lists between the separators of a text that has them in one line, as files do; empty ones are left out.
VertexLists splitLists(std::span<const std::uint32_t> vertices, std::uint32_t separator = 0xFFFFFFFFu);

/// Three indices a triangle, in the order of the lists.
std::vector<std::uint32_t> trianglesOfStrips(const VertexLists& strips);
std::vector<std::uint32_t> trianglesOfFans(const VertexLists& fans);

/// `neighbours`: those of the indices.
VertexLists makeStrips(std::span<const std::uint32_t> indices, const MeshNeighbours& neighbours);
VertexLists makeFans(std::span<const std::uint32_t> indices, const MeshNeighbours& neighbours);

}  // namespace penumbra
