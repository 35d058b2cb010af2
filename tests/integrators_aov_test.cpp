// AOVs: what scenes with known geometry must show, in the picture's own samples, with the same bits however it is
// rendered.
#include "core/base/parallel.h"
#include "core/image/exr.h"
#include "core/math/double_vector.h"
#include "tests/integrators_fixture.h"
#include "tests/run_program.h"

#include <gtest/gtest.h>

#include <numbers>

namespace penumbra {
namespace {

using namespace test;

RenderOptions withAovs() {
    RenderOptions options;
    options.build.aovs.emplace();
    for (const AovKind& kind : aovKinds())
        options.build.aovs->add(kind.aov);
    return options;
}

/// The AOVs of one pixel of a job that keeps all of them.
class Pixel {
public:
    Pixel(const RenderJob& job, int x, int y) {
        job.film().estimateAovs(std::size_t(y) * std::size_t(job.film().crop().width()) + std::size_t(x), values_);
    }
    float value(Aov aov, std::size_t channel = 0) const {
        return values_[aovKinds()[std::size_t(aov)].first + channel];
    }
    Vec3d triple(Aov aov) const { return {value(aov), value(aov, 1), value(aov, 2)}; }

private:
    AovValues values_{};
};

void expectNear(Vec3d a, Vec3d b, double tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

/// A filter so narrow that a pixel shows its centre.
std::string centres(int width, int height) {
    return film(width, height) + "PixelFilter \"box\" \"float xradius\" .001 \"float yradius\" .001\n";
}

/// 8 x 8 units at z = 5 (camera space of the identity), reflecting .2 .4 .6; uv runs from 0 to 1, the shading normal is
/// slanted.
constexpr char kWall[] = R"(
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ .2 .4 .6 ]
Shape "trianglemesh" "point3 P" [ -4 -4 5  4 -4 5  4 4 5  -4 4 5 ] "integer indices" [ 0 1 2 0 2 3 ]
  "point2 uv" [ 0 0 1 0 1 1 0 1 ] "normal N" [ .6 0 -.8  .6 0 -.8  .6 0 -.8  .6 0 -.8 ]
)";

TEST(Aovs, AWallShowsWhereItStands) {
    const auto job =
        renderText("Camera \"perspective\" \"float fov\" 90\n" + centres(16, 16) + "WorldBegin\n" + kWall, withAovs());
    // The picture spans -5 to 5 of the plane z = 5, of which the wall covers the middle 8.
    const double pixel = 10.0 / 16, tolerance = 0.002 * pixel;
    for (int y = 2; y < 14; ++y)
        for (int x = 2; x < 14; ++x) {
            const Pixel p(*job, x, y);
            const double px = -5 + (x + 0.5) * pixel, py = 5 - (y + 0.5) * pixel;
            expectNear(p.triple(Aov::Position), {px, py, 5}, tolerance);
            EXPECT_NEAR(p.value(Aov::Depth), 5, 1e-5);
            EXPECT_NEAR(p.value(Aov::Uv, 0), (px + 4) / 8, tolerance);
            EXPECT_NEAR(p.value(Aov::Uv, 1), (py + 4) / 8, tolerance);
            expectNear(p.triple(Aov::Normal), {0, 0, -1}, 1e-6);
            expectNear(p.triple(Aov::ShadingNormal), {0.6, 0, -0.8}, 1e-6);
            expectNear(p.triple(Aov::Albedo), {0.2, 0.4, 0.6}, 1e-6);
            EXPECT_NEAR(p.value(Aov::Time), 0.5, 1e-6);
        }
}

TEST(Aovs, WhereNothingIsMetThereIsNoPlace) {
    const auto job =
        renderText("Camera \"perspective\" \"float fov\" 90\n" + centres(16, 16) + "WorldBegin\n" + kWall, withAovs());
    const Pixel sky(*job, 0, 7);
    for (const Aov aov : {Aov::Albedo, Aov::Normal, Aov::ShadingNormal})
        expectNear(sky.triple(aov), {0, 0, 0}, 0);
    for (const Aov aov :
         {Aov::Position, Aov::Depth, Aov::DepthAlongX, Aov::DepthAlongY, Aov::Uv, Aov::Time})
        EXPECT_TRUE(std::isnan(sky.value(aov)));
}

/// The plane z = 5 + x / 2 - y / 4 before a camera at the origin, seen in 32 x 16 pixels.
std::unique_ptr<RenderJob> slope(const std::string& camera, const std::string& look = "") {
    return renderText(look + camera + centres(32, 16) + R"(WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Shape "trianglemesh" "point3 P" [ -8 -8 3  8 -8 11  8 8 7  -8 8 -1 ] "integer indices" [ 0 1 2 0 2 3 ]
)",
                      withAovs());
}

