// Surface points: position, its error bound, normals, uv and tangent of every shape, as it stands, in instances and in
// moving ones, against double precision; eight lanes against one, bit by bit; and where rays start that leave them.
#include "core/geometry/accelerator.h"
#include "core/geometry/surface_derivatives.h"
#include "tests/geometry_fixture.h"

#include <gtest/gtest.h>

#include <cstring>

namespace penumbra {
namespace {

using namespace test;

struct Sighting {
    Vec3<float> origin, direction;
    float time;
    Hit<float> hit;
    ExactHit exact;
};

class SurfacePoints : public testing::Test {
protected:
    /// Rays that met something, the same thing in both searches.
    std::vector<Sighting> sightings(std::size_t rays, std::uint32_t seed) const {
        std::vector<Sighting> list;
        Random random(seed);
        for (std::size_t i = 0; i < rays; ++i) {
            const Vec3<float> o = rounded(random.inCube(4));
            const Vec3<float> d = normalize(rounded(random.inCube(1.8)) - o);
            const float time = float(random());
            const RayHitPacket p = trace(o, d, time);
            const std::optional<ExactHit> exact = everything_.search(widened(o), widened(d), kInfinity, time);
            if (!exact || p.hit.geometry[0] != exact->geometry || p.hit.instance[0] != exact->instance ||
                p.hit.primitive[0] != exact->primitive || std::abs(exact->t - p.ray.far[0]) > 1e-3)
                continue;
            list.push_back({o, d, time, hitOf(p), *exact});
        }
        return list;
    }
    RayHitPacket trace(const Vec3<float>& o, const Vec3<float>& d, float time) const {
        RayHitPacket p{};
        p.ray.originX[0] = o.x, p.ray.originY[0] = o.y, p.ray.originZ[0] = o.z;
        p.ray.directionX[0] = d.x, p.ray.directionY[0] = d.y, p.ray.directionZ[0] = d.z;
        p.ray.far[0] = kInfinity, p.ray.time[0] = time, p.ray.mask[0] = ~0u;
        p.hit.geometry[0] = p.hit.instance[0] = kNoHit;
        accelerator_.intersect(p, 1);
        return p;
    }
    /// REQUIRES: something was met.
    Hit<float> hitOf(const RayHitPacket& p) const {
        const std::uint32_t shape = shapeOf<float>(geometry(), p.hit.geometry[0], p.hit.instance[0]);
        return {shape, p.hit.primitive[0], p.hit.instance[0], p.hit.u[0], p.hit.v[0], p.ray.far[0]};
    }
    SurfacePoint<float> pointOf(const Sighting& s) const {
        return surfacePoint<float>(geometry(), s.hit, s.origin, s.direction, s.time);
    }
    const Geometry& geometry() const { return everything_.geometry; }
    bool isMesh(const Sighting& s) const { return geometry().shapes[s.hit.shape].kind == ShapeKind::Mesh; }

