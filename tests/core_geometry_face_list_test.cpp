// The list of faces that small scenes are traced by: which scenes have one, and that it finds what a search in double
// precision and Embree find, with no ray lost between faces, not even at corners.
#include "core/geometry/face_list.h"

#include "tests/ray_fixture.h"

#include <gtest/gtest.h>

#include <limits>

namespace penumbra {
namespace {

using namespace test;

class Small {
public:
    Geometry geometry;

    Small& mesh(const std::vector<Vec3d>& corners, std::vector<std::uint32_t> indices) {
        TriangleMesh m;
        reserveVertices(m.positions, corners.size());
        for (const Vec3d& p : corners)
            for (const double x : {p.x, p.y, p.z})
                m.positions.push_back(float(x));
        m.indices = std::move(indices);
        return mesh(std::move(m));
    }
    Small& mesh(TriangleMesh&& m) {
        geometry.shapes.push_back(geometry.addMesh(std::move(m)));
        return *this;
    }
    /// Six squares, some cut along one diagonal and some along the other.
    Small& box(const Matrix4& place) {
        std::vector<Vec3d> corners;
        for (int i = 0; i < 8; ++i)
            corners.push_back(transformPoint(place, {i & 1 ? 1. : -1., i & 2 ? 1. : -1., i & 4 ? 1. : -1.}));
        return mesh(corners, {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 1, 5, 0, 5, 4, 0,
                              2, 6, 7, 3, 2, 7, 0, 4, 6, 2, 0, 6, 5, 1, 3, 5, 3, 7});
    }
    Small& quadric(ShapeKind kind, const Matrix4& world) {
        geometry.shapes.push_back(geometry.addQuadric(wholeQuadric(kind, world)));
        return *this;
    }
    Small& finish() {
        geometry.groups[0] = {0, std::uint32_t(geometry.shapes.size())};
        geometry.finish();
        return *this;
    }
    bool hasList() { return FaceList::make(finish().geometry) != nullptr; }
};

/// Boxes, a pair of triangles that is bent, one that is concave, loose ones, one with its neighbour turned over, and
/// quadrics; about five units across.
Small mixedScene() {
    Small s;
    s.box(translation(0.9, 0.8, -0.5) * rotation(30, 1, 2, 3) * scaling(0.6, 0.4, 0.8));
    s.box(translation(-1, -0.6, 0.7) * rotation(50, 0, 1, 1) * scaling(0.5, 0.5, 0.5));
    s.mesh({{-2, -2, -1.5}, {2, -2, -1.2}, {2, 2, -2}, {-2, 2, -1}}, {0, 1, 2, 0, 2, 3});       // bent
    s.mesh({{0, 1.5, 1.5}, {-0.7, 0.8, 1.5}, {1.4, 1.5, 1.5}, {-0.7, 2.2, 1.5}}, {0, 1, 2, 0, 2, 3});  // not convex
    s.mesh({{1.5, -1.5, 0}, {2, 0, 1}, {1, -0.5, 1.5}}, {0, 1, 2});
    s.mesh({{-2, 0, 0}, {-2, 1, 0}, {-2, 1, 1}, {-2, 0, 1}}, {0, 1, 2, 0, 3, 2});
    s.quadric(ShapeKind::Sphere, translation(0.3, -1.4, 0.2) * scaling(0.5, 0.5, 0.5));
    s.quadric(ShapeKind::Disk, translation(-0.5, 0.8, 0.3) * rotation(40, 1, 0, 0) * scaling(0.7, 0.7, 1));
    s.quadric(ShapeKind::Cylinder, translation(1.4, 1.5, 1.2) * rotation(70, 0, 1, 0) * scaling(0.4, 0.4, 0.6));
    return s.finish();
}

TEST(FaceList, IsMadeOfSmallScenesThatStandStillAndHaveNoHoles) {
    EXPECT_NE(FaceList::make(mixedScene().geometry), nullptr);
    EXPECT_TRUE(Small().hasList());   // of an empty scene
    EXPECT_TRUE(Small().mesh(icosphere(0)).hasList());
    EXPECT_FALSE(Small().mesh(icosphere(1)).hasList());   // 80 faces
    EXPECT_FALSE(Small().mesh(icosphere(5)).hasList());
    EXPECT_EQ(FaceList::make(EverythingScene().geometry), nullptr);   // it has instances
    Small masked;
    masked.mesh(icosphere(0)).geometry.shapes[0].alpha = 0.5f;
    EXPECT_FALSE(masked.hasList());
    Small hidden;   // what rays cannot meet does not count
    hidden.mesh(icosphere(0)).mesh(icosphere(3)).geometry.shapes[1].flags |= kShapeInvisible;
    EXPECT_TRUE(hidden.hasList());
    Small many;
    for (int i = 0; i < 60; ++i)
        many.quadric(ShapeKind::Sphere, translation(3. * i, 0, 0));
    EXPECT_FALSE(many.hasList());
    EXPECT_TRUE(Accelerator(mixedScene().geometry, IntersectionMode::Robust).hasFaceList());
    for (const IntersectionMode mode : {IntersectionMode::Embree, IntersectionMode::Fast})
        EXPECT_FALSE(Accelerator(mixedScene().geometry, mode).hasFaceList());
}

/// Nearest hits against the search through all shapes in double precision, and barycentrics against Embree's. Rays that
/// pass within 1e-4 of an edge of what they meet may differ.
TEST(FaceList, AgreesWithASearchInDoubleAndWithEmbree) {
    const Small scene = mixedScene();
    const Accelerator list(scene.geometry, IntersectionMode::Robust), embree(scene.geometry, IntersectionMode::Embree);
    const ExactSearch search(scene.geometry);
    Random random(1);
    std::size_t met = 0, differ = 0;
    for (const Ray& r : randomRays(random, 60000)) {
        const std::optional<ExactHit> exact = search.search(widened(r.origin), widened(r.direction), r.far, 0);
        const Answer a = alone(list, r), e = alone(embree, r);
        const bool same = (a[4] != kNoHit) == exact.has_value();
        met += exact.has_value();
        if (!same || (exact && (a[4] != exact->geometry || a[3] != exact->primitive))) {
            ++differ;
            continue;
        }
        EXPECT_EQ(occludedAlone(list, r), exact.has_value());
        if (!exact) continue;
        EXPECT_NEAR(floatFromBits(a[0]), exact->t, 1e-5 * (1 + exact->t));
        EXPECT_EQ(a[5], kNoHit);
        if (e[4] != a[4] || e[3] != a[3]) continue;
        EXPECT_NEAR(floatFromBits(a[1]), floatFromBits(e[1]), 2e-5);
        EXPECT_NEAR(floatFromBits(a[2]), floatFromBits(e[2]), 2e-5);
    }
    EXPECT_GT(met, 20000u);
    EXPECT_LE(differ, 6u);  // 1e-4 of the rays
}

/// Packets with dead lanes, which hold what is not even finite, against each ray alone in lane 0: the same bits.
TEST(FaceList, NeitherLaneNorNeighboursNorMaskMatter) {
    const Small scene = mixedScene();
    const std::unique_ptr<FaceList> list = FaceList::make(scene.geometry);
    const Accelerator accelerator(scene.geometry, IntersectionMode::Robust);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Random random(2);
    std::size_t met = 0;
    for (int round = 0; round < 4000; ++round) {
        const std::vector<Ray> rays = randomRays(random, 8);
        const unsigned live = random.bits() & 0xFFu;
        RayHitPacket p = emptyPacket();
        RayPacket shadow{};
        for (int i = 0; i < 8; ++i)
            for (RayPacket* to : {&p.ray, &shadow})
                put(*to, i, live >> i & 1u ? rays[i] : Ray{{nan, nan, 3e38f}, {0, nan, 0}, nan, nan});
        list->intersect(p, live);
        list->occluded(shadow, live);
        for (int i = 0; i < 8; ++i) {
            if (live >> i & 1u) {
                met += p.hit.geometry[i] != kNoHit;
                EXPECT_EQ(answerOf(p, i), alone(accelerator, rays[i]));
                EXPECT_EQ(shadow.far[i] < 0, p.hit.geometry[i] != kNoHit);
            } else {
                EXPECT_EQ(p.hit.geometry[i], kNoHit);
                EXPECT_EQ(floatBits(p.ray.far[i]), floatBits(nan));
                EXPECT_EQ(floatBits(shadow.far[i]), floatBits(nan));
            }
        }
    }
    EXPECT_GT(met, 4000u);
}

/// Rays from within closed shapes to their corners, edges and faces, aimed as exactly as floats can: none gets out.
TEST(FaceList, ClosedShapesAreTight) {
    struct Case {
        double scale, offset;
    };
    for (const Case c : {Case{1e-4, 0}, Case{1, 0}, Case{1e6, 0}, Case{1, 1e5}, Case{1e6, 1e5}})
        for (const bool isBox : {true, false}) {
            Small scene;
            const Matrix4 place = translation(c.offset, c.offset, c.offset) * scaling(c.scale, c.scale, c.scale);
            if (isBox) scene.box(place * rotation(33, 3, 1, 2));
            else scene.mesh(icosphere(0, c.scale, c.offset));
            scene.finish();
            const std::unique_ptr<FaceList> list = FaceList::make(scene.geometry);
            ASSERT_TRUE(list);
            const auto corner = [&](std::size_t i) {
                const float* p = &scene.geometry.positions[3 * std::size_t(scene.geometry.indices[i])];
                return Vec3d{p[0], p[1], p[2]};
            };
            Random random(3);
            std::size_t out = 0, rays = 0;
            for (std::size_t t = 0; t + 2 < scene.geometry.indices.size(); t += 3)
                for (int k = 0; k < 3000; ++k) {
                    const int aim = k % 3;
                    const double u = aim == 2 ? random() / 2 : 0, v = aim == 0 ? 0 : random() / 2;
                    const Vec3d q = corner(t) * (1 - u - v) + corner(t + 1) * v + corner(t + 2) * u;
                    RayHitPacket p = emptyPacket();
                    const Vec3<float> o = rounded(Vec3d{c.offset, c.offset, c.offset} + random.inCube(0.4 * c.scale));
                    put(p.ray, 0, {o, rounded(normalized(q - widened(o))), kInfinity, 0});
                    list->intersect(p, 1);
                    ++rays;
                    out += p.hit.geometry[0] == kNoHit;
                }
            EXPECT_GE(rays, 36000u);
            EXPECT_EQ(out, 0u) << (isBox ? "box" : "icosahedron") << " of scale " << c.scale << " at " << c.offset;
        }
}

}  // namespace
}  // namespace penumbra
