// Shapes with holes: what "alpha" of a shape means to rays. The closed forms of scenes/analytic/masks.cpp test the same by
// pictures.
#include "core/geometry/alpha_mask.h"
#include "core/statistics/hypothesis_tests.h"
#include "tests/geometry_fixture.h"
#include "tests/scenes_builder_fixture.h"
#include "tests/temporary_folder.h"

#include <cmath>

namespace penumbra {
namespace {

using namespace test;

const std::string kLight = "LightSource \"infinite\"\n";

std::string withAlpha(const std::string& alpha, const std::string& shapes) {
    return "AttributeBegin Attribute \"shape\" " + alpha + "\n" + shapes + " AttributeEnd\n";
}
std::string number(const std::string& alpha) {
    return "\"float alpha\" " + alpha;
}

struct TestRay {
    Vec3<float> origin, direction;
    float time;
};

/// Every kind of shape with the same alpha: mapped and plain meshes, a sphere, a disk; in the world, instanced, mirrored,
/// and moving.
std::string everything(const std::string& alpha) {
    const std::string shapes =
        "Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ] \"integer indices\" [ 0 1 2 0 2 3 ] "
        "\"point2 uv\" [ 0 0 1 0 1 1 0 1 ]\n"
        "AttributeBegin Translate 0 0 1.5 Rotate 20 1 1 0\nShape \"trianglemesh\" \"point3 P\" "
        "[ -1 -1 0  1 -1 0  1 1 0  -1 1 0.4 ] \"integer indices\" [ 0 1 2 0 2 3 ] AttributeEnd\n"
        "AttributeBegin Translate 0.3 0.2 -1.2 Rotate 50 1 0 1\nShape \"sphere\" \"float radius\" 0.8 \"float phimax\" 320 "
        "AttributeEnd\n"
        "AttributeBegin Translate -0.2 0 -2.4 Rotate 10 0 1 0\nShape \"disk\" \"float innerradius\" 0.2 AttributeEnd\n";
    return withAlpha(alpha, shapes + "ObjectBegin \"o\"\n" + shapes +
                                "ActiveTransform EndTime Rotate 40 0 0 1 ActiveTransform All\nTranslate 0 0 0.6 Shape \"disk\" \"float radius\" 1.4\n"
                                "ObjectEnd\n") +
           "AttributeBegin Translate 3 0 0 Scale 1 1 -1 ObjectInstance \"o\" AttributeEnd\n"
           "AttributeBegin ActiveTransform EndTime Translate 0.5 0.2 0 Rotate 30 0 1 0 ActiveTransform All "
           "Translate 0 3 0 Scale 1.2 0.8 1 ObjectInstance \"o\" AttributeEnd\n";
}

std::vector<TestRay> raysAtEverything(std::size_t count) {
    Random random(11);
    std::vector<TestRay> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3d from = Vec3d{1, 1, 0} + random.inCube(5), to = Vec3d{1.2, 1.2, 0} + random.inCube(2.2);
        const Vec3<float> o{float(from.x), float(from.y), float(from.z)}, t{float(to.x), float(to.y), float(to.z)};
        rays.push_back({o, normalize(t - o), float(random())});
    }
    return rays;
}

/// Up to eight rays in the lanes of a packet.
RayHitPacket packetOf(std::span<const TestRay> rays) {
    RayHitPacket p{};
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const TestRay& r = rays[i];
        p.ray.originX[i] = r.origin.x, p.ray.originY[i] = r.origin.y, p.ray.originZ[i] = r.origin.z;
        p.ray.directionX[i] = r.direction.x, p.ray.directionY[i] = r.direction.y, p.ray.directionZ[i] = r.direction.z;
        p.ray.far[i] = kInfinity;
        p.ray.time[i] = r.time;
        p.ray.mask[i] = kNoHit;
        p.hit.geometry[i] = p.hit.instance[i] = kNoHit;
    }
    return p;
}

struct Met {
    bool any;
    std::uint32_t t, geometry, primitive, instance;
    bool operator==(const Met&) const = default;
};
Met metBy(const RayHitPacket& p, int i) {
    if (p.hit.geometry[i] == kNoHit) return {};
    return {true, floatBits(p.ray.far[i]), p.hit.geometry[i], p.hit.primitive[i], p.hit.instance[i]};
}
Met alone(const Scene& scene, const TestRay& r, Coherence coherence = Coherence::Incoherent) {
    RayHitPacket p = packetOf({&r, 1});
    scene.accelerator.intersect(p, 1, coherence);
    return metBy(p, 0);
}
bool occluded(const Scene& scene, const TestRay& r, float far) {
    RayHitPacket p = packetOf({&r, 1});
    p.ray.far[0] = far;
    scene.accelerator.occluded(p.ray, 1);
    return p.ray.far[0] < 0;
}

