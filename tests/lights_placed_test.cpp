// The lights that shine from a point with a pattern of their own (spot, goniometric, projection): where their light
// goes, and that all of it is their power.
#include "tests/lights_cases.h"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

constexpr double kPiD = std::numbers::pi;
const Spectrum<float> kOne = {1.f, 1.f, 1.f};

/// The intensity towards the direction w of a light at `place`.
Spectrum<float> intensity(const LightTable& lights, Vec3d place, Vec3d w, double distance = 1) {
    const auto s = sampleLight<float>(lights, 0, rounded(place + w * (distance / length(w))), {0.f, 0.f});
    return s.L * float(distance * distance);
}

/// The mean of the channels' intensity, times 4 pi, over directions that know the sphere evenly (a lattice of the
/// golden ratio on the cylinder).
double fluxOverSphere(const LightTable& lights, Vec3d place, int directions) {
    double sum = 0;
    for (int i = 0; i < directions; ++i) {
        const double z = 1 - (2 * i + 1.0) / directions, phi = 2 * kPiD * std::fmod(i * 0.6180339887498949, 1);
        const double r = std::sqrt(1 - z * z);
        sum += average(intensity(lights, place, {r * std::cos(phi), r * std::sin(phi), z}));
    }
    return 4 * kPiD * sum / directions;
}

double smoothStep(double t) {
    return t * t * (3 - 2 * t);
}

TEST(SpotLights, FallOffInTheCosineBetweenTheCones) {
    LightTable lights;
    lights.add(SpotLight::make(Matrix4{}, {1, 2, 3}, {0, 0, 7}, 25, 30, kOne));
    const auto at = [&](double degrees) {
        const double a = degrees * kPiD / 180;
        return intensity(lights, {1, 2, 3}, {std::sin(a) * 0.6, std::sin(a) * 0.8, std::cos(a)}).r;
    };
    const double inner = std::cos(25 * kPiD / 180), outer = std::cos(30 * kPiD / 180);
    EXPECT_NEAR(at(0), 1, 1e-6);
    EXPECT_NEAR(at(24.9), 1, 1e-5);
    for (const double degrees : {25.5, 26.0, 27.0, 28.5, 29.5}) {
        const double t = (std::cos(degrees * kPiD / 180) - outer) / (inner - outer);
        EXPECT_NEAR(at(degrees), smoothStep(t), 3e-5) << degrees;
    }
    for (const double degrees : {30.01, 60.0, 120.0, 180.0})
        EXPECT_EQ(at(degrees), 0) << degrees;
}

TEST(SpotLights, WithoutAFallOffHaveAnEdge) {
    LightTable lights;
    lights.add(SpotLight::make(Matrix4{}, {0, 0, 0}, {1, 0, 0}, 40, 40, kOne));
    EXPECT_NEAR(intensity(lights, {}, {std::cos(0.698), std::sin(0.698), 0}).g, 1, 1e-6);
    EXPECT_EQ(intensity(lights, {}, {std::cos(0.6983), std::sin(0.6983), 0}).g, 0);
}

TEST(SpotLights, NarrowBeamsAreRound) {
    // A hundredth of a degree: cosines in single precision have no digit left for it.
    LightTable lights;
    lights.add(SpotLight::make(Matrix4{}, {0, 0, 0}, {0.3, -0.5, 0.8}, 0.005, 0.01, kOne));
    const Vec3d axis = Vec3d{0.3, -0.5, 0.8} * (1 / std::sqrt(0.98)),
                x = {0.8 / std::sqrt(0.73), 0, -0.3 / std::sqrt(0.73)};
    for (const auto& [degrees, expected] : {std::pair{0.004, 1.0}, {0.0075, smoothStep(0.5833)}, {0.011, 0.0}})
        EXPECT_NEAR(intensity(lights, {}, axis + x * std::tan(degrees * kPiD / 180)).r, expected, 2e-2) << degrees;
}

TEST(SpotLights, TurnAndStretchWithTheirMatrix) {
    LightTable lights;
    lights.add(SpotLight::make(translation(0, 0, 5) * rotation(90, 0, 1, 0) * scaling(2, 2, 2), {0, 0, 1}, {0, 0, 1},
                               30, 30, kOne));
    // Rotation by 90 degrees about y takes z to x: the light is at (2, 0, 5) and shines to +x.
    EXPECT_FLOAT_EQ(intensity(lights, {2, 0, 5}, {1, 0.5, 0}).r, 1);
    EXPECT_EQ(intensity(lights, {2, 0, 5}, {0, 0, 1}).r, 0);

    LightTable wide;
    wide.add(SpotLight::make(scaling(3, 1, 1), {0, 0, 0}, {0, 0, 1}, 30, 30, kOne));
    EXPECT_NEAR(intensity(wide, {}, {std::tan(0.5) * 2.9, 0, 1}).r, 1, 1e-6);  // 0.5 < 30 degrees = 0.5236
    EXPECT_EQ(intensity(wide, {}, {0, std::tan(0.5) * 2.9, 1}).r, 0);
    EXPECT_THROW(SpotLight::make(scaling(1, 0, 1), {}, {0, 0, 1}, 1, 2, kOne), Error);
}

