// Measured materials: a metal known in closed form, written as a measurement and read back.
#include "tests/materials_fixture.h"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

using F = Lanes8f;
using Measured = MaterialsUnderTest<MeasuredMaterial>;

MeasuredMetal::V toDouble(const Vec3<float>& w) {
    return {w.x, w.y, w.z};
}

/// The colour of a spectrum that is a straight line, by its values at 400 and 700 nm.
Rgb straightColor(double at400, double at700) {
    SampledSpectrum spectrum;
    for (int i = 0; i < kWavelengthCount; ++i)
        spectrum.values[std::size_t(i)] = at400 + (at700 - at400) * (kFirstWavelength + i - 400) / 300;
    return reflectanceToRgb(spectrum, srgbColorSpace());
}

struct Metal {
    const char* name;
    float alphaX, alphaY;
};
void PrintTo(const Metal& metal, std::ostream* out) {
    *out << metal.name;
}
class MeasuredMetals : public testing::TestWithParam<Metal> {
protected:
    MeasuredMetal metal() const {
        MeasuredMetal m;
        m.alphaX = GetParam().alphaX;
        m.alphaY = GetParam().alphaY;
        return m;
    }
    Measured measured() const { return Measured(Settings{number("metal.ax", GetParam().alphaX), number("metal.ay", GetParam().alphaY)}); }
};

/// Errors of f cos against the formula, by the brightest channel's worst and mean, for views that view(i) gives.
struct Errors {
    double worst = 0, mean = 0;
};
template <class View>
Errors errorsOf(const MeasuredMetal& truth, const MeasuredBsdf<float>& bsdf, View&& view) {
    constexpr std::uint32_t kCount = 4000;
    Errors errors;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const auto u = [&](std::uint32_t d) { return unitFloat<float>(mixBits(4 * i + d)); };
        const float side = i % 2 ? -1.f : 1.f;
        const Vec3<float> wo = view(i), wi = directionOf(0.1 + 0.9 * u(2), 6.2831853 * u(3));
        const BsdfEval<float> e = bsdf.evaluate({wo.x, wo.y, side * wo.z}, {wi.x, wi.y, side * wi.z});
        const auto o = toDouble(wo), in = toDouble(wi);
        const Rgb expected = straightColor(truth.value(o, in, 400), truth.value(o, in, 700));
        const double error =
            std::max({std::abs(e.fCos.r - expected.r), std::abs(e.fCos.g - expected.g), std::abs(e.fCos.b - expected.b)}) /
            (0.02 + expected.g);
        errors.worst = std::max(errors.worst, error);
        errors.mean += error / kCount;
    }
    return errors;
}

/// At the file's own directions of view only its 32 x 32 nodes are between it and the formula: most at grazing angles,
/// where the formula falls off within one of their cells.
TEST_P(MeasuredMetals, EvaluateToTheirFormula) {
    const MeasuredMetal truth = metal();
    const Errors errors = errorsOf(truth, measured().closure<float>(0u), [&](std::uint32_t i) {
        const double theta = 1.5 * (i % 7) / (truth.thetas - 1), phi = -3.14159265358979 + 6.28318530717959 * (i % 8) / (truth.phis - 1);
        return directionOf(std::cos(theta), phi);
    });
    EXPECT_LT(errors.worst, 0.2);
    EXPECT_LT(errors.mean, 0.015);
}

/// Between them, eight angles from the normal, and eight around it where it matters, have to do.
TEST_P(MeasuredMetals, InterpolateBetweenViews) {
    const Errors errors = errorsOf(metal(), measured().closure<float>(0u), [](std::uint32_t i) {
        return directionOf(0.2 + 0.8 * unitFloat<float>(mixBits(4 * i)), 6.2831853 * unitFloat<float>(mixBits(4 * i + 1)));
    });
    EXPECT_LT(errors.mean, 0.04);
}

