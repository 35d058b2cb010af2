#include "core/geometry/subdivision.h"

#include "core/base/error.h"
#include "core/math/double_vector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace penumbra {
namespace {

constexpr std::uint32_t kNobody = 0xFFFFFFFFu;

constexpr std::size_t next(std::size_t i) {
    return (i + 1) % 3;
}
constexpr std::size_t previous(std::size_t i) {
    return (i + 2) % 3;
}

/// Edge k of a face leads from corner k to the next one.
struct Face {
    std::array<std::uint32_t, 3> corner;
    std::array<std::uint32_t, 3> neighbour{kNobody, kNobody, kNobody};  ///< across each edge

    std::size_t cornerOf(std::uint32_t vertex) const { return corner[0] == vertex ? 0 : corner[1] == vertex ? 1 : 2; }
};

/// A level of the refinement.
struct Level {
    std::vector<Face> faces;
    std::vector<float> positions;
    std::vector<std::uint32_t> aFace;  ///< of each vertex, kNobody where it has none
    std::vector<bool> border;          ///< vertices on a border

    std::size_t vertexCount() const { return aFace.size(); }
    Vec3d position(std::uint32_t v) const {
        const float* p = &positions[3 * std::size_t{v}];
        return {p[0], p[1], p[2]};
    }
    void add(const Vec3d& p) { positions.insert(positions.end(), {float(p.x), float(p.y), float(p.z)}); }
    std::uint32_t across(std::uint32_t face, std::size_t edge) const { return faces[face].neighbour[edge]; }

