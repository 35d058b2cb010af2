// Spectrum parameters of scenes, the film's sensor, and conductors fitted to three channels.

#include "core/color/conductor_fit.h"
#include "core/color/sensor.h"
#include "core/color/spectrum_parameter.h"
#include "tests/expect_error.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace penumbra {
namespace {

Parameter numbersParameter(std::string type, std::string name, std::vector<float> values, std::string space = "srgb") {
    Parameter p;
    p.type = std::move(type);
    p.name = std::move(name);
    p.where = {0, 7, 3};
    p.values = std::move(values);
    p.colorSpace = std::move(space);
    return p;
}

Parameter namedParameter(std::string name, std::string spectrum) {
    Parameter p = numbersParameter("spectrum", std::move(name), {});
    p.values = std::vector<std::string>{std::move(spectrum)};
    return p;
}

class SpectrumParameter : public testing::Test {
protected:
    Rgb read(const Parameter& p, SpectrumRole role) {
        return readSpectrumParameter(p, role, context, "material 'wall'");
    }
    std::string refused(const std::function<void()>& work, ErrorKind kind = ErrorKind::BadData) {
        const std::string message = messageOf(work, kind);
        EXPECT_EQ(message.find("scene.pbrt:7:3: "), 0u) << message;
        return message;
    }
    std::string refused(const Parameter& p, SpectrumRole role, ErrorKind kind = ErrorKind::BadData) {
        return refused([&] { read(p, role); }, kind);
    }

    TemporaryFolder folder;
    std::vector<std::string> files{"scene.pbrt"};
    Warnings warnings;
    SpectrumContext context{srgbColorSpace(), files, [this](const std::string& name) { return folder.path(name); },
                            warnings};
};

void expectNear(Rgb actual, Rgb expected, float tolerance) {
    EXPECT_NEAR(actual.r, expected.r, tolerance);
    EXPECT_NEAR(actual.g, expected.g, tolerance);
    EXPECT_NEAR(actual.b, expected.b, tolerance);
}

TEST_F(SpectrumParameter, RgbIsTheNumbersThemselves) {
    const Rgb color{0.2f, 0.3f, 0.8f};
    for (const SpectrumRole role : {SpectrumRole::Albedo, SpectrumRole::Unbounded, SpectrumRole::Illuminant})
        EXPECT_EQ(read(numbersParameter("rgb", "c", {0.2f, 0.3f, 0.8f}), role), color);
    EXPECT_EQ(read(numbersParameter("rgb", "L", {20, 30, 40}), SpectrumRole::Illuminant), (Rgb{20, 30, 40}));
}

TEST_F(SpectrumParameter, RgbOfAnotherSpaceIsConvertedByItsRole) {
    expectNear(read(numbersParameter("rgb", "L", {1, 1, 1}, "aces2065-1"), SpectrumRole::Illuminant),
               {1.0469f, 0.9946f, 0.9155f}, 1e-4f);
    expectNear(read(numbersParameter("rgb", "reflectance", {1, 1, 1}, "aces2065-1"), SpectrumRole::Albedo), {1, 1, 1},
               1e-6f);
    const Rgb red = read(numbersParameter("rgb", "reflectance", {1, 0, 0}, "rec2020"), SpectrumRole::Albedo);
    EXPECT_EQ(red, (Rgb{1, 0, 0}));  // outside of sRGB: clamped
    EXPECT_LT(read(numbersParameter("rgb", "L", {1, 0, 0}, "rec2020"), SpectrumRole::Illuminant).g,
              0);  // light is kept
}

TEST_F(SpectrumParameter, BlackbodyAndSpectrumLightsHaveLuminanceOne) {
    expectNear(read(numbersParameter("blackbody", "L", {3000}), SpectrumRole::Illuminant),
               {1.77064f, 0.84428f, 0.27214f}, 2e-5f);
    expectNear(read(numbersParameter("spectrum", "L", {300, 5, 900, 5}), SpectrumRole::Illuminant),
               {1.20488f, 0.94824f, 0.90920f}, 2e-5f);
    expectNear(read(namedParameter("L", "stdillum-A"), SpectrumRole::Illuminant), {1.84504f, 0.82607f, 0.23337f},
               2e-5f);
}

TEST_F(SpectrumParameter, ReflectanceSpectrumIsSeenUnderTheWhiteOfTheFilm) {
    expectNear(read(numbersParameter("spectrum", "reflectance", {300, 0.25f, 900, 0.25f}), SpectrumRole::Albedo),
               {0.25f, 0.25f, 0.25f}, 1e-6f);
    folder.file("grey.spd", "300 0.5\n900 0.5\n");
    expectNear(read(namedParameter("reflectance", "grey.spd"), SpectrumRole::Albedo), {0.5f, 0.5f, 0.5f}, 1e-6f);
    const Rgb green =
        read(numbersParameter("spectrum", "reflectance", {500, 0, 520, 1, 560, 1, 580, 0}), SpectrumRole::Albedo);
    EXPECT_GT(green.g, 0.5f);
    EXPECT_EQ(green.r, 0);  // the colour lies outside of sRGB
    EXPECT_NEAR(read(numbersParameter("spectrum", "sigma_a", {300, 40, 900, 40}), SpectrumRole::Unbounded).g, 40,
                1e-4f);
}

TEST_F(SpectrumParameter, NegativeSpectrumWarnsAndCountsAsZero) {
    const Rgb color = read(numbersParameter("spectrum", "reflectance", {300, -1, 900, -1}), SpectrumRole::Albedo);
    EXPECT_EQ(color, (Rgb{0, 0, 0}));
    ASSERT_EQ(warnings.all().size(), 1u);
    EXPECT_EQ(warnings.all()[0],
              "scene.pbrt:7:3: 'spectrum reflectance' of material 'wall': negative values of the spectrum count as 0");
}

TEST_F(SpectrumParameter, BadValuesAreRefusedWithTheirPlace) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(
        refused(numbersParameter("rgb", "c", {1, 2}), SpectrumRole::Unbounded).find("expected 3 numbers, found 2"),
        std::string::npos);
    EXPECT_NE(refused(numbersParameter("rgb", "c", {-1, 0, 0}), SpectrumRole::Illuminant).find("-1 is outside"),
              std::string::npos);
    EXPECT_NE(refused(numbersParameter("rgb", "c", {0, 1.5f, 0}), SpectrumRole::Albedo).find("1.5 is outside"),
              std::string::npos);
    EXPECT_NE(refused(numbersParameter("rgb", "c", {0, nan, 0}), SpectrumRole::Albedo).find("not finite"),
              std::string::npos);
    EXPECT_NE(refused(numbersParameter("blackbody", "L", {0}), SpectrumRole::Illuminant).find("0 K"),
              std::string::npos);
    EXPECT_NE(refused(numbersParameter("blackbody", "L", {-3000}), SpectrumRole::Illuminant).find("-3000 K"),
              std::string::npos);
    EXPECT_NE(refused(numbersParameter("blackbody", "L", {3000, 1}), SpectrumRole::Illuminant).find("1 number,"),
              std::string::npos);
    EXPECT_NE(refused(numbersParameter("blackbody", "L", {5}), SpectrumRole::Illuminant).find("emits nothing"),
              std::string::npos);
    EXPECT_NE(refused(numbersParameter("spectrum", "L", {400}), SpectrumRole::Illuminant).find("pairs"),
              std::string::npos);
    EXPECT_NE(
        refused(numbersParameter("spectrum", "L", {900, 1, 1000, 1}), SpectrumRole::Illuminant).find("emits nothing"),
        std::string::npos);
    EXPECT_NE(refused(numbersParameter("float", "c", {1}), SpectrumRole::Albedo).find("expected an rgb"),
              std::string::npos);
}

