// Closed forms: Fresnel's equations, the energy of single-scattering GGX, white furnaces.
#include "tests/materials_fixture.h"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

using F = Lanes8f;

double dielectric(double cosine, double eta) {
    return dielectricFresnel(float(cosine), float(eta)).reflectance;
}
double conductor(double cosine, double eta, double k) {
    return conductorReflectance(float(cosine), float(eta * eta - k * k), float(4 * eta * eta * k * k));
}

/// 2 int_0^1 mu F(mu) dmu
double diffuseReflectance(double eta) {
    constexpr int kSteps = 1 << 18;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double mu = (i + 0.5) / kSteps;
        sum += 2 * mu * dielectric(mu, eta) / kSteps;
    }
    return sum;
}

TEST(Fresnel, DielectricHasItsClosedForms) {
    EXPECT_NEAR(dielectric(1, 1.5), 0.04, 1e-7);
    EXPECT_NEAR(dielectric(std::cos(std::atan(1.5)), 1.5), 0.07396449704, 1e-7);  // Brewster's angle
    EXPECT_EQ(dielectric(0, 1.5), 1);
    EXPECT_NEAR(diffuseReflectance(1.5), 0.09177795934, 2e-7);     // Walsh, Duntley
    EXPECT_NEAR(diffuseReflectance(1 / 1.5), 0.5963457597, 2e-7);  // 1 - (1 - outer) / eta^2
}

TEST(Fresnel, ReflectionFromWithinIsTotalBeyondTheCriticalAngle) {
    const double critical = std::sqrt(1 - 1 / (1.5 * 1.5));
    EXPECT_EQ(dielectric(critical - 1e-4, 1 / 1.5), 1);
    EXPECT_LT(dielectric(critical + 1e-4, 1 / 1.5), 0.95);
    // Stokes: the same from both sides, at the angles that belong together.
    for (const double outside : {0.9, 0.5, 0.1}) {
        const double inside = std::sqrt(1 - (1 - outside * outside) / (1.5 * 1.5));
        EXPECT_NEAR(dielectric(outside, 1.5), dielectric(inside, 1 / 1.5), 2e-6);
    }
}

TEST(Fresnel, ConductorHasItsClosedForms) {
    EXPECT_NEAR(conductor(1, 0.2, 3), 0.9233716475, 1e-6);
    EXPECT_EQ(conductor(0, 0.2, 3), 1);
    for (const double cosine : {1.0, 0.6, 0.2, 0.05})  // without absorption it is a dielectric
        EXPECT_NEAR(conductor(cosine, 1.5, 0), dielectric(cosine, 1.5), 2e-6) << cosine;
    for (const double cosine : {1.0, 0.5, 0.1})
        for (const double eta : {0.05, 0.26, 1.0, 3.0})
            for (const double k : {0.5, 3.0, 24.0})
                EXPECT_NEAR(conductor(cosine, eta, k), conductorFresnel(cosine, eta, k), 1e-5)
                    << cosine << " " << eta << " " << k;
}

/// How far Schlick's approximation is from Fresnel's equations: from the lowest to the highest error over all cosines.
template <class Approximate, class Exact>
void expectErrors(Approximate&& approximate, Exact&& exact, double lowest, double highest) {
    double low = 1, high = -1;
    for (int i = 1; i <= 4000; ++i) {
        const float cosine = float(i) / 4000;
        const double error = double(approximate(cosine)) - exact(cosine);
        low = std::min(low, error);
        high = std::max(high, error);
    }
    EXPECT_NEAR(low, lowest, 2e-4);
    EXPECT_NEAR(high, highest, 2e-4);
}

TEST(Schlick, ErrsOnGlassByWhatIsDocumented) {
    struct Row {
        float eta;
        double lowest, highest;
    };
    for (const auto& [eta, lowest, highest] : {Row{1.5f, -0.01963, 0.03569}, Row{1.33f, -0.00917, 0.05992},
                                               Row{2.4f, -0.01403, 0.07404}, Row{1 / 1.5f, -0.01963, 0.03569}}) {
        expectErrors([&, e = eta](float c) { return schlickDielectric(c, e).reflectance; },
                     [&, e = eta](float c) { return dielectric(c, e); }, lowest, highest);
        EXPECT_NEAR(schlickDielectric(1.f, eta).reflectance, dielectric(1, eta), 1e-6);
        EXPECT_EQ(schlickDielectric(0.f, eta).reflectance, 1);
        for (const float cosine : {0.9f, 0.5f})
            EXPECT_EQ(schlickDielectric(cosine, eta).etaCosRefracted, dielectricFresnel(cosine, eta).etaCosRefracted);
    }
}

