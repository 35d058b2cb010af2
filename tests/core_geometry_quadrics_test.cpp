// Spheres, cylinders and disks: intersections against double precision at all sizes, parts, limits of the ray; rays
// that leave the surface do not meet it again.
#include "core/geometry/quadrics.h"

#include "core/geometry/surface_point.h"
#include "tests/geometry_fixture.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

using namespace test;

QuadricRecord sphere(double radius) {
    QuadricRecord q;
    q.radius = float(radius);
    q.zMin = -q.radius;
    q.zMax = q.radius;
    return q;
}
QuadricRecord partOfSphere() {
    QuadricRecord q = sphere(1);
    q.zMin = -0.5f;
    q.zMax = 0.8f;
    q.thetaMin = std::acos(0.8f);
    q.thetaMax = std::acos(-0.5f);
    q.phiMax = 4;
    return q;
}
QuadricRecord ring() {
    QuadricRecord q = sphere(1);
    q.kind = ShapeKind::Disk;
    q.innerRadius = 0.4f;
    q.zMin = q.zMax = 0.25f;
    q.phiMax = 5;
    return q;
}

QuadricRecord cylinder(double radius) {
    QuadricRecord q = sphere(radius);
    q.kind = ShapeKind::Cylinder;
    return q;
}
QuadricRecord partOfCylinder() {
    QuadricRecord q = cylinder(0.7);
    q.zMin = -0.4f;
    q.zMax = 0.9f;
    q.phiMax = 4;
    return q;
}
const std::vector<QuadricRecord>& allKinds() {
    static const std::vector<QuadricRecord> list{sphere(1), partOfSphere(), ring(), cylinder(1), partOfCylinder()};
    return list;
}

/// The nearest hit in (0, far), by the textbook; 0 where there is none. `edge`: how near it is to where that changes.
double exactDistance(const QuadricRecord& q, Vec3d o, Vec3d d, double far, double& edge) {
    std::vector<double> roots;
    edge = 1e30;
    if (q.kind == ShapeKind::Disk) {
        roots = {(q.zMin - o.z) / d.z};
    } else {
        const bool round = q.kind == ShapeKind::Sphere;
        const Vec3d from{o.x, o.y, round ? o.z : 0}, along{d.x, d.y, round ? d.z : 0};
        const double a = dot(along, along), b = dot(from, along) / a;
        const double c = (dot(from, from) - double(q.radius) * q.radius) / a;
        edge = std::abs(b * b - c) / (double(q.radius) * q.radius);
        if (b * b < c) return 0;
        roots = {-b - std::sqrt(b * b - c), -b + std::sqrt(b * b - c)};
    }
    for (const double t : roots) {
        const Vec3d p = o + d * t;
        double phi = std::atan2(p.y, p.x);
        if (phi < 0) phi += 2 * std::numbers::pi;
        edge = std::min({edge, std::abs(t), std::abs(t - far)});
        bool in = t > 0 && t < far && phi <= q.phiMax;
        if (q.phiMax < 6.28f) edge = std::min({edge, std::abs(phi - q.phiMax), phi, 2 * std::numbers::pi - phi});
        if (q.kind == ShapeKind::Disk) {
            const double rho = std::hypot(p.x, p.y);
            in = in && rho <= q.radius && rho >= q.innerRadius;
            edge = std::min({edge, std::abs(rho - q.radius), std::abs(rho - q.innerRadius)});
        } else {
            in = in && p.z >= q.zMin && p.z <= q.zMax;
            if (q.zMin > -q.radius || q.kind == ShapeKind::Cylinder)
                edge = std::min({edge, std::abs(p.z - q.zMin), std::abs(p.z - q.zMax)});
        }
        if (in) return t;
    }
    return 0;
}

