// Light sources and area lights.
#include "tests/scenes_builder_fixture.h"
#include "tests/temporary_folder.h"

#include <bit>
#include <cstring>
#include <numbers>

namespace penumbra {
namespace {

const std::string kRectangle =
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0  2 0 0  2 3 0  0 3 0] \"integer indices\" [0 1 2 0 2 3]\n";
const std::string kTwoTriangles =
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0  2 0 0  3 3 0  0 3 0] \"integer indices\" [0 1 2 0 2 3]\n";
const std::string kArea = "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3]\n";

template <class T>
T onlyLight(const BuiltScene& built) {
    EXPECT_EQ(built.scene.lights.size(), 1u);
    const auto rows = built.scene.lights.rows<T>();
    EXPECT_EQ(rows.size(), 1u) << "it is of another type";
    return rows.empty() ? T{} : rows[0];
}

/// A PFM picture of one colour.
std::string pfm(int width, int height, Rgb c) {
    std::string bytes = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
    for (int i = 0; i < width * height; ++i)
        for (const float v : {c.r, c.g, c.b})
            bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
    return bytes;
}

/// Whether light 0 is seen by light sampling from a point.
bool shinesTo(const Scene& scene, Vec3<float> p) {
    return sampleLight<float>(scene.lights, 0u, p, {0.4f, 0.6f}).valid;
}

TEST(AreaLights, TwoTrianglesThatMakeARectangleAreOneLight) {
    const BuiltScene built = buildWorld(kArea + kRectangle);
    const auto light = onlyLight<RectangleLight>(built);
    EXPECT_FLOAT_EQ(light.width * light.height, 6);
    EXPECT_EQ(light.radiance.b, 3);
    const ShapeRecord& shape = built.scene.geometry.shapes[0];
    EXPECT_EQ(shape.light, 0u);
    EXPECT_EQ(shape.lightStride, 0u);
    EXPECT_TRUE(built.warnings.all().empty());
}

TEST(AreaLights, OtherMeshesHaveALightForEachTriangle) {
    const BuiltScene built = buildWorld("LightSource \"point\"\n" + kArea + kTwoTriangles + kTwoTriangles);
    EXPECT_EQ(built.scene.lights.rows<TriangleLight>().size(), 4u);
    const ShapeRecord& second = built.scene.geometry.shapes[1];
    EXPECT_EQ(second.lightStride, 1u);
    EXPECT_TRUE(built.scene.lights.isA<TriangleLight>(second.light + 1));
}

struct SideCase {
    const char* name;
    std::string world;
    bool above, below;
};
class AreaLightSide : public testing::TestWithParam<SideCase> {};

/// Light sampling and the geometric normal of hits agree on the side that emits.
TEST_P(AreaLightSide, IsTheSideOfTheNormal) {
    const BuiltScene built = buildWorld(GetParam().world);
    const Vec3<float> above{0.3f, 0.5f, 8}, below{0.3f, 0.5f, -8};
    EXPECT_EQ(shinesTo(built.scene, above), GetParam().above);
    EXPECT_EQ(shinesTo(built.scene, below), GetParam().below);
    if (GetParam().above == GetParam().below) return;
    const auto hit = trace(built.scene, above, {0, 0, -1});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->at.ng.z > 0, GetParam().above);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, AreaLightSide,
    testing::Values(
        SideCase{"Rectangle", kArea + kRectangle, true, false},
        SideCase{"RectangleReversed", kArea + "ReverseOrientation " + kRectangle, false, true},
        SideCase{"RectangleMirrored", kArea + "Scale 1 1 -1 " + kRectangle, false, true},
        SideCase{"TwoSided", "AreaLightSource \"diffuse\" \"bool twosided\" true " + kRectangle, true, true},
        SideCase{"Triangles", kArea + kTwoTriangles, true, false},
        SideCase{"TrianglesReversed", kArea + "ReverseOrientation " + kTwoTriangles, false, true},
        SideCase{"NormalsWin",
                 kArea + "Shape \"trianglemesh\" \"point3 P\" [0 0 0 4 0 0 0 4 0] \"normal N\" [0 0 -1 0 0 -1 0 0 -1]",
                 false, true},
        SideCase{"Disk", kArea + "Shape \"disk\" \"float radius\" 2", true, false},
        SideCase{"DiskReversed", kArea + "ReverseOrientation Shape \"disk\" \"float radius\" 2", false, true},
        SideCase{"DiskMirrored", kArea + "Scale -1 1 1 Shape \"disk\" \"float radius\" 2", false, true},
        SideCase{"DiskTurned", kArea + "Rotate 180 0 1 0 Shape \"disk\" \"float radius\" 2", false, true},
        SideCase{"Sphere", kArea + "Shape \"sphere\" \"float radius\" 2", true, true},
        SideCase{"SphereReversed", kArea + "ReverseOrientation Shape \"sphere\" \"float radius\" 2", false, false},
        SideCase{"SphereMirrored", kArea + "Scale 1 -1 1 Shape \"sphere\" \"float radius\" 2", false, false}),
    [](const auto& info) { return info.param.name; });

