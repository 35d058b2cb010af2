// A limit on samples (--clamp, the film's maxcomponentvalue): the bias is what it says it is, and without it nothing changes.
#include "app/batch/recipe.h"
#include "app/batch/statistics.h"
#include "tests/integrators_fixture.h"
#include "tests/run_program.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra {
namespace {

using namespace test;

/// Four pixels; the left half of each shows (10, 8, 2), the right half (1, 1, 1). The samplers' points are spread so evenly that
/// exactly half of them fall on either side.
std::string stripes(const std::string& filmParameters = "") {
    return "Camera \"orthographic\" \"float screenwindow\" [ 0 2 0 2 ]\n" + film(2, 2) + filmParameters + R"(
PixelFilter "box"
Sampler "sobol" "integer pixelsamples" 64
Integrator "path" "integer maxdepth" 1
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
AreaLightSource "diffuse" "rgb L" [ 10 8 2 ] "bool twosided" true
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
Shape "trianglemesh" "point3 P" [ 0 0 1  .5 0 1  .5 2 1  0 2 1  1 0 1  1.5 0 1  1.5 2 1  1 2 1 ]
  "integer indices" [ 0 1 2 0 2 3 4 5 6 4 6 7 ]
)";
}

RenderOptions clampedTo(float limit) {
    RenderOptions options;
    options.build.clamp = limit;
    return options;
}

TEST(Clamp, BiasIsWhatTheClosedFormSays) {
    const auto job = renderText(stripes(), clampedTo(4)), whole = renderText(stripes());
    const double limited[] = {4, 3.2, 0.8}, light[] = {10, 8, 2};
    const ClampBias bias = clampBias(*job);
    EXPECT_EQ(bias.samples, 4u * 64 / 2);
    double lost = 0, all = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        lost += (light[c] - limited[c]) / 2;
        all += (light[c] + 1) / 2;
        EXPECT_NEAR(bias.meanLost[c], (light[c] - limited[c]) / 2, 1e-6);
        for (std::size_t pixel = 0; pixel < 4; ++pixel) {
            EXPECT_NEAR(job->film().estimate(pixel).mean[c], (limited[c] + 1) / 2, 1e-6);
            EXPECT_NEAR(job->film().estimate(pixel).mean[c] + bias.meanLost[c], whole->film().estimate(pixel).mean[c], 1e-6);
        }
    }
    const PictureError error = pictureError(job->film());
    EXPECT_NEAR(bias.relativeTo(error.mean), lost / all, 1e-6);
    EXPECT_EQ(clampText(bias, error), "128 samples limited to 4: a bias; on average the picture is too dark by 52 %");
    EXPECT_EQ(clampBias(*whole).samples, 0u);
}

/// One mechanism: the option stands for the film's parameter, and takes its place.
TEST(Clamp, IsTheFilmsMaxComponentValue) {
    const std::string limited = "\"float maxcomponentvalue\" 3\n";
    const auto byFilm = renderText(stripes(limited)), byOption = renderText(stripes(), clampedTo(3));
    EXPECT_TRUE(byFilm->film() == byOption->film());
    EXPECT_EQ(clampBias(*byFilm).samples, clampBias(*byOption).samples);
    EXPECT_TRUE(renderText(stripes(limited), clampedTo(4))->film() == renderText(stripes(), clampedTo(4))->film());
    EXPECT_TRUE(renderText(stripes(limited), clampedTo(kInfinity))->film() == renderText(stripes())->film());
}

TEST(Clamp, LeavesWhatIsWithinTheLimitToTheBit) {
    const SceneFolder folder;
    const auto plain = renderText(roomText(), {}, folder.path());
    const auto off = renderText(roomText(), clampedTo(kInfinity), folder.path());
    const auto wide = renderText(roomText(), clampedTo(1e8f), folder.path());
    EXPECT_TRUE(off->film() == plain->film());
    EXPECT_TRUE(wide->film() == plain->film());
    EXPECT_EQ(clampBias(*wide).samples, 0u);
    EXPECT_FALSE(nlohmann::json::parse(recipeJson(*plain)).contains("clamp"));
}