TEST(Quadrics, HitsAgreeWithDoublePrecision) {
    Random random(1);
    for (const QuadricRecord& q : allKinds()) {
        int hits = 0, compared = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3<float> o = rounded(random.inCube(i % 4 ? 2.5 : 0.5));
            const Vec3<float> d = normalize(rounded(random.inCube(1.2)) - o) * float(0.2 + 3 * random());
            const float far = i % 3 ? kInfinity : float(4 * random());
            double edge = 0;
            const double exact = exactDistance(q, widened(o), widened(d), far, edge);
            if (edge < 1e-4) continue;
            const QuadricHit<float> hit = intersectQuadric(q, o, d, 0.f, far);
            ASSERT_EQ(hit.hit, exact > 0) << "ray " << i;
            if (hit.hit) {
                ASSERT_NEAR(hit.t, exact, 3e-5 * (1 + exact)) << "ray " << i;
            }
            ++compared;
            hits += hit.hit;
        }
        EXPECT_GT(compared, 15000);
        EXPECT_GT(hits, 3000);
    }
}

/// Small spheres far off, and huge ones: the distance keeps its digits.
TEST(Quadrics, SpheresOfAllSizes) {
    Random random(2);
    for (const double radius : {1e-4, 1.0, 1e6})
        for (const double distance : {0.5, 3.0, 1e3}) {  // in radii
            const QuadricRecord q = sphere(radius);
            for (int i = 0; i < 5000; ++i) {
                const Vec3<float> o = rounded(normalized(random.inCube(1)) * (distance * radius));
                const Vec3<float> d = normalize(rounded(random.inCube(0.8 * radius)) - o);
                double edge = 0;
                const double exact = exactDistance(q, widened(o), widened(d), 1e30, edge);
                // The direction's own rounding, times the distance, is what the impact may be off by.
                if (edge < 1e-3 + 4e-7 * distance * 100) continue;
                const QuadricHit<float> hit = intersectQuadric(q, o, d, 0.f, kInfinity);
                ASSERT_EQ(hit.hit, exact > 0) << radius << " at " << distance;
                if (hit.hit) {
                    ASSERT_NEAR(hit.t, exact, 1e-6 * exact + radius * (1e-5 + 2e-6 * distance))
                        << radius << " at " << distance;
                }
            }
        }
}

/// From where rays start, outwards: nothing; inwards: the far side, not the near one again.
TEST(Quadrics, RaysThatLeaveDoNotComeBack) {
    Random random(3);
    for (const double radius : {1e-4, 1.0, 1e6})
        for (const QuadricRecord& q : {sphere(radius), cylinder(radius)}) {
            const Records<float, QuadricRecord> record(&q, 0u);
            const bool round = q.kind == ShapeKind::Sphere;
            for (int i = 0; i < 50000; ++i) {
                const QuadricPoint<float> at = quadricPoint(record, rounded(normalized(random.inCube(1)) * radius));
                Vec3<float> w = rounded(normalized(random.inCube(1)));
                if (i % 4 == 0)
                    w = normalize(w - at.normal * (dot(w, at.normal) * float(1 - 1e-4 * random())));  // grazing
                const Vec3<float> o = offsetOrigin(at.p, at.error, at.normal, w);
                const QuadricHit<float> hit = intersectQuadric(q, o, w, 0.f, kInfinity);
                // Across a cylinder only the part of the direction that is across its axis moves on.
                const float across = round ? 1.f : std::hypot(w.x, w.y);
                const float cosine = dot(w, at.normal) / across, far = -2 * cosine / across;
                const bool within = round || std::abs(at.p.z + far * float(radius) * w.z) < 0.999 * radius;
                if (!(cosine < 0)) {
                    ASSERT_FALSE(hit.hit) << "radius " << radius << " cosine " << cosine;
                } else if (cosine < -0.01f && within) {
                    ASSERT_TRUE(hit.hit) << "radius " << radius << " cosine " << cosine;
                    ASSERT_NEAR(hit.t / radius, far, 1e-3 / across);
                }
            }
        }
}

