// Film, camera, filter, sampler, integrator; overrides; the form of errors.
#include "tests/scenes_builder_fixture.h"

namespace penumbra {
namespace {

/// A scene of only an options block.
BuiltScene settings(const std::string& options, const BuildOptions& overrides = {}) {
    return buildText(options + "\nWorldBegin\nLightSource \"point\"", overrides);
}

TEST(BuildSampler, CountsSamples) {
    const auto samples = [](const std::string& sampler, int asked = 0) {
        BuildOptions o;
        o.samplesOverride = asked;
        return settings(sampler, o).scene.samplesPerPixel;
    };
    EXPECT_EQ(samples(""), 16);
    EXPECT_EQ(samples("Sampler \"zsobol\" \"integer pixelsamples\" 100"), 64)
        << "rounded down to a power of two, as the format has it";
    EXPECT_EQ(samples("Sampler \"zsobol\" \"integer pixelsamples\" 100", 100), 100);
    EXPECT_EQ(samples("Sampler \"sobol\" \"integer pixelsamples\" 100"), 100);
    EXPECT_EQ(samples("Sampler \"halton\" \"integer pixelsamples\" 100"), 100);
    EXPECT_EQ(samples("Sampler \"independent\""), 4);
    EXPECT_EQ(samples("Sampler \"stratified\" \"integer xsamples\" 3 \"integer ysamples\" 5"), 15);
    EXPECT_EQ(samples("Sampler \"stratified\"", 7), 7);
}

TEST(BuildSampler, StandInsWarnWhereThePointsDiffer) {
    EXPECT_TRUE(settings("Sampler \"zsobol\"").warnings.all().empty());
    EXPECT_TRUE(settings("Sampler \"paddedsobol\" \"string randomization\" \"fastowen\"").warnings.all().empty());
    EXPECT_TRUE(
        settings("Sampler \"halton\"").warnsOf("the sampler 'halton' is not there yet; 'sobol' stands in for it"));
}

TEST(BuildSampler, OverridesKeepTheCount) {
    BuildOptions o;
    o.sampler = "independent";
    const BuiltScene built = settings("Sampler \"zsobol\" \"integer pixelsamples\" 64", o);
    EXPECT_EQ(built.scene.samplesPerPixel, 64);
    EXPECT_EQ(built.scene.sampler.info().name, "independent");
    o.sampler = "sobbol";
    EXPECT_NE(errorOf("WorldBegin", o).find("did you mean 'sobol' or 'zsobol'"), std::string::npos);
}

TEST(BuildSampler, SeedsRankCommandLineThenSamplerThenOption) {
    EXPECT_EQ(settings("").scene.seed, 0u);
    EXPECT_EQ(settings("Option \"seed\" 5").scene.seed, 5u);
    EXPECT_EQ(settings("Option \"seed\" 5 Sampler \"zsobol\" \"integer seed\" 6").scene.seed, 6u);
    BuildOptions o;
    o.seed = 7;
    EXPECT_EQ(settings("Option \"seed\" 5 Sampler \"zsobol\" \"integer seed\" 6", o).scene.seed, 7u);
}

TEST(BuildFilm, ReadsSizeAndCrop) {
    const FilmSettings standard = settings("").scene.film;
    EXPECT_EQ(standard.width, 1280);
    EXPECT_EQ(standard.height, 720);
    EXPECT_EQ(standard.crop.x1, 1280);
    const CropWindow window =
        settings(
            "Film \"rgb\" \"integer xresolution\" 10 \"integer yresolution\" 20 \"float cropwindow\" [.25 .75 0 .5]")
            .scene.film.crop;
    EXPECT_EQ(window.x0, 3);  // ceil(2.5)
    EXPECT_EQ(window.x1, 8);  // ceil(7.5)
    EXPECT_EQ(window.y0, 0);
    EXPECT_EQ(window.y1, 10);
    const CropWindow bounds =
        settings(
            "Film \"rgb\" \"integer xresolution\" 10 \"integer yresolution\" 20 \"integer pixelbounds\" [1 4 5 99]")
            .scene.film.crop;
    EXPECT_EQ(bounds.x0, 1);
    EXPECT_EQ(bounds.x1, 4);
    EXPECT_EQ(bounds.y0, 5);
    EXPECT_EQ(bounds.y1, 20);
}

TEST(BuildFilm, ResolutionOverrideKeepsTheFractionOfTheCrop) {
    BuildOptions o;
    o.width = 200;
    o.height = 400;
    for (const char* crop : {"\"float cropwindow\" [.125 .5 .25 .75]", "\"integer pixelbounds\" [12 50 50 150]"}) {
        const FilmSettings film =
            settings("Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 200 " + std::string(crop), o)
                .scene.film;
        EXPECT_EQ(film.width, 200);
        EXPECT_NEAR(film.crop.x0, 25, 1);
        EXPECT_EQ(film.crop.x1, 100);
        EXPECT_EQ(film.crop.y0, 100);
        EXPECT_EQ(film.crop.y1, 300);
    }
}

TEST(BuildFilm, Exposure) {
    const auto sensor = [](const std::string& options) { return settings(options).scene.film; };
    EXPECT_TRUE(sensor("").isIdentity());
    EXPECT_FLOAT_EQ(sensor("Film \"rgb\" \"float iso\" 200").sensorFromFilm[4], 2);
    EXPECT_FLOAT_EQ(sensor("Camera \"perspective\" \"float shutterclose\" 0.01").sensorFromFilm[0], 0.01f);
    EXPECT_FLOAT_EQ(sensor("Film \"rgb\" \"float maxcomponentvalue\" 10").maxComponent, 10);
    const FilmSettings balanced = sensor("Film \"rgb\" \"float whitebalance\" 5000");
    EXPECT_NEAR(balanced.sensorFromFilm[0], 0.9392, 2e-3);
    EXPECT_NEAR(balanced.sensorFromFilm[8], 1.3318, 3e-3);
}

TEST(BuildFilm, ColoursAreInItsSpace) {
    const BuiltScene built = buildText(
        "ColorSpace \"aces2065-1\" Film \"rgb\" ColorSpace \"srgb\" WorldBegin LightSource \"point\" \"rgb I\" [1 0 "
        "0]");
    EXPECT_EQ(built.scene.film.colorSpace, "aces2065-1");
    EXPECT_LT(built.scene.lights.rows<PointLight>()[0].intensity.r, 0.9f);
}

TEST(BuildFilm, OtherTypesCountAsRgb) {
    EXPECT_TRUE(settings("Film \"spectral\" \"integer nbuckets\" 8").warnsOf("the film 'spectral' is not there yet"));
    const auto gbuffer = settings("Film \"gbuffer\" \"string coordinatesystem\" \"world\"");
    EXPECT_TRUE(gbuffer.warnsOf("SE stands for Variance"));
    EXPECT_EQ(aovNames(gbuffer.scene.film.aovs), (std::vector<std::string>{"albedo", "N", "Ns", "P", "dzdx", "dzdy", "uv"}));
    EXPECT_FALSE(gbuffer.scene.film.aovsInCameraSpace);
    EXPECT_TRUE(settings("Film \"gbuffer\"").scene.film.aovsInCameraSpace);
}

TEST(BuildFilter, HasTheDefaultsOfTheFormat) {
    const auto filter = [](const std::string& text) { return settings(text).scene.filter; };
    const auto reach = [](const Filter& f) { return f.sample<float>({0.999999f, 0.5f}).offset.x; };
    EXPECT_NEAR(reach(filter("")), 1.5, 0.1);
    EXPECT_NEAR(reach(filter("PixelFilter \"box\"")), 0.5, 1e-3);
    EXPECT_NEAR(reach(filter("PixelFilter \"triangle\"")), 2, 0.1);
    EXPECT_NEAR(reach(filter("PixelFilter \"mitchell\"")), 2, 0.1);
    EXPECT_NEAR(reach(filter("PixelFilter \"sinc\"")), 4, 0.1);
    EXPECT_TRUE(filter("").isPositive());
    EXPECT_FALSE(filter("PixelFilter \"mitchell\"").isPositive());
    EXPECT_NEAR(reach(filter("PixelFilter \"box\" \"float xradius\" 3")), 3, 1e-3);
}

TEST(BuildIntegrator, KnowsTheFormatsNames) {
    const auto integrator = [](const std::string& text, const BuildOptions& o = {}) { return settings(text, o); };
    EXPECT_EQ(integrator("").scene.integrator.name, "path");
    EXPECT_EQ(integrator("").scene.integrator.maxDepth, 5);
    EXPECT_EQ(integrator("Integrator \"volpath\" \"integer maxdepth\" 9").scene.integrator.maxDepth, 9);
    EXPECT_TRUE(integrator("Integrator \"volpath\" \"string lightsampler\" \"bvh\"").warnings.all().empty());
    EXPECT_EQ(integrator("").scene.integrator.lightSelection, LightSelection::Bvh);
    EXPECT_EQ(integrator("Integrator \"path\" \"string lightsampler\" \"power\"").scene.integrator.lightSelection,
              LightSelection::Power);
    EXPECT_TRUE(integrator("Integrator \"path\" \"string lightsampler\" \"pwoer\"").warnsOf("did you mean 'power'?"));
    EXPECT_TRUE(integrator("Integrator \"path\" \"string lightsampler\" \"exhaustive\"").warnsOf("not there yet"));
    EXPECT_EQ(integrator("Integrator \"path\" \"string lightsampler\" \"uniform\"").scene.integrator.lightSelection,
              LightSelection::Uniform);
    EXPECT_EQ(integrator("Integrator \"simplepath\" \"bool samplelights\" false").scene.integrator.strategy,
              Strategy::BsdfOnly);
    const BuiltScene bdpt = integrator("Integrator \"bdpt\" \"integer maxdepth\" 3 \"bool visualizeweights\" false");
    EXPECT_EQ(bdpt.scene.integrator.name, "path");
    EXPECT_EQ(bdpt.scene.integrator.maxDepth, 3);
    ASSERT_EQ(bdpt.warnings.all().size(), 1u);
    const IntegratorSettings ao =
        integrator("Integrator \"ambientocclusion\" \"float maxdistance\" 3 \"bool cossample\" false").scene.integrator;
    EXPECT_EQ(ao.name, "ambientocclusion");
    EXPECT_EQ(ao.maxDistance, 3);
    EXPECT_FALSE(ao.cosineSampling);
}

TEST(BuildIntegrator, TheCommandLineWins) {
    BuildOptions o;
    o.integrator = "direct";
    o.maxDepth = 2;
    o.roulette = RouletteRule::Off;
    o.strategy = Strategy::BsdfOnly;
    o.lightSelection = LightSelection::Uniform;
    const IntegratorSettings s = settings("Integrator \"bdpt\" \"integer maxdepth\" 3", o).scene.integrator;
    EXPECT_EQ(s.name, "direct");
    EXPECT_EQ(s.maxDepth, 2);
    EXPECT_EQ(s.roulette, RouletteRule::Off);
    EXPECT_EQ(s.strategy, Strategy::BsdfOnly);
    EXPECT_EQ(s.lightSelection, LightSelection::Uniform);
}

/// Direction of the camera ray through the middle of the right edge, as its slope.
float edgeSlope(const Scene& scene) {
    const CameraRay<float> ray =
        scene.camera.ray<float>({float(scene.film.width), 0.5f * float(scene.film.height)}, {0.5f, 0.5f}, 0.f);
    return ray.direction.x / ray.direction.z;
}

TEST(BuildCamera, FovIsOfTheShorterAxis) {
    const std::string film = "Film \"rgb\" \"integer xresolution\" 300 \"integer yresolution\" 100 ";
    EXPECT_NEAR(edgeSlope(settings(film).scene), 3, 1e-4);
    EXPECT_NEAR(edgeSlope(settings(film + "Camera \"perspective\" \"float frameaspectratio\" 2").scene), 2, 1e-4);
    EXPECT_NEAR(edgeSlope(settings(film + "Camera \"perspective\" \"float screenwindow\" [-5 7 -1 1]").scene), 7, 1e-4);
    EXPECT_NEAR(edgeSlope(settings("Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 300 ").scene), 1,
                1e-4);
}

TEST(BuildCamera, AnotherAspectOnTheCommandLineMakesAnotherScreen) {
    const std::string scene =
        "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100 Camera \"perspective\" \"float "
        "frameaspectratio\" 2.5";
    BuildOptions o;
    o.width = 400, o.height = 200;
    EXPECT_NEAR(edgeSlope(settings(scene, o).scene), 2.5, 1e-4);
    o.width = 400, o.height = 100;
    EXPECT_NEAR(edgeSlope(settings(scene, o).scene), 4, 1e-4);
}

TEST(BuildCamera, ConesShrinkAsSamplesGrow) {
    const auto spread = [](int samples, const std::string& option = "") {
        return buildText(option + "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100\n"
                         "Camera \"perspective\" \"float fov\" 90\nSampler \"sobol\" \"integer pixelsamples\" " +
                         std::to_string(samples) + "\nWorldBegin\n")
            .scene.camera.coneSpread();
    };
    EXPECT_FLOAT_EQ(spread(1), 0.02f);  // a pixel of a screen of side 2 in the distance 1
    EXPECT_FLOAT_EQ(spread(16), 0.02f / 4);
    EXPECT_FLOAT_EQ(spread(64), 0.02f / 8);
    EXPECT_FLOAT_EQ(spread(1024), 0.02f / 8);
    EXPECT_EQ(spread(4, "Option \"disabletexturefiltering\" true\n"), 0);
}

TEST(BuildCamera, SphericalCamerasTakeWhatProjectiveOnesTake) {
    const BuiltScene built = settings(
        "Camera \"spherical\" \"float frameaspectratio\" 2 \"float screenwindow\" [-1 1 -1 1] \"float lensradius\" 1");
    EXPECT_TRUE(built.warnings.all().empty());
    EXPECT_EQ(built.scene.camera.info().name, "spherical");
    EXPECT_NE(
        errorOf("Camera \"spherical\" \"string mapping\" \"equalara\"\nWorldBegin").find("did you mean 'equalarea'?"),
        std::string::npos);
}

struct BadText {
    const char* text;
    const char* message;  ///< begins the error
};
class BuildErrors : public testing::TestWithParam<BadText> {};

TEST_P(BuildErrors, BeginWithTheirPlace) {
    const std::string error = errorOf(GetParam().text);
    EXPECT_EQ(error.rfind(GetParam().message, 0), 0u) << "was: " << error;
}

INSTANTIATE_TEST_SUITE_P(
    Texts, BuildErrors,
    testing::Values(
        BadText{"Film \"rgb\" \"integer xresolution\" 0\nWorldBegin",
                "test.pbrt:1:12: xresolution is 0, outside the allowed range, 1 to "},
        BadText{"Film \"rgb\" \"integer xresolution\" 1000000 \"integer yresolution\" 1000000\nWorldBegin",
                "test.pbrt:1:1: a film of 1000000 x 1000000 pixels is too large: it would take "},
        BadText{"Film \"rgb\" \"float cropwindow\" [.5 .5 0 1]\nWorldBegin",
                "test.pbrt:1:12: cropwindow leaves no pixel"},
        BadText{"Film \"rgb\" \"float cropwindow\" [0 1 0]\nWorldBegin", "test.pbrt:1:12: cropwindow needs 4 numbers"},
        BadText{"Film \"rgb\" \"float iso\" 0\nWorldBegin", "test.pbrt:1:12: iso 0 is not above 0"},
        BadText{"Film \"rbg\"\nWorldBegin", "test.pbrt:1:1: unknown film 'rbg'; did you mean 'rgb'?"},
        BadText{"Camera \"perspective\" \"float fov\" 180\nWorldBegin",
                "test.pbrt:1:22: fov is 180, outside the allowed range"},
        BadText{"Camera \"perspective\" \"float fov\" [40 50]\nWorldBegin",
                "test.pbrt:1:22: 'float fov' must be one value"},
        BadText{"Camera \"perspective\" \"float shutteropen\" 1\nWorldBegin",
                "test.pbrt:1:1: the shutter closes at 1, not after it opens at 1"},
        BadText{"Camera \"prespective\"\nWorldBegin",
                "test.pbrt:1:1: unknown camera 'prespective'; did you mean 'perspective'?"},
        BadText{"PixelFilter \"gausian\"\nWorldBegin",
                "test.pbrt:1:1: unknown pixel filter 'gausian'; did you mean 'gaussian'?"},
        BadText{"PixelFilter \"box\" \"float xradius\" 0\nWorldBegin",
                "test.pbrt:1:19: xradius is 0, outside the allowed range"},
        BadText{"Sampler \"sobel\"\nWorldBegin", "test.pbrt:1:1: unknown sampler 'sobel'; did you mean 'sobol'"},
        BadText{"Sampler \"zsobol\" \"integer pixelsamples\" 0\nWorldBegin",
                "test.pbrt:1:18: pixelsamples is 0, outside the allowed range"},
        BadText{"Integrator \"pathh\"\nWorldBegin", "test.pbrt:1:1: unknown integrator 'pathh'; did you mean 'path'"},
        BadText{"Integrator \"path\" \"integer maxdepth\" -1\nWorldBegin",
                "test.pbrt:1:19: maxdepth is -1, outside the allowed range"},
        BadText{"WorldBegin\nShape \"shpere\"", "test.pbrt:2:1: unknown shape 'shpere'; did you mean 'sphere'?"},
        BadText{"WorldBegin\nShape \"sphere\" \"float radius\" -1",
                "test.pbrt:2:16: radius is -1, outside the allowed range"},
        BadText{"WorldBegin\nShape \"trianglemesh\"",
                "test.pbrt:2:1: shape 'trianglemesh': a triangle mesh needs \"P\""},
        BadText{"WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 3]",
                "test.pbrt:2:1: shape 'trianglemesh': \"indices\"[2] is 3, outside 0 to 2"},
        BadText{"WorldBegin\nShape \"plymesh\"", "test.pbrt:2:1: shape 'plymesh': \"string filename\" is missing"},
        BadText{"WorldBegin\n ObjectInstance \"tree\"", "test.pbrt:2:2: unknown object 'tree'"},
        BadText{"WorldBegin\nMediumInterface \"fog\" \"\"\nShape \"sphere\"", "test.pbrt:2:1: unknown medium 'fog'"},
        BadText{"WorldBegin\nLightSource \"pointt\"", "test.pbrt:2:1: unknown light 'pointt'; did you mean 'point'?"},
        BadText{"WorldBegin\nLightSource \"point\" \"rgb I\" [1e30 1e30 1e30] \"float scale\" 1e30",
                "test.pbrt:2:1: light 'point': its light is too large"},
        BadText{"WorldBegin\nLightSource \"distant\" \"point3 from\" [0 0 1]",
                "test.pbrt:2:1: light 'distant': its points 'from' and 'to' give no direction"},
        BadText{"WorldBegin\nAreaLightSource \"difuse\" Shape \"sphere\"",
                "test.pbrt:2:1: unknown area light 'difuse'; did you mean 'diffuse'?"},
        BadText{"WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [2 0 0] Shape \"sphere\"", "test.pbrt:2:20: "},
        BadText{"WorldBegin\nMaterial \"dielectric\" \"float eta\" -1 Shape \"sphere\"", "test.pbrt:2:"}));

TEST(BuildWarnings, BeginWithTheirPlaceAndAreErrorsWhereStrict) {
    const std::string text = "WorldBegin\nLightSource \"point\"\nShape \"sphere\" \"float radios\" 2";
    const BuiltScene built = buildText(text);
    ASSERT_EQ(built.warnings.all().size(), 1u);
    EXPECT_EQ(built.warnings.all()[0],
              "test.pbrt:3:16: parameter 'float radios' of shape 'sphere' is unknown; did you mean 'radius'?");
    Warnings strict(true);
    SceneDescription description = readSceneText(text, "test.pbrt", ".", strict);
    EXPECT_THROW(buildScene(std::move(description), {}, strict), Error);
}

TEST(BuildWarnings, ASceneWithoutLightsIsBlackAndSaysSo) {
    EXPECT_TRUE(buildText("WorldBegin Shape \"sphere\"").warnsOf("test.pbrt: the scene has no lights"));
    EXPECT_TRUE(buildText("Integrator \"normals\" WorldBegin Shape \"sphere\"").warnings.all().empty());
}

}  // namespace
}  // namespace penumbra
