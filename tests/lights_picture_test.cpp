// Pictures on area lights: where on the surface a colour stands, and what light the whole gives.
#include "tests/lights_cases.h"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

constexpr double kPiD = std::numbers::pi;

/// A picture whose red is its column and whose green is its row, both from 1.
EmissionPicture ruler(std::size_t width, std::size_t height, LightTables& tables) {
    std::vector<float> rgb;
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x)
            rgb.insert(rgb.end(), {float(x + 1), float(y + 1), 0.f});
    return makePicture(rgb, width, height, tables);
}

TEST(EmissionPictures, AreBilinearAndClampedWithTheTopRowAtTheEndOfV) {
    LightTables tables;
    tables.pictures.push_back(
        onTriangle(ruler(4, 2, tables), {{{1, 1, 5}, {3, 1, 5}, {1, 2, 5}}}, {{{0, 0}, {1, 0}, {0, 1}}}));
    EXPECT_FLOAT_EQ(tables.pictures[0].mean, (2.5f + 1.5f) / 3);
    const auto at = [&](float u, float v) { return pictureAt<float>(tables, 0u, {1 + 2 * u, 1 + v, 5}); };
    EXPECT_NEAR(at(0.125f, 0.25f).r, 1, 1e-6);  // the middle of the first pixel of the bottom row
    EXPECT_NEAR(at(0.125f, 0.25f).g, 2, 1e-6);
    EXPECT_NEAR(at(0.875f, 0.75f).r, 4, 1e-6);
    EXPECT_NEAR(at(0.875f, 0.75f).g, 1, 1e-6);
    EXPECT_NEAR(at(0.25f, 0.5f).r, 1.5, 1e-6);
    EXPECT_NEAR(at(0.25f, 0.5f).g, 1.5, 1e-6);
    for (const float beyond : {-3.f, 0.f, 0.1f})
        EXPECT_NEAR(at(beyond, 1.5f).r, 1, 1e-6);
    EXPECT_NEAR(at(7, -2).r, 4, 1e-6);
    EXPECT_NEAR(at(7, -2).g, 2, 1e-6);
    EXPECT_EQ(at(std::numeric_limits<float>::quiet_NaN(), 0.5f).r, 1.f) << "no place reads outside";
}

TEST(EmissionPictures, GoRoundDisksCylindersAndSpheres) {
    LightTables tables;
    const Matrix4 m = translation(0, 0, 7) * scaling(2, 2, 2);
    tables.pictures.push_back(onRound(ruler(360, 100, tables), EmissionPicture::Disk, m, 2 * kPiD, 1, 0.5));
    tables.pictures.push_back(onRound(ruler(360, 100, tables), EmissionPicture::Sphere, m, 2 * kPiD, kPiD, 0));
    tables.pictures.push_back(onRound(ruler(360, 100, tables), EmissionPicture::Cylinder, m, 2 * kPiD, -1, 1));
    for (const double degrees : {10., 100., 190., 300.}) {
        const double a = degrees * kPiD / 180;
        // On the ring v goes from 0 at the rim to 1 at the hole; the top row is v = 1.
        const Spectrum<float> disk = pictureAt<float>(tables, 0u, rounded({1.5 * std::cos(a), 1.5 * std::sin(a), 7}));
        EXPECT_NEAR(disk.r, degrees + 0.5, 1e-3);
        EXPECT_NEAR(disk.g, 50 + 0.5, 1e-3);
        const Spectrum<float> tube = pictureAt<float>(tables, 2u, rounded({2 * std::cos(a), 2 * std::sin(a), 7 + 0.5}));
        EXPECT_NEAR(tube.r, degrees + 0.5, 1e-3);
        EXPECT_NEAR(tube.g, 37.5 + 0.5, 1e-3);  // v = 5 / 8 from the bottom at z = 1 / 4
        const double theta = 0.3 * kPiD;
        const Spectrum<float> sphere = pictureAt<float>(
            tables, 1u,
            rounded({2 * std::sin(theta) * std::cos(a), 2 * std::sin(theta) * std::sin(a), 7 + 2 * std::cos(theta)}));
        EXPECT_NEAR(sphere.r, degrees + 0.5, 1e-3);
        EXPECT_NEAR(sphere.g, 30 + 0.5, 1e-3);
    }
}

TEST(EmissionPictures, CountInThePowerOfTheirLight) {
    for (const LightCase& c : LightCases<RectangleLight>::make(1)) {
        if (c.name != "rectangle with a picture") continue;
        EXPECT_NEAR(c.lights.power(0), kPiD * 4 * average(kTestRadiance) * c.lights.tables.pictures[0].mean, 1e-4);
        EXPECT_NEAR(c.lights.bounds(0)->intensity() * kPiD, c.lights.power(0), 1e-4);
        return;
    }
    FAIL();
}

}  // namespace
}  // namespace penumbra::test