TEST(Aovs, DepthChangesAsTheSlopeSays) {
    // A pixel is 4 / 16 units to the side.
    const auto flat = slope("Camera \"orthographic\" \"float screenwindow\" [ -4 4 -2 2 ]\n");
    const auto deep = slope("Camera \"perspective\" \"float fov\" 40\n");
    const double tangent = std::tan(std::numbers::pi / 9), k = 2 * tangent / 16;  // of a pixel, at depth 1
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x) {
            EXPECT_NEAR(Pixel(*flat, x, y).value(Aov::DepthAlongX), 0.5 * 0.25, 1e-5);
            EXPECT_NEAR(Pixel(*flat, x, y).value(Aov::DepthAlongY), 0.25 * 0.25, 1e-5);
            // z = 5 / (1 - a / 2 + b / 4) in the direction (a, b, 1).
            const double a = (x + 0.5 - 16) * k, b = (8 - y - 0.5) * k;
            const auto depth = [&](double da, double db) { return 5 / (1 - (a + da) / 2 + (b + db) / 4); };
            EXPECT_NEAR(Pixel(*deep, x, y).value(Aov::DepthAlongX), depth(k / 2, 0) - depth(-k / 2, 0), 1e-4);
            EXPECT_NEAR(Pixel(*deep, x, y).value(Aov::DepthAlongY), depth(0, -k / 2) - depth(0, k / 2), 1e-4);
        }
    // However the camera stands: a wall at a right angle to its axis has no slope, nor has a sphere around it.
    const auto aside = renderText("LookAt 3 2 -4  3 2 5  1 1 0\nCamera \"perspective\" \"float fov\" 20\n" +
                                      centres(4, 4) + "WorldBegin\n" + kWall,
                                  withAovs());
    EXPECT_NEAR(Pixel(*aside, 1, 1).value(Aov::DepthAlongX), 0, 1e-4);
    EXPECT_NEAR(Pixel(*aside, 1, 1).value(Aov::DepthAlongY), 0, 1e-4);
    const auto around = renderText("Camera \"spherical\"\n" + centres(16, 16) +
                                       "WorldBegin\nLightSource \"infinite\"\nShape \"sphere\" \"float radius\" 3\n",
                                   withAovs());
    for (int x = 0; x < 16; ++x)
        EXPECT_NEAR(Pixel(*around, x, 5).value(Aov::DepthAlongX), 0, 0.15);
}

/// The wall's edge goes through the middle of the pixels.
TEST(Aovs, AnEdgeIsFilteredAsThePictureIs) {
    const auto job =
        renderText("Camera \"orthographic\" \"float screenwindow\" [ 3 5 -1 1 ]\n" + film(1, 1) +
                       "PixelFilter \"box\"\nSampler \"sobol\" \"integer pixelsamples\" 256\nWorldBegin\n" + kWall,
                   withAovs());
    const Pixel p(*job, 0, 0);
    EXPECT_EQ(job->film().estimate(0).alpha, 0.5);
    expectNear(p.triple(Aov::Albedo), {0.1, 0.2, 0.3}, 1e-6);  // of all samples
    expectNear(p.triple(Aov::Normal), {0, 0, -1}, 1e-6);
    expectNear(p.triple(Aov::Position), {3.5, 0, 5}, 0.02);  // of those that met the wall
}

/// A sharper filter's negative lobes count in the albedo, but no mean of places lies outside of what was seen.
TEST(Aovs, FiltersWithNegativeLobes) {
    const auto job =
        renderText("Camera \"orthographic\" \"float screenwindow\" [ 0.5 8.5 -4 4 ]\n" + film(8, 8) +
                       "PixelFilter \"mitchell\"\nSampler \"sobol\" \"integer pixelsamples\" 1024\nWorldBegin\n" + kWall,
                   withAovs());
    bool overshoots = false;
    for (int x = 0; x < 8; ++x) {
        const Pixel p(*job, x, 4);
        overshoots = overshoots || p.value(Aov::Albedo, 2) > 0.603f || p.value(Aov::Albedo, 2) < -0.003f;
        EXPECT_TRUE(x >= 5 || (p.value(Aov::Position) > x - 1.1f && p.value(Aov::Position) < 4.0001f));
        EXPECT_TRUE(x >= 5 || std::fabs(p.value(Aov::Depth) - 5) < 1e-5f);
    }
    EXPECT_TRUE(overshoots);
}

