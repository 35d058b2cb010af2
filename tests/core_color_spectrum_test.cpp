// Spectra and their colours, against figures computed with the full 1 nm tables of the standards.

#include "core/color/spectrum.h"

#include "tests/expect_error.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace penumbra {
namespace {

void expectNear(Rgb actual, Rgb expected, float tolerance, const std::string& what) {
    EXPECT_NEAR(actual.r, expected.r, tolerance) << what;
    EXPECT_NEAR(actual.g, expected.g, tolerance) << what;
    EXPECT_NEAR(actual.b, expected.b, tolerance) << what;
}

SampledSpectrum builtin(const std::string& name) {
    const SampledSpectrum* found = findBuiltinSpectrum(name);
    if (!found) throw Error(ErrorKind::Internal, "no spectrum " + name);
    return *found;
}

struct BlackbodyCase {
    double kelvin;
    Rgb light;  // luminance 1
    Rgb peak;   // Planck curve of peak 1
};
constexpr BlackbodyCase kBlackbodies[] = {
    {1500, {3.26402f, 0.43412f, -0.06421f}, {1.189f, 0.158f, -0.023f}},
    {2000, {2.51986f, 0.64688f, 0.02043f}, {13.055f, 3.351f, 0.106f}},
    {2700, {1.93479f, 0.80357f, 0.19184f}, {57.13f, 23.73f, 5.66f}},
    {3000, {1.77064f, 0.84428f, 0.27214f}, {78.71f, 37.53f, 12.10f}},
    {3500, {1.56403f, 0.89225f, 0.40564f}, {107.93f, 61.57f, 27.99f}},
    {4000, {1.41377f, 0.92403f, 0.53355f}, {124.77f, 81.55f, 47.09f}},
    {5000, {1.21332f, 0.96053f, 0.76253f}, {127.43f, 100.88f, 80.09f}},
    {6000, {1.08867f, 0.97836f, 0.95314f}, {109.67f, 98.56f, 96.02f}},
    {6500, {1.04321f, 0.98359f, 1.03522f}, {98.75f, 93.11f, 98.00f}},
    {8000, {0.94708f, 0.99176f, 1.23763f}, {68.69f, 71.93f, 89.76f}},
    {10000, {0.87182f, 0.99462f, 1.43102f}, {41.33f, 47.15f, 67.84f}},
};

TEST(Spectrum, BlackbodyAsALightHasItsColourAtLuminanceOne) {
    for (const BlackbodyCase& c : kBlackbodies) {
        const Rgb rgb = illuminantToRgb(blackbodySpectrum(c.kelvin), srgbColorSpace(), "test");
        expectNear(rgb, c.light, 2e-5f, std::to_string(c.kelvin));
        EXPECT_NEAR(srgbColorSpace().luminance(rgb), 1, 1e-6);
    }
}

TEST(Spectrum, BlackbodyPeaksAtOne) {
    for (const BlackbodyCase& c : kBlackbodies)
        expectNear(srgbColorSpace().fromXyz(xyzSum(blackbodySpectrum(c.kelvin))), c.peak, 0.006f,
                   std::to_string(c.kelvin));
    EXPECT_NEAR(blackbodySpectrum(2.8977721e-3 / 600e-9).at(600), 1, 1e-9);
}

TEST(Spectrum, IlluminantsHaveTheirColours) {
    const ColorSpace& srgb = srgbColorSpace();
    expectNear(illuminantToRgb(constantSpectrum(5), srgb, ""), {1.20488f, 0.94824f, 0.90920f}, 2e-5f, "equal energy");
    expectNear(illuminantToRgb(builtin("stdillum-A"), srgb, ""), {1.84504f, 0.82607f, 0.23337f}, 2e-5f, "A");
    expectNear(illuminantToRgb(builtin("stdillum-D50"), srgb, ""), {1.08658f, 0.99951f, 0.74971f}, 2e-5f, "D50");
    expectNear(illuminantToRgb(builtin("stdillum-D65"), srgb, ""), {1, 1, 1}, 2e-5f, "D65");
    expectNear(illuminantToRgb(builtin("stdillum-F2"), srgb, ""), {1.34006f, 0.94299f, 0.56285f}, 2e-5f, "F2");
    expectNear(illuminantToRgb(builtin("stdillum-F7"), srgb, ""), {1.00031f, 1.00017f, 0.99740f}, 2e-5f, "F7");
    expectNear(illuminantToRgb(builtin("stdillum-F11"), srgb, ""), {1.41209f, 0.92473f, 0.53156f}, 2e-5f, "F11");
    expectNear(illuminantToRgb(builtin("illum-acesD60"), *findColorSpace("aces2065-1"), ""), {1, 1, 1}, 2e-5f, "D60");
}

TEST(Spectrum, ObserverSumsToTheConstantOfTheFormat) {
    EXPECT_NEAR(xyzSum(constantSpectrum(1))[1], kYbarSum, 2e-4);
}

TEST(Spectrum, DaylightOf6500IsD65) {
    const Chromaticity xy = chromaticityOf(xyzSum(daylightSpectrum(6500))), white = srgbColorSpace().white;
    EXPECT_NEAR(xy.x, white.x, 1e-4);
    EXPECT_NEAR(xy.y, white.y, 1e-4);
    const SampledSpectrum cool = daylightSpectrum(3000);  // too low for daylight
    EXPECT_NEAR(cool.at(560) / cool.at(500),
                blackbodySpectrum(3000 * 1.4388 / 1.4380).at(560) / blackbodySpectrum(3000 * 1.4388 / 1.4380).at(500),
                1e-12);
}

TEST(Spectrum, NeutralReflectanceIsNeutralInEverySpace) {
    for (const std::string& name : colorSpaceNames())
        expectNear(reflectanceToRgb(constantSpectrum(0.37), *findColorSpace(name)), {0.37f, 0.37f, 0.37f}, 1e-6f, name);
}

TEST(Spectrum, PairsAreLinearBetweenAndZeroOutside) {
    const float pairs[] = {400, 1, 410, 3, 500.5f, 3, 501.5f, 5};
    const SampledSpectrum s = piecewiseLinearSpectrum(pairs, "test");
    EXPECT_EQ(s.at(399), 0);
    EXPECT_EQ(s.at(400), 1);
    EXPECT_NEAR(s.at(405), 2, 1e-12);
    EXPECT_EQ(s.at(410), 3);
    EXPECT_NEAR(s.at(450), 3, 1e-12);
    EXPECT_NEAR(s.at(501), 4, 1e-12);
    EXPECT_EQ(s.at(502), 0);
    const float wide[] = {100, 2, 2000, 2};
    EXPECT_EQ(piecewiseLinearSpectrum(wide, "test").at(360), 2);
    EXPECT_EQ(piecewiseLinearSpectrum(wide, "test").at(830), 2);
    const float single[] = {555, 7};
    EXPECT_EQ(piecewiseLinearSpectrum(single, "test").at(555), 7);
    EXPECT_EQ(piecewiseLinearSpectrum(single, "test").at(554), 0);
}

TEST(Spectrum, BadPairsAreRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto refused = [](std::vector<float> pairs) {
        return messageOf([&] { piecewiseLinearSpectrum(pairs, "scene:1:2"); });
    };
    EXPECT_EQ(refused({}).find("scene:1:2: "), 0u);
    EXPECT_NE(refused({400, 1, 500}).find("3 numbers"), std::string::npos);
    EXPECT_NE(refused({500, 1, 400, 1}).find("400 nm follows 500 nm"), std::string::npos);
    EXPECT_NE(refused({500, 1, 500, 1}).find("have to rise"), std::string::npos);
    EXPECT_NE(refused({400, nan}).find("not finite"), std::string::npos);
    EXPECT_NE(refused({nan, 1}).find("not finite"), std::string::npos);
    EXPECT_NE(refused({-5, 1}).find("not above 0"), std::string::npos);
}

TEST(Spectrum, FileWithCommentsGivesTheSameAsItsNumbers) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.spd", "# measured 1998\r\n400 0.5 # low\r\n\t500,1.5\n\n600\n+2.5e0");
    const float pairs[] = {400, 0.5f, 500, 1.5f, 600, 2.5f};
    EXPECT_EQ(readSpectrumFile(path).values, piecewiseLinearSpectrum(pairs, "").values);
}

