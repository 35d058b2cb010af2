// Mesh topology: for each edge of each triangle the triangle beyond it, and what a mesh is as a surface: manifold or not,
// closed or with borders, consistently oriented.
//
// Conventions: a mesh is its index list, three vertices a triangle; nothing is asked about positions. Half-edge 3 t + k is the
// edge of triangle t from its corner k to the next. Two triangles are neighbours across an edge where no third one has it. A
// triangle that names a vertex twice is degenerate: it has no neighbours and counts for nothing.
//
// Cost: linear in triangles and vertices whatever the mesh (edges are brought together by counting sorts), about 60 bytes a
// triangle while it lasts. Thread safety: pure functions, plain values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra {

struct MeshNeighbours {
    /// What lies beyond a half-edge; else the half-edge number of the neighbour.
    static constexpr std::uint32_t kBorder = 0xFFFFFFFFu;    ///< nothing
    static constexpr std::uint32_t kCrowded = 0xFFFFFFFEu;   ///< two triangles or more
    static constexpr std::uint32_t kDegenerate = 0xFFFFFFFDu;
    /// Set in the number of the neighbour where both triangles run the edge in the same direction: one of them faces the
    /// other way.
    static constexpr std::uint32_t kTurned = 0x80000000u;

    std::vector<std::uint32_t> across;   ///< three a triangle
    std::size_t edges = 0;               ///< different ones
    std::size_t crowdedEdges = 0;        ///< of three triangles and more

    std::size_t triangleCount() const { return across.size() / 3; }
    bool hasNeighbour(std::uint32_t halfEdge) const { return across[halfEdge] < kDegenerate; }
    std::uint32_t neighbour(std::uint32_t halfEdge) const { return across[halfEdge] & ~kTurned; }
    bool isTurned(std::uint32_t halfEdge) const { return (across[halfEdge] & kTurned) != 0; }

    static constexpr std::uint32_t next(std::uint32_t halfEdge) { return halfEdge % 3 == 2 ? halfEdge - 2 : halfEdge + 1; }
    static constexpr std::uint32_t previous(std::uint32_t halfEdge) { return halfEdge % 3 == 0 ? halfEdge + 2 : halfEdge - 1; }
};

/// REQUIRES: indices in threes, below vertexCount; fewer than 2^31 of them.
MeshNeighbours findNeighbours(std::span<const std::uint32_t> indices, std::size_t vertexCount);

/// The way back: an index list that has these neighbours. Vertices are numbered as they come up; corners become one vertex where
/// neighbours say so, so that a vertex at which several fans of triangles merely touch becomes several. Of a mesh without such
/// vertices and without crowded edges it is the old list but for the names of its vertices. Degenerate triangles stay so.
std::vector<std::uint32_t> indicesOf(const MeshNeighbours& neighbours);

/// What a mesh is as a surface. See isManifold, isClosed, isOriented first.
struct MeshTopology {
    std::size_t triangles = 0, vertices = 0, edges = 0;   ///< vertices that triangles use; degenerate triangles not counted
    std::size_t degenerateTriangles = 0;
    std::size_t borderEdges = 0;       ///< of one triangle
    std::size_t crowdedEdges = 0;      ///< of three and more
    std::size_t turnedEdges = 0;       ///< whose two triangles face opposite ways
    std::size_t pinchedVertices = 0;   ///< where several fans of triangles meet in a point
    std::size_t components = 0;        ///< connected by vertices
    std::size_t borders = 0;           ///< connected lines of border edges: of a manifold, its holes

    /// Every point has a neighbourhood like a disk, or half of one.
    bool isManifold() const { return crowdedEdges == 0 && pinchedVertices == 0; }
    /// A manifold without a border.
    bool isClosed() const { return isManifold() && borderEdges == 0 && triangles > 0; }
    /// No two neighbours face opposite ways.
    bool isOriented() const { return turnedEdges == 0; }
    /// Vertices - edges + triangles; of one closed oriented component 2 - 2 genus.
    std::int64_t eulerCharacteristic() const { return std::int64_t(vertices) - std::int64_t(edges) + std::int64_t(triangles); }
};

MeshTopology topologyOf(std::span<const std::uint32_t> indices, std::size_t vertexCount);

/// The index list with vertices of equal coordinates made one (the first of them), so that seams of uv and of normals vanish.
std::vector<std::uint32_t> weldedIndices(std::span<const std::uint32_t> indices, std::span<const float> positions);

}  // namespace penumbra
