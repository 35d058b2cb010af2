// What the tests of geometry share: a scene of every shape in every placement, and a search for hits in double
// precision that knows nothing of lanes or acceleration structures.
//
// The search follows the definitions: shapes in their own space, matrices as they stand in the tables, motion by linear
// interpolation between neighbouring matrices, normals by the inverse transpose.
#pragma once

#include "core/geometry/geometry.h"
#include "core/geometry/mesh.h"
#include "core/math/double_vector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace penumbra::test {

/// Numbers that are the same with every library.
class Random {
public:
    explicit Random(std::uint32_t seed) : generator_(seed) {}
    double operator()() { return (generator_() + 0.5) * 0x1p-32; }  ///< in (0, 1)
    std::uint32_t bits() { return std::uint32_t(generator_()); }
    Vec3d inCube(double halfWidth) {
        const double x = (*this)(), y = (*this)(), z = (*this)();
        return Vec3d{2 * x - 1, 2 * y - 1, 2 * z - 1} * halfWidth;
    }
    std::mt19937& generator() { return generator_; }

private:
    std::mt19937 generator_;
};

/// The unit sphere in 20 * 4^levels triangles that face outwards, scaled and then moved along each axis.
inline TriangleMesh icosphere(int levels, double scale = 1, double offset = 0) {
    const double g = std::numbers::phi;
    std::vector<Vec3d> v = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                            {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    for (Vec3d& p : v)
        p = normalized(p);
    std::vector<std::uint32_t> t = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                                    4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                                    6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [place, isNew] = middles.try_emplace(std::minmax(a, b), std::uint32_t(v.size()));
            if (isNew) v.push_back(normalized(v[a] + v[b]));
            return place->second;
        };
        std::vector<std::uint32_t> finer;
        for (std::size_t i = 0; i < t.size(); i += 3) {
            const std::uint32_t a = t[i], b = t[i + 1], c = t[i + 2], ab = middle(a, b), bc = middle(b, c),
                                ca = middle(c, a);
            finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
        }
        t = std::move(finer);
    }
    TriangleMesh mesh;
    reserveVertices(mesh.positions, v.size());
    for (const Vec3d& p : v)
        for (const double x : {p.x, p.y, p.z})
            mesh.positions.push_back(float(offset + scale * x));
    mesh.indices = std::move(t);
    return mesh;
}

struct ExactHit {
    double t = 0;
    std::uint32_t geometry = 0, primitive = 0, instance = kNone;  ///< as the accelerator names them
    Vec3d p, ng, ns, tangent;                                     ///< world; ng, ns unit; ns on ng's side
    double u = 0, v = 0;
};

/// The tables of a geometry in double precision, searched one by one.
class ExactSearch {
public:
    explicit ExactSearch(const Geometry& geometry) : g_(geometry) {}

    static Matrix4 matrixOf(const AffineRecord& a) {
        Matrix4 m;
        for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 4; ++c)
                m.m[r][c] = a.m[4 * r + c];
        return m;
    }
    Matrix4 placeOf(const InstanceRecord& instance, double time) const {
        const double scaled = time * instance.segments;
        const std::uint32_t i = std::min(std::uint32_t(scaled), instance.segments ? instance.segments - 1 : 0);
        const double f = scaled - i;
        Matrix4 m = matrixOf(g_.matrices[instance.firstMatrix + i]);
        if (instance.segments == 0) return m;
        const Matrix4 next = matrixOf(g_.matrices[instance.firstMatrix + i + 1]);
        for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 4; ++c)
                m.m[r][c] = (1 - f) * m.m[r][c] + f * next.m[r][c];
        return m;
    }

    /// The nearest hit with 0 < t < far.
    std::optional<ExactHit> search(Vec3d origin, Vec3d direction, double far, double time) const {
        std::optional<ExactHit> best;
        const auto take = [&](std::optional<ExactHit> hit) {
            if (hit && hit->t < far && (!best || hit->t < best->t)) best = hit;
        };
        for (std::uint32_t i = 0; i < g_.groups[0].shapeCount; ++i)
            take(shape(i, i, origin, direction));
        for (std::uint32_t n = 0; n < g_.instances.size(); ++n) {
            const InstanceRecord& instance = g_.instances[n];
            const Matrix4 place = placeOf(instance, time);
            Matrix4 back;
            if (!invert(place, back)) continue;
            const Vec3d o = transformPoint(back, origin), d = transformVector(back, direction);
            for (std::uint32_t i = 0; i < g_.groups[instance.group].shapeCount; ++i) {
                std::optional<ExactHit> hit = shape(instance.firstShape + i, i, o, d);
                if (!hit) continue;
                hit->instance = n;
                placeHit(*hit, place, back);
                take(hit);
            }
        }
        return best;
    }