TEST(Alpha, OneAndMoreAndNoneCostNothing) {
    for (const char* alpha : {"1", "1.5", "1e30"}) {
        const BuiltScene built = buildWorld(kLight + withAlpha(number(alpha), "Shape \"sphere\""));
        EXPECT_FALSE(built.scene.geometry.shapes.at(0).isMasked()) << alpha;
    }
    EXPECT_TRUE(buildWorld(kLight + withAlpha(number("0.999"), "Shape \"sphere\"")).scene.geometry.shapes.at(0).isMasked());
    // A constant texture is a number.
    const BuiltScene built =
        buildWorld("Texture \"c\" \"float\" \"constant\" \"float value\" 1\n" + kLight +
                   withAlpha("\"texture alpha\" \"c\"", "Shape \"sphere\""));
    EXPECT_FALSE(built.scene.geometry.shapes.at(0).isMasked());
}

TEST(Alpha, NothingIsLeftOfZeroAndLess) {
    for (const char* alpha : {"0", "-1", "-1e30"})
        EXPECT_TRUE(buildWorld(kLight + withAlpha(number(alpha), "Shape \"sphere\"")).scene.geometry.shapes.empty()) << alpha;
}

TEST(Alpha, ALightOfAlphaZeroIsThereForLightSamplingAlone) {
    const BuiltScene built = buildWorld("AreaLightSource \"diffuse\"\n" + withAlpha(number("0"), "Shape \"sphere\""));
    EXPECT_EQ(built.scene.lights.size(), 1u);
    EXPECT_TRUE(built.scene.lightMasks.empty());
    EXPECT_FALSE(trace(built.scene, {0, 0, 10}, {0, 0, -1}));
}

TEST(Alpha, NeedsAFloatTexture) {
    const std::string shape = withAlpha("\"texture alpha\" \"c\"", "Shape \"sphere\"");
    EXPECT_NE(errorOf("WorldBegin " + shape).find("unknown float texture 'c'"), std::string::npos);
    EXPECT_NE(errorOf("WorldBegin Texture \"c\" \"spectrum\" \"constant\"\n" + shape).find("needs a float texture"),
              std::string::npos);
}

/// Which of three sheets a ray meets first: with probability a, (1 - a) b, (1 - a)(1 - b) c; none with the rest.
/// False alarms: 1e-4 each.
void expectStackedSheets(const std::string& a, const std::string& b, const std::string& c, const std::array<double, 3>& alpha) {
    const BuiltScene built = buildWorld(kLight + withAlpha(number(std::to_string(alpha[0])), a) +
                                        withAlpha(number(std::to_string(alpha[1])), b) +
                                        withAlpha(number(std::to_string(alpha[2])), c));
    constexpr std::size_t kRays = 20000;
    Random random(5);
    std::vector<double> met(4, 0);
    std::size_t wrongShadows = 0;
    for (std::size_t i = 0; i < kRays; ++i) {
        const Vec3d from = random.inCube(0.5), to = random.inCube(0.5);
        const Vec3<float> o{float(from.x), float(from.y), 4}, t{float(to.x), float(to.y), -4};
        const TestRay ray{o, normalize(t - o), float(random())};
        const auto hit = trace(built.scene, ray.origin, ray.direction, ray.time);
        const std::size_t sheet = !hit ? 3 : hit->at.p.z > 1 ? 0 : hit->at.p.z > -1 ? 1 : 2;
        met[sheet] += 1;
        wrongShadows += occluded(built.scene, ray, kInfinity) != hit.has_value();
        if (hit) wrongShadows += occluded(built.scene, ray, hit->distance * 0.999f);
    }
    EXPECT_EQ(wrongShadows, 0u);
    const auto [first, second, third] = alpha;
    const std::vector<double> expected{kRays * first, kRays * (1 - first) * second, kRays * (1 - first) * (1 - second) * third,
                                       kRays * (1 - first) * (1 - second) * (1 - third)};
    EXPECT_GT(chiSquareTest(met, expected).pValue, 1e-4) << met[0] << " " << met[1] << " " << met[2] << " " << met[3];
}

