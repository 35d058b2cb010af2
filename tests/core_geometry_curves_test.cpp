// Curves: their control points against the definition of the bases; what rays meet against a search in double that
// knows nothing of Embree; normals, tangents and parameters of the format; and rays that leave do not meet them again.
#include "core/geometry/accelerator.h"
#include "core/geometry/surface_point.h"
#include "tests/expect_error.h"
#include "tests/geometry_fixture.h"

#include <gtest/gtest.h>

#include <cstring>

namespace penumbra {
namespace {

using namespace test;

/// Points of a curve that winds upwards, with segments of different bend.
CurveArrays winding(bool spline, int degree, CurveType type = CurveType::Flat, double size = 1) {
    CurveArrays a;
    a.spline = spline;
    a.degree = degree;
    a.type = type;
    const int segments = 5, points = spline ? segments + degree : segments * degree + 1;
    for (int i = 0; i < points; ++i) {
        const double t = double(i) / (points - 1);
        for (const double x : {std::cos(7 * t), std::sin(5 * t + 0.3), 2 * t - 1})
            a.P.push_back(float(size * x));
    }
    a.width0 = float(0.08 * size);
    a.width1 = float(0.02 * size);
    if (type == CurveType::Ribbon)
        for (int i = 0; i <= segments; ++i)
            for (const double x : {std::cos(0.5 * i), std::sin(0.7 * i), 0.4})
                a.N.push_back(float(x));
    return a;
}

/// By the recursion of de Boor: B-spline basis function i of a degree on uniform knots.
double basis(int degree, int i, double t) {
    if (degree == 0) return t >= i && t < i + 1 ? 1 : 0;
    return ((t - i) * basis(degree - 1, i, t) + (i + degree + 1 - t) * basis(degree - 1, i + 1, t)) / degree;
}
double choose(int n, int k) {
    return k == 0 || k == n ? 1 : choose(n - 1, k - 1) + choose(n - 1, k);
}

struct Along {
    Vec3d p, tangent;
    double width;
};
/// The curve at u of a segment, by the bases' definitions; the tangent by differences.
Along definition(const CurveArrays& a, int segment, double u, bool wantsTangent = true) {
    Along out;
    for (int i = 0; i <= a.degree; ++i) {
        const double weight = a.spline ? basis(a.degree, i, a.degree + std::min(u, 1 - 1e-12))
                                       : choose(a.degree, i) * std::pow(u, i) * std::pow(1 - u, a.degree - i);
        const float* p = &a.P[3 * std::size_t((a.spline ? segment : segment * a.degree) + i)];
        out.p = out.p + Vec3d{p[0], p[1], p[2]} * weight;
    }
    const std::size_t points = a.P.size() / 3, degree = std::size_t(a.degree);
    const double segments = double(a.spline ? points - degree : (points - 1) / degree), t = (segment + u) / segments;
    out.width = (1 - t) * a.width0 + t * a.width1;
    if (wantsTangent) {
        const double h = 1e-4, low = std::max(u - h, 0.0), high = std::min(u + h, 1.0);
        out.tangent = normalized(definition(a, segment, high, false).p - definition(a, segment, low, false).p);
    }
    return out;
}
constexpr int kSegments = 5;

/// A piece of a set at its own u: position and radius.
std::array<double, 4> atPiece(const CurveSet& set, std::size_t piece, double u) {
    std::array<double, 4> sum{};
    for (int i = 0; i < 4; ++i) {
        const double weight = set.spline ? basis(3, i, 3 + std::min(u, 1 - 1e-12))
                                         : choose(3, i) * std::pow(u, i) * std::pow(1 - u, 3 - i);
        for (std::size_t k = 0; k < 4; ++k)
            sum[k] += weight * set.vertices[4 * (set.indices[piece] + std::size_t(i)) + k];
    }
    return sum;
}

CurveSet built(const CurveArrays& arrays) {
    Warnings warnings;
    CurveSet set = curvesFromArrays(arrays, "here", warnings);
    EXPECT_TRUE(warnings.all().empty());
    return set;
}

TEST(CurveSets, AreTheCurvesOfTheirDefinition) {
    for (const bool spline : {false, true})
        for (const int degree : {2, 3})
            for (const double thinner : {1.0, 0.05}) {
                CurveArrays a = winding(spline, degree);
                a.width0 *= float(thinner), a.width1 *= float(thinner);
                const CurveSet set = built(a);
                EXPECT_EQ(set.spline, spline && degree == 3);
                EXPECT_EQ(set.level > 0, thinner < 1);
                ASSERT_EQ(set.indices.size(), std::size_t(kSegments) << set.level);
                for (std::size_t piece = 0; piece < set.indices.size(); ++piece)
                    for (const double u : {0.0, 0.3, 0.8, 1.0}) {
                        const double part = double(1u << set.level);
                        const int segment = int(piece >> set.level);
                        const Along exact = definition(a, segment, (double(piece % (1u << set.level)) + u) / part);
                        const std::array<double, 4> at = atPiece(set, piece, u);
                        ASSERT_LT(length(Vec3d{at[0], at[1], at[2]} - exact.p), 1e-6) << spline << degree << piece;
                        ASSERT_NEAR(2 * at[3], exact.width, 1e-7);
                    }
            }
}

/// Eight chords a piece stay within a twentieth of the width.
TEST(CurveSets, AreCutUntilChordsFollowThem) {
    for (const bool spline : {false, true})
        for (const double width : {0.5, 0.05, 0.002}) {
            CurveArrays a = winding(spline, 3);
            a.width0 = a.width1 = float(width);
            const CurveSet set = built(a);
            double farthest = 0;
            for (std::size_t piece = 0; piece < set.indices.size(); ++piece)
                for (int quad = 0; quad < kCurveQuads; ++quad) {
                    const auto at = [&](double u) {
                        const std::array<double, 4> p = atPiece(set, piece, u);
                        return Vec3d{p[0], p[1], p[2]};
                    };
                    const Vec3d middle = (at(double(quad) / kCurveQuads) + at((quad + 1.0) / kCurveQuads)) * 0.5;
                    farthest = std::max(farthest, length(at((quad + 0.5) / kCurveQuads) - middle));
                }
            EXPECT_LT(farthest, 0.05 * width);
            if (set.level > 0) {
                EXPECT_GT(farthest, 0.001 * width) << "cut for nothing";
            }
        }
}

TEST(CurveSets, RefuseWhatIsNoCurve) {
    Warnings warnings;
    const auto build = [&](CurveArrays a) { return curvesFromArrays(a, "here", warnings); };
    CurveArrays a = winding(false, 3);
    a.P.resize(a.P.size() - 3);
    EXPECT_EQ(messageOf([&] {
                  build(a);
              }).rfind("here: 15 points make no curve of degree 3; needed are 4, and 3 for each further segment", 0),
              0u);
    a = winding(true, 2);
    a.P.resize(6);
    EXPECT_EQ(messageOf([&] { build(a); }).rfind("here: 2 points make no curve of degree 2; needed are at least 3", 0),
              0u);
    a.P.clear();
    EXPECT_EQ(messageOf([&] { build(a); }).rfind("here: 0 points make no curve", 0), 0u);
    a = winding(false, 3, CurveType::Ribbon);
    a.N.resize(a.N.size() - 3);
    EXPECT_EQ(messageOf([&] { build(a); }).rfind("here: a ribbon of 5 segments needs 6 normals \"N\", but has 5", 0),
              0u);
    a.N.insert(a.N.end(), {0, 0, 0});
    EXPECT_EQ(messageOf([&] { build(a); }).rfind("here: the normal number 5 has no length", 0), 0u);
    EXPECT_TRUE(warnings.all().empty());
    a.type = CurveType::Flat;
    EXPECT_EQ(build(a).indices.size(), 5u);
    ASSERT_EQ(warnings.all().size(), 1u);
    EXPECT_EQ(warnings.all()[0], "here: \"N\" is of use for ribbons only; ignored");
}

TEST(CurveSets, LeaveOutWhatCannotBeSeen) {
    CurveArrays a = winding(false, 3);
    a.width0 = a.width1 = 0;
    EXPECT_TRUE(built(a).indices.empty());
    a = winding(false, 3);
    a.P[4] = 1e30f;
    EXPECT_TRUE(built(a).indices.empty());
    a = winding(false, 3);
    for (std::size_t i = 0; i < 12; ++i)
        a.P[i] = a.P[i % 3];  // the first segment is a point
    EXPECT_EQ(built(a).indices.size(), std::size_t(4) << built(a).level);
    a.P = std::vector<float>(12, 1.f);
    EXPECT_TRUE(built(a).indices.empty());
}

TEST(CurveSets, SimilaritiesKeepThemRound) {
    EXPECT_TRUE(isSimilarity(translation(1, 2, 3) * rotation(40, 1, 2, 3) * scaling(-2, 2, 2)));
    EXPECT_FALSE(isSimilarity(scaling(1, 1, 1.01)));
    EXPECT_FALSE(isSimilarity(rotation(40, 1, 2, 3) * scaling(1, 0, 1)));
    CurveSet set = built(winding(false, 3, CurveType::Ribbon));
    const CurveSet before = set;
    const Matrix4 m = translation(1, 2, 3) * rotation(90, 0, 0, 1) * scaling(2, 2, 2);
    transform(set, m);
    EXPECT_NEAR(set.vertices[0], 1 - 2 * before.vertices[1], 1e-6);
    EXPECT_NEAR(set.vertices[1], 2 + 2 * before.vertices[0], 1e-6);
    EXPECT_FLOAT_EQ(set.vertices[3], 2 * before.vertices[3]);
    EXPECT_NEAR(set.normals[0], -before.normals[1], 1e-6);
}

/// One shape of each basis and type in the world; that of `curves[i]` is shape i.
class CurveScene {
public:
    explicit CurveScene(const std::vector<CurveArrays>& curves) : curves_(curves) {
        for (const CurveArrays& a : curves) {
            ShapeRecord r = geometry_.addCurves(built(a));
            r.flags |= kShapeNeedsTangent | (a.type == CurveType::Cylinder ? kShapeCurveCylinder : 0u);
            geometry_.shapes.push_back(r);
        }
        geometry_.groups[0] = {0, std::uint32_t(geometry_.shapes.size())};
        geometry_.finish();
        accelerator_ = Accelerator(geometry_, IntersectionMode::Robust);
    }