private:
    static void placeHit(ExactHit& hit, const Matrix4& m, const Matrix4& inverse) {
        const Matrix4 forNormals = transpose(inverse);
        hit.p = transformPoint(m, hit.p);
        hit.ng = normalized(transformVector(forNormals, hit.ng));
        hit.ns = normalized(transformVector(forNormals, hit.ns));
        hit.tangent = transformVector(m, hit.tangent);
    }

    std::optional<ExactHit> shape(std::uint32_t row, std::uint32_t id, Vec3d o, Vec3d d) const {
        const ShapeRecord& s = g_.shapes[row];
        std::optional<ExactHit> best = s.kind == ShapeKind::Mesh ? mesh(s, o, d) : quadric(s, o, d);
        if (best) best->geometry = id;
        return best;
    }

    Vec3d row3(const std::vector<float>& table, std::uint32_t i) const {
        return {table[3 * i], table[3 * i + 1], table[3 * i + 2]};
    }

    std::optional<ExactHit> mesh(const ShapeRecord& s, Vec3d o, Vec3d d) const {
        std::optional<ExactHit> best;
        for (std::uint32_t t = 0; t < s.count; ++t) {
            const std::uint32_t* i = &g_.indices[3 * (s.first + t)];
            const Vec3d p0 = row3(g_.positions, i[0]), e1 = row3(g_.positions, i[1]) - p0,
                        e2 = row3(g_.positions, i[2]) - p0;
            const Vec3d n = cross(e1, e2), r = o - p0, q = cross(r, d);  // Cramer's rule: r = -t d + b1 e1 + b2 e2
            const double determinant = -dot(d, n), distance = dot(r, n) / determinant;
            const double b1 = dot(e2, q) / determinant, b2 = -dot(e1, q) / determinant;
            if (!(b1 >= 0 && b2 >= 0 && b1 + b2 <= 1 && distance > 0)) continue;
            if (best && best->t < distance) continue;
            best = triangleHit(s, t, i, b1, b2);
            best->t = distance;
        }
        return best;
    }

    ExactHit triangleHit(const ShapeRecord& s, std::uint32_t t, const std::uint32_t* i, double b1, double b2) const {
        const double b0 = 1 - b1 - b2;
        const auto mix = [&](const std::vector<float>& table, std::uint32_t shift) {
            return row3(table, i[0] + shift) * b0 + row3(table, i[1] + shift) * b1 + row3(table, i[2] + shift) * b2;
        };
        ExactHit hit;
        hit.primitive = t;
        hit.p = mix(g_.positions, 0);
        const Vec3d p0 = row3(g_.positions, i[0]), e1 = row3(g_.positions, i[1]) - p0,
                    e2 = row3(g_.positions, i[2]) - p0;
        hit.ng = normalized(cross(e1, e2));
        if (s.flags & kShapeFlipNormal) hit.ng = hit.ng * -1.0;
        hit.ns = hit.ng;
        if (s.normalShift != kNone) {
            hit.ns = normalized(mix(g_.normals, s.normalShift));
            if (dot(hit.ns, hit.ng) < 0) hit.ng = hit.ng * -1.0;
        }
        std::array<double, 2> c[3] = {{0, 0}, {1, 0}, {1, 1}};
        if (s.uvShift != kNone)
            for (int k = 0; k < 3; ++k)
                c[k] = {g_.uvs[2 * (i[k] + s.uvShift)], g_.uvs[2 * (i[k] + s.uvShift) + 1]};
        hit.u = c[0][0] * b0 + c[1][0] * b1 + c[2][0] * b2;
        hit.v = c[0][1] * b0 + c[1][1] * b1 + c[2][1] * b2;
        const double v1 = c[1][1] - c[0][1], v2 = c[2][1] - c[0][1];
        const double area = (c[1][0] - c[0][0]) * v2 - (c[2][0] - c[0][0]) * v1;
        hit.tangent = area != 0 ? (e1 * v2 - e2 * v1) * (1 / area) : e1;
        if (s.tangentShift != kNone) hit.tangent = mix(g_.tangents, s.tangentShift);
        return hit;
    }

    std::optional<ExactHit> quadric(const ShapeRecord& s, Vec3d o, Vec3d d) const {
        const QuadricRecord& q = g_.quadrics[s.first];
        const Matrix4 world = matrixOf(q.worldFromObject);
        Matrix4 object;
        if (!invert(world, object)) return std::nullopt;
        const Vec3d from = transformPoint(object, o), along = transformVector(object, d);
        std::vector<double> roots;
        if (q.kind == ShapeKind::Disk) {
            roots = {(q.zMin - from.z) / along.z};
        } else {
            const double round = q.kind == ShapeKind::Sphere;
            const double a = dot(along, along) - (1 - round) * along.z * along.z;
            const double b = dot(from, along) - (1 - round) * from.z * along.z;
            const double c = dot(from, from) - (1 - round) * from.z * from.z - double(q.radius) * q.radius;
            const double root = b * b - a * c;
            if (root >= 0) roots = {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a};
        }
        for (const double t : roots) {
            if (!(t > 0)) continue;
            std::optional<ExactHit> hit = quadricHit(q, from + along * t);
            if (!hit) continue;
            if (s.flags & kShapeFlipNormal) hit->ng = hit->ng * -1.0;
            hit->ns = hit->ng;
            hit->t = t;
            placeHit(*hit, world, object);
            return hit;
        }
        return std::nullopt;
    }

    static std::optional<ExactHit> quadricHit(const QuadricRecord& q, Vec3d p) {
        double phi = std::atan2(p.y, p.x);
        if (phi < 0) phi += 2 * std::numbers::pi;
        if (phi > q.phiMax) return std::nullopt;
        ExactHit hit;
        hit.p = p;
        hit.u = phi / q.phiMax;
        hit.tangent = {-p.y, p.x, 0};
        if (q.kind == ShapeKind::Disk) {
            const double rho = std::hypot(p.x, p.y);
            if (rho > q.radius || rho < q.innerRadius) return std::nullopt;
            hit.ng = {0, 0, 1};
            hit.v = (q.radius - rho) / (q.radius - q.innerRadius);
        } else if (p.z < q.zMin || p.z > q.zMax) {
            return std::nullopt;
        } else if (q.kind == ShapeKind::Cylinder) {
            hit.ng = Vec3d{p.x, p.y, 0} * (1.0 / q.radius);
            hit.v = (p.z - q.zMin) / (double(q.zMax) - q.zMin);
        } else {
            hit.ng = p * (1.0 / q.radius);
            const double theta = std::acos(std::clamp(p.z / q.radius, -1.0, 1.0));
            const double top = std::acos(double(q.zMax) / q.radius), bottom = std::acos(double(q.zMin) / q.radius);
            hit.v = (theta - bottom) / (top - bottom);
        }
        return hit;
    }

    const Geometry& g_;
};