const std::string kSquare =
    "Shape \"trianglemesh\" \"point3 P\" [ -9 -9 0  9 -9 0  9 9 0  -9 9 0 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n";

TEST(Alpha, StackedMeshesPassTheProduct) {
    expectStackedSheets("Translate 0 0 2 " + kSquare, kSquare, "Translate 0 0 -2 " + kSquare, {0.3, 0.6, 0.5});
}

TEST(Alpha, StackedQuadricsPassTheProduct) {
    expectStackedSheets("Translate 0 0 2 Shape \"disk\" \"float radius\" 9", "Translate 0 0 -10 Shape \"sphere\" \"float radius\" 10 \"float zmin\" 5",
                        "Translate 0 0 -2 Shape \"disk\" \"float radius\" 9", {0.45, 0.2, 0.7});
}

TEST(Alpha, BothSidesOfASphereAreSheets) {
    const BuiltScene built = buildWorld(kLight + withAlpha(number("0.3"), "Shape \"sphere\" \"float radius\" 2"));
    Random random(6);
    std::vector<double> met(3, 0);
    constexpr double kRays = 20000;
    for (int i = 0; i < kRays; ++i) {
        const Vec3d from = random.inCube(0.5);
        const auto hit = trace(built.scene, {float(from.x), float(from.y), 4}, {0, 0, -1});
        met[!hit ? 2 : hit->at.p.z > 0 ? 0 : 1] += 1;
    }
    EXPECT_GT(chiSquareTest(met, std::vector<double>{0.3 * kRays, 0.21 * kRays, 0.49 * kRays}).pValue, 1e-4);
}

TEST(Alpha, InstancesOfOneShapeAreIndependentSheets) {
    const std::string object = "ObjectBegin \"o\" " + kSquare + " ObjectEnd ";
    const BuiltScene built = buildWorld(kLight + withAlpha(number("0.5"), object) +
                                        "ObjectInstance \"o\" Translate 0 0 1 ObjectInstance \"o\" "
                                        "ActiveTransform EndTime Translate 0.5 0 0.5 ActiveTransform All Translate 0 0 1 "
                                        "ObjectInstance \"o\"");
    Random random(8);
    std::vector<double> met(4, 0);
    constexpr double kRays = 20000;
    for (int i = 0; i < kRays; ++i) {
        const Vec3d from = random.inCube(0.5);
        // Parallel rays, so that in every instance's own space they are much the same.
        const auto hit = trace(built.scene, {float(from.x), float(from.y), 4}, {0, 0, -1}, float(random()));
        met[!hit ? 3 : hit->at.p.z > 1.5f ? 0 : hit->at.p.z > 0.5f ? 1 : 2] += 1;
    }
    EXPECT_GT(chiSquareTest(met, std::vector<double>{0.5 * kRays, 0.25 * kRays, 0.125 * kRays, 0.125 * kRays}).pValue, 1e-4);
}

/// The choice is a function of the ray alone: not of its lane, its neighbours, the hint of coherence, or the moment.
TEST(Alpha, ARayDecidesForItself) {
    const std::string checker =
        "Texture \"holes\" \"float\" \"checkerboard\" \"float uscale\" 3 \"float vscale\" 5 \"float tex1\" 0.3 \"float tex2\" 0.8\n";
    for (const std::string& world : {everything(number("0.4")), checker + everything("\"texture alpha\" \"holes\"")}) {
        const BuiltScene built = buildWorld(kLight + world);
        const std::vector<TestRay> rays = raysAtEverything(4000);
        std::size_t differ = 0, met = 0, passed = 0;
        Random random(9);
        for (std::size_t i = 0; i + 8 <= rays.size(); i += 8) {
            for (const Coherence coherence : {Coherence::Incoherent, Coherence::Coherent}) {
                const unsigned live = (random.bits() & 0xFFu) | 1u;
                RayHitPacket p = packetOf(std::span(rays).subspan(i, 8));
                built.scene.accelerator.intersect(p, live, coherence);
                for (int k = 0; k < 8; ++k) {
                    if (!(live >> k & 1u)) continue;
                    const TestRay& ray = rays[i + std::size_t(k)];
                    differ += metBy(p, k) != alone(built.scene, ray, coherence);
                    met += metBy(p, k).any;
                    passed += metBy(p, k).any != occluded(built.scene, ray, kInfinity);
                }
            }
        }
        EXPECT_EQ(differ, 0u);
        EXPECT_EQ(passed, 0u);
        EXPECT_GT(met, 800u);
    }
}