TEST_F(SpectrumParameter, UnknownNameSuggestsTheNearestAndMissingFileSaysSo) {
    EXPECT_NE(
        refused(namedParameter("eta", "metal-Agg-eta"), SpectrumRole::Unbounded).find("did you mean 'metal-Ag-eta'"),
        std::string::npos);
    EXPECT_NE(refused(namedParameter("eta", "spds/Au.eta.spd"), SpectrumRole::Unbounded, ErrorKind::MissingInput)
                  .find("Au.eta.spd"),
              std::string::npos);
    folder.file("bad.spd", "400 x");
    EXPECT_NE(refused(namedParameter("eta", "bad.spd"), SpectrumRole::Unbounded).find("bad.spd:1:5: expected a finite"),
              std::string::npos);
}

TEST_F(SpectrumParameter, IndexOfRefractionIsOneNumber) {
    const auto index = [&](const Parameter& p) { return readIndexOfRefraction(p, context, "material 'wall'"); };
    EXPECT_EQ(index(numbersParameter("float", "eta", {1.33f})), 1.33f);
    for (const float bad : {0.f, -1.f})
        EXPECT_THROW(index(numbersParameter("float", "eta", {bad})), Error) << bad;
    EXPECT_NEAR(index(numbersParameter("rgb", "eta", {1.4f, 1.5f, 1.6f})), 1.5f, 1e-6f);
    EXPECT_NEAR(index(numbersParameter("spectrum", "eta", {300, 1.7f, 900, 1.7f})), 1.7f, 1e-6f);
    const std::pair<const char*, float> glasses[] = {
        {"glass-BK7", 1.51842f}, {"glass-BAF10", 1.67288f}, {"glass-FK51A", 1.48771f}, {"glass-LASF9", 1.85556f},
        {"glass-F5", 1.67690f},  {"glass-F10", 1.73341f},   {"glass-F11", 1.79088f}};
    for (const auto& [name, expected] : glasses)
        EXPECT_NEAR(index(namedParameter("eta", name)), expected, 2e-5f) << name;
    refused([&] { index(numbersParameter("float", "eta", {-1.5f})); });
    refused([&] { index(numbersParameter("rgb", "eta", {-1.5f, 1, 1})); });
}