/// A unit sphere, disk (at height 0) or cylinder, of which nothing is cut off. REQUIRES: world is not singular.
inline QuadricRecord wholeQuadric(ShapeKind kind, const Matrix4& world) {
    QuadricRecord q;
    Matrix4 object;
    invert(world, object);
    q.worldFromObject = toRecord(world);
    q.objectFromWorld = toRecord(object);
    q.kind = kind;
    if (kind == ShapeKind::Disk) q.zMin = q.zMax = 0;
    return q;
}

/// Meshes flat and smooth with and without uv and tangents, partial spheres, cylinders and disks, as they are,
/// mirrored, in instances and in moving instances; about five units across.
class EverythingScene {
public:
    Geometry geometry;

    EverythingScene() {
        constexpr std::uint32_t kAll = kShapeNeedsUv | kShapeNeedsTangent;
        addMesh(icosphere(1, 0.8, 0.9), kAll);
        addMesh(smooth(icosphere(1, 0.7, -0.8)), kAll | kShapeFlipNormal);
        addQuadric(ShapeKind::Sphere, translation(-1.2, 0.5, 0.8) * scaling(0.6, 0.6, 0.6), kAll);
        addQuadric(ShapeKind::Disk, translation(1.2, -1, 0.3) * rotation(50, 1, 2, 0), kAll | kShapeFlipNormal);
        addQuadric(ShapeKind::Cylinder, translation(0.2, -1.5, -1.3) * rotation(75, 1, 0.5, 0) * scaling(0.4, 0.4, 0.6),
                   kAll);
        const std::uint32_t worldShapes = std::uint32_t(geometry.shapes.size());
        addMesh(smooth(icosphere(1, 0.5)), kAll);
        addMesh(mapped(icosphere(0, 0.4, 0.6)), kAll);
        addQuadric(ShapeKind::Sphere, translation(-0.7, 0, 0) * rotation(20, 1, 0, 0) * scaling(0.3, 0.5, 0.4), kAll);
        addQuadric(ShapeKind::Disk, translation(0.5, -0.6, 0), kAll);
        addQuadric(ShapeKind::Cylinder, translation(0, -0.3, -0.6) * rotation(30, 0, 1, 1) * scaling(0.2, 0.3, 0.4),
                   kAll | kShapeFlipNormal);
        geometry.groups = {{0, worldShapes}, {worldShapes, std::uint32_t(geometry.shapes.size()) - worldShapes}};

        const Matrix4 a = translation(1.4, 1.2, -1) * rotation(70, 1, -1, 2) * scaling(1.2, 0.7, 1);
        place(a, a);
        const Matrix4 b = translation(-1.5, -1.4, 1.2) * scaling(-1, 1.1, 0.9) * rotation(15, 0, 1, 1);
        place(b, b);
        place(translation(0, 1.5, 1.5), translation(0.5, 1.2, 1.8) * rotation(80, 1, 1, 0) * scaling(1.1, 1, 0.8));
        place(translation(-1.5, 1.6, -1.4) * scaling(1, 1, -1),
              translation(-1.2, 1.6, -1.2) * rotation(140, 0, 0, 1) * scaling(1, 1, -1));
        geometry.finish();
    }