TEST(Spectrum, BadFilesNameTheirPlace) {
    const TemporaryFolder folder;
    const auto refused = [&](std::string_view text) {
        const std::string path = folder.file("bad.spd", text);
        const std::string message = messageOf([&] { readSpectrumFile(path); });
        EXPECT_EQ(message.find(path), 0u) << message;
        return message.substr(path.size());
    };
    EXPECT_EQ(refused("400 1\n500 abc\n").find(":2:5: expected a finite number, found 'abc'"), 0u);
    EXPECT_EQ(refused("400 nan\n").find(":1:5: "), 0u);
    EXPECT_EQ(refused("400 inf\n").find(":1:5: "), 0u);
    EXPECT_EQ(refused("400 1e999\n").find(":1:5: "), 0u);
    EXPECT_EQ(refused("400 1 500x 2").find(":1:7: "), 0u);
    EXPECT_NE(refused("").find("there are 0 numbers"), std::string::npos);
    EXPECT_NE(refused("# nothing\n").find("there are 0 numbers"), std::string::npos);
    EXPECT_NE(refused("400 1 500").find("there are 3 numbers"), std::string::npos);
    EXPECT_EQ(refused(std::string_view("\0\0\0\0", 4)).find(":1:1: "), 0u);
    EXPECT_NE(refused(std::string(9 << 20, ' ')).find("too large"), std::string::npos);
    messageOf([&] { readSpectrumFile(folder.path("missing.spd")); }, ErrorKind::MissingInput);
    messageOf([&] { readSpectrumFile(folder.path("")); }, ErrorKind::MissingInput);
}

TEST(Spectrum, AllBuiltinNamesOfTheFormatExist) {
    EXPECT_EQ(builtinSpectrumNames().size(), 37u);
    for (const char* metal : {"Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"})
        for (const char* part : {"eta", "k"})
            EXPECT_TRUE(findBuiltinSpectrum(std::string("metal-") + metal + "-" + part));
    for (const char* glass : {"BK7", "BAF10", "FK51A", "LASF9", "F5", "F10", "F11"})
        EXPECT_TRUE(findBuiltinSpectrum(std::string("glass-") + glass));
    for (int i = 1; i <= 12; ++i)
        EXPECT_TRUE(findBuiltinSpectrum("stdillum-F" + std::to_string(i)));
    EXPECT_FALSE(findBuiltinSpectrum("glass-SF10"));
    EXPECT_FALSE(findBuiltinSpectrum(""));
}

TEST(Spectrum, DarkSpectraAreNoLights) {
    messageOf([] { illuminantToRgb(constantSpectrum(0), srgbColorSpace(), "L"); });
    messageOf([] { illuminantToRgb(blackbodySpectrum(1), srgbColorSpace(), "L"); });
}

}  // namespace
}  // namespace penumbra