/// The first surface that is more than a border of media; glass is one.
TEST(Aovs, BordersOfMediaAreLookedThrough) {
    const auto depthBehind = [](const std::string& material) {
        const auto job = renderText(
            "Camera \"perspective\" \"float fov\" 20\n" + centres(1, 1) + "WorldBegin\n" +
                scoped("Material \"" + material + "\"\nTranslate 0 0 3\nShape \"sphere\" \"float radius\" .5\n") +
                kWall,
            withAovs());
        return Pixel(*job, 0, 0).value(Aov::Depth);
    };
    EXPECT_NEAR(depthBehind("interface"), 5, 1e-5);
    EXPECT_NEAR(depthBehind("dielectric"), 2.5, 1e-5);
}

TEST(Aovs, MotionIsAveraged) {
    const auto job = renderText("Camera \"perspective\" \"float fov\" 40\n" + centres(2, 2) +
                                    "Sampler \"sobol\" \"integer pixelsamples\" 256\nWorldBegin\n"
                                    "ActiveTransform EndTime\nTranslate 0 0 2\nActiveTransform All\n" +
                                    kWall,
                                withAovs());
    const Pixel p(*job, 1, 1);
    EXPECT_NEAR(p.value(Aov::Depth), 6, 0.01);  // 5 to 7 in even motion
    EXPECT_NEAR(p.value(Aov::Time), 0.5, 0.005);
}

/// A lens looks past the edge of a near wall at a far one: what is seen of each is what the albedo says.
TEST(Aovs, DefocusIsAveraged) {
    const auto job = renderText(
        "Camera \"perspective\" \"float fov\" 60 \"float lensradius\" 1.5 \"float focaldistance\" 4\n" + film(16, 4) +
            "PixelFilter \"box\"\nSampler \"sobol\" \"integer pixelsamples\" 64\nWorldBegin\n"
            "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"
            "Material \"diffuse\" \"rgb reflectance\" [ 1 0 0 ]\n"
            "Shape \"trianglemesh\" \"point3 P\" [ 0 -9 2  9 -9 2  9 9 2  0 9 2 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n"
            "Material \"diffuse\" \"rgb reflectance\" [ 0 1 0 ]\n"
            "Shape \"trianglemesh\" \"point3 P\" [ -20 -9 4  20 -9 4  20 9 4  -20 9 4 ] \"integer indices\" [ 0 1 2 0 "
            "2 3 ]\n",
        withAovs());
    int mixed = 0;
    for (int x = 0; x < 16; ++x) {
        const Pixel p(*job, x, 2);
        const double near = p.value(Aov::Albedo, 0), far = p.value(Aov::Albedo, 1);
        EXPECT_NEAR(near + far, 1, 1e-6);
        EXPECT_NEAR(p.value(Aov::Depth), 2 * near + 4 * far, 1e-5);
        mixed += near > 0.05 && far > 0.05;
    }
    EXPECT_GE(mixed, 2);
}

TEST(Aovs, NormalsFaceTheViewer) {
    const std::string behind =
        "Camera \"perspective\" \"float fov\" 40\n" + centres(2, 2) + "WorldBegin\nReverseOrientation\n" + kWall;
    expectNear(Pixel(*renderText(behind, withAovs()), 0, 0).triple(Aov::Normal), {0, 0, -1}, 1e-6);
    expectNear(Pixel(*renderText(behind, withAovs()), 0, 0).triple(Aov::ShadingNormal), {0.6, 0, -0.8}, 1e-6);
}

/// Two ways to one thing: an integrator's picture and an AOV beside it, of one sample a pixel.
TEST(Aovs, ShadingNormalsAreThoseThatTheIntegratorShows) {
    const SceneFolder folder;
    RenderOptions options = withAovs();
    options.build.integrator = "normals";
    options.build.samplesOverride = 1;
    const auto job = renderText(motionText(), options, folder.path());
    constexpr double kOpen = 0.8;  // for how long the shutter is open, by which pictures are exposed
    int seen = 0;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) {
            const PixelEstimate e = job->film().estimate(std::size_t(y * 32 + x));
            if (e.alpha == 0) continue;
            ++seen;
            expectNear(Pixel(*job, x, y).triple(Aov::ShadingNormal),
                       {2 * e.mean[0] / kOpen - 1, 2 * e.mean[1] / kOpen - 1, 2 * e.mean[2] / kOpen - 1}, 1e-6);
        }
    EXPECT_GT(seen, 200);
}