    struct Met {
        Hit<float> hit;
        SurfacePoint<float> at;
    };
    std::optional<Met> trace(const Vec3<float>& o, const Vec3<float>& d) const {
        RayHitPacket p{};
        p.ray.originX[0] = o.x, p.ray.originY[0] = o.y, p.ray.originZ[0] = o.z;
        p.ray.directionX[0] = d.x, p.ray.directionY[0] = d.y, p.ray.directionZ[0] = d.z;
        p.ray.far[0] = kInfinity, p.ray.mask[0] = ~0u;
        p.hit.geometry[0] = p.hit.instance[0] = kNoHit;
        accelerator_.intersect(p, 1);
        if (p.hit.geometry[0] == kNoHit) return std::nullopt;
        const Hit<float> hit{p.hit.geometry[0], p.hit.primitive[0], p.hit.instance[0],
                             p.hit.u[0],        p.hit.v[0],         p.ray.far[0]};
        return Met{hit, surfacePoint(geometry_, hit, o, d, 0.f)};
    }
    const Geometry& geometry() const { return geometry_; }
    const Accelerator& accelerator() const { return accelerator_; }
    int segmentOf(const Hit<float>& hit) const {
        return int(hit.primitive >> ((geometry_.shapes[hit.shape].flags >> kShapeCurveLevelShift) & kMostCurveLevel));
    }

private:
    std::vector<CurveArrays> curves_;
    Geometry geometry_;
    Accelerator accelerator_;
};

/// How near the ray passes the curve, by a search along it. What Embree draws may be off by a twentieth of the width,
/// and by more where a curve is seen end on; its ends are cut straight, and so is either side of a kink, where Bezier
/// segments meet.
struct Passage {
    double excess = 1e30;  ///< (distance - half width) / width, where that is least
    bool clear = true;     ///< neither near an end of a segment nor end on
};
Passage passage(const CurveArrays& a, Vec3d o, Vec3d d) {
    Passage best;
    constexpr int kSteps = 200;
    for (int segment = 0; segment < kSegments; ++segment)
        for (int i = 0; i <= kSteps; ++i) {
            const Along at = definition(a, segment, double(i) / kSteps, false);
            const double t = dot(at.p - o, d), distance = length(at.p - (o + d * t));
            const double excess = (distance - 0.5 * at.width) / at.width;
            const bool end = i < kSteps / 20 || i > kSteps - kSteps / 20;
            if (t > 0 && excess < best.excess)
                best = {excess, !end && length(cross(d, definition(a, segment, double(i) / kSteps).tangent)) > 0.3};
        }
    return best;
}

/// Rays from all sides towards points near the curve.
struct Aim {
    Vec3<float> origin, direction;
};
Aim aimAt(const CurveArrays& a, Random& random, double size) {
    const Along at = definition(a, int(random() * kSegments), random(), false);
    const Vec3<float> o = rounded(random.inCube(3 * size));
    return {o, normalize(rounded(at.p + random.inCube(0.06 * size)) - o)};
}

TEST(Curves, AreMetWhereTheRayPassesWithinTheirWidth) {
    Random random(1);
    for (const double size : {1e-3, 1.0, 1e4})
        for (const CurveArrays& a : {winding(false, 3, CurveType::Flat, size), winding(true, 3, CurveType::Flat, size),
                                     winding(false, 2, CurveType::Cylinder, size)}) {
            const CurveScene scene({a});
            int met = 0, compared = 0;
            for (int i = 0; i < 600; ++i) {
                const Aim ray = aimAt(a, random, size);
                const Passage exact = passage(a, widened(ray.origin), widened(ray.direction));
                const auto hit = scene.trace(ray.origin, ray.direction);
                if (std::abs(exact.excess) < 0.12 || !exact.clear) continue;
                ++compared;
                met += hit.has_value();
                ASSERT_EQ(hit.has_value(), exact.excess < 0) << "ray " << i << " size " << size;
            }
            EXPECT_GT(compared, 280);
            EXPECT_GT(met, 100);
        }
}

/// The shading of PBRT-v4: p on the ribbon, u along a segment, v towards d x T, tangent and normals.
TEST(Curves, HaveTheParametersOfTheFormat) {
    Random random(2);
    const std::vector<CurveArrays> curves = {winding(false, 3), winding(true, 3), winding(true, 2),
                                             winding(true, 3, CurveType::Cylinder)};
    for (const CurveArrays& a : curves) {
        const CurveScene scene({a});
        int compared = 0;
        double sum = 0;
        for (int i = 0; i < 4000; ++i) {
            const Aim ray = aimAt(a, random, 1);
            const auto met = scene.trace(ray.origin, ray.direction);
            if (!met) continue;
            const Along exact = definition(a, scene.segmentOf(met->hit), met->at.uv.x);
            const Vec3d d = widened(ray.direction), side = normalized(cross(d, exact.tangent));
            if (length(cross(d, exact.tangent)) < 0.3) continue;  // seen end on
            if (std::abs(met->at.uv.x - 0.5f) > 0.45f) continue;  // by a kink
            ++compared;
            const Vec3d p = widened(ray.origin) + d * double(met->hit.t);
            ASSERT_LT(length(widened(met->at.p) - p), 0.25 * exact.width);
            const double off = std::abs(met->at.uv.y - 0.5 - dot(p - exact.p, side) / exact.width);
            ASSERT_LT(off, 0.2);
            sum += off;
            ASSERT_LT(std::abs(dot(p - exact.p, d)), 0.12 * exact.width);
            ASSERT_LT(length(widened(met->at.frame.s) - exact.tangent), 2e-3);
            const double angle = a.type == CurveType::Cylinder ? std::numbers::pi * (double(met->at.uv.y) - 0.5) : 0;
            const Vec3d normal = side * std::sin(angle) + cross(exact.tangent, side) * std::cos(angle);
            ASSERT_LT(length(widened(met->at.ng) - normal), 5e-3);
            ASSERT_LT(length(widened(met->at.frame.n) - normal), 5e-3);
        }
        EXPECT_GT(compared, 700);
        EXPECT_LT(sum / compared, 0.02);
    }
}

/// A quarter of a turn: flat, and so that its normals turn with it.
CurveArrays quarterRibbon() {
    CurveArrays a;
    a.type = CurveType::Ribbon;
    a.P = {0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 3};
    a.N = {1, 0, 0, 0, 1, 0};
    a.width0 = a.width1 = 0.4f;
    return a;
}

TEST(Ribbons, LieAcrossTheirNormals) {
    const CurveArrays a = quarterRibbon();
    const CurveScene scene({a});
    Random random(3);
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
        // Through a point of the true surface, well within its border: z = 3 u.
        const double u = 0.02 + 0.96 * random(), v = random() * 1.3 - 0.15, angle = u * std::numbers::pi / 2;
        const Vec3d normal{std::cos(angle), std::sin(angle), 0}, side = cross(normal, {0, 0, 1});
        const Vec3d on = side * ((v - 0.5) * 0.4) + Vec3d{0, 0, 3 * u};
        const Vec3<float> o = rounded(on + normalized(random.inCube(1)) * 2.0), d = normalize(rounded(on) - o);
        const double facing = dot(widened(d), normal);
        if (std::abs(facing) < 0.3 || std::abs(v) < 0.03 || std::abs(v - 1) < 0.03) continue;
        const auto hit = scene.trace(o, d);
        if (v < 0 || v > 1) continue;  // it twists: the ray may meet it elsewhere
        ASSERT_TRUE(hit) << i;
        if (std::abs(double(hit->hit.t) - 2) > 0.02) continue;
        ++met;
        ASSERT_LT(length(widened(hit->at.p) - on), 4e-3);
        ASSERT_NEAR(hit->at.uv.x, u, 3e-3);
        ASSERT_NEAR(hit->at.uv.y, facing < 0 ? 1 - v : v, 6e-3) << "facing " << facing;
        ASSERT_GT(dot(widened(hit->at.ng), normal), 0.98);
        ASSERT_GT(hit->at.frame.s.z, 0.999f);
    }
    EXPECT_GT(met, 2000);
}

/// From a straight curve nothing comes back to it, whatever the direction: ribbons that face a ray fill a tube, and
/// rays start outside of it. They start not farther off than they must.
TEST(Curves, RaysThatLeaveDoNotComeBack) {
    Random random(4);
    for (const double size : {1e-3, 1.0, 1e3})
        for (const CurveType type : {CurveType::Flat, CurveType::Cylinder, CurveType::Ribbon}) {
            CurveArrays a = quarterRibbon();
            for (float& x : a.P)
                x *= float(size);
            a.N = {1, 0, 0, 1, 0, 0};
            if (type != CurveType::Ribbon) a.N = {};
            a.type = type;
            a.width0 = a.width1 = float(0.01 * size);
            const CurveScene scene({a});
            int left = 0;
            for (int i = 0; i < 6000; ++i) {
                const Vec3<float> o = rounded(random.inCube(2 * size));
                const Vec3d target = Vec3d{0, 0, (0.1 + 2.8 * random()) * size} + random.inCube(0.004 * size);
                const auto met = scene.trace(o, normalize(rounded(target) - o));
                if (!met) continue;
                Vec3<float> w = rounded(normalized(random.inCube(1)));
                if (i % 3 == 0)  // nearly along the curve
                    w = normalize(rounded(Vec3d{0, 0, i % 2 ? 1.0 : -1.0} + random.inCube(0.02)));
                const Vec3<float> from = offsetOrigin(met->at.p, met->at.error, met->at.ng, w);
                ASSERT_LT(length(from - met->at.p), (type == CurveType::Cylinder ? 1.9 : 1.0) * a.width0);
                ASSERT_FALSE(scene.trace(from, w)) << "type " << int(type) << " size " << size << " ray " << i;
                ++left;
            }
            EXPECT_GT(left, 1200);
        }
}

/// Eight at a time, shapes of all kinds mixed: the bits of one at a time; and packets do not care for their neighbours.
TEST(Curves, EightLanesGiveTheBitsOfOne) {
    const std::vector<CurveArrays> curves = {winding(false, 3), winding(true, 3), winding(true, 2, CurveType::Cylinder),
                                             winding(false, 3, CurveType::Ribbon)};
    const CurveScene scene(curves);
    Random random(5);
    int met = 0;
    for (int i = 0; i < 3000; ++i) {
        RayHitPacket packet{};
        Vec3<Lanes8f> origin, direction;
        Hit<Lanes8f> hit;
        SurfacePoint<float> alone[8];
        unsigned there = 0;
        for (int k = 0; k < 8; ++k) {
            const Aim ray = aimAt(curves[random.bits() % curves.size()], random, 1);
            packet.ray.originX[k] = ray.origin.x, packet.ray.originY[k] = ray.origin.y;
            packet.ray.originZ[k] = ray.origin.z, packet.ray.directionX[k] = ray.direction.x;
            packet.ray.directionY[k] = ray.direction.y, packet.ray.directionZ[k] = ray.direction.z;
            packet.ray.far[k] = kInfinity, packet.ray.mask[k] = ~0u;
            packet.hit.geometry[k] = packet.hit.instance[k] = kNoHit;
            setLane(origin.x, k, ray.origin.x), setLane(origin.y, k, ray.origin.y), setLane(origin.z, k, ray.origin.z);
            setLane(direction.x, k, ray.direction.x), setLane(direction.y, k, ray.direction.y);
            setLane(direction.z, k, ray.direction.z);
        }
        scene.accelerator().intersect(packet, 0xFFu);
        for (int k = 0; k < 8; ++k) {
            const auto one = scene.trace(lane(origin, k), lane(direction, k));
            ASSERT_EQ(one.has_value(), packet.hit.geometry[k] != kNoHit);
            if (!one) continue;
            there |= 1u << k;
            ASSERT_EQ(one->hit.shape, packet.hit.geometry[k]);
            ASSERT_EQ(one->hit.primitive, packet.hit.primitive[k]);
            ASSERT_EQ(floatBits(one->hit.t), floatBits(packet.ray.far[k]));
            ASSERT_EQ(floatBits(one->hit.u), floatBits(packet.hit.u[k]));
            ASSERT_EQ(floatBits(one->hit.v), floatBits(packet.hit.v[k]));
            alone[k] = one->at;
        }
        if (there == 0) continue;
        for (int k = 0; k < 8; ++k) {  // every lane must hold a hit: the missing ones take that of another
            const int from = there >> k & 1u ? k : std::countr_zero(there);
            setLane(hit.shape, k, packet.hit.geometry[from]), setLane(hit.primitive, k, packet.hit.primitive[from]);
            setLane(hit.instance, k, kNone), setLane(hit.u, k, packet.hit.u[from]),
                setLane(hit.v, k, packet.hit.v[from]);
            setLane(hit.t, k, packet.ray.far[from]);
        }
        const SurfacePoint<Lanes8f> wide =
            surfacePoint<Lanes8f>(scene.geometry(), hit, origin, direction, Lanes8f(0.f));
        for (int k = 0; k < 8; ++k) {
            if (!(there >> k & 1u)) continue;
            ++met;
            const auto words = [](const Vec3<float>& a, const Vec3<float>& b, const Vec3<float>& c,
                                  const Vec2<float>& d, float e) {
                return std::array{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, e};
            };
            const auto a = words(lane(wide.p, k), lane(wide.ng, k), lane(wide.frame.s, k),
                                 {lane(wide.uv.x, k), lane(wide.uv.y, k)}, lane(wide.uvPerLength, k));
            const auto b = words(alone[k].p, alone[k].ng, alone[k].frame.s, alone[k].uv, alone[k].uvPerLength);
            ASSERT_EQ(std::memcmp(a.data(), b.data(), sizeof a), 0) << "lane " << k;
        }
    }
    EXPECT_GT(met, 5000);
}

}  // namespace
}  // namespace penumbra
