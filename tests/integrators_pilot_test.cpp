// The pilot of the path tracer's roulette: it measures what it says, alike for every crop window and sensor.
#include "integrators/pilot.h"

#include "integrators/registry.h"
#include "tests/integrators_fixture.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

using namespace test;

float pilot(const std::string& filmParameters, const std::string& world) {
    const auto job = prepareText("Camera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 60 \"integer yresolution\" 40 " +
                                 filmParameters + "\nIntegrator \"direct\"\nWorldBegin\n" + world);
    return typicalRadiance(job->scene(), *makeIntegrator(job->scene()));
}

const std::string kSky = "LightSource \"infinite\" \"rgb L\" [ 2 2 2 ]\n";
const std::string kHalf = "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\nTranslate 0 -1e4 1\nShape \"trianglemesh\" \"point3 P\" "
                          "[ -1e4 0 0  1e4 0 0  1e4 1e4 0  -1e4 1e4 0 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n";

TEST(Pilot, IsTheRadianceOfAnEvenPicture) {
    EXPECT_NEAR(pilot("", kSky), 2, 1e-4);
    EXPECT_EQ(pilot("", scoped("Translate 0 0 -9\nLightSource \"point\"\n")), 0);
}

TEST(Pilot, IsTheSquaredMeanOfTheRoot) {
    // Black below the horizon: half of the grid's tiles, up to the pixel filter's reach.
    EXPECT_NEAR(pilot("", kSky + kHalf), 2 * 0.25, 0.05);
}

TEST(Pilot, DoesNotDependOnTheCropOrTheSensor) {
    const float whole = pilot("", kSky + kHalf);
    EXPECT_EQ(pilot("\"integer pixelbounds\" [ 3 9 30 40 ]", kSky + kHalf), whole);
    EXPECT_NEAR(pilot("\"float iso\" 800", kSky + kHalf), whole, 1e-4);
}

}  // namespace
}  // namespace penumbra
