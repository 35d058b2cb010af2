#include "core/geometry/patches.h"

#include "core/math/double_vector.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra {
namespace {

/// What one vertex of a face carries.
struct Corner {
    Vec3d p{}, n{};
    double u = 0, v = 0;
};

Vec3d twistOf(const Vec3d& p00, const Vec3d& p10, const Vec3d& p01, const Vec3d& p11) {
    return (p00 - p10) + (p11 - p01);
}

struct Patch {
    Corner p00, p10, p01, p11;

    Vec3d twist() const { return twistOf(p00.p, p10.p, p01.p, p11.p); }
    /// dp/du x dp/dv.
    Vec3d normal(double u, double v) const {
        const Vec3d du = (p10.p - p00.p) * (1 - v) + (p11.p - p01.p) * v;
        const Vec3d dv = (p01.p - p00.p) * (1 - u) + (p11.p - p10.p) * u;
        return cross(du, dv);
    }
};

/// The mesh that is cut, face by face.
class Faces {
public:
    explicit Faces(const PatchMesh& from) : mesh_(from.mesh), quads_(from.quads) {}

    /// Calls triangle(first index) or quad(first index) of every face, in order.
    template <class Triangle, class Quad>
    void each(Triangle&& triangle, Quad&& quad) const {
        auto next = quads_.begin();
        for (std::size_t t = 0; t < mesh_.triangleCount(); ++t) {
            const bool isQuad = next != quads_.end() && *next == t;
            if (!isQuad) {
                triangle(3 * t);
                continue;
            }
            quad(3 * t);
            ++next, ++t;
        }
    }

    Corner corner(std::uint32_t vertex) const {
        const auto three = [&](const std::vector<float>& table) {
            const float* const v = &table[3 * std::size_t{vertex}];
            return Vec3d{v[0], v[1], v[2]};
        };
        Corner c;
        c.p = three(mesh_.positions);
        if (!mesh_.normals.empty()) c.n = three(mesh_.normals);
        if (!mesh_.uvs.empty()) {
            c.u = mesh_.uvs[2 * std::size_t{vertex}];
            c.v = mesh_.uvs[2 * std::size_t{vertex} + 1];
        }
        return c;
    }
    std::array<Corner, 3> triangle(std::size_t first) const {
        return {corner(mesh_.indices[first]), corner(mesh_.indices[first + 1]), corner(mesh_.indices[first + 2])};
    }
    /// Both ways of cutting a quad have its corners at these places.
    Patch patch(std::size_t first) const {
        const std::uint32_t* const i = &mesh_.indices[first];
        return {corner(i[0]), corner(i[1]), corner(i[5]), corner(i[4])};
    }

private:
    const TriangleMesh& mesh_;
    const std::vector<std::uint32_t>& quads_;
};

/// How far a patch is from two flat triangles.
class Measure {
public:
    Measure(const TriangleMesh& mesh, const DiceOptions& options)
        : options_(options), hasNormals_(!mesh.normals.empty()), hasUvs_(!mesh.uvs.empty()) {
        if (options.polygons) meshSize_ = diagonal(bounds(mesh));
    }

    bool isFlat(const Patch& patch) const {
        constexpr double kRounding = 1e-5;
        return !(bend(patch) >
                 (options_.polygons ? 4 * kPolygonTolerance * meshSize_ : kRounding * longestEdge(patch)));
    }
    /// How many cells along an edge keep to the tolerance.
    int cells(const Patch& q) const {
        const bool isFlat = this->isFlat(q);
        if (options_.polygons) return isFlat ? 1 : cellsOf(length(placed(q.twist())), meshSize_, kPolygonTolerance);
        const double turn = length(twistOf(q.p00.n, q.p10.n, q.p01.n, q.p11.n));
        const double longest = std::max({length(q.p00.n), length(q.p10.n), length(q.p01.n), length(q.p11.n)});
        int most = cellsOf(turn, longest);
        if (hasUvs_)
            most = std::max(most, cellsOf(std::hypot(q.p00.u - q.p10.u - q.p01.u + q.p11.u,
                                                     q.p00.v - q.p10.v - q.p01.v + q.p11.v),
                                          longestUvEdge(q)));
        // Two triangles are the whole of a convex polygon, if nobody asks how u and v go across it.
        const bool asksForParameters = options_.needsUv || (hasNormals_ && !haveOneNormal(q));
        if (isFlat && !asksForParameters && isConvex(q)) return most;
        return std::max(most, cellsOf(length(placed(q.twist())), longestEdge(q)));
    }

private:
    static int cellsOf(double twist, double size, double tolerance = kDiceTolerance) {
        const double n = std::ceil(std::sqrt(twist / (4 * tolerance * size)));
        return n > 1 ? int(std::min(n, double(kMostCells))) : 1;  // also where it is no number
    }
    Vec3d placed(const Vec3d& v) const { return transformVector(options_.place, v); }