/// The room's filter has negative lobes, so some of what is lost counts negative.
TEST(Clamp, IsTheSameForAnyLanesAndTilesAndAddsUpToThePicture) {
    const SceneFolder folder;
    RenderOptions narrow = clampedTo(0.5f);
    narrow.build.roulette = RouletteRule::Off;
    RenderOptions wide = narrow, unlimited = narrow;
    narrow.controls.lanes = 1;
    narrow.controls.batchSize = 37;
    narrow.tileSize = 5;
    unlimited.build.clamp.reset();
    const auto a = renderText(roomText(), wide, folder.path()), b = renderText(roomText(), narrow, folder.path());
    const auto whole = renderText(roomText(), unlimited, folder.path());
    EXPECT_TRUE(a->film() == b->film());
    const ClampBias bias = clampBias(*a), other = clampBias(*b);
    EXPECT_GT(bias.samples, 100u);
    EXPECT_EQ(bias.samples, other.samples);
    EXPECT_EQ(bias.meanLost, other.meanLost);
    for (std::size_t c = 0; c < 3; ++c) {
        double limitedMean = 0, mean = 0;
        const std::size_t pixels = a->film().pixelCount();
        for (std::size_t i = 0; i < pixels; ++i) {
            limitedMean += a->film().estimate(i).mean[c] / double(pixels);
            mean += whole->film().estimate(i).mean[c] / double(pixels);
        }
        EXPECT_NEAR(limitedMean + bias.meanLost[c], mean, 1e-6 * mean);
    }
}

class ClampCommand : public testing::Test {
protected:
    const TemporaryFolder folder;
    const std::string scene = folder.file("scene.pbrt", stripes());
    ProgramRun run(std::vector<std::string> options) const {
        options.insert(options.begin(), {"render", scene, "-o", folder.path("a.exr")});
        return runProgram(options);
    }
};

TEST_F(ClampCommand, IsAnnouncedAndRepeated) {
    const ProgramRun told = run({"--clamp", "4", "--stats=json"});
    EXPECT_EQ(told.code, 0) << told.err;
    EXPECT_TRUE(contains(told.err, "\n128 samples limited to 4: a bias; ")) << told.err;
    const nlohmann::json statistics = nlohmann::json::parse(told.out), recipe = statistics.at("recipe");
    EXPECT_TRUE(contains(recipe.at("command"), " --clamp 4"));
    EXPECT_EQ(recipe.at("clamp").at("limit"), 4);
    EXPECT_EQ(statistics.at("bias").at("clamp").at("mean_lost"), recipe.at("clamp").at("mean_lost"));
    EXPECT_NEAR(statistics.at("bias").at("clamp").at("relative").get<double>(), 6 / 11.5, 1e-6);
    EXPECT_NEAR(recipe.at("clamp").at("mean_lost").at(0).get<double>(), 3, 1e-6);
    EXPECT_TRUE(contains(run({"--clamp", "4", "--stats", "--quiet"}).err, "clamped            128 samples"));
    EXPECT_TRUE(contains(run({"--clamp", "off", "--stats=json"}).out, " --clamp off\""));
}

TEST_F(ClampCommand, AReplayedSampleSaysWhatItWas) {
    // The first of the two kinds of samples is found by its value.
    int limited = 0;
    for (int sample = 0; sample < 8; ++sample) {
        const ProgramRun replay = run({"--clamp", "4", "--pixel", "0,0", "--sample", std::to_string(sample)});
        EXPECT_EQ(replay.code, 0) << replay.err;
        const bool isLight = replay.out.starts_with("4 ");
        limited += isLight;
        EXPECT_EQ(contains(replay.err, "warning: the sample is limited to 4: it was 10 8 2"), isLight) << replay.err;
        if (!isLight) {
            EXPECT_EQ(replay.out, "1 1 1\n");
        }
    }
    EXPECT_GT(limited, 0);
    EXPECT_LT(limited, 8);
}

TEST_F(ClampCommand, TakesANumberAboveZeroOrOff) {
    for (const char* bad : {"0", "-1", "nan", "inf", "1e300", "4x", "", "on"}) {
        const ProgramRun refused = run({"--clamp", bad});
        EXPECT_EQ(refused.code, 64) << bad;
        EXPECT_TRUE(contains(refused.err, "error: --clamp: ")) << refused.err;
    }
}

}  // namespace
}  // namespace penumbra
