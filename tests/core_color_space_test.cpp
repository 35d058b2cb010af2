// Colour spaces, conversions between them, transfer functions.

#include "core/color/color_space.h"
#include "core/color/transfer.h"

#include <gtest/gtest.h>

#include <cmath>

namespace penumbra {
namespace {

void expectMatrix(const Matrix3& actual, const Matrix3& expected, double tolerance) {
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            EXPECT_NEAR(actual.m[row][column], expected.m[row][column], tolerance) << row << ", " << column;
}

TEST(ColorSpace, MatricesAreThoseOfTheFormat) {
    constexpr double kTolerance = 1e-5;  // white points and expected figures have six digits
    expectMatrix(
        findColorSpace("srgb")->rgbFromXyz,
        {{{{3.240444, -1.537134, -0.498530}, {-0.969267, 1.876012, 0.041556}, {0.055644, -0.204026, 1.057227}}}},
        kTolerance);
    expectMatrix(
        findColorSpace("dci-p3")->rgbFromXyz,
        {{{{2.493175, -0.931263, -0.402659}, {-0.829504, 1.762695, 0.023625}, {0.035854, -0.076189, 0.957094}}}},
        kTolerance);
    expectMatrix(
        findColorSpace("rec2020")->rgbFromXyz,
        {{{{1.716508, -0.355641, -0.253345}, {-0.666693, 1.616503, 0.015769}, {0.017644, -0.042780, 0.942306}}}},
        kTolerance);
    expectMatrix(findColorSpace("aces2065-1")->rgbFromXyz,
                 {{{{1.049820, 0, -0.000097}, {-0.495902, 1.373309, 0.098240}, {0, 0, 0.991262}}}}, kTolerance);
}

TEST(ColorSpace, NamesIgnoreCaseAndUnknownOnesAreNull) {
    EXPECT_EQ(findColorSpace("sRGB"), &srgbColorSpace());
    EXPECT_EQ(findColorSpace("ACES2065-1"), findColorSpace("aces2065-1"));
    EXPECT_EQ(findColorSpace("Rec2020")->name, "rec2020");
    EXPECT_EQ(findColorSpace("srgb "), nullptr);
    EXPECT_EQ(findColorSpace(""), nullptr);
    EXPECT_EQ(colorSpaceNames().size(), 4u);
}

TEST(ColorSpace, InversesAndWhites) {
    for (const std::string& name : colorSpaceNames()) {
        const ColorSpace& space = *findColorSpace(name);
        expectMatrix(space.rgbFromXyz * space.xyzFromRgb, Matrix3{}, 1e-14);
        EXPECT_NEAR(space.luminance({1, 1, 1}), 1, 1e-12);
        const Chromaticity white = chromaticityOf(space.toXyz({1, 1, 1}));
        EXPECT_NEAR(white.x, space.white.x, 1e-12);
        EXPECT_NEAR(white.y, space.white.y, 1e-12);
        EXPECT_NEAR(chromaticityOf(space.toXyz({0, 1, 0})).x, space.green.x, 1e-12);
    }
}

TEST(ColorSpace, LightKeepsItsColourAndReflectancesStayNeutral) {
    const ColorSpace &aces = *findColorSpace("aces2065-1"), &srgb = srgbColorSpace();
    const Rgb light = apply(lightConversion(aces, srgb), {1, 1, 1});
    EXPECT_NEAR(light.r, 1.0469f, 1e-4f);
    EXPECT_NEAR(light.g, 0.9946f, 1e-4f);
    EXPECT_NEAR(light.b, 0.9155f, 1e-4f);
    const Rgb neutral = apply(reflectanceConversion(aces, srgb), {0.5f, 0.5f, 0.5f});
    EXPECT_NEAR(neutral.r, 0.5f, 1e-6f);
    EXPECT_NEAR(neutral.g, 0.5f, 1e-6f);
    EXPECT_NEAR(neutral.b, 0.5f, 1e-6f);
    EXPECT_EQ(lightConversion(srgb, srgb), Matrix3{});
    const Rgb color{0.1f, 0.2f, 0.7f};
    EXPECT_EQ(apply(lightConversion(srgb, srgb), color), color);  // exactly
}

TEST(ColorSpace, IsFoundByRoundedPrimaries) {
    EXPECT_EQ(findColorSpace({0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}), &srgbColorSpace());
    EXPECT_EQ(findColorSpace({0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}, {0.32168, 0.33767})->name, "aces2065-1");
    EXPECT_EQ(findColorSpace({0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, {0.3127, 0.3290}), nullptr);  // Adobe RGB
}

TEST(TransferFunction, SrgbIsItsOwnInverseAndContinuous) {
    for (int i = 0; i <= 1000; ++i)
        EXPECT_NEAR(srgbFromLinear(linearFromSrgb(i / 1000.f)), i / 1000.f, 2e-6f);
    EXPECT_NEAR(linearFromSrgb(0.5f), 0.2140411f, 1e-6f);
    EXPECT_EQ(linearFromSrgb(0), 0);
    EXPECT_NEAR(linearFromSrgb(1), 1, 1e-7f);
    EXPECT_NEAR(linearFromSrgb(0.04045f), linearFromSrgb(std::nextafter(0.04045f, 1.f)), 1e-6f);
}

TEST(TransferFunction, ParsesWhatTexturesMayName) {
    EXPECT_EQ(TransferFunction::parse("sRGB"), TransferFunction::srgb());
    EXPECT_EQ(TransferFunction::parse("linear"), TransferFunction::linear());
    EXPECT_EQ(TransferFunction::parse("gamma 2.2"), TransferFunction::gamma(2.2f));
    EXPECT_EQ(TransferFunction::parse("gamma  1"), TransferFunction::gamma(1));
    for (const char* bad : {"", "gamma", "gamma ", "gamma x", "gamma 2.2x", "gamma -1", "gamma 0", "gamma nan",
                            "gamma inf", "srgb2", "log"})
        EXPECT_FALSE(TransferFunction::parse(bad)) << bad;
    EXPECT_NEAR(TransferFunction::gamma(2.2f).decode(0.5f), std::pow(0.5f, 2.2f), 1e-7f);
    EXPECT_EQ(TransferFunction::linear().decode(0.3f), 0.3f);
    EXPECT_EQ(TransferFunction::srgb().decodeTable()[128], linearFromSrgb(128 / 255.f));
    EXPECT_EQ(TransferFunction::gamma(2.5f).name(), "gamma 2.5");
}

}  // namespace
}  // namespace penumbra