    double diagonal(const MeshBounds& box) const {
        double squared = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double extent = double(box.upper[axis]) - box.lower[axis];
            const Vec3d side = placed({axis == 0 ? extent : 0, axis == 1 ? extent : 0, axis == 2 ? extent : 0});
            squared += dot(side, side);
        }
        return std::sqrt(squared);
    }
    double longestEdge(const Patch& q) const {
        return std::max({length(placed(q.p10.p - q.p00.p)), length(placed(q.p11.p - q.p01.p)),
                         length(placed(q.p01.p - q.p00.p)), length(placed(q.p11.p - q.p10.p))});
    }
    static double longestUvEdge(const Patch& q) {
        const auto edge = [](const Corner& a, const Corner& b) { return std::hypot(b.u - a.u, b.v - a.v); };
        return std::max({edge(q.p00, q.p10), edge(q.p01, q.p11), edge(q.p00, q.p01), edge(q.p10, q.p11)});
    }
    /// How far the twist leads out of the plane along both diagonals. Parallel diagonals lie in one plane.
    double bend(const Patch& q) const {
        const Vec3d n = cross(placed(q.p11.p - q.p00.p), placed(q.p01.p - q.p10.p));
        const double size = length(n);
        return size > 0 ? std::abs(dot(placed(q.twist()), n)) / size : 0;
    }
    static bool haveOneNormal(const Patch& q) {
        const auto same = [](const Vec3d& a, const Vec3d& b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
        return same(q.p00.n, q.p10.n) && same(q.p00.n, q.p01.n) && same(q.p00.n, q.p11.n);
    }
    /// Of a planar patch: either diagonal cuts it into two triangles that face one way.
    static bool isConvex(const Patch& q) {
        const auto normal = [](const Corner& a, const Corner& b, const Corner& c) {
            return cross(b.p - a.p, c.p - a.p);
        };
        return dot(normal(q.p00, q.p10, q.p11), normal(q.p00, q.p11, q.p01)) >= 0 &&
               dot(normal(q.p00, q.p10, q.p01), normal(q.p10, q.p11, q.p01)) >= 0;
    }

    const DiceOptions& options_;
    const bool hasNormals_, hasUvs_;
    double meshSize_ = 0;  ///< of polygons
};

/// Collects the triangles of faces cut into n x n cells, each face with vertices of its own.
class Dicer {
public:
    Dicer(int n, bool withNormals, bool withUvs, bool ownNormals) : n_(n), withUvs_(withUvs), ownNormals_(ownNormals) {
        withNormals_ = withNormals || ownNormals;
    }

    void reserve(std::size_t triangles, std::size_t quads) {
        const std::size_t n = std::size_t(n_), cells = (triangles + 2 * quads) * n * n;
        // Two triangles have more vertices than a patch.
        const std::size_t vertices = (triangles + 2 * quads) * ((n + 1) * (n + 2) / 2);
        reserveVertices(mesh_.positions, vertices);
        if (withNormals_) mesh_.normals.reserve(3 * vertices);
        if (withUvs_) mesh_.uvs.reserve(2 * vertices);
        mesh_.indices.reserve(3 * cells);
        mesh_.faceIndices.reserve(cells);
    }
    void addPatch(const Patch& q, std::int32_t face) {
        const double largest = std::max({length(q.normal(0, 0)), length(q.normal(1, 0)), length(q.normal(0, 1)),
                                         length(q.normal(1, 1))});
        const std::uint32_t first = nextVertex();
        for (int j = 0; j <= n_; ++j)
            for (int i = 0; i <= n_; ++i) {
                const std::array<double, 4> weights{double((n_ - i) * (n_ - j)), double(i * (n_ - j)),
                                                    double((n_ - i) * j), double(i * j)};
                Corner vertex = mean<4>({q.p00, q.p10, q.p01, q.p11}, weights);
                if (ownNormals_) vertex.n = scaled(q.normal(double(i) / n_, double(j) / n_), largest);
                addVertex(vertex);
            }
        const auto at = [&](int i, int j) { return first + std::uint32_t(j * (n_ + 1) + i); };
        for (int j = 0; j < n_; ++j)
            for (int i = 0; i < n_; ++i) {
                addTriangle(at(i, j), at(i + 1, j), at(i + 1, j + 1), face);
                addTriangle(at(i, j), at(i + 1, j + 1), at(i, j + 1), face);
            }
    }
    void addTriangle(const std::array<Corner, 3>& c, std::int32_t face) {
        const Vec3d normal = cross(c[1].p - c[0].p, c[2].p - c[0].p);
        const std::uint32_t first = nextVertex();
        for (int j = 0; j <= n_; ++j)
            for (int i = 0; i + j <= n_; ++i) {
                // n times what would do, so that vertices on an edge are rounded as those of a patch.
                Corner vertex = mean<3>(c, {double(n_ * (n_ - i - j)), double(n_ * i), double(n_ * j)});
                if (ownNormals_) vertex.n = scaled(normal, length(normal));
                addVertex(vertex);
            }
        const auto at = [&](int i, int j) { return first + std::uint32_t(j * (n_ + 1) - j * (j - 1) / 2 + i); };
        for (int j = 0; j < n_; ++j)
            for (int i = 0; i + j < n_; ++i) {
                addTriangle(at(i, j), at(i + 1, j), at(i, j + 1), face);
                if (i + j + 1 < n_) addTriangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), face);
            }
    }
    TriangleMesh take() { return std::move(mesh_); }