TEST(AreaLights, PowerIsThatOfEachPrimitive) {
    const float pi = std::numbers::pi_v<float>;
    const auto radiance = [](const std::string& light, const std::string& shape) {
        const BuiltScene built = buildWorld("AreaLightSource \"diffuse\" " + light + "\n" + shape);
        const auto s = sampleLight<float>(built.scene.lights, 0u, {0.3f, 0.5f, 8}, {0.4f, 0.6f});
        return s.L.r;
    };
    // The two triangles of the rectangle have an area of 3 each.
    EXPECT_FLOAT_EQ(radiance("\"float power\" 12", kRectangle), 12 / (pi * 3));
    EXPECT_FLOAT_EQ(radiance("\"float power\" 12 \"bool twosided\" true", kRectangle), 12 / (2 * pi * 3));
    EXPECT_FLOAT_EQ(radiance("\"float power\" 12 \"float scale\" 2", kRectangle), 24 / (pi * 3));
    EXPECT_FLOAT_EQ(radiance("\"float power\" 12 \"rgb L\" [5 5 5]", kRectangle), 60 / (pi * 3));
    EXPECT_FLOAT_EQ(radiance("\"float power\" -1 \"rgb L\" [5 5 5]", kRectangle), 5);
    // Of quadrics the area in object space counts.
    EXPECT_FLOAT_EQ(radiance("\"float power\" 12", "Scale 3 3 3 Shape \"sphere\" \"float radius\" 2"),
                    12 / (pi * 16 * pi));
    EXPECT_FLOAT_EQ(radiance("\"float power\" 12", "Shape \"disk\" \"float radius\" 2 \"float innerradius\" 1"),
                    12 / (pi * 3 * pi));
}

TEST(AreaLights, PicturesAreTheirRadiance) {
    const TemporaryFolder folder;
    folder.file("grey.pfm", pfm(4, 4, {1, 2, 3}));
    const auto built = [&](const std::string& parameters, const std::string& shape) {
        return buildWorld("AreaLightSource \"diffuse\" \"string filename\" \"grey.pfm\" " + parameters + "\n" + shape,
                          folder.path(""));
    };
    const auto radiance = [&](const std::string& parameters, const std::string& shape) {
        return sampleLight<float>(built(parameters, shape).scene.lights, 0u, {0.3f, 0.5f, 8}, {0.4f, 0.6f}).L;
    };
    const std::string uv = kRectangle.substr(0, kRectangle.size() - 1) + " \"point2 uv\" [0 0 1 0 1 1 0 1]\n";
    for (const std::string& shape : {uv, kRectangle, kTwoTriangles, std::string("Shape \"sphere\" \"float radius\" 2"),
                                     std::string("Shape \"disk\" \"float radius\" 2")}) {
        EXPECT_NEAR(radiance("\"float scale\" 3", shape).b, 9, 1e-5) << shape;
        EXPECT_TRUE(built("", shape).warnings.all().empty());
    }
    // The power is that of the luminance.
    const float luminance = 0.2126f * 1 + 0.7152f * 2 + 0.0722f * 3, pi = std::numbers::pi_v<float>;
    EXPECT_NEAR(radiance("\"float power\" 12", kRectangle).r, 12 / (pi * 3 * luminance), 1e-4);

    // One light where the two triangles show one picture; without uv each shows its own.
    EXPECT_EQ(built("", uv).scene.lights.size(), 1u);
    EXPECT_EQ(built("", kRectangle).scene.lights.size(), 2u);

    folder.file("black.pfm", pfm(2, 2, {0, 0, 0}));
    EXPECT_TRUE(buildWorld("AreaLightSource \"diffuse\" \"string filename\" \"black.pfm\" " + uv, folder.path(""))
                    .scene.lights.empty());
    EXPECT_NE(errorOf("WorldBegin AreaLightSource \"diffuse\" \"string filename\" \"grey.pfm\" \"rgb L\" [1 1 1] " + uv,
                      {}, folder.path(""))
                  .find("not both"),
              std::string::npos);
}