// --- conductors ------------------------------------------------------------------------------------------------------

struct Metal {
    const char* name;
    double f0[3];         // colour of the spectral reflectance along the normal, in linear sRGB
    double tolerance[3];  // of the fitted curve, over all angles, after the target is clamped to [0, 1]
};
constexpr Metal kMetals[] = {
    {"Ag", {.9715, .9599, .9153}, {.002, .002, .002}},   {"Al", {.9132, .9215, .9245}, {.002, .002, .002}},
    {"Au", {1.0219, .7825, .3434}, {.010, .002, .002}},  {"Cu", {.9553, .6376, .5382}, {.005, .002, .002}},
    {"CuZn", {.9096, .7783, .4228}, {.005, .002, .002}}, {"MgO", {.0720, .0731, .0749}, {.002, .002, .002}},
    {"TiO2", {.2322, .2446, .2727}, {.002, .002, .002}},
};

double component(Rgb c, int i) {
    return i == 0 ? c.r : i == 1 ? c.g : c.b;
}

TEST(ConductorFit, FollowsTheColourOfTheSpectralCurve) {
    const ChannelWeights& weights = channelWeights(srgbColorSpace());
    for (const Metal& metal : kMetals) {
        const SampledSpectrum& eta = *findBuiltinSpectrum(std::string("metal-") + metal.name + "-eta");
        const SampledSpectrum& k = *findBuiltinSpectrum(std::string("metal-") + metal.name + "-k");
        const ConductorIndex fit = fitConductor(eta, k, srgbColorSpace());
        for (int c = 0; c < 3; ++c)
            for (int degrees = 0; degrees < 90; ++degrees) {
                const double cosine = std::cos(degrees * std::numbers::pi / 180);
                double target = 0;
                for (int i = 0; i < kWavelengthCount; ++i)
                    target += weights.rows[c][i] * conductorFresnel(cosine, eta.values[i], k.values[i]);
                if (degrees == 0) {
                    EXPECT_NEAR(target, metal.f0[c], 3e-4) << metal.name << c;
                }
                EXPECT_NEAR(conductorFresnel(cosine, component(fit.eta, c), component(fit.k, c)),
                            std::clamp(target, 0., 1.), metal.tolerance[c])
                    << metal.name << " channel " << c << " at " << degrees;
            }
    }
}

TEST(ConductorFit, GivesConstantSpectraBack) {
    const double cases[][2] = {{0.2, 3}, {1.5, 7}, {0.05, 4}, {2.5, 0.5}, {1.2, 1.9}, {4, 0.1}};
    for (const auto& [eta, k] : cases) {
        const ConductorIndex fit = fitConductor(constantSpectrum(eta), constantSpectrum(k), *findColorSpace("rec2020"));
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(component(fit.eta, c), eta, 2e-3 * eta) << eta << ", " << k;
            EXPECT_NEAR(component(fit.k, c), k, 5e-3 * k) << eta << ", " << k;
        }
    }
}

TEST(ConductorFit, StaysFiniteWhereNothingFits) {
    for (const double eta : {0.0, 1.0, 1e-6, 1e30})
        for (const double k : {0.0, 1.0, 1e30}) {
            const ConductorIndex fit = fitConductor(constantSpectrum(eta), constantSpectrum(k), srgbColorSpace());
            EXPECT_TRUE(fit.eta.isFinite() && fit.k.isFinite()) << eta << ", " << k;
            EXPECT_GT(fit.eta.smallest(), 0);
            EXPECT_GE(fit.k.smallest(), 0);
        }
}

TEST(ConductorFit, FresnelOfADielectricAndOfGrazingLight) {
    EXPECT_NEAR(conductorFresnel(1, 1.5, 0), 0.04, 1e-12);
    EXPECT_NEAR(conductorFresnel(1, 0.2, 3), (0.8 * 0.8 + 9) / (1.2 * 1.2 + 9), 1e-12);
    EXPECT_NEAR(conductorFresnel(0, 0.2, 3), 1, 1e-12);
    EXPECT_NEAR(conductorFresnel(0.5, 1, 0), 0, 1e-12);
}

