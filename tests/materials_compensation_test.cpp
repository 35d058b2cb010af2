// The option multiscatter: what rough facets lose is given back, whole where they absorb nothing.
#include "tests/materials_fixture.h"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

constexpr double kCosines[] = {1.0, 0.8, 0.5, 0.25, 0.1, 0.03};

Settings mirror(float alphaX, float alphaY) {
    return {color("eta", 0, 0, 0), color("k", 1, 1, 1), number("uroughness", alphaX), number("vroughness", alphaY),
            plainAlpha()};
}
Settings compensated(Settings settings) {
    settings.push_back(multiscatter());
    return settings;
}

template <class M>
double reflected(const Settings& settings, const Vec3<float>& wo) {
    const MaterialsUnderTest<M> material(settings);
    return SphereIntegrator(material.wide(), wo).hemisphere(wo.z > 0)[1];
}

/// The white furnace, by quadrature of evaluate() and by sampling.
TEST(Compensation, RoughMirrorsLoseNothing) {
    for (const float alpha : {0.05f, 0.2f, 0.5f, 1.f}) {
        const MaterialsUnderTest<ConductorMaterial> material(compensated(mirror(alpha, alpha)));
        const auto bsdf = material.wide();
        for (const double cosine : kCosines) {
            const Vec3<float> wo = directionOf(cosine, 0.3);
            EXPECT_NEAR(SphereIntegrator(bsdf, wo).hemisphere(true)[1], 1, 1e-3) << alpha << " " << cosine;
            EXPECT_NEAR(sampledAlbedo(bsdf, wo, 64), 1, 3e-3) << alpha << " " << cosine;
        }
    }
}

TEST(Compensation, AnisotropicMirrorsLoseNearlyNothing) {
    for (const double phi : {0.0, 0.8, 1.57}) {
        const MaterialsUnderTest<ConductorMaterial> material(compensated(mirror(0.6f, 0.15f)));
        const auto bsdf = material.wide();
        for (const double cosine : kCosines)
            EXPECT_NEAR(SphereIntegrator(bsdf, directionOf(cosine, phi)).hemisphere(true)[1], 1, 1e-2)
                << phi << " " << cosine;
    }
}

/// Reflected and transmitted energy, from both sides.
TEST(Compensation, RoughGlassLosesNothing) {
    for (const float eta : {1.5f, 0.7f}) {
        for (const float alpha : {0.3f, 1.f}) {
            const MaterialsUnderTest<DielectricMaterial> material(
                Settings{multiscatter(), number("eta", eta), number("roughness", alpha), plainAlpha()});
            const auto bsdf = material.wide();
            for (const double cosine : {1.0, 0.5, 0.1, -0.1, -0.6, -1.0}) {
                const Vec3<float> wo = directionOf(cosine, 0.3);
                const SphereIntegrator integrator(bsdf, wo);
                const double relative = cosine > 0 ? eta : 1 / eta;
                const double energy = integrator.hemisphere(cosine > 0)[1] +
                                      integrator.hemisphere(cosine < 0)[1] * relative * relative;
                EXPECT_NEAR(energy, 1, 3e-3) << eta << " " << alpha << " " << cosine;
                EXPECT_NEAR(sampledAlbedo(bsdf, wo, 64), energy, 8e-3) << eta << " " << alpha << " " << cosine;
            }
        }
    }
}

/// The lobe's tint is Fm^2 Em / (1 - Fm (1 - Em)), with both means found in another way.
TEST(Compensation, MetalsTintWhatMeetsSeveralFacets) {
    constexpr double kEta = 0.2, kK = 1.5, kAlpha = 0.6;
    double meanFresnel = 0, meanEnergy = 0;
    for (int i = 0; i < 1000; ++i) {
        const double mu = (i + 0.5) / 1000;
        meanFresnel += 2 * mu * conductorFresnel(mu, kEta, kK) / 1000;
    }
    for (int i = 0; i < 32; ++i) {
        const double mu = (i + 0.5) / 32;
        meanEnergy += 2 * mu * reflected<ConductorMaterial>(mirror(kAlpha, kAlpha), directionOf(mu, 0)) / 32;
    }
    const double expected = meanFresnel * meanFresnel * meanEnergy / (1 - meanFresnel * (1 - meanEnergy));
    const Settings metal{color("eta", kEta, kEta, kEta), color("k", kK, kK, kK), number("roughness", kAlpha), plainAlpha()};
    for (const double cosine : {1.0, 0.6, 0.3}) {
        const Vec3<float> wo = directionOf(cosine, 1);
        const double again = reflected<ConductorMaterial>(compensated(metal), wo) - reflected<ConductorMaterial>(metal, wo);
        const double lost = 1 - reflected<ConductorMaterial>(mirror(kAlpha, kAlpha), wo);
        EXPECT_NEAR(again / lost, expected, 5e-3) << cosine;
    }
}

/// Where perpendicular reflectance is given, the mean of Fresnel's factor comes from a table, or Schlick's closed form.
TEST(Compensation, MeansOfFresnelAgree) {
    for (const float r : {0.03f, 0.4f, 0.77f, 0.99f}) {
        const float k = 2 * std::sqrt(r) / std::sqrt(1 - r);
        const Settings index{multiscatter(), color("eta", 1, 1, 1), color("k", k, k, k), number("roughness", 0.5f)},
            reflectance{multiscatter(), color("reflectance", r, r, r), number("roughness", 0.5f)};
        const MaterialsUnderTest<ConductorMaterial> a(index), b(reflectance);
        EXPECT_NEAR(a.closure<float>(0u).compensation.tint.g, b.closure<float>(0u).compensation.tint.g, 5e-4) << r;
        Settings approximate = reflectance, withIndex = index;
        approximate.push_back(schlick());
        withIndex.push_back(schlick());
        const MaterialsUnderTest<ConductorMaterial> c(approximate), d(withIndex);
        EXPECT_NEAR(c.closure<float>(0u).compensation.tint.g, d.closure<float>(0u).compensation.tint.g, 1e-4) << r;
    }
}

TEST(Compensation, SmoothSurfacesAreLeftAlone) {
    const MaterialsUnderTest<ConductorMaterial> metal(Settings{multiscatter()});
    const MaterialsUnderTest<DielectricMaterial> glass(Settings{multiscatter()}), nothing(
        Settings{multiscatter(), number("eta", 1), number("roughness", 0.5f)});
    EXPECT_FALSE(metal.closure<float>(0u).compensation.active);
    EXPECT_FALSE(glass.closure<float>(0u).compensation.active);
    EXPECT_FALSE(nothing.closure<float>(0u).compensation.active);
    
}

}  // namespace
}  // namespace penumbra::test