    /// The vertices around one, clockwise as seen from the front: all neighbours of one inside; of one on a border from
    /// one end of it, counterclockwise, to the other.
    void ring(std::uint32_t vertex, std::vector<std::uint32_t>& out) const;
};

void Level::ring(std::uint32_t vertex, std::vector<std::uint32_t>& out) const {
    out.clear();
    std::uint32_t face = aFace[vertex];
    if (!border[vertex]) {
        do {
            const std::size_t at = faces[face].cornerOf(vertex);
            out.push_back(faces[face].corner[next(at)]);
            face = across(face, at);
        } while (face != aFace[vertex]);
        return;
    }
    for (std::uint32_t f = face; f != kNobody; f = across(f, faces[f].cornerOf(vertex)))
        face = f;
    out.push_back(faces[face].corner[next(faces[face].cornerOf(vertex))]);
    while (face != kNobody) {
        const std::size_t before = previous(faces[face].cornerOf(vertex));
        out.push_back(faces[face].corner[before]);
        face = across(face, before);
    }
}

void joinNeighbours(std::vector<Face>& faces) {
    struct Edge {
        std::uint32_t from, to, face, edge;
        bool operator<(const Edge& o) const {
            return from != o.from ? from < o.from : to != o.to ? to < o.to : face < o.face;
        }
    };
    std::vector<Edge> edges;
    edges.reserve(3 * faces.size());
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        for (std::uint32_t k = 0; k < 3; ++k)
            edges.push_back({faces[f].corner[k], faces[f].corner[next(k)], f, k});
    std::sort(edges.begin(), edges.end());
    const auto first = [&](std::uint32_t from, std::uint32_t to) {
        const auto found = std::lower_bound(edges.begin(), edges.end(), Edge{from, to, 0, 0});
        return found != edges.end() && found->from == from && found->to == to ? &*found : nullptr;
    };
    for (const Edge& e : edges) {
        const Edge* other = first(e.to, e.from);
        if (other && &e == first(e.from, e.to)) faces[e.face].neighbour[e.edge] = other->face;
    }
}

void findBorders(Level& level) {
    level.border.assign(level.vertexCount(), false);
    for (std::uint32_t v = 0; v < level.vertexCount(); ++v) {
        const std::uint32_t start = level.aFace[v];
        std::uint32_t face = start;
        while (face != kNobody) {
            face = level.across(face, level.faces[face].cornerOf(v));
            if (face == start) break;
        }
        level.border[v] = face == kNobody;
    }
}

Level controlLevel(TriangleMesh&& control) {
    Level level;
    level.positions = std::move(control.positions);
    level.aFace.assign(level.positions.size() / 3, kNobody);
    level.faces.reserve(control.triangleCount());
    for (std::size_t i = 0; i < control.indices.size(); i += 3) {
        const std::array<std::uint32_t, 3> c = {control.indices[i], control.indices[i + 1], control.indices[i + 2]};
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
        for (const std::uint32_t v : c)
            level.aFace[v] = std::uint32_t(level.faces.size());
        level.faces.push_back({c});
    }
    joinNeighbours(level.faces);
    findBorders(level);
    return level;
}

/// Loop's weight of each neighbour of a vertex with n of them, in Warren's simpler choice.
double vertexWeight(std::size_t n) {
    return n == 3 ? 3. / 16 : 3. / (8 * double(n));
}

/// The vertex, with the weight given for each of its neighbours: all around it, or the two along its border.
Vec3d weighted(const Level& level, std::uint32_t v, const std::vector<std::uint32_t>& ring, double inside,
               double along) {
    const Vec3d p = level.position(v);
    if (level.border[v])
        return p * (1 - 2 * along) + (level.position(ring.front()) + level.position(ring.back())) * along;
    Vec3d sum = p * (1 - inside * double(ring.size()));
    for (const std::uint32_t n : ring)
        sum = sum + level.position(n) * inside;
    return sum;
}

Vec3d edgePoint(const Level& level, std::uint32_t face, std::size_t edge) {
    const Face& f = level.faces[face];
    const std::uint32_t from = f.corner[edge], to = f.corner[next(edge)], other = f.neighbour[edge];
    const Vec3d ends = level.position(from) + level.position(to);
    if (other == kNobody) return ends * 0.5;
    const Face& g = level.faces[other];
    const Vec3d sides = level.position(f.corner[previous(edge)]) + level.position(g.corner[next(g.cornerOf(from))]);
    return ends * 0.375 + sides * 0.125;
}

/// Every face becomes four: 4 f + k at its corner k, and 4 f + 3 in the middle. Vertices keep their numbers.
Level refined(const Level& coarse) {
    Level fine;
    const std::uint32_t count = std::uint32_t(coarse.faces.size());
    fine.positions.reserve(coarse.positions.size() + 9 * std::size_t{count} / 2);
    fine.aFace.reserve(coarse.vertexCount() + 3 * std::size_t{count} / 2);
    std::vector<std::uint32_t> ring;
    for (std::uint32_t v = 0; v < coarse.vertexCount(); ++v) {
        const std::uint32_t face = coarse.aFace[v];
        if (face == kNobody) {
            fine.add(coarse.position(v));
            fine.aFace.push_back(kNobody);
            continue;
        }
        coarse.ring(v, ring);
        fine.add(weighted(coarse, v, ring, vertexWeight(ring.size()), 1. / 8));
        fine.aFace.push_back(4 * face + std::uint32_t(coarse.faces[face].cornerOf(v)));
    }
    fine.border = coarse.border;

    // The lower of the two faces at an edge makes its vertex, so the higher finds it made.
    std::vector<std::array<std::uint32_t, 3>> middles(count);
    for (std::uint32_t f = 0; f < count; ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t other = coarse.across(f, k);
            if (other < f) {
                const Face& g = coarse.faces[other];
                middles[f][k] = middles[other][g.cornerOf(coarse.faces[f].corner[next(k)])];
                continue;
            }
            middles[f][k] = std::uint32_t(fine.vertexCount());
            fine.add(edgePoint(coarse, f, k));
            fine.aFace.push_back(4 * f + 3);
            fine.border.push_back(other == kNobody);
        }

    fine.faces.resize(4 * std::size_t{count});
    for (std::uint32_t f = 0; f < count; ++f) {
        const Face& face = coarse.faces[f];
        const auto childOf = [&](std::size_t edge, std::uint32_t vertex) {
            const std::uint32_t other = face.neighbour[edge];
            return other == kNobody ? kNobody : 4 * other + std::uint32_t(coarse.faces[other].cornerOf(vertex));
        };
        Face& middle = fine.faces[4 * std::size_t{f} + 3];
        for (std::size_t k = 0; k < 3; ++k) {
            Face& child = fine.faces[4 * std::size_t{f} + k];
            child.corner[k] = face.corner[k];
            child.corner[next(k)] = middles[f][k];
            child.corner[previous(k)] = middles[f][previous(k)];
            child.neighbour[k] = childOf(k, face.corner[k]);
            child.neighbour[next(k)] = 4 * f + 3;
            child.neighbour[previous(k)] = childOf(previous(k), face.corner[k]);
            middle.corner[k] = middles[f][k];
            middle.neighbour[k] = 4 * f + std::uint32_t(next(k));
        }
    }
    return fine;
}

/// The normal of the limit surface, of any length, out of the positions around the vertex.
Vec3d limitNormal(const Level& level, std::uint32_t v, const std::vector<std::uint32_t>& ring) {
    const std::size_t n = ring.size();
    const auto around = [&](std::size_t i) { return level.position(ring[i]); };
    Vec3d s{}, t{};
    if (!level.border[v]) {
        for (std::size_t i = 0; i < n; ++i) {
            const double angle = 2 * std::numbers::pi * double(i) / double(n);
            s = s + around(i) * std::cos(angle);
            t = t + around(i) * std::sin(angle);
        }
    } else {
        const Vec3d p = level.position(v);
        s = around(n - 1) - around(0);
        if (n == 2) {
            t = around(0) + around(1) - p * 2;
        } else if (n == 3) {
            t = around(1) - p;
        } else if (n == 4) {
            t = (around(1) + around(2)) * 2 - around(0) - around(3) - p * 2;
        } else {
            const double angle = std::numbers::pi / double(n - 1);
            t = (around(0) + around(n - 1)) * -std::sin(angle);
            for (std::size_t i = 1; i + 1 < n; ++i)
                t = t - around(i) * ((2 * std::cos(angle) - 2) * std::sin(double(i) * angle));
        }
    }
    return {s.y * t.z - s.z * t.y, s.z * t.x - s.x * t.z, s.x * t.y - s.y * t.x};
}

void toLimit(Level& level) {
    std::vector<float> limit;
    reserveVertices(limit, level.vertexCount());
    std::vector<std::uint32_t> ring;
    for (std::uint32_t v = 0; v < level.vertexCount(); ++v) {
        Vec3d p = level.position(v);
        if (level.aFace[v] != kNobody) {
            level.ring(v, ring);
            const double n = double(ring.size());
            p = weighted(level, v, ring, 1 / (n + 3 / (8 * vertexWeight(ring.size()))), 1. / 5);
        }
        limit.insert(limit.end(), {float(p.x), float(p.y), float(p.z)});
    }
    level.positions = std::move(limit);
}

std::vector<float> limitNormals(const Level& level) {
    std::vector<float> normals;
    normals.reserve(level.positions.size() + kSpareFloats);
    std::vector<std::uint32_t> ring;
    for (std::uint32_t v = 0; v < level.vertexCount(); ++v) {
        Vec3d n{};
        if (level.aFace[v] != kNobody) {
            level.ring(v, ring);
            n = limitNormal(level, v, ring);
        }
        normals.insert(normals.end(), {float(n.x), float(n.y), float(n.z)});
    }
    return normals;
}

}  // namespace

TriangleMesh subdivideLoop(TriangleMesh&& control, int levels, const std::string& where) {
    if (std::ldexp(double(control.triangleCount()), 2 * levels) > double(kMostSubdividedTriangles))
        throw Error(ErrorKind::BadData, where + ": " + std::to_string(levels) +
                                            " levels of subdivision make more than " +
                                            std::to_string(kMostSubdividedTriangles) + " triangles of the " +
                                            std::to_string(control.triangleCount()) + " given");
    Level level = controlLevel(std::move(control));
    for (int i = 0; i < levels; ++i)
        level = refined(level);
    toLimit(level);
    TriangleMesh mesh;
    mesh.normals = limitNormals(level);
    mesh.positions = std::move(level.positions);
    mesh.indices.reserve(3 * level.faces.size() + kSpareFloats);
    for (const Face& f : level.faces)
        mesh.indices.insert(mesh.indices.end(), f.corner.begin(), f.corner.end());
    return mesh;
}

}  // namespace penumbra