    std::optional<ExactHit> search(Vec3d origin, Vec3d direction, double far, double time) const {
        return ExactSearch(geometry).search(origin, direction, far, time);
    }

    static TriangleMesh smooth(TriangleMesh mesh) {
        mesh.normals.assign(mesh.positions.begin(), mesh.positions.end());  // about a centre that is not the sphere's
        for (std::size_t i = 0; i < mesh.normals.size(); ++i)
            mesh.normals[i] += i % 3 == 2 ? 0.9f : 0.7f;
        return mesh;
    }
    static TriangleMesh mapped(TriangleMesh mesh) {
        for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
            const float* p = &mesh.positions[3 * i];
            mesh.uvs.insert(mesh.uvs.end(), {2 * p[0] + p[2], p[1] - 0.5f * p[2] * p[2]});
            mesh.tangents.insert(mesh.tangents.end(), {p[1] + 0.3f, p[2], 1 - p[0]});
        }
        return mesh;
    }

private:
    void addMesh(TriangleMesh mesh, std::uint32_t flags) {
        ShapeRecord r = geometry.addMesh(std::move(mesh));
        r.flags = flags;
        geometry.shapes.push_back(r);
    }
    void addQuadric(ShapeKind kind, const Matrix4& world, std::uint32_t flags) {
        QuadricRecord q = wholeQuadric(kind, world);
        q.phiMax = 5;
        if (kind == ShapeKind::Disk) {
            q.innerRadius = 0.3f;
            q.zMin = q.zMax = 0.1f;
        } else {
            q.zMin = -0.6f;
            q.zMax = 0.9f;
            q.thetaMin = std::acos(q.zMax);
            q.thetaMax = std::acos(q.zMin);
        }
        ShapeRecord r = geometry.addQuadric(q);
        r.flags = flags;
        geometry.shapes.push_back(r);
    }
    void place(const Matrix4& start, const Matrix4& end) {
        InstanceRecord r;
        r.group = 1;
        r.firstShape = geometry.groups[1].firstShape;
        r.firstMatrix = std::uint32_t(geometry.matrices.size());
        for (const Matrix4& m : motionMatrices(start, end))
            geometry.matrices.push_back(toRecord(m));
        r.segments = std::uint32_t(geometry.matrices.size()) - r.firstMatrix - 1;
        geometry.instances.push_back(r);
    }
};

}  // namespace penumbra::test