    EverythingScene everything_;
    Accelerator accelerator_{everything_.geometry, IntersectionMode::Robust};
};

double angle(Vec3d a, Vec3d b) {
    return length(a - b);
}

TEST_F(SurfacePoints, AgreeWithDoublePrecision) {
    const std::vector<Sighting> all = sightings(30000, 1);
    ASSERT_GT(all.size(), 8000u);
    std::size_t moving = 0;
    for (const Sighting& s : all) {
        const SurfacePoint<float> at = pointOf(s);
        const std::string where =
            "shape " + std::to_string(s.hit.shape) + " instance " + std::to_string(int(s.hit.instance));
        // Along the surface a grazing ray amplifies the rounding of its origin and direction.
        const double grazing = std::max(std::abs(dot(widened(s.direction), s.exact.ng)), 1e-3), reach = 4e-6 / grazing;
        ASSERT_LT(length(widened(at.p) - s.exact.p), reach) << where;
        ASSERT_LT(angle(widened(at.ng), s.exact.ng), isMesh(s) ? 4e-6 : 2e-5 + 8 * reach) << where;
        ASSERT_NEAR(length(widened(at.ng)), 1, 1e-6);
        const double tilt = isMesh(s) ? 2e-5 + 20 * reach : 2e-5 + 8 * reach;
        const Vec3d ns = s.exact.ns * (dot(s.exact.ns, s.exact.ng) < 0 ? -1.0 : 1.0);
        ASSERT_LT(angle(widened(at.frame.n), ns), tilt) << where;
        ASSERT_GE(dot(widened(at.frame.n), widened(at.ng)), -1e-6) << where;
        ASSERT_NEAR(at.uv.x, s.exact.u, 1e-5 + 20 * reach) << where;
        ASSERT_NEAR(at.uv.y, s.exact.v, 1e-5 + 40 * reach) << where;
        const Vec3d across = s.exact.tangent - ns * dot(ns, s.exact.tangent);
        if (length(across) > 0.05 * length(s.exact.tangent)) {
            ASSERT_LT(angle(widened(at.frame.s), normalized(across)), 2e-4 + 400 * reach) << where;
        }
        moving += s.hit.instance != kNone && geometry().instances[s.hit.instance].segments > 1;
    }
    EXPECT_GT(moving, 1500u);
}

/// Orthonormal, right-handed, whatever mirrors the shape.
TEST_F(SurfacePoints, FramesAreRightHanded) {
    for (const Sighting& s : sightings(10000, 2)) {
        const Frame<float> f = pointOf(s).frame;
        const Vec3d a = widened(f.s), b = widened(f.t), n = widened(f.n);
        ASSERT_NEAR(dot(cross(a, b), n), 1, 1e-5);
        for (const double product : {dot(a, b), dot(b, n), dot(n, a)})
            ASSERT_NEAR(product, 0, 1e-5);
        for (const Vec3d& v : {a, b, n})
            ASSERT_NEAR(length(v), 1, 1e-6);
    }
}

/// The true surface passes within the bound; and not much nearer, or every ray would start too far off.
TEST_F(SurfacePoints, TheErrorBoundHolds) {
    double tightest = 0;
    for (const Sighting& s : sightings(30000, 3)) {
        const SurfacePoint<float> at = pointOf(s);
        const double bound = dot(widened(abs(at.ng)), widened(at.error));
        // How far p is off the surface: a plane, or nearly one. The points differ along it, too.
        const Vec3d off = widened(at.p) - s.exact.p;
        const double bend = isMesh(s) ? 0 : 3 * dot(off, off);
        const double distance = std::abs(dot(off, s.exact.ng));
        ASSERT_LE(distance, bound + bend) << "shape " << s.hit.shape;
        ASSERT_LT(bound, 4e-5);
        tightest = std::max(tightest, distance / bound);
    }
    EXPECT_GT(tightest, 0.02);
}

/// A ray that leaves starts on its own side, beyond the error.
/// What is met beside a sighting, a little to one side; nothing where that is another surface.
struct Beside {
    SurfacePoint<float> ahead, behind;
};

TEST_F(SurfacePoints, DerivativesAreThoseOfNeighbours) {
    const auto beside = [&](const Sighting& s, const Vec3<float>& offset) -> std::optional<Beside> {
        const auto at = [&](float sign) -> std::optional<SurfacePoint<float>> {
            const Vec3<float> d = normalize(s.direction + offset * sign);
            const RayHitPacket p = trace(s.origin, d, s.time);
            if (p.hit.geometry[0] == kNoHit) return std::nullopt;
            const Hit<float> hit = hitOf(p);
            if (hit.shape != s.hit.shape || hit.primitive != s.hit.primitive || hit.instance != s.hit.instance)
                return std::nullopt;
            return surfacePoint<float>(geometry(), hit, s.origin, d, s.time);
        };
        const auto ahead = at(1), behind = at(-1);
        if (!ahead || !behind) return std::nullopt;
        return Beside{*ahead, *behind};
    };
    std::size_t meshes = 0, quadrics = 0, bent = 0;
    for (const Sighting& s : sightings(4000, 77)) {
        const SurfacePoint<float> at = pointOf(s);
        const SurfaceDerivatives<float> d = surfaceDerivatives<float>(geometry(), s.hit, at, s.time);
        const Frame<float> across = Frame<float>::fromNormal(s.direction);
        for (const Vec3<float>& offset : {across.s * 1e-3f, across.t * 1e-3f}) {
            const std::optional<Beside> found = beside(s, offset);
            if (!found) continue;
            const Vec2<float> uv = found->ahead.uv - found->behind.uv;
            if (std::hypot(uv.x, uv.y) > 0.05f) continue;  // at a seam or a pole
            const Vec3<float> moved = found->ahead.p - found->behind.p;
            const Vec3<float> turned = found->ahead.frame.n - found->behind.frame.n;
            const float far = length(moved);
            EXPECT_LT(length(moved - (d.dpdu * uv.x + d.dpdv * uv.y)), 0.02f * far + 1e-5f) << s.hit.shape;
            EXPECT_LT(length(turned - (d.dndu * uv.x + d.dndv * uv.y)), 0.02f * (far + length(turned)) + 2e-5f)
                << s.hit.shape;
            ++(isMesh(s) ? meshes : quadrics);
            bent += isMesh(s) && length(turned) > 1e-4f;
        }
        EXPECT_NEAR(dot(d.dndu, at.frame.n), 0, 1e-4f * (1 + length(d.dndu)));
    }
    EXPECT_GT(meshes, 300u);
    EXPECT_GT(quadrics, 300u);
    EXPECT_GT(bent, 100u);
}

TEST_F(SurfacePoints, RaysStartOnTheirSide) {
    Random random(4);
    for (const Sighting& s : sightings(10000, 5)) {
        const SurfacePoint<float> at = pointOf(s);
        const Vec3<float> w = normalize(rounded(random.inCube(1)));
        const Vec3d origin = widened(offsetOrigin(at.p, at.error, at.ng, w));
        const double side = dot(widened(w), widened(at.ng)) < 0 ? -1 : 1;
        ASSERT_GT(side * dot(origin - s.exact.p, s.exact.ng), 0) << "shape " << s.hit.shape;
    }
}

/// Eight at a time: shapes, instances and times mixed in a group.
TEST_F(SurfacePoints, EightLanesGiveTheBitsOfOne) {
    const std::vector<Sighting> all = sightings(12000, 6);
    for (std::size_t i = 0; i + 8 <= all.size(); i += 8) {
        Hit<Lanes8f> hit;
        Vec3<Lanes8f> origin, direction;
        Lanes8f time;
        for (int k = 0; k < 8; ++k) {
            const Sighting& s = all[i + std::size_t(k)];
            setLane(hit.shape, k, s.hit.shape);
            setLane(hit.primitive, k, s.hit.primitive);
            setLane(hit.instance, k, s.hit.instance);
            setLane(hit.u, k, s.hit.u);
            setLane(hit.v, k, s.hit.v);
            setLane(hit.t, k, s.hit.t);
            setLane(time, k, s.time);
            for (const auto& [to, from] : {std::pair{&origin, &s.origin}, std::pair{&direction, &s.direction}}) {
                setLane(to->x, k, from->x);
                setLane(to->y, k, from->y);
                setLane(to->z, k, from->z);
            }
        }
        const SurfacePoint<Lanes8f> wide = surfacePoint<Lanes8f>(geometry(), hit, origin, direction, time);
        const auto floatsOf = [](const auto& p, auto&& get) {
            std::vector<float> list;
            for (const auto& v : {p.p, p.error, p.ng, p.frame.s, p.frame.t, p.frame.n})
                for (const auto& x : {v.x, v.y, v.z})
                    list.push_back(get(x));
            for (const auto& x : {p.uv.x, p.uv.y, p.uvPerLength})
                list.push_back(get(x));
            return list;
        };
        for (int k = 0; k < 8; ++k) {
            const std::vector<float> a = floatsOf(wide, [&](const Lanes8f& x) { return lane(x, k); });
            const std::vector<float> b = floatsOf(pointOf(all[i + std::size_t(k)]), [](float x) { return x; });
            ASSERT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0) << "lane " << k;
        }
        const SurfaceDerivatives<Lanes8f> wideDerivatives = surfaceDerivatives<Lanes8f>(geometry(), hit, wide, time);
        for (int k = 0; k < 8; ++k) {
            const Sighting& s = all[i + std::size_t(k)];
            const SurfaceDerivatives<float> one = surfaceDerivatives<float>(geometry(), s.hit, pointOf(s), s.time);
            const Vec3<float> a[] = {one.dpdu, one.dpdv, one.dndu, one.dndv};
            const Vec3<float> b[] = {lane(wideDerivatives.dpdu, k), lane(wideDerivatives.dpdv, k),
                                     lane(wideDerivatives.dndu, k), lane(wideDerivatives.dndv, k)};
            ASSERT_EQ(std::memcmp(a, b, sizeof a), 0) << "lane " << k;
        }
    }
}

TEST_F(SurfacePoints, KnowHowDenseUvAre) {
    std::size_t instanced = 0, quadrics = 0;
    for (const Sighting& s : sightings(4000, 12)) {
        const SurfacePoint<float> at = pointOf(s);
        const SurfaceDerivatives<float> d = surfaceDerivatives<float>(geometry(), s.hit, at, s.time);
        const float area = length(cross(d.dpdu, d.dpdv));
        if (!at.shape.has(kShapeNeedsUv)) {
            EXPECT_EQ(at.uvPerLength, 0);
        } else {
            EXPECT_NEAR(at.uvPerLength * at.uvPerLength * area, 1, 1e-3f) << s.hit.shape;
            instanced += s.hit.instance != kNone;
            quadrics += !isMesh(s);
        }
    }
    EXPECT_GT(instanced, 200u);
    EXPECT_GT(quadrics, 200u);
}

/// The corner of a room far from the origin: points next to an edge stay inside of the next wall, although floats are
/// coarse there; farther from the edge nothing is moved.
TEST(SurfacePointsAtEdges, StayOffTheNextWall) {
    for (const double offset : {0.0, 1e3, 1e5}) {
        const float a = float(offset), b = float(offset + 2);
        Geometry g;
        TriangleMesh mesh;  // the wall x = a: a square with the diagonal y = z
        reserveVertices(mesh.positions, 4);
        mesh.positions = {a, a, a, a, b, a, a, b, b, a, a, b};
        mesh.indices = {0, 1, 2, 0, 2, 3};
        g.shapes.push_back(g.addMesh(std::move(mesh)));
        g.groups[0] = {0, 1};
        g.finish();
        Random random(7);
        for (int i = 0; i < 20000; ++i) {
            // Barycentrics near, on and by rounding beyond the triangle's borders, and in its corners.
            const auto small = [&] { return i % 4 == 0 ? 0 : std::pow(random(), 8) * (i % 5 ? 1 : -1e-7); };
            double weights[3];
            weights[i % 3] = small();
            weights[(i + 1) % 3] = (1 - weights[i % 3]) * (i % 2 ? small() : random());
            weights[(i + 2) % 3] = 1 - weights[i % 3] - weights[(i + 1) % 3];
            const float u = float(weights[1]), v = float(weights[2]);
            const Hit<float> hit{0, i % 7 < 3 ? 0u : 1u, kNone, u, v, 1};
            const SurfacePoint<float> at = surfacePoint<float>(g, hit, {b, b, b}, {-1, 0, 0}, 0.f);
            for (const float x : {at.p.y, at.p.z}) {
                ASSERT_GT(x, a) << offset << " u " << u << " v " << v;
                ASSERT_LT(x, b) << offset << " u " << u << " v " << v;
            }
            ASSERT_NEAR(at.p.x, a, std::max(offset, 2.0) * 4e-7);
        }
        const SurfacePoint<float> inside =
            surfacePoint<float>(g, {0, 0, kNone, 0.25f, 0.5f, 1}, {b, b, b}, {-1, 0, 0}, 0.f);
        EXPECT_EQ(inside.p.y, a + 1.5f);
        EXPECT_EQ(inside.p.z, a + 1.0f);
    }
}

/// The shift of -1, as after a mesh of one vertex without normals, would be the mark of a mesh that has none.
TEST(Geometry, NoShiftIsTheMarkOfNone) {
    Geometry g;
    TriangleMesh bare;
    bare.positions = {0, 0, 0};
    EXPECT_EQ(g.addMesh(std::move(bare)).normalShift, kNone);
    TriangleMesh mesh;
    mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    mesh.normals = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    mesh.indices = {0, 1, 2};
    const ShapeRecord shape = g.addMesh(std::move(mesh));
    ASSERT_NE(shape.normalShift, kNone);
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t row = g.indices[corner] + shape.normalShift;
        EXPECT_EQ(g.normals.at(3 * row), float(3 * corner + 1));
    }
}

}  // namespace
}  // namespace penumbra