/// Depth is along the axis of the camera, wherever that looks; of a camera that looks all round it is the distance.
TEST(Aovs, DepthBelongsToTheCamera) {
    const std::string look = "LookAt 3 2 -4  0 1 5  0 1 0\n";
    const auto job = renderText(
        look + "Camera \"perspective\" \"float fov\" 40\n" + centres(5, 5) + "WorldBegin\n" + kWall, withAovs());
    const Vec3d eye{3, 2, -4};
    const Vec3d axis = normalized(Vec3d{-3, -1, 9});
    for (const auto& [x, y] : {std::pair{0, 0}, {2, 2}, {4, 1}}) {
        const Pixel p(*job, x, y);
        EXPECT_NEAR(p.value(Aov::Depth), dot(p.triple(Aov::Position) - eye, axis), 1e-4);
    }
    const auto around =
        renderText(look + "Camera \"spherical\"\n" + centres(32, 32) + "WorldBegin\n" + kWall, withAovs());
    int seen = 0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
            const Pixel p(*around, x, y);
            if (std::isnan(p.value(Aov::Depth))) continue;
            ++seen;
            EXPECT_NEAR(p.value(Aov::Depth), length(p.triple(Aov::Position) - eye),
                        0.02);  // a mean of lengths, and of places
        }
    EXPECT_GT(seen, 10);
}

/// pbrt's film of that name: N, Ns, P in the space of the camera unless it says world.
TEST(Aovs, TheFilmGbufferKeepsThem) {
    const auto render = [](const std::string& parameters, const RenderOptions& options = {}) {
        Warnings warnings;
        const std::string text =
            "LookAt 3 2 -4  0 1 5  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
            "Film \"gbuffer\" \"integer xresolution\" 3 \"integer yresolution\" 3 " +
            parameters + "\nPixelFilter \"box\" \"float xradius\" .001 \"float yradius\" .001\nWorldBegin\n" + kWall;
        auto job = std::make_unique<RenderJob>(readSceneText(text, "test.pbrt", ".", warnings), options, warnings);
        job->run();
        EXPECT_EQ(warnings.all().size(), 1u);
        return job;
    };
    EXPECT_EQ(aovNames(render("")->scene().film.aovs), (std::vector<std::string>{"albedo", "N", "Ns", "P", "dzdx", "dzdy", "uv"}));
    const auto camera = render("", withAovs()), world = render("\"string coordinatesystem\" \"world\"", withAovs());
    const Pixel c(*camera, 1, 1), w(*world, 1, 1);
    expectNear(w.triple(Aov::Normal), {0, 0, -1}, 1e-6);
    expectNear(c.triple(Aov::Position), {0, 0, c.value(Aov::Depth)}, 1e-2);  // the middle of the picture is on the axis
    // A rotation leaves angles as they are; the axis of the camera is z there.
    const Vec3d axis = normalized(Vec3d{-3, -1, 9});
    EXPECT_NEAR(c.triple(Aov::Normal).z, dot(w.triple(Aov::Normal), axis), 1e-6);
    EXPECT_NEAR(c.triple(Aov::ShadingNormal).z, dot(w.triple(Aov::ShadingNormal), axis), 1e-6);
    EXPECT_NEAR(dot(c.triple(Aov::Normal), c.triple(Aov::ShadingNormal)), 0.8, 1e-6);
    EXPECT_TRUE(render("",
                       [] {
                           RenderOptions none;
                           none.build.aovs.emplace();
                           return none;
                       }())
                    ->film()
                    .aovs()
                    .empty());
}

class AovScenes : public testing::TestWithParam<const char*> {
protected:
    std::unique_ptr<RenderJob> render(const RenderOptions& options) const {
        const std::string text = std::string(GetParam()) == "Room" ? roomText() : motionText();
        return renderText(text, options, folder_.path());
    }
    SceneFolder folder_;
};

TEST_P(AovScenes, AreTheSameHoweverTheyAreRendered) {
    const auto reference = render(withAovs());
    EXPECT_FALSE(reference->film().aovs().empty());
    for (const int lanes : {1, 8})
        for (const int batchSize : {37, 1024}) {
            RenderOptions options = withAovs();
            options.controls.lanes = lanes;
            options.controls.batchSize = batchSize;
            options.tileSize = lanes == 1 ? 5 : 3;
            const ThreadLimit threads(lanes == 1 ? 3 : 2);
            EXPECT_TRUE(render(options)->film().aovs() == reference->film().aovs())
                << lanes << " lanes, batches of " << batchSize;
        }
}