/// The surface at a hit: on it, with the normal outwards, and the parameters of the format.
TEST(Quadrics, SurfaceOfCylinders) {
    const QuadricRecord q = partOfCylinder();
    const Records<float, QuadricRecord> record(&q, 0u);
    Random random(5);
    for (int i = 0; i < 1000; ++i) {
        const double phi = 4 * random(), z = -0.4 + 1.3 * random();
        const Vec3d normal{std::cos(phi), std::sin(phi), 0}, on = normal * q.radius + Vec3d{0, 0, z};
        const QuadricPoint<float> at = quadricPoint(record, rounded(on + random.inCube(3e-6)));
        ASSERT_NEAR(std::hypot(double(at.p.x), double(at.p.y)), q.radius,
                    dot(widened(abs(at.normal)), widened(at.error)));
        ASSERT_LT(length(widened(at.normal) - normal), 1e-5);
        ASSERT_NEAR(at.uv.x, phi / 4, 3e-6);
        ASSERT_NEAR(at.uv.y, (z + 0.4) / 1.3, 6e-6);
        ASSERT_LT(length(normalized(widened(at.tangent)) - Vec3d{-normal.y, normal.x, 0}), 1e-5);
    }
}

TEST(Quadrics, EightLanesGiveTheBitsOfOne) {
    Random random(4);
    for (const QuadricRecord& q : allKinds())
        for (int i = 0; i < 2000; ++i) {
            Vec3<Lanes8f> o, d;
            Lanes8f far;
            Vec3<float> origins[8], directions[8];
            float ends[8];
            for (int k = 0; k < 8; ++k) {
                origins[k] = rounded(random.inCube(2));
                directions[k] = rounded(random.inCube(1));
                ends[k] = k % 2 ? kInfinity : float(5 * random());
                setLane(o.x, k, origins[k].x), setLane(o.y, k, origins[k].y), setLane(o.z, k, origins[k].z);
                setLane(d.x, k, directions[k].x), setLane(d.y, k, directions[k].y), setLane(d.z, k, directions[k].z);
                setLane(far, k, ends[k]);
            }
            const QuadricHit<Lanes8f> wide = intersectQuadric<Lanes8f>(q, o, d, Lanes8f(0.f), far);
            for (int k = 0; k < 8; ++k) {
                const QuadricHit<float> one = intersectQuadric<float>(q, origins[k], directions[k], 0.f, ends[k]);
                ASSERT_EQ(lane(wide.hit, k), one.hit);
                if (one.hit) {
                    ASSERT_EQ(floatBits(lane(wide.t, k)), floatBits(one.t));
                }
            }
        }
}

/// No direction, poles, the plane of a disk: nothing is met, nothing is NaN.
TEST(Quadrics, DegenerateRays) {
    const Vec3<float> zero{0, 0, 0}, x{1, 0, 0}, z{0, 0, 1};
    EXPECT_FALSE(intersectQuadric(ring(), {0.5f, 0, 0.25f}, x, 0.f, kInfinity).hit);  // within its plane
    EXPECT_FALSE(intersectQuadric(ring(), {0.5f, 0, 0}, zero, 0.f, kInfinity).hit);
    EXPECT_FALSE(intersectQuadric(sphere(1), {0.5f, 0, 0}, zero, 0.f, kInfinity).hit);
    EXPECT_FALSE(intersectQuadric(cylinder(1), {0.5f, 0, 0}, zero, 0.f, kInfinity).hit);
    for (const float x : {0.f, 0.5f, 1.f, 2.f})  // along the axis: through the open ends, in the surface, outside
        EXPECT_FALSE(intersectQuadric(cylinder(1), {x, 0, -3}, z, 0.f, kInfinity).hit) << x;
    EXPECT_TRUE(intersectQuadric(cylinder(1), zero, x, 0.f, kInfinity).hit);
    EXPECT_TRUE(intersectQuadric(sphere(1), zero, z, 0.f, kInfinity).hit);  // from the centre
    const QuadricRecord q = sphere(1);
    const Records<float, QuadricRecord> record(&q, 0u);
    for (const float pole : {1.f, -1.f}) {
        const QuadricPoint<float> at = quadricPoint(record, {0, 0, pole});
        EXPECT_EQ(at.normal.z, pole);
        EXPECT_GT(length(at.tangent), 0);
        EXPECT_NEAR(at.uv.y, pole > 0 ? 1 : 0, 1e-6);
    }
}

}  // namespace
}  // namespace penumbra