/// A scene that is moved takes its masks along.
TEST(Alpha, SurvivesAMoveOfTheScene) {
    BuiltScene built = buildWorld(
        "Texture \"holes\" \"float\" \"checkerboard\" \"float uscale\" 3 \"float vscale\" 5 \"float tex1\" 0 \"float tex2\" 1\n" +
        kLight + everything("\"texture alpha\" \"holes\""));
    const std::vector<TestRay> rays = raysAtEverything(300);
    std::vector<Met> before;
    for (const TestRay& r : rays)
        before.push_back(alone(built.scene, r));
    const Scene moved = std::move(built.scene);
    for (std::size_t i = 0; i < rays.size(); ++i)
        EXPECT_EQ(alone(moved, rays[i]) == before[i], true);
}

/// Compares with a search in double that goes on from hole to hole. `squares` gives the coordinates of a hit on a checkerboard,
/// in squares.
template <class Squares>
void expectCuts(const std::string& mapping, const Squares& squares) {
    const BuiltScene built =
        buildWorld("Texture \"holes\" \"float\" \"checkerboard\" \"float tex1\" 0 \"float tex2\" 1 " + mapping + "\n" + kLight +
                   everything("\"texture alpha\" \"holes\""));
    const ExactSearch search(built.scene.geometry);
    std::size_t compared = 0, cut = 0, wrong = 0;
    for (const TestRay& r : raysAtEverything(4000)) {
        const Vec3d o{r.origin.x, r.origin.y, r.origin.z}, d{r.direction.x, r.direction.y, r.direction.z};
        double start = 0, margin = 1;
        std::optional<ExactHit> hit;
        while ((hit = search.search(o + d * start, d, 1e30, r.time))) {
            const auto [x, y] = squares(*hit);
            margin = std::min({margin, std::abs(x - std::round(x)), std::abs(y - std::round(y))});
            if ((int(std::floor(x)) + int(std::floor(y))) % 2 != 0) break;
            ++cut;
            start += hit->t + 1e-7;
        }
        if (margin < 1e-3) continue;   // too near to a border of squares for float and double to agree
        ++compared;
        const Met met = alone(built.scene, r);
        if (!hit) wrong += met.any;
        else wrong += !met.any || std::abs(floatFromBits(met.t) - (start + hit->t)) > 1e-3;
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(compared, 3000u);
    EXPECT_GT(cut, 800u);
}

TEST(Alpha, TexturesCutByUv) {
    expectCuts("\"float uscale\" 3 \"float vscale\" 5", [](const ExactHit& hit) { return std::pair(3 * hit.u, 5 * hit.v); });
}

/// Where the surface is in the world says what is cut, of instances and of moving ones too.
TEST(Alpha, TexturesCutByPlace) {
    expectCuts("\"string mapping\" \"planar\" \"vector3 v1\" [ 2 0 1 ] \"vector3 v2\" [ 0 3 0.5 ] \"float udelta\" 0.1",
               [](const ExactHit& hit) { return std::pair(2 * hit.p.x + hit.p.z + 0.1, 3 * hit.p.y + 0.5 * hit.p.z); });
}

/// Of an image with an alpha channel, a float texture is that channel.
TEST(Alpha, OfAnImageIsItsAlphaChannel) {
    const BuiltScene built = buildWorld("Texture \"leaf\" \"float\" \"imagemap\" \"string filename\" \"leaf.png\"\n" + kLight +
                                            withAlpha("\"texture alpha\" \"leaf\"",
                                                      "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  1 1 0  0 1 0 ] "
                                                      "\"integer indices\" [ 0 1 2 0 2 3 ] \"point2 uv\" [ 0 0 1 0 1 1 0 1 ]"),
                                        PENUMBRA_SOURCE_DIR "/scenes/gallery/assets");
    EXPECT_TRUE(trace(built.scene, {0.47f, 0.4f, 1}, {0, 0, -1}));
    EXPECT_TRUE(trace(built.scene, {0.5f, 0.05f, 1}, {0, 0, -1}));
    EXPECT_FALSE(trace(built.scene, {0.1f, 0.05f, 1}, {0, 0, -1}));
    EXPECT_FALSE(trace(built.scene, {0.9f, 0.95f, 1}, {0, 0, -1}));
}

}  // namespace
}  // namespace penumbra