TEST_F(SpectrumParameter, ConductorIndexByEveryWayOfGivingIt) {
    const auto index = [&](const Parameter* eta, const Parameter* k) {
        return readConductorIndex(eta, k, context, "material 'wall'");
    };
    const ConductorIndex copper = index(nullptr, nullptr);
    expectNear(copper.eta, {0.158f, 0.976f, 1.210f}, 2e-3f);
    const Parameter rgbEta = numbersParameter("rgb", "eta", {0.2f, 0.9f, 1.1f}),
                    rgbK = numbersParameter("rgb", "k", {3.9f, 2.4f, 2.1f});
    EXPECT_EQ(index(&rgbEta, &rgbK).eta, (Rgb{0.2f, 0.9f, 1.1f}));
    EXPECT_EQ(index(&rgbEta, &rgbK).k, (Rgb{3.9f, 2.4f, 2.1f}));
    const ConductorIndex mixed = index(&rgbEta, nullptr);
    EXPECT_EQ(mixed.eta, (Rgb{0.2f, 0.9f, 1.1f}));
    EXPECT_EQ(mixed.k, reflectanceToRgb(*findBuiltinSpectrum("metal-Cu-k"), srgbColorSpace()));
    const Parameter silverEta = namedParameter("eta", "metal-Ag-eta"), silverK = namedParameter("k", "metal-Ag-k");
    expectNear(index(&silverEta, &silverK).k, {4.108f, 3.345f, 2.412f}, 5e-3f);
}

// --- sensor ----------------------------------------------------------------------------------------------------------

void addNumber(ParameterSet& set, const char* name, float value) {
    set.add(numbersParameter("float", name, {value}));
}
void addText(ParameterSet& set, const char* name, const char* value) {
    Parameter p = numbersParameter("string", name, {});
    p.values = std::vector<std::string>{value};
    set.add(p);
}

class Sensor : public SpectrumParameter {
protected:
    FilmSensor read(double shutterClose = 1) {
        return readFilmSensor(film, 0, shutterClose, srgbColorSpace(), files, warnings);
    }
    ParameterSet film;
};

TEST_F(Sensor, DefaultsChangeNothing) {
    EXPECT_TRUE(read().isIdentity());
    EXPECT_EQ(read(0.01).imagingRatio, 0.01);
}

TEST_F(Sensor, IsoAndShutterMakeTheImagingRatio) {
    addNumber(film, "iso", 400);
    EXPECT_DOUBLE_EQ(read(0.5).imagingRatio, 2);
    EXPECT_EQ(read(0.5).matrix, Matrix3{});
}

TEST_F(Sensor, WhiteBalanceOf5000) {
    addNumber(film, "whitebalance", 5000);
    const Matrix3 expected{{{{0.9392, -0.0942, -0.0175}, {0.0045, 1.0244, -0.0065}, {0.0081, 0.0295, 1.3318}}}};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            EXPECT_NEAR(read().matrix.m[row][column], expected.m[row][column], 6e-5) << row << ", " << column;
}

TEST_F(Sensor, WhiteBalanceMakesItsDaylightWhite) {
    for (const double kelvin : {2500., 4000., 5000., 7500., 20000.}) {
        const Rgb lamp = illuminantToRgb(daylightSpectrum(kelvin), srgbColorSpace(), "lamp");
        expectNear(apply(whiteBalanceMatrix(kelvin, srgbColorSpace()), lamp), {1, 1, 1}, 1e-6f);
    }
}

TEST_F(Sensor, NamedCameraIsTheObserverAt6500) {
    addText(film, "sensor", "nikon_d850");
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            EXPECT_NEAR(read().matrix.m[row][column], row == column, 2e-4);
    EXPECT_TRUE(warnings.all().empty());
}

TEST_F(Sensor, UnknownCameraWarnsWithTheNearest) {
    addText(film, "sensor", "nikon_d80");
    EXPECT_TRUE(read().isIdentity());
    ASSERT_EQ(warnings.all().size(), 1u);
    EXPECT_NE(warnings.all()[0].find("scene.pbrt:7:3: unknown sensor 'nikon_d80'"), std::string::npos);
    EXPECT_NE(warnings.all()[0].find("nikon_d8"), std::string::npos);
    Warnings strict(true);
    EXPECT_THROW(readFilmSensor(film, 0, 1, srgbColorSpace(), files, strict), Error);
}

TEST_F(Sensor, BadNumbersAreRefused) {
    for (const float iso : {0.f, -100.f, std::numeric_limits<float>::infinity()}) {
        film = {};
        addNumber(film, "iso", iso);
        refused([&] { read(); });
    }
    for (const float kelvin : {-1.f, 10.f, 1e9f}) {
        film = {};
        addNumber(film, "whitebalance", kelvin);
        refused([&] { read(); });
    }
}

}  // namespace
}  // namespace penumbra