TEST(AreaLights, AlphaZeroIsSeenByNoRayButShines) {
    const BuiltScene built = buildWorld(kArea + "Shape \"disk\" \"float alpha\" 0");
    EXPECT_FALSE(trace(built.scene, {0, 0, 5}, {0, 0, -1}));
    const auto sample = sampleLight<float>(built.scene.lights, 0u, {0, 0, 5}, {0.4f, 0.6f});
    EXPECT_TRUE(sample.valid);
    EXPECT_TRUE(sample.delta) << "no other strategy finds it";
    EXPECT_TRUE(built.warnings.all().empty());
}

TEST(AreaLights, AlphaWithoutALightLeavesTheShapeOut) {
    const BuiltScene gone = buildWorld("LightSource \"point\" Shape \"disk\" \"float alpha\" 0");
    EXPECT_TRUE(gone.scene.geometry.shapes.empty());
    const BuiltScene half = buildWorld("LightSource \"point\" Shape \"disk\" \"float alpha\" 0.5");
    EXPECT_TRUE(half.warnings.all().empty());
    EXPECT_EQ(half.scene.geometry.shapes.size(), 1u);
}

TEST(AreaLights, AreDroppedWhereTheyCannotBe) {
    const BuiltScene interface = buildWorld(kArea + "Material \"interface\" " + kRectangle);
    EXPECT_TRUE(interface.scene.lights.empty());
    EXPECT_TRUE(interface.warnsOf("interface material cannot be an area light"));

    const BuiltScene moving =
        buildWorld(kArea + "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All " + kRectangle);
    EXPECT_TRUE(moving.scene.lights.empty());
    EXPECT_TRUE(moving.warnsOf("cannot be area lights"));

    const BuiltScene object = buildWorld("ObjectBegin \"o\" " + kArea + kRectangle + "ObjectEnd ObjectInstance \"o\"");
    EXPECT_TRUE(object.scene.lights.empty());
    EXPECT_TRUE(object.warnsOf("cannot be area lights"));
    EXPECT_TRUE(object.warnsOf("the scene has no lights"));

    EXPECT_TRUE(buildWorld("AreaLightSource \"diffuse\" \"rgb L\" [0 0 0] " + kRectangle).scene.lights.empty());
}

TEST(LightSources, SpectraBecomeLightOfLuminanceOne) {
    const auto intensity = [](const std::string& parameters) {
        const Spectrum<float> i = onlyLight<PointLight>(buildWorld("LightSource \"point\" " + parameters)).intensity;
        return Rgb{i.r, i.g, i.b};
    };
    EXPECT_EQ(intensity(""), (Rgb{1, 1, 1}));
    EXPECT_EQ(intensity("\"rgb I\" [1 2 3] \"float scale\" 10"), (Rgb{10, 20, 30}));
    const Rgb warm = intensity("\"blackbody I\" 3000");
    EXPECT_NEAR(warm.r, 1.77064, 2e-3);
    EXPECT_NEAR(warm.g, 0.84428, 2e-3);
    EXPECT_NEAR(warm.b, 0.27214, 2e-3);
    const Rgb flat = intensity("\"spectrum I\" [300 5 900 5]");
    EXPECT_NEAR(flat.r, 1.20488, 2e-3);
    EXPECT_NEAR(flat.b, 0.90920, 2e-3);
    EXPECT_NEAR(intensity("\"float power\" 8").r, 8 / (4 * std::numbers::pi), 1e-6);
}