TEST(Schlick, ReflectsTotallyWhereFresnelDoes) {
    const float critical = std::sqrt(1 - 1 / 2.25f);
    EXPECT_EQ(schlickDielectric(critical - 1e-4f, 1 / 1.5f).reflectance, 1);
    EXPECT_LT(schlickDielectric(critical + 1e-3f, 1 / 1.5f).reflectance, 1);
}

TEST(Schlick, ErrsOnMetalsByWhatIsDocumented) {
    const double copper[3][2] = {{0.1684, 3.6390}, {0.9765, 2.6211}, {1.2113, 2.3663}}, highest[3] = {0.01792, 0.03949, 0.03593};
    for (int i = 0; i < 3; ++i) {
        const float eta = float(copper[i][0]), k = float(copper[i][1]);
        const MaterialsUnderTest<ConductorMaterial> metal(Settings{schlick(), color("eta", eta, eta, eta), color("k", k, k, k)});
        const auto bsdf = metal.closure<float>(0u);
        expectErrors([&](float c) { return bsdf.fresnel(c).g; }, [&](float c) { return conductor(c, eta, k); },
                     i == 2 ? -0.00014 : 0, highest[i]);
    }
    const MaterialsUnderTest<ConductorMaterial> red(Settings{schlick(), color("reflectance", 0.8f, 0, 0)});
    EXPECT_NEAR(red.closure<float>(0u).fresnel(0.5f).r, 0.8 + 0.2 / 32, 1e-6);
}

TEST(Schlick, IsOneOfTwoWords) {
    MaterialTables tables;
    PlainMaterialInput input({Setting{"string", "fresnel", {}, "shlick"}}, tables);
    try {
        ConductorMaterial::make(input);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean 'schlick'?"), std::string::npos) << error.what();
    }
}

TEST(Conductor, DefaultIsCopper) {
    const MaterialsUnderTest<ConductorMaterial> copper(Settings{});
    const Spectrum<float> albedo = lane(copper.wide().albedo({F(0.f), F(0.f), F(1.f)}), 0);
    EXPECT_NEAR(albedo.r, 0.9553, 2e-3);
    EXPECT_NEAR(albedo.g, 0.6376, 2e-3);
    EXPECT_NEAR(albedo.b, 0.5382, 2e-3);
}

TEST(Conductor, ReflectanceIsWhatNormalIncidenceReflects) {
    for (const float r : {0.f, 0.1f, 0.5f, 0.97f}) {
        const MaterialsUnderTest<ConductorMaterial> metal(Settings{color("reflectance", r, r, r)});
        EXPECT_NEAR(lane(metal.wide().albedo({F(0.f), F(0.f), F(1.f)}), 0).r, r, 1e-5);
    }
}

TEST(Conductor, RefusesReflectanceTogetherWithAnIndex) {
    MaterialTables tables;
    PlainMaterialInput input({color("reflectance", 1, 1, 1), color("k", 1, 1, 1)}, tables);
    EXPECT_THROW(ConductorMaterial::make(input), Error);
}

/// Energy of a mirror of rough facets (F = 1), by sampling and by quadrature of evaluate().
TEST(Conductor, RoughMirrorLosesWhatSingleScatteringLoses) {
    struct Row {
        float alpha;
        double cosine, energy;
    };
    const Row rows[] = {{0.1f, 1.0, 0.9883040565}, {0.1f, 0.5, 0.9692049844}, {0.1f, 0.1, 0.8834550019},
                        {0.5f, 1.0, 0.6878485151}, {0.5f, 0.5, 0.6982506969}, {0.5f, 0.1, 0.8601050727},
                        {1.0f, 1.0, 0.3068528194}, {1.0f, 0.5, 0.4506938557}, {1.0f, 0.1, 0.7602104727}};
    for (const Row& row : rows) {
        const MaterialsUnderTest<ConductorMaterial> mirror(
            Settings{color("eta", 0, 0, 0), color("k", 1, 1, 1), number("roughness", row.alpha), plainAlpha()});
        const auto bsdf = mirror.wide();
        const Vec3<float> wo = directionOf(row.cosine, 0.3);
        EXPECT_NEAR(sampledAlbedo(bsdf, wo, 256), row.energy, 1e-4) << row.alpha << " " << row.cosine;
        EXPECT_NEAR(SphereIntegrator(bsdf, wo).hemisphere(true)[1], row.energy, 1e-4) << row.alpha << " " << row.cosine;
    }
}