TEST(SpotLights, PowerIsAllTheirLight) {
    for (const auto& [inner, outer] : {std::pair{25.0, 30.0}, {0.0, 80.0}, {100.0, 170.0}, {180.0, 180.0}}) {
        LightTable lights;
        lights.add(SpotLight::make(rotation(20, 1, 1, 0), {0, 0, 0}, {0, 1, 2}, inner, outer, kTestRadiance));
        EXPECT_NEAR(fluxOverSphere(lights, {}, 200000) / lights.power(0), 1, 2e-4) << outer;
    }
}

/// The pixel of a 3 x 3 image with values 1 to 9 (row by row) towards each axis: +y its centre, y and z swapped.
TEST(GoniometricLights, PutTheAxisYInTheCentreOfTheImage) {
    LightTable lights;
    const std::vector<float> image = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    lights.add(GoniometricLight::make(Matrix4{}, image, 3, kOne, lights.tables));
    EXPECT_FLOAT_EQ(intensity(lights, {}, {0, 1, 0}).r, 5);
    EXPECT_FLOAT_EQ(intensity(lights, {}, {1, 0, 0}).r, 6);
    EXPECT_FLOAT_EQ(intensity(lights, {}, {-1, 0, 0}).r, 4);
    EXPECT_FLOAT_EQ(intensity(lights, {}, {0, 0, 1}).r, 8);
    EXPECT_FLOAT_EQ(intensity(lights, {}, {0, 0, -1}).r, 2);
    EXPECT_FLOAT_EQ(intensity(lights, {}, {0.1, -1, 0.1}).r, 9);
    EXPECT_FLOAT_EQ(intensity(lights, {}, {-0.1, -1, 0.1}).r, 7);
    EXPECT_FLOAT_EQ(intensity(lights, {}, {0.1, -1, -0.1}, 3).r, 3);
}

TEST(GoniometricLights, PowerIsAllTheirLight) {
    LightTable lights;
    std::vector<float> image(16 * 16, 0.1f);
    image[37] = 20.f;
    image[200] = -3.f;
    image[201] = std::numeric_limits<float>::quiet_NaN();
    lights.add(
        GoniometricLight::make(translation(1, 2, 3) * rotation(70, 2, 1, 0), image, 16, kTestRadiance, lights.tables));
    EXPECT_NEAR(lights.power(0), 4 * kPiD * (253 * 0.1 + 20) / 256 * average(kTestRadiance), 1e-3);
    EXPECT_NEAR(fluxOverSphere(lights, {1, 2, 3}, 200000) / lights.power(0), 1, 2e-3);
}

TEST(ProjectionLights, ShowTheImageUpright) {
    LightTable lights;
    // Red, blue, red over three greens: three columns, so that 90 degrees over the two rows leave 1.5 to each side.
    const std::vector<float> rgb = {1, 0, 0, 0, 0, 1, 2, 0, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0};
    lights.add(ProjectionLight::make(Matrix4{}, rgb, 3, 2, 90, 2.f, lights.tables));
    const auto at = [&](double x, double y) { return intensity(lights, {}, {x, y, 1}); };
    EXPECT_NEAR(at(-1.4, 0.9).r, 2, 1e-5);   // the top left pixel
    EXPECT_NEAR(at(0, 0.1).b, 2, 1e-5);      // the top middle
    EXPECT_NEAR(at(1.4, 0.9).r, 4, 1e-5);    // the top right
    EXPECT_NEAR(at(-1.4, -0.9).g, 4, 1e-5);  // the bottom left
    EXPECT_NEAR(at(1.4, -0.1).g, 8, 1e-5);   // the bottom right
    for (const auto& [x, y] : {std::pair{0.0, 1.01}, {0.0, -1.01}, {1.51, 0.0}, {-1.51, 0.0}})
        EXPECT_TRUE(isBlack(at(x, y))) << x << ' ' << y;
    EXPECT_TRUE(isBlack(intensity(lights, {}, {0.1, 0.1, -1})));
    EXPECT_TRUE(isBlack(intensity(lights, {}, {1, 0, 0})));
}

TEST(ProjectionLights, PowerIsAllTheirLight) {
    LightTable lights;
    // Many pixels: the power takes each pixel's solid angle at its middle.
    std::vector<float> rgb(3 * 60 * 90);
    for (std::size_t i = 0; i < rgb.size(); ++i)
        rgb[i] = float(i % 11);
    lights.add(ProjectionLight::make(rotation(30, 1, 0, 2), rgb, 90, 60, 70, 0.5f, lights.tables));
    EXPECT_NEAR(fluxOverSphere(lights, {}, 1000000) / lights.power(0), 1, 3e-3);
}

TEST(PlacedLights, DoNotShineOnThemselves) {
    forEachType(TypeList<PointLight, SpotLight, GoniometricLight, ProjectionLight>{}, [&]<class T>() {
        for (const LightCase& c : LightCases<T>::make(1)) {
            const Vec3<float> place = c.lights.rows<T>()[0].position;
            EXPECT_FALSE(sampleLight<float>(c.lights, 0, place, {0.f, 0.f}).valid) << c.name;
        }
    });
}

}  // namespace
}  // namespace penumbra::test