TEST(LightSources, PointAndDistantFollowTheirMatrix) {
    const auto point =
        onlyLight<PointLight>(buildWorld("Translate 1 2 3 Scale 2 2 2 LightSource \"point\" \"point3 from\" [1 0 0]"));
    EXPECT_FLOAT_EQ(point.position.x, 3);
    EXPECT_FLOAT_EQ(point.position.z, 3);
    const auto sun =
        onlyLight<DistantLight>(buildWorld("Rotate 90 1 0 0 LightSource \"distant\" \"point3 from\" [0 5 0] \"point3 "
                                           "to\" [0 1 0] \"float illuminance\" 7 \"rgb L\" [1 2 3]"));
    EXPECT_NEAR(sun.toLight.x, 0, 1e-6);
    EXPECT_NEAR(sun.toLight.y, 0, 1e-6);
    EXPECT_NEAR(sun.toLight.z, 1, 1e-6);  // Rotate 90 1 0 0 takes +y to +z
    EXPECT_FLOAT_EQ(sun.irradiance.g, 14);
    const auto plain = onlyLight<DistantLight>(buildWorld("LightSource \"distant\""));
    EXPECT_FLOAT_EQ(plain.toLight.z, -1);
}

TEST(LightSources, ConstantInfiniteLight) {
    const auto sky = onlyLight<ConstantInfiniteLight>(
        buildWorld("LightSource \"infinite\" \"rgb L\" [1 2 3] \"float illuminance\" 2"));
    EXPECT_FLOAT_EQ(sky.radiance.g, 4 / std::numbers::pi_v<float>);
    EXPECT_EQ(buildWorld("LightSource \"infinite\"").scene.lights.infiniteIds().size(), 1u);
}

TEST(LightSources, ImageInfiniteLight) {
    const TemporaryFolder folder;
    folder.file("sky.pfm", pfm(32, 32, {1, 2, 3}));
    folder.file("wide.pfm", pfm(32, 17, {1, 2, 3}));
    const auto radiance = [&](const std::string& parameters) {
        const BuiltScene built =
            buildWorld("LightSource \"infinite\" \"string filename\" \"sky.pfm\" " + parameters, folder.path(""));
        return evaluateLight<float>(built.scene.lights, 0u, {{}, {}, {0, 0.6f, 0.8f}}).L;
    };
    EXPECT_FLOAT_EQ(radiance("").b, 3);
    EXPECT_FLOAT_EQ(radiance("\"float scale\" 2").g, 4);
    // The format's illuminance of images is twice the true one: radiance L of luminance Y becomes L E / (pi Y / 2).
    const float luminance = 0.2126f * 1 + 0.7152f * 2 + 0.0722f * 3;
    EXPECT_NEAR(radiance("\"float illuminance\" 1").r, 2 / (std::numbers::pi_v<float> * luminance), 5e-3);

    const auto error = [&](const std::string& light) {
        return errorOf("WorldBegin\n LightSource \"infinite\" " + light, {}, folder.path(""));
    };
    const std::string wide = error("\"string filename\" \"wide.pfm\"");
    EXPECT_EQ(wide.rfind("test.pbrt:2:2: light 'infinite': the image ", 0), 0u) << wide;
    EXPECT_NE(wide.find("32 x 17"), std::string::npos) << wide;
    EXPECT_NE(error("\"string filename\" \"sky.pfm\" \"rgb L\" [1 1 1]").find("not both"), std::string::npos);
    EXPECT_NE(error("\"string filename\" \"no.exr\"").find("no.exr"), std::string::npos);
}