TEST(Dielectric, SmoothGlassKeepsAllEnergy) {
    for (const float eta : {1.5f, 0.7f, 2.4f}) {
        const MaterialsUnderTest<DielectricMaterial> glass(Settings{number("eta", eta)});
        for (const double cosine : {1.0, 0.5, 0.05, -0.3, -0.9})
            EXPECT_NEAR(sampledAlbedo(glass.wide(), directionOf(cosine, 1), 8), 1, 1e-5) << eta << " " << cosine;
    }
}

TEST(Dielectric, SmoothGlassObeysSnellAndScalesRadiance) {
    const MaterialsUnderTest<DielectricMaterial> glass(Settings{});
    const auto bsdf = glass.closure<float>(0u);
    const Vec3<float> wo = directionOf(0.6, 0.5);
    const BsdfSample<float> through = bsdf.sample(wo, 0.99f, {0.5f, 0.5f});
    ASSERT_TRUE(through.valid && through.delta);
    EXPECT_NEAR(through.wi.x, -wo.x / 1.5f, 1e-6);
    EXPECT_NEAR(through.wi.y, -wo.y / 1.5f, 1e-6);
    EXPECT_LT(through.wi.z, 0);
    EXPECT_EQ(through.eta, 1.5f);
    EXPECT_NEAR(through.weight.r, 1 / 2.25, 1e-6);
    EXPECT_NEAR(through.pdf, 1 - dielectric(0.6, 1.5), 1e-6);
    const BsdfSample<float> back = bsdf.sample(through.wi, 0.99f, {0.5f, 0.5f});
    EXPECT_NEAR(dot(back.wi, wo), 1, 1e-6);
    EXPECT_NEAR(back.weight.r, 2.25, 1e-5);
    EXPECT_NEAR(back.eta, 1 / 1.5, 1e-6);
    const BsdfSample<float> mirrored = bsdf.sample(wo, 0.f, {0.5f, 0.5f});
    EXPECT_NEAR(mirrored.wi.x, -wo.x, 1e-6);
    EXPECT_NEAR(mirrored.wi.z, wo.z, 1e-6);
    EXPECT_EQ(mirrored.eta, 1);
}

TEST(Dielectric, WithoutAStepOfTheIndexLightGoesStraightOn) {
    const MaterialsUnderTest<DielectricMaterial> nothing(Settings{number("eta", 1), number("roughness", 0.5f)});
    const auto bsdf = nothing.closure<float>(0u);
    for (const double cosine : {1.0, 0.4, 1e-3, -0.7}) {
        const Vec3<float> wo = directionOf(cosine, 2);
        const BsdfSample<float> s = bsdf.sample(wo, 0.f, {0.3f, 0.7f});
        EXPECT_TRUE(s.valid && s.delta);
        EXPECT_EQ(s.weight.r, 1);
        EXPECT_NEAR(dot(s.wi, wo), -1, 1e-6);
    }
}

/// Nearly smooth glass must approach smooth glass, reflection and refraction each.
TEST(Dielectric, RoughGlassTendsToSmoothGlass) {
    const MaterialsUnderTest<DielectricMaterial> rough(Settings{number("roughness", 0.01f), plainAlpha()});
    const auto bsdf = rough.wide();
    for (const double cosine : {0.9, 0.5, -0.9}) {
        const SphereIntegrator integrator(bsdf, directionOf(cosine, 0.2));
        const double eta = cosine > 0 ? 1.5 : 1 / 1.5, fresnel = dielectric(std::abs(cosine), eta);
        EXPECT_NEAR(integrator.hemisphere(cosine > 0)[1], fresnel, 2e-3);
        EXPECT_NEAR(integrator.hemisphere(cosine < 0)[1] * eta * eta, 1 - fresnel, 2e-3);
    }
}

TEST(Dielectric, RefusesAnIndexThatNothingHas) {
    for (const float eta : {-1.f, 1e-5f, 1e6f}) {
        MaterialTables tables;
        PlainMaterialInput input({number("eta", eta)}, tables);
        EXPECT_THROW(DielectricMaterial::make(input), Error) << eta;
    }
}

}  // namespace
}  // namespace penumbra::test
