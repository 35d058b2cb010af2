// Bilinear patches in scenes: what rays meet of them, against the patch in double; the lights they are; holes, motion,
// and what is wrong with those that are none.
#include "core/geometry/patches.h"
#include "tests/geometry_fixture.h"
#include "tests/scenes_builder_fixture.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>

#include <numbers>

namespace penumbra {
namespace {

using namespace test;

const std::string kLight = "LightSource \"infinite\"\n";
const std::string kArea = "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3]\n";
/// Something looks at uv, but its value is one everywhere.
const std::string kLooksAtUv =
    "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [.5 .5 .5] \"rgb tex2\" [.5 .5 .5]\n"
    "Material \"diffuse\" \"texture reflectance\" \"t\"\n";

using Corners = std::array<Vec3d, 4>;
const Corners kSaddle{{{-1, -1, -.5}, {1, -1, .5}, {-1, 1, .5}, {1, 1, -.5}}};

std::string pointsOf(const Corners& c) {
    std::string text = "\"point3 P\" [";
    for (const Vec3d& p : c)
        text += fmt::format(" {} {} {}", p.x, p.y, p.z);
    return text + "]";
}
std::string patch(const Corners& c, const std::string& more = "") {
    return "Shape \"bilinearmesh\" " + pointsOf(c) + " " + more + "\n";
}
Vec3d bilinear(const Corners& c, double u, double v) {
    return c[0] * ((1 - u) * (1 - v)) + c[1] * (u * (1 - v)) + c[2] * ((1 - u) * v) + c[3] * (u * v);
}
Vec3d normalOf(const Corners& c, double u, double v) {
    return normalized(cross((c[1] - c[0]) * (1 - v) + (c[3] - c[2]) * v, (c[2] - c[0]) * (1 - u) + (c[3] - c[1]) * u));
}

struct PlaceCase {
    const char* name;
    std::string before, after;  ///< of the Shape directive
    Matrix4 place;              ///< at time 0.5
    double side;                ///< of the normal, against the one of the object
};

class PlacedPatch : public testing::TestWithParam<PlaceCase> {};

TEST_P(PlacedPatch, IsMetWhereItIsWithItsNormalAndUv) {
    const PlaceCase& place = GetParam();
    const BuiltScene built = buildWorld(kLight + kLooksAtUv + place.before + patch(kSaddle) + place.after);
    ASSERT_TRUE(built.warnings.all().empty());
    Matrix4 inverse;
    ASSERT_TRUE(invert(place.place, inverse));
    Corners corners;
    for (std::size_t i = 0; i < 4; ++i)
        corners[i] = transformPoint(place.place, kSaddle[i]);
    double size = 0;
    for (const auto& [a, b] : {std::pair(0, 1), {2, 3}, {0, 2}, {1, 3}})
        size = std::max(size, length(corners[std::size_t(a)] - corners[std::size_t(b)]));
    const double bound = kDiceTolerance * size + 1e-5;
    Random random(3);
    for (int i = 0; i < 500; ++i) {
        // A saddle over its plane, so that the ray meets nothing else.
        const double u = random(), v = random();
        const Vec3d target = bilinear(corners, u, v), normal = normalOf(corners, u, v);
        const Vec3d away = normalized(normal + random.inCube(0.3)) * (i % 2 ? 5. : -5.);
        const auto hit = trace(built.scene, rounded(target + away), rounded(normalized(away) * -1.), 0.5f);
        ASSERT_TRUE(hit);
        const SurfacePoint<float>& at = hit->at;
        EXPECT_LE(length(bilinear(corners, at.uv.x, at.uv.y) - widened(at.p)), bound);
        EXPECT_LE(length(widened(at.p) - target), 4 * bound);
        Vec3d expected = normalOf(kSaddle, at.uv.x, at.uv.y);
        expected = normalized(transformVector(transpose(inverse), expected)) * place.side;
        EXPECT_LE(length(widened(at.frame.n) - expected), 1e-4);
        EXPECT_GT(dot(widened(at.ng), expected), 0.99);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Everywhere, PlacedPatch,
    testing::Values(
        PlaceCase{"World", "", "", {}, 1}, PlaceCase{"Reversed", "ReverseOrientation\n", "", {}, -1},
        PlaceCase{"Stretched", "Translate 1 2 3 Scale 2 1 .5\n", "", translation(1, 2, 3) * scaling(2, 1, .5), 1},
        PlaceCase{"Mirrored", "Scale 1 -1 1\n", "", scaling(1, -1, 1), 1},
        PlaceCase{"MirroredReversed", "Scale 1 -1 1 ReverseOrientation\n", "", scaling(1, -1, 1), -1},
        PlaceCase{"Instance", "ObjectBegin \"o\"\n", "ObjectEnd Translate 1 0 0 Scale 2 2 -2 ObjectInstance \"o\"\n",
                  translation(1, 0, 0) * scaling(2, 2, -2), 1},
        PlaceCase{"Moving", "ActiveTransform EndTime Translate 2 0 1 ActiveTransform All\n", "",
                  translation(1, 0, .5), 1}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(BilinearMeshes, DoNotLeakAlongTheirEdges) {
    // A cube with its corners moved about, seen from within: rays at its edges, and any others. (Not rays that are aimed
    // at a vertex to the last bit: of any fine mesh, Embree lets one in a thousand of those through.)
    Random random(9);
    Vec3d corner[8];
    for (int i = 0; i < 8; ++i)
        corner[i] = Vec3d{double(i & 1), double(i >> 1 & 1), double(i >> 2)} + random.inCube(0.25);
    std::string points;
    for (const Vec3d& p : corner)
        points += fmt::format(" {} {} {}", float(p.x), float(p.y), float(p.z));
    const BuiltScene built =
        buildWorld(kLight + "Shape \"bilinearmesh\" \"point3 P\" [" + points +
                   "] \"integer indices\" [ 0 1 2 3  6 7 4 5  1 0 5 4  2 3 6 7  0 2 4 6  7 3 5 1 ]\n");
    const auto at = [&](const Vec3d& target) {
        const Vec3d from = Vec3d{.5, .5, .5} + random.inCube(0.1);
        return trace(built.scene, rounded(from), rounded(normalized(target - from)));
    };
    constexpr int kEdges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                                   {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
    for (int i = 0; i < 60000; ++i) {
        const auto& edge = kEdges[random.bits() % 12];
        const double t = random();
        ASSERT_TRUE(at(corner[edge[0]] * (1 - t) + corner[edge[1]] * t)) << i;
        ASSERT_TRUE(at(Vec3d{.5, .5, .5} + random.inCube(1))) << i;
    }
}

TEST(BilinearMeshes, AreOneLightWhereTheyAreARectangle) {
    const Corners rectangle{{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {2, 3, 0}}};
    for (const std::string& material : {std::string(), kLooksAtUv}) {
        const BuiltScene built = buildWorld(kArea + material + patch(rectangle));
        ASSERT_EQ(built.scene.lights.rows<RectangleLight>().size(), 1u);
        EXPECT_FLOAT_EQ(built.scene.lights.rows<RectangleLight>()[0].width *
                            built.scene.lights.rows<RectangleLight>()[0].height,
                        6);
        EXPECT_EQ(built.scene.lights.size(), 1u);
    }
    const BuiltScene curved = buildWorld(kArea + patch(kSaddle));
    EXPECT_EQ(curved.scene.lights.size(), curved.scene.geometry.shapes[0].count);
    EXPECT_GT(curved.scene.lights.size(), 100u);
    EXPECT_EQ(curved.scene.lights.rows<TriangleLight>().size(), curved.scene.lights.size());
}

TEST(BilinearMeshes, ShineWithTheirPowerOnce) {
    const auto power = [](const std::string& shape, const std::string& folder = ".") {
        const BuiltScene built = buildWorld("AreaLightSource \"diffuse\" \"float power\" 12\n" + shape, folder);
        double sum = 0;
        for (std::uint32_t i = 0; i < built.scene.lights.size(); ++i)
            sum += built.scene.lights.power(i);
        return sum;
    };
    const Corners rectangle{{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {2, 3, 0}}};
    EXPECT_NEAR(power(patch(rectangle)), 12, 1e-4);
    EXPECT_NEAR(power(patch(kSaddle)), 12, 1e-3);
    EXPECT_NEAR(power("Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0 2 0 1 2 1 3] "
                      "\"integer indices\" [0 1 2 3 1 4 3 5]\n"),
                24, 2e-3);
    // So do the quads of a file, which are patches; triangles each have it.
    const TemporaryFolder folder;
    folder.file("m.ply",
                "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
                "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
                "0 0 0 1 0 0 1 1 0 0 1 0 2 0 0\n4 0 1 2 3\n3 1 4 2\n");
    EXPECT_NEAR(power("Shape \"plymesh\" \"string filename\" \"m.ply\"\n", folder.path("")), 24, 1e-3);
    EXPECT_NEAR(power("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0] \"integer indices\" "
                      "[0 1 2 0 2 3] \"integer faceIndices\" [0 0]\n"),
                24, 1e-3);
}

TEST(BilinearMeshes, ShowThePictureOfTheirLight) {
    // Radiance u, v over the patch: a picture of 64 x 64 pixels, the bottom row first.
    std::string picture = "PF\n64 64\n-1.0\n";
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (const float c : {(float(x) + .5f) / 64, (float(y) + .5f) / 64, 0.f})
                picture.append(reinterpret_cast<const char*>(&c), sizeof c);
    const TemporaryFolder folder;
    folder.file("uv.pfm", picture);
    const std::string lamp = "AreaLightSource \"diffuse\" \"string filename\" \"uv.pfm\" \"bool twosided\" true\n";
    const Corners trapezium{{{-2, -1, 0}, {2, -1, 0}, {-.5, 1, 0}, {.5, 1, 0}}};
    for (const Corners& c : {kSaddle, trapezium}) {
        // An image for sampling is none for looking.
        const BuiltScene built =
            buildWorld(lamp + patch(c, "\"string emissionfilename\" \"none.exr\""), folder.path(""));
        ASSERT_TRUE(built.warnings.all().empty());
        const Scene& scene = built.scene;
        Random random(4);
        for (int i = 0; i < 300; ++i) {
            const double u = 0.02 + 0.96 * random(), v = 0.02 + 0.96 * random();
            const Vec3d from = bilinear(c, u, v) + normalOf(c, u, v) * 3.;
            const Vec3<float> w = rounded(normalOf(c, u, v) * -1.);
            const auto hit = trace(scene, rounded(from), w);
            ASSERT_TRUE(hit);
            const ShapeRecord& shape = scene.geometry.shapes[0];
            const std::uint32_t light = shape.light + shape.lightStride * hit->at.primitive;
            const auto met = evaluateLight<float>(scene.lights, light, {rounded(from), hit->at.p, w});
            EXPECT_NEAR(met.L.r, u, 0.005);
            EXPECT_NEAR(met.L.g, v, 0.005);
        }
    }
}

TEST(BilinearMeshes, HaveHolesByTheirUv) {
    // Alpha is 0 where u is below a half.
    const BuiltScene built =
        buildWorld(kLight +
                   "Texture \"a\" \"float\" \"bilerp\" \"float v00\" -500 \"float v01\" -500 \"float v10\" 501 "
                   "\"float v11\" 501\n" +
                   patch(kSaddle, "\"texture alpha\" \"a\""));
    Random random(6);
    for (int i = 0; i < 300; ++i) {
        const double u = random(), v = random();
        if (std::abs(u - 0.5) < 0.01) continue;
        const Vec3d n = normalOf(kSaddle, u, v);
        EXPECT_EQ(bool(trace(built.scene, rounded(bilinear(kSaddle, u, v) + n), rounded(n * -1.))), u > 0.5);
    }
}

TEST(BilinearMeshes, AreFactsAsTheFileHasThem) {
    BuildOptions options;
    std::vector<MeshFacts> facts;
    options.meshFacts = &facts;
    buildText("WorldBegin\n" + kLight + patch(kSaddle), options);
    ASSERT_EQ(facts.size(), 1u);
    EXPECT_EQ(facts[0].topology.triangles, 2u);
    EXPECT_EQ(facts[0].topology.borders, 1u);
}

TEST(BilinearMeshes, SayWhatIsWrongWithThem) {
    const auto error = [](const std::string& parameters) {
        return errorOf("WorldBegin\n" + kLight + "Shape \"bilinearmesh\" " + parameters);
    };
    const std::string four = pointsOf(kSaddle), place = "test.pbrt:3:1: shape 'bilinearmesh': ";
    EXPECT_EQ(error(""), place + "\"indices\" are missing, 4 a patch; they may be only with 4 points");
    EXPECT_EQ(error("\"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]"),
              place + "\"indices\" are missing, 4 a patch; they may be only with 4 points");
    EXPECT_EQ(error(four + " \"integer indices\" [0 1 2 4]"), place + "\"indices\"[3] is 4, but there are 4 points");
    EXPECT_EQ(error(four + " \"integer indices\" [0 1 -2 3]"), place + "\"indices\"[2] is -2, but there are 4 points");
    EXPECT_EQ(error(four + " \"integer indices\" [0 1 2 3]"), "");
    const BuiltScene surplus = buildWorld(kLight + patch(kSaddle, "\"integer indices\" [0 1 2 3 0 1] \"point2 uv\" [0 0]"));
    EXPECT_TRUE(surplus.warnsOf("the last 2 are ignored"));
    EXPECT_TRUE(surplus.warnsOf("\"uv\" has 2 numbers where 8 were expected; ignored"));
    const BuiltScene nothing = buildWorld(kLight + "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 0 0 0 0 0 0 0 0 0]");
    EXPECT_TRUE(nothing.warnsOf("no triangle is left of the mesh"));
}

TEST(BilinearMeshes, TakeALimitedRoomHoweverMany) {
    // Each would have 3000 triangles.
    std::string world = kLight, bent = patch({{{0, 0, 0}, {1, 0, 1}, {1, 0, 1}, {0, 0, 0}}});
    for (int i = 0; i < 4000; ++i)
        world += bent;
    const BuiltScene built = buildWorld(world);
    EXPECT_LE(built.scene.facts.triangles, (std::size_t(1) << 23) + 8000);
}

}  // namespace
}  // namespace penumbra