TEST(LightSources, SkiesByLatitude) {
    const TemporaryFolder folder;
    folder.file("sky.pfm", pfm(64, 32, {1, 2, 3}));
    folder.file("odd.pfm", pfm(40, 32, {1, 2, 3}));
    const auto build = [&](const std::string& parameters) {
        return buildWorld("LightSource \"infinite\" " + parameters, folder.path(""));
    };
    const auto radiance = [](const BuiltScene& built) {
        return evaluateLight<float>(built.scene.lights, 0u, {{}, {}, {0, 0.6f, 0.8f}}).L.b;
    };
    const BuiltScene guessed = build("\"string filename\" \"sky.pfm\"");
    EXPECT_TRUE(guessed.warnsOf("twice as wide as high"));
    EXPECT_EQ(onlyLight<ImageInfiniteLight>(guessed).map, SkyMap::LatLong);
    EXPECT_FLOAT_EQ(radiance(guessed), 3);
    const BuiltScene said = build("\"string filename\" \"odd.pfm\" \"string mapping\" \"latlong\"");
    EXPECT_TRUE(said.warnings.all().empty());
    EXPECT_EQ(onlyLight<ImageInfiniteLight>(said).height, 32u);
    const float luminance = 0.2126f * 1 + 0.7152f * 2 + 0.0722f * 3;
    EXPECT_NEAR(
        radiance(build("\"string filename\" \"odd.pfm\" \"string mapping\" \"latlong\" \"float illuminance\" 1")),
        3 * 2 / (std::numbers::pi_v<float> * luminance), 5e-3);
    const auto error = [&](const std::string& parameters) {
        return errorOf("WorldBegin\nLightSource \"infinite\" " + parameters, {}, folder.path(""));
    };
    EXPECT_NE(error("\"string filename\" \"sky.pfm\" \"string mapping\" \"equalarea\"").find("64 x 32"),
              std::string::npos);
    EXPECT_NE(error("\"string filename\" \"sky.pfm\" \"string mapping\" \"latlon\"").find("did you mean 'latlong'"),
              std::string::npos);
}

TEST(LightSources, PortalsShowTheSkyBehindThem) {
    const TemporaryFolder folder;
    // By latitude, columns of a quarter turn: red from +x to +y of the light, then green, blue, white.
    std::string image = "PF\n4 2\n-1.0\n";
    for (int row = 0; row < 2; ++row)
        for (const Rgb c : {Rgb{1, 0, 0}, Rgb{0, 1, 0}, Rgb{0, 0, 1}, Rgb{1, 1, 1}})
            for (const float v : {c.r, c.g, c.b})
                image.append(reinterpret_cast<const char*>(&v), sizeof v);
    folder.file("sky.pfm", image);
    const auto built = [&](const std::string& parameters, const std::string& before = "") {
        return buildWorld(before + "LightSource \"infinite\" " + parameters, folder.path(""));
    };
    // A window in the plane x = 2, from y, z = -1 to 1. Out is +x: x of the frame is +y, y of it +z.
    const std::string portal = "\"point3 portal\" [2 -1 -1  2 -1 1  2 1 1  2 1 -1]";
    const auto look = [](const BuiltScene& scene, Vec3<float> from, Vec3<float> w) {
        return evaluateLight<float>(scene.scene.lights, 0u, {from, {}, normalize(w)}).L;
    };
    const BuiltScene plain = built("\"rgb L\" [1 2 3] \"float scale\" 2 " + portal, "Translate 9 9 9 Scale 3 3 3 ");
    EXPECT_EQ(onlyLight<PortalInfiniteLight>(plain).width, 2.f);
    EXPECT_FLOAT_EQ(look(plain, {0, 0, 0}, {2, 0.9f, 0.9f}).g, 4);
    EXPECT_EQ(look(plain, {0, 0, 0}, {2, 1.1f, 0}).g, 0) << "past its edge";
    EXPECT_FLOAT_EQ(look(plain, {0, 5, 0}, {2, -5, 0}).g, 4);
    EXPECT_EQ(look(plain, {3, 0, 0}, {1, 0, 0}).g, 0) << "outside of the room";
    EXPECT_EQ(look(plain, {3, 0, 0}, {-1, 0, 0}).g, 0) << "from behind";

    const std::string sky = "\"string filename\" \"sky.pfm\" \"string mapping\" \"latlong\" " + portal;
    const BuiltScene upright = built(sky);
    EXPECT_FLOAT_EQ(look(upright, {0, -1, 0}, {2, 1.9f, 0.1f}).r, 1);  // 43 degrees from +x: the middle of the red
    EXPECT_NEAR(look(upright, {0, -1, 0}, {2, 1.9f, 0.1f}).g, 0, 0.1);
    EXPECT_FLOAT_EQ(look(upright, {0, 1, 0}, {2, -1.9f, 0.1f}).g, 1);  // the white
    // The light turned by 90 degrees about z: what was red is now from +y to -x, and white where red was.
    EXPECT_NEAR(look(built(sky, "Rotate 90 0 0 1 "), {0, -1, 0}, {2, 1.9f, 0.1f}).g, 1, 0.1);

    EXPECT_NE(
        errorOf("WorldBegin LightSource \"infinite\" \"point3 portal\" [0 0 0 1 0 0]").find("four points, 6 numbers"),
        std::string::npos);
    EXPECT_NE(
        errorOf("WorldBegin LightSource \"infinite\" \"point3 portal\" [0 0 0 1 0 0 1 1 0 0 2 0]").find("rectangle"),
        std::string::npos);
    EXPECT_NE(
        errorOf("WorldBegin LightSource \"infinite\" \"point3 portal\" [0 0 0 0 0 0 0 0 0 0 0 0]").find("rectangle"),
        std::string::npos);
}