private:
    std::uint32_t nextVertex() const { return std::uint32_t(mesh_.vertexCount()); }

    /// Weights that add up to n^2. On an edge all but two of them are 0, and the sum is rounded the same in any order.
    template <std::size_t kCount>
    Corner mean(const std::array<Corner, kCount>& c, const std::array<double, kCount>& weights) const {
        Corner sum;
        for (std::size_t k = 0; k < kCount; ++k) {
            sum.p = sum.p + c[k].p * weights[k];
            sum.n = sum.n + c[k].n * weights[k];
            sum.u += c[k].u * weights[k];
            sum.v += c[k].v * weights[k];
        }
        const double total = double(n_) * n_;
        return {{sum.p.x / total, sum.p.y / total, sum.p.z / total},
                {sum.n.x / total, sum.n.y / total, sum.n.z / total},
                sum.u / total,
                sum.v / total};
    }
    static Vec3d scaled(const Vec3d& v, double size) { return size > 0 ? v * (1 / size) : Vec3d{}; }

    void addVertex(const Corner& c) {
        mesh_.positions.insert(mesh_.positions.end(), {float(c.p.x), float(c.p.y), float(c.p.z)});
        if (withNormals_) mesh_.normals.insert(mesh_.normals.end(), {float(c.n.x), float(c.n.y), float(c.n.z)});
        if (withUvs_) mesh_.uvs.insert(mesh_.uvs.end(), {float(c.u), float(c.v)});
    }
    void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::int32_t face) {
        // Where an edge of the face is a point, cells have less than three corners.
        const auto same = [&](std::uint32_t v, std::uint32_t w) {
            const float* const p = mesh_.positions.data();
            return std::equal(p + 3 * std::size_t{v}, p + 3 * std::size_t{v} + 3, p + 3 * std::size_t{w});
        };
        if (same(a, b) || same(b, c) || same(c, a)) return;
        mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
        mesh_.faceIndices.push_back(face);
    }

    const int n_;
    bool withNormals_;
    const bool withUvs_, ownNormals_;
    TriangleMesh mesh_;
};

constexpr std::array<std::array<double, 2>, 3> kTriangleUvs{{{0, 0}, {1, 0}, {1, 1}}};

}  // namespace

TriangleMesh dice(PatchMesh from, const DiceOptions& options) {
    TriangleMesh& mesh = from.mesh;
    if (from.quads.empty()) return std::move(mesh);
    const Faces faces(from);
    const Measure measure(mesh, options);
    int n = 1;
    bool isCurved = false;
    faces.each([](std::size_t) {},
               [&](std::size_t first) {
                   const Patch patch = faces.patch(first);
                   n = std::max(n, measure.cells(patch));
                   isCurved = isCurved || !measure.isFlat(patch);
               });
    const double allowed = double(options.mostTriangles) / double(mesh.triangleCount());
    n = std::max(1, std::min(n, int(std::sqrt(std::min(allowed, 1e6)))));

    std::int32_t face = 0;
    const bool ownNormals = isCurved && mesh.normals.empty(), ownUvs = options.needsUv && mesh.uvs.empty();
    if (n == 1 && !ownNormals && !ownUvs) {
        mesh.faceIndices.clear();
        if (options.numbersFaces)
            faces.each([&](std::size_t) { mesh.faceIndices.push_back(face++); },
                       [&](std::size_t) { mesh.faceIndices.insert(mesh.faceIndices.end(), 2, face++); });
        return std::move(mesh);
    }
    const auto withUvs = [](Corner c, double u, double v) {
        c.u = u, c.v = v;
        return c;
    };
    Dicer dicer(n, !mesh.normals.empty(), options.needsUv, ownNormals);
    dicer.reserve(mesh.triangleCount() - 2 * from.quads.size(), from.quads.size());
    faces.each(
        [&](std::size_t first) {
            std::array<Corner, 3> c = faces.triangle(first);
            for (std::size_t k = 0; ownUvs && k < 3; ++k)
                c[k] = withUvs(c[k], kTriangleUvs[k][0], kTriangleUvs[k][1]);
            dicer.addTriangle(c, face++);
        },
        [&](std::size_t first) {
            Patch q = faces.patch(first);
            if (ownUvs)
                q = {withUvs(q.p00, 0, 0), withUvs(q.p10, 1, 0), withUvs(q.p01, 0, 1), withUvs(q.p11, 1, 1)};
            if (!options.polygons || !measure.isFlat(q)) return dicer.addPatch(q, face++);
            const std::uint32_t* const i = &mesh.indices[first];
            if (i[2] == i[4]) {
                dicer.addTriangle({q.p00, q.p10, q.p11}, face);
                dicer.addTriangle({q.p00, q.p11, q.p01}, face++);
            } else {
                dicer.addTriangle({q.p00, q.p10, q.p01}, face);
                dicer.addTriangle({q.p10, q.p11, q.p01}, face++);
            }
        });
    return dicer.take();
}

}  // namespace penumbra