/// Sampled one by one, the mean weight is the albedo of the formula.
TEST_P(MeasuredMetals, KeepTheirEnergy) {
    const MeasuredMetal truth = metal();
    const Measured material = measured();
    const auto bsdf = material.wide();
    for (const double cosine : {0.9, 0.5}) {
        const Vec3<float> wo = directionOf(cosine, 0.7);
        double expected = 0;
        constexpr int kSteps = 200;
        for (int j = 0; j < kSteps; ++j)
            for (int i = 0; i < kSteps; ++i) {
                const Vec3<float> wi = directionOf((j + 0.5) / kSteps, 6.283185307 * (i + 0.5) / kSteps);
                const auto o = toDouble(wo), in = toDouble(wi);
                expected += straightColor(truth.value(o, in, 400), truth.value(o, in, 700)).r * 6.283185307 / (kSteps * kSteps);
            }
        EXPECT_NEAR(sampledAlbedo(bsdf, wo, 64), expected, 0.015) << cosine;
        EXPECT_NEAR(lane(bsdf.albedo(broadcast<F>(wo)), 0).r, expected, 0.03) << cosine;
    }
}

/// Sampling follows the metal: no weight is far above one.
TEST_P(MeasuredMetals, AreSampledWell) {
    const Measured material = measured();
    const auto bsdf = material.wide();
    const Uniforms u{3};
    for (std::uint32_t group = 0; group < 2000; ++group) {
        const BsdfSample<F> s = bsdf.sample(broadcast<F>(directionOf(0.7, 2)), u(group, 0), {u(group, 1), u(group, 2)});
        for (int k = 0; k < 8; ++k)
            if (lane(s.valid, k)) {
                ASSERT_LT(lane(s.weight.g, k), 2);
            }
    }
}

/// Twice the nodes leave less than half of the error.
TEST(Measured, ConvergesToTheFormula) {
    const auto meanError = [](float nodes) {
        const Measured material(Settings{number("metal.nodes", nodes)});
        return errorsOf(MeasuredMetal{}, material.closure<float>(0u), [](std::uint32_t i) {
                   return directionOf(std::cos(1.5 * (i % 7) / 7), 0.1 * i);
               }).mean;
    };
    EXPECT_LT(meanError(64), 0.5 * meanError(32));
}

INSTANTIATE_TEST_SUITE_P(All, MeasuredMetals,
                         testing::Values(Metal{"Isotropic", 0.4f, 0.4f}, Metal{"Rough", 0.8f, 0.8f},
                                         Metal{"Anisotropic", 0.3f, 0.6f}),
                         [](const auto& info) { return info.param.name; });

TEST(Measured, AnisotropicOnesNeedATangent) {
    MaterialTables tables;
    PlainMaterialInput round({}, tables), brushed({number("metal.ax", 0.3f), number("metal.ay", 0.6f)}, tables);
    EXPECT_FALSE(MeasuredMaterial::make(round).needsTangent());
    EXPECT_TRUE(MeasuredMaterial::make(brushed).needsTangent());
}

TEST(Measured, OneFileHasOneTable) {
    MaterialTables tables;
    PlainMaterialInput input({}, tables);
    const MeasuredMaterial first = MeasuredMaterial::make(input);
    const std::size_t size = tables.size();
    EXPECT_EQ(MeasuredMaterial::make(input).block, first.block);
    EXPECT_EQ(tables.size(), size);
}

/// A file with one field changed, as a scene would hand it over.
class OddInput final : public MaterialInput {
public:
    OddInput(std::vector<char> bytes, MaterialTables& tables) : plain_({}, tables), bytes_(std::move(bytes)) {}
    SpectrumInput albedo(std::string_view name, Rgb otherwise) override { return plain_.albedo(name, otherwise); }
    SpectrumInput coefficient(std::string_view name, Rgb otherwise) override { return plain_.coefficient(name, otherwise); }
    ScalarInput scalar(std::string_view name, float otherwise) override { return plain_.scalar(name, otherwise); }
    ScalarInput scalar(std::string_view name, const ScalarInput& otherwise) override { return plain_.scalar(name, otherwise); }
    float dielectricIndex(std::string_view name, float otherwise) override { return plain_.dielectricIndex(name, otherwise); }
    ConductorIndex conductorIndex(std::string_view eta, std::string_view k) override { return plain_.conductorIndex(eta, k); }
    std::vector<char> file(std::string_view, std::uint64_t) override { return bytes_; }
    const ChannelWeights& channelWeights() const override { return plain_.channelWeights(); }
    const ParameterSet& parameters() const override { return plain_.parameters(); }
    void warn(const std::string& text) override { plain_.warn(text); }
    [[noreturn]] void fail(const std::string& text) override { plain_.fail(text); }
    MaterialTables& tables() override { return plain_.tables(); }

private:
    PlainMaterialInput plain_;
    std::vector<char> bytes_;
};