/// The intensity towards w of the only light, which is at the point p.
Rgb intensityTowards(const BuiltScene& built, Vec3<float> p, Vec3<float> w) {
    EXPECT_EQ(built.scene.lights.size(), 1u);
    const float distance = 2.f / length(w);
    const Spectrum<float> L = sampleLight<float>(built.scene.lights, 0u, p + w * distance, {0.f, 0.f}).L * 4.f;
    return {L.r, L.g, L.b};
}

TEST(LightSources, SpotsHaveConesAndPower) {
    const auto at = [](const std::string& parameters, float degrees) {
        const BuiltScene built = buildWorld(
            "Translate 1 0 0 LightSource \"spot\" \"point3 from\" [0 0 1] \"point3 to\" [0 5 1] " + parameters);
        const float a = degrees * std::numbers::pi_v<float> / 180;
        return intensityTowards(built, {1, 0, 1}, {std::sin(a), std::cos(a), 0}).r;
    };
    EXPECT_NEAR(at("", 24), 1, 1e-5);
    EXPECT_GT(at("", 28), 0.1);
    EXPECT_LT(at("", 28), 0.9);
    EXPECT_EQ(at("", 31), 0);
    EXPECT_NEAR(at("\"float coneangle\" 60 \"rgb I\" [3 2 1] \"float scale\" 2", 50), 6, 1e-5);
    const double k = 2 * std::numbers::pi *
                     (1 - std::cos(50 * std::numbers::pi / 180) +
                      (std::cos(50 * std::numbers::pi / 180) - std::cos(60 * std::numbers::pi / 180)) / 2);
    EXPECT_NEAR(at("\"float coneangle\" 60 \"float conedeltaangle\" 10 \"float power\" 10", 3), 10 / k, 1e-5);
    // A falloff of more than the cone is mirrored at the axis, as the format has it; of more than twice, it is cut.
    EXPECT_NEAR(at("\"float coneangle\" 20 \"float conedeltaangle\" 25", 4), 1, 1e-4);
    EXPECT_LT(at("\"float coneangle\" 20 \"float conedeltaangle\" 25", 6), 1);
    EXPECT_EQ(at("\"float coneangle\" 2", 3), 0);
    EXPECT_TRUE(buildWorld("LightSource \"spot\" \"float coneangle\" 2").warnsOf("more than twice coneangle"));
}

TEST(LightSources, GoniometricImagesAreMeansOfTheirChannels) {
    const TemporaryFolder folder;
    folder.file("lamp.pfm", pfm(4, 4, {1, 2, 3}));
    folder.file("wide.pfm", pfm(4, 2, {1, 2, 3}));
    const auto at = [&](const std::string& parameters) {
        return intensityTowards(
            buildWorld("LightSource \"goniometric\" \"string filename\" \"lamp.pfm\" " + parameters, folder.path("")),
            {0, 0, 0}, {0.6f, 0, 0.8f});
    };
    EXPECT_NEAR(at("").g, 2, 1e-6);
    EXPECT_NEAR(at("\"rgb I\" [3 2 1] \"float scale\" 2").r, 12, 1e-5);
    EXPECT_NEAR(at("\"float power\" 8").r, 8 / (4 * std::numbers::pi), 1e-6);
    EXPECT_NEAR(at("\"float power\" 8 \"float scale\" 3").r, 24 / (4 * std::numbers::pi), 1e-6);
    const std::string wide =
        errorOf("WorldBegin\n LightSource \"goniometric\" \"string filename\" \"wide.pfm\"", {}, folder.path(""));
    EXPECT_EQ(wide.rfind("test.pbrt:2:2: light 'goniometric': the image ", 0), 0u) << wide;
    const BuiltScene none = buildWorld("LightSource \"goniometric\" \"rgb I\" [2 2 2]");
    EXPECT_TRUE(none.warnsOf("light 'goniometric': without a filename it shines alike in all directions"));
    EXPECT_EQ(onlyLight<PointLight>(none).intensity.r, 2);
}

