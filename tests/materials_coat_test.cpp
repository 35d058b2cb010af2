// The coated base: the check numbers of the pbrt format, the layered random walk that the closure is the expectation
// of, and the accuracy of its tables.
#include "tests/layered_walk.h"
#include "tests/materials_fixture.h"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

using F = Lanes8f;
using Coated = MaterialsUnderTest<CoatedDiffuseMaterial>;

Setting grey(float r) {
    return color("reflectance", r, r, r);
}

double albedoOf(const Coated& coated, double cosine) {
    return lane(coated.wide().albedo(broadcast<F>(directionOf(cosine, 0.3))), 0).r;
}

/// Directional reflectance with all defaults but R, at 0, 45, 60 and 75 degrees: albedo(), sampling and evaluate()
/// alike.
TEST(CoatedDiffuse, HasThePublishedReflectance) {
    struct Row {
        float base;
        double reflectance[4];
    };
    const Row rows[] = {{0.2f, {.1256, .1348, .1702, .3194}},
                        {0.5f, {.3043, .3114, .3394, .4581}},
                        {0.8f, {.5850, .5887, .6051, .6758}},
                        {1.f, {.8652, .8656, .8704, .8932}}};
    const double degrees[] = {0, 45, 60, 75};
    for (const Row& row : rows) {
        const Coated coated(Settings{grey(row.base)});
        const auto bsdf = coated.wide();
        for (int i = 0; i < 4; ++i) {
            const double cosine = std::cos(degrees[i] * 3.14159265358979323846 / 180);
            EXPECT_NEAR(albedoOf(coated, cosine), row.reflectance[i], 6e-5) << row.base << " " << degrees[i];
            const Vec3<float> wo = directionOf(cosine, 0.3);
            EXPECT_NEAR(sampledAlbedo(bsdf, wo, 128), row.reflectance[i], 3e-4) << row.base << " " << degrees[i];
            const double top = dielectricFresnel(float(cosine), 1.5f).reflectance;
            EXPECT_NEAR(SphereIntegrator(bsdf, wo).hemisphere(true)[1] + top, row.reflectance[i], 1e-4);
        }
    }
}

TEST(CoatedDiffuse, RoughCoatHasThePublishedReflectance) {
    const Coated coated(Settings{number("roughness", 0.3f)});
    EXPECT_NEAR(albedoOf(coated, 1), 0.229, 2e-3);
    EXPECT_NEAR(sampledAlbedo(coated.wide(), directionOf(1, 0), 128), albedoOf(coated, 1), 3e-4);
}

/// Without absorption and cut nothing is lost: Saunderson's sum, and 1 over a white base.
TEST(CoatedDiffuse, ClearCoatHasItsClosedForms) {
    const Settings clear = {number("thickness", 0), integer("maxdepth", 1000)};
    Settings white = clear, grey8 = clear;
    white.push_back(grey(1));
    grey8.push_back(grey(0.8f));
    EXPECT_NEAR(albedoOf(Coated(grey8), 1), 0.6328334076, 2e-6);
    for (const double cosine : {1.0, 0.7, 0.3, 0.1})
        EXPECT_NEAR(albedoOf(Coated(white), cosine), 1, 2e-6);
}

TEST(CoatedDiffuse, WithoutACoatIsItsBase) {
    const Coated bare(Settings{number("eta", 1), number("thickness", 0), integer("maxdepth", 1), grey(0.6f)});
    const BsdfEval<float> e = bare.closure<float>(0u).evaluate(directionOf(0.5, 0), directionOf(0.7, 2));
    EXPECT_NEAR(e.fCos.r, 0.6 * 0.7 / 3.14159265, 1e-6);
}

/// Student's test of each case at 1e-4: five cases, a false-alarm rate below 5e-4. Table errors are allowed for.
TEST(CoatedDiffuse, IsTheExpectationOfTheLayeredWalk) {
    struct Case {
        float ax, ay, eta, thickness, base;
        int maxDepth;
        double cosine;
    };
    const Case cases[] = {{0.3f, 0.3f, 1.5f, 0.01f, 0.8f, 10, 0.8},
                          {0.5477f, 0.5477f, 1.5f, 0.01f, 0.5f, 10, 1.0},
                          {0.1f, 0.5f, 1.8f, 0.2f, 1.f, 10, 0.4},
                          {0.05f, 0.05f, 1.5f, 0.05f, 1.f, 3, 0.6},
                          {0.2f, 0.2f, 0.8f, 0.01f, 0.9f, 10, 0.7}};
    for (const Case& c : cases) {
        const Coated coated(Settings{number("uroughness", c.ax), number("vroughness", c.ay), plainAlpha(),
                                     number("eta", c.eta), number("thickness", c.thickness), grey(c.base),
                                     integer("maxdepth", c.maxDepth)});
        const Vec3<float> wo = directionOf(c.cosine, 0.3);
        const auto closure = coated.closure<float>(0u);
        const double below = closure.albedo(wo).r - closure.coat(wo).reflected;
        LayeredWalk walk(c.eta, c.thickness, {c.ax, c.ay}, c.maxDepth,
                         [&](const Vec3<float>&, LayeredWalk& numbers, double& weight) {
                             weight *= c.base;
                             const float x = numbers.next();
                             return cosineHemisphere(Vec2<float>{x, numbers.next()});
                         });
        std::vector<double> leaving(1u << 18);
        for (double& energy : leaving) {
            const LayeredWalk::Leaving light = walk.walk(wo);
            energy = light.enteredCoat ? light.weight : 0;
        }
        const Moments moments = momentsOf(leaving);
        EXPECT_GT(studentTest(moments, below, 2e-4).pValue, 1e-4)
            << c.ax << ": " << moments.mean << " against " << below;
    }
}