struct SmallFile {
    std::vector<float> phi{0}, theta{0, 1}, wavelengths{400, 700}, ndf{1, 1, 1, 1}, sigma{1, 1, 1, 1}, visible{1, 1, 1, 1, 1, 1, 1, 1},
        luminance{1, 1, 1, 1, 1, 1, 1, 1}, spectra = std::vector<float>(16, 0.5f);
    std::uint64_t side = 2;

    std::vector<char> bytes() const {
        const std::uint64_t p = phi.size(), t = theta.size(), w = wavelengths.size();
        TensorFileMaker maker;
        maker.floats("phi_i", {p}, phi);
        maker.floats("theta_i", {t}, theta);
        maker.floats("wavelengths", {w}, wavelengths);
        maker.floats("ndf", {2, 2}, ndf);
        maker.floats("sigma", {2, 2}, sigma);
        maker.floats("vndf", {p, t, 2, 2}, visible);
        maker.floats("luminance", {p, t, side, 4 / side}, luminance);
        maker.floats("spectra", {p, t, w, 2, 2}, spectra);
        return maker.bytes();
    }
    std::string error() const {
        MaterialTables tables;
        OddInput input(bytes(), tables);
        try {
            MeasuredMaterial::make(input);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }
};

TEST(Measured, RefusesWhatMakesNoSense) {
    EXPECT_EQ(SmallFile{}.error(), "");
    SmallFile odd;
    odd.theta = {1, 0};
    EXPECT_NE(odd.error().find("do not rise: theta_i"), std::string::npos);
    odd = {};
    odd.visible = {1, 1, 1, 1, 0, 0, 0, 0};
    EXPECT_NE(odd.error().find("from which nothing is seen"), std::string::npos);
    odd = {};
    odd.luminance.assign(8, -1.f);
    EXPECT_NE(odd.error().find("from which nothing is seen"), std::string::npos);
    odd = {};
    odd.side = 4;
    EXPECT_NE(odd.error().find("less than two by two in luminance"), std::string::npos);
    odd = {};
    odd.spectra.assign(16, INFINITY);
    EXPECT_NE(odd.error().find("not finite"), std::string::npos);
    odd = {};
    odd.phi = {0, 1, 2};
    odd.theta = {0};
    odd.visible.assign(12, 1);
    odd.luminance.assign(12, 1);
    odd.spectra.assign(24, 1);
    EXPECT_NE(odd.error().find("less than a full turn"), std::string::npos);
}

/// A spectrum of one half everywhere is the colour one half, whatever the space.
TEST(Measured, GreySpectraAreGrey) {
    MaterialTable table;
    OddInput input(SmallFile{}.bytes(), table.tables());
    table.add("measured", input);
    const Textures textures;
    const ShadingContext<float> context{textures, table.tableData(), {}};
    const auto bsdf = MeasuredMaterial::bsdf(table.records<MeasuredMaterial, float>(table.firstId(kTagOf<MeasuredMaterial, MaterialTypes>)), context);
    const Spectrum<float> albedo = bsdf.albedo({0, 0, 1});
    EXPECT_NEAR(albedo.r, 0.5, 1e-5);
    EXPECT_NEAR(albedo.g, 0.5, 1e-5);
    EXPECT_NEAR(albedo.b, 0.5, 1e-5);
}

}  // namespace
}  // namespace penumbra::test