TEST_P(AovScenes, ChangeNoBitOfThePictureAndCostNothingWhereNobodyAsks) {
    const auto with = render(withAovs()), without = render({});
    const std::size_t pixels = without->film().pixelCount();
    EXPECT_EQ(without->film().memoryBytes(), pixels * (sizeof(PixelSums) + sizeof(PixelSquares)));
    EXPECT_EQ(with->film().memoryBytes(), without->film().memoryBytes() + pixels * (kAovChannels * sizeof(ExactSum) + 4));
    EXPECT_EQ(with->counts().rays, without->counts().rays);
    for (std::size_t i = 0; i < pixels; ++i) {
        const PixelEstimate a = with->film().estimate(i), b = without->film().estimate(i);
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(a.mean[c], b.mean[c]);
            EXPECT_EQ(a.standardError[c], b.standardError[c]);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, AovScenes, testing::Values("Room", "Motion"),
                         [](const auto& info) { return std::string(info.param); });

TEST(AovSums, LeaveOutWhatCannotBeSummed) {
    AovSet set;
    set.add(Aov::Depth);
    set.add(Aov::Normal);
    AovSums sums(set, 1);
    AovValues values{};
    const std::size_t depth = aovKinds()[std::size_t(Aov::Depth)].first,
                      normal = aovKinds()[std::size_t(Aov::Normal)].first;
    for (const float z : {2.f, std::numeric_limits<float>::quiet_NaN(), kInfinity, 0x1p33f, 4.f}) {
        values[depth] = z;
        values[normal] = z < 3 ? 1.f : -1.f;
        values[0] = kInfinity;  // an albedo that nobody asked for
        sums.add(0, values, -1.f);
    }
    float out[4];
    sums.estimate(0, 5, 1, out);
    EXPECT_EQ(out[0], 0);  // two normals that point against each other have no direction
    EXPECT_EQ(out[3], 3);
}

class AovCommand : public testing::Test {
protected:
    const TemporaryFolder folder;
    const std::string scene = folder.file("scene.pbrt", kSmallScene);
    ProgramRun run(const std::string& picture, const std::vector<std::string>& options) const {
        std::vector<std::string> arguments{"render", scene, "-o", folder.path(picture)};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return runProgram(arguments);
    }
};

TEST_F(AovCommand, WritesTheChannelsThatAreAskedFor) {
    ASSERT_EQ(run("a.exr", {"--aov", "Z,uv"}).code, 0);
    std::vector<std::string> names;
    for (const ExrChannel& channel : readExr(folder.path("a.exr")).header.channels)
        names.push_back(channel.name);
    EXPECT_EQ(names,
              (std::vector<std::string>{"A", "B", "G", "R", "SE.B", "SE.G", "SE.R", "Z", "samples", "uv.U", "uv.V"}));
    ASSERT_EQ(run("b.exr", {"--aov", "all", "-t", "1"}).code, 0);
    ASSERT_EQ(run("c.exr", {"--aov", "albedo,N,Ns,P,Z,dzdx,dzdy,uv,time", "--lanes", "1"}).code, 0);
    const ExrFile all = readExr(folder.path("b.exr"));
    for (const char* name : {"albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z", "Ns.X", "Ns.Y", "Ns.Z", "P.X",
                             "P.Y", "P.Z", "Z", "dzdx", "dzdy", "uv.U", "uv.V", "time"})
        EXPECT_TRUE(all.find(name)) << name;
    EXPECT_EQ(readBytes(folder.path("b.exr")), readBytes(folder.path("c.exr")));
    EXPECT_TRUE(contains(readBytes(folder.path("a.exr")), " --aov Z,uv\""));
    // Shown by the layer's name.
    for (const char* layer : {"N", "uv", "Z"})
        EXPECT_EQ(runProgram({"convert", folder.path("b.exr"), folder.path("n.png"), "--layer", layer}).code, 0);
}

TEST_F(AovCommand, NamesTheNearestAndWarnsWhereNoChannelsAre) {
    EXPECT_EQ(run("a.exr", {"--aov", "N,albdo"}).err, "error: --aov: unknown name 'albdo'; did you mean 'albedo'?\n");
    for (const char* bad : {"", ",", "N,", "none,N"})
        EXPECT_EQ(run("a.exr", {"--aov", bad}).code, 64) << bad;
    EXPECT_TRUE(contains(run("a.png", {"--aov", "N"}).err, "a.png: only an EXR holds AOVs"));
    EXPECT_TRUE(contains(runProgram({"list", "aovs"}).out, "albedo"));
}

}  // namespace
}  // namespace penumbra