TEST(LightSources, ProjectionsAreFrames) {
    const TemporaryFolder folder;
    folder.file("slide.pfm", pfm(4, 2, {1, 2, 3}));
    const auto at = [&](const std::string& parameters, Vec3<float> w) {
        return intensityTowards(
            buildWorld("LightSource \"projection\" \"string filename\" \"slide.pfm\" " + parameters, folder.path("")),
            {0, 0, 0}, w);
    };
    EXPECT_NEAR(at("", {1.9f, 0.9f, 1}).b, 3, 1e-5);
    EXPECT_EQ(at("", {1.9f, 1.1f, 1}).b, 0);
    EXPECT_EQ(at("\"float fov\" 60", {0, 0.6f, 1}).b, 0);
    EXPECT_NEAR(at("\"float scale\" 2 \"float fov\" 60", {0, 0.5f, 1}).r, 2, 1e-5);
    // The power is that of the luminance: A = 4 tan^2(45 degrees) 2, and the eight pixels lie at x = +-0.5, +-1.5 and
    // y = +-0.5 of the screen at distance 1.
    const double luminance = 0.2126 * 1 + 0.7152 * 2 + 0.0722 * 3;
    const double cosines = (std::pow(1 + 0.25 + 0.25, -1.5) + std::pow(1 + 2.25 + 0.25, -1.5)) / 2;
    EXPECT_NEAR(at("\"float power\" 5", {0, 0, 1}).r, 5 / (8 * luminance * cosines), 1e-4);

    const auto error = [&](const std::string& parameters) {
        return errorOf("WorldBegin\n LightSource \"projection\" " + parameters, {}, folder.path(""));
    };
    EXPECT_EQ(error(""), "test.pbrt:2:2: light 'projection': needs an image, as \"string filename\"");
    EXPECT_NE(error("\"string filename\" \"slide.pfm\" \"float fov\" 180").find("fov is 180"), std::string::npos);
    folder.file("black.pfm", pfm(1, 1, {0, 0, 0}));
    EXPECT_NE(error("\"string filename\" \"black.pfm\" \"float power\" 1").find("not black"), std::string::npos);
}

TEST(LightSelectionOfScenes, LeavesConstantSkiesOutUnlessLightsAreAllThereIs) {
    const std::string world = "WorldBegin LightSource \"infinite\" Shape \"sphere\"";
    EXPECT_TRUE(buildText(world).scene.lightSampler.empty());
    BuildOptions options;
    options.strategy = Strategy::LightOnly;
    EXPECT_FALSE(buildText(world, options).scene.lightSampler.empty());
}

TEST(LightSelectionOfScenes, KnowsTheSizeOfTheScene) {
    const BuiltScene built = buildWorld("LightSource \"infinite\" Translate 5 0 0 Shape \"sphere\"");
    EXPECT_NEAR(built.scene.lights.tables.sceneCenter.x, 5, 1e-4);
    EXPECT_NEAR(built.scene.lights.tables.sceneRadius, std::sqrt(3.f), 1e-4);
    EXPECT_EQ(buildWorld("LightSource \"infinite\"").scene.lights.tables.sceneRadius, 1);
    BuildOptions options;
    options.classicArea = true;
    EXPECT_TRUE(buildText("WorldBegin LightSource \"infinite\"", options).scene.lights.tables.classicArea);
}

}  // namespace
}  // namespace penumbra