TEST(CoatedDiffuse, MaxDepthLimitsTheMeetingsWithTheBase) {
    const auto below = [](int maxDepth) {
        const Coated coated(Settings{grey(1), integer("maxdepth", maxDepth)});
        return albedoOf(coated, 1) - 0.04;
    };
    const double once = below(1);
    EXPECT_NEAR(below(0), 0, 1e-6);
    EXPECT_NEAR(below(2), once, 1e-7);
    EXPECT_NEAR(below(3), once * (1 + 0.5674), 1e-4);
    EXPECT_NEAR(below(10), once * (1 - std::pow(0.567364, 5)) / (1 - 0.567364), 1e-5);
}

// ------------------------------------------------------------------------------------------------ tables

/// T and R by quadrature, directly. REQUIRES: ggx is what the material was made with.
double tableError(const CoatedDiffuseBsdf<float>& closure, const Coat& coat, const Ggx<float>& ggx, double leastCosine,
                  double mostCosine) {
    double worst = 0;
    for (int i = 0; i < 400; ++i) {
        const float u = unitFloat<float>(mixBits(std::uint32_t(2 * i + 1))),
                    v = unitFloat<float>(mixBits(std::uint32_t(2 * i + 2)));
        const Vec3<float> w = directionOf(leastCosine + (mostCosine - leastCosine) * u, 6.2831853 * v);
        worst = std::max(worst, std::abs(closure.coat(w).transmitted - roughCoatAlbedo(coat, ggx, w).transmitted));
    }
    return worst;
}

TEST(CoatTable, InterpolatesConstantRoughness) {
    for (const float alpha : {0.01f, 0.1f, 0.3f, 0.9f}) {
        const Coated coated(Settings{number("roughness", alpha), plainAlpha()});
        const auto closure = coated.closure<float>(0u);
        EXPECT_LT(tableError(closure, {}, {alpha, alpha}, 0.1, 1), 2e-4) << alpha;
        EXPECT_LT(tableError(closure, {}, {alpha, alpha}, 0, 0.1), 2e-4) << alpha;
    }
    const Coated anisotropic(Settings{number("uroughness", 0.02f), number("vroughness", 0.4f), plainAlpha()});
    const auto closure = anisotropic.closure<float>(0u);
    EXPECT_LT(tableError(closure, {}, {0.02f, 0.4f}, 0.1, 1), 2e-4);
    EXPECT_LT(tableError(closure, {}, {0.02f, 0.4f}, 0, 0.1), 2e-3);
}

TEST(CoatTable, InterpolatesTexturedRoughness) {
    CoatedDiffuseMaterial material;
    std::vector<float> numbers;
    appendTexturedCoat({}, numbers);
    material.setBlock(0, kTexturedRows, numbers.data());
    const Records<float, CoatedDiffuseMaterial> record(&material, 0u);
    for (const float alpha : {0.002f, 0.03f, 0.21f, 0.77f, 1.f}) {
        const auto rough = RoughnessInputs::surface(alpha, alpha);
        const auto closure =
            CoatedDiffuseMaterial::closure<float>(record, numbers.data(), rough, Spectrum<float>::constant(0.5f));
        EXPECT_LT(tableError(closure, {}, {alpha, alpha}, 0.1, 1), 2e-4) << alpha;
        EXPECT_LT(tableError(closure, {}, {alpha, alpha}, 0, 0.1), 2e-3) << alpha;
    }
    // Where the texture says smooth, the coat is the smooth one.
    const auto closure = CoatedDiffuseMaterial::closure<float>(
        record, numbers.data(), RoughnessInputs::surface(0.f, 0.f), Spectrum<float>::constant(0.5f));
    EXPECT_NEAR(closure.albedo(directionOf(1, 0)).r, 0.3043, 1e-4);
}

TEST(CoatTable, SmoothCoatHasThePublishedFractions) {
    std::vector<float> numbers;
    appendSmoothCoat({}, numbers);
    EXPECT_NEAR(numbers[0], 0.5674, 5e-5);
    EXPECT_NEAR(numbers[2], 0.3991, 5e-5);
}

TEST(CoatedDiffuse, WarnsOfWhatItDoesNotSimulate) {
    MaterialTables tables;
    PlainMaterialInput scattering({color("albedo", 0.5f, 0.5f, 0.5f)}, tables);
    EXPECT_NEAR(CoatedDiffuseMaterial::make(scattering).opticalThickness, 0.005f, 1e-7);
    EXPECT_EQ(scattering.warnings.size(), 1u);
    PlainMaterialInput plain({}, tables);
    CoatedDiffuseMaterial::make(plain);
    EXPECT_TRUE(plain.warnings.empty());
    PlainMaterialInput negative({number("thickness", -1)}, tables);
    EXPECT_THROW(CoatedDiffuseMaterial::make(negative), Error);
}

}  // namespace
}  // namespace penumbra::test
