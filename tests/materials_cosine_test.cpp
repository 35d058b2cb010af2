// phong and blinn against their closed forms, for perpendicular light: what arrives within a cone about the mirror direction.
#include "tests/materials_fixture.h"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

constexpr double kPiD = 3.14159265358979323846;

Settings glossyOnly(float exponent) {
    return {color("kd", 0, 0, 0), color("ks", 1, 1, 1), number("exponent", exponent)};
}

/// int f cos over the directions within the angle `sigma` of the normal, seen perpendicularly.
template <class M>
double withinCone(const Settings& settings, double sigma) {
    const MaterialsUnderTest<M> material(settings);
    const auto bsdf = material.wide();
    const SphereIntegrator integrator(bsdf, directionOf(1, 0));
    constexpr int kRings = 32;
    double sum = 0;
    for (int i = 0; i < kRings; ++i)
        sum += integrator.cell(std::cos(sigma * (i + 1) / kRings), std::cos(sigma * i / kRings), 0, 2 * kPiD)[1];
    return sum;
}

TEST(Phong, ConesHoldTheirShareOfPerpendicularLight) {
    EXPECT_NEAR(withinCone<PhongMaterial>(glossyOnly(10), kPiD / 6), 0.8220214844, 2e-6);
    for (const float n : {0.f, 1.f, 3.5f, 60.f, 1000.f})
        for (const double sigma : {0.05, 0.4, 1.2, kPiD / 2})
            EXPECT_NEAR(withinCone<PhongMaterial>(glossyOnly(n), sigma), 1 - std::pow(std::cos(sigma), n + 2.0), 2e-4)
                << n << " " << sigma;
}

TEST(Blinn, ConesHoldTheirShareOfPerpendicularLight) {
    for (const float n : {0.f, 1.f, 3.5f, 60.f, 1000.f}) {
        // int cos^n(t/2) cos t sin t dt from 0 to the angle, c = cos(angle / 2)
        const auto outside = [n](double angle) {
            const double c = std::cos(angle / 2);
            return 8 * std::pow(c, n + 4.0) / (n + 4) - 4 * std::pow(c, n + 2.0) / (n + 2);
        };
        const double all = outside(0) - outside(kPiD / 2);
        for (const double sigma : {0.05, 0.4, 1.2, kPiD / 2})
            EXPECT_NEAR(withinCone<BlinnMaterial>(glossyOnly(n), sigma), (outside(0) - outside(sigma)) / all, 2e-4)
                << n << " " << sigma;
    }
}

/// The glossy term reflects the less, the more light grazes.
template <class M>
void expectFallingAlbedo() {
    for (const float n : {0.f, 0.5f, 2.f, 7.f, 40.f}) {
        const MaterialsUnderTest<M> material(glossyOnly(n));
        const auto bsdf = material.wide();
        double before = 1 + 1e-4;
        for (const double cosine : {1.0, 0.95, 0.8, 0.6, 0.4, 0.2, 0.05}) {
            const double albedo = SphereIntegrator(bsdf, directionOf(cosine, 1)).hemisphere(true)[1];
            EXPECT_LE(albedo, before + 1e-4) << n << " " << cosine;
            before = albedo;
        }
    }
}
TEST(Phong, ReflectsNoMoreThanOfPerpendicularLight) {
    expectFallingAlbedo<PhongMaterial>();
}
TEST(Blinn, ReflectsNoMoreThanOfPerpendicularLight) {
    expectFallingAlbedo<BlinnMaterial>();
}

TEST(Blinn, WithoutExponentIsLambertian) {
    const MaterialsUnderTest<BlinnMaterial> blinn(glossyOnly(0));
    const MaterialsUnderTest<DiffuseMaterial> diffuse(Settings{color("reflectance", 1, 1, 1)});
    const Vec3<float> wo = directionOf(0.4, 1), wi = directionOf(0.7, 3);
    EXPECT_NEAR(blinn.closure<float>(0u).evaluate(wo, wi).fCos.g, diffuse.closure<float>(0u).evaluate(wo, wi).fCos.g,
                1e-6);
}

/// Lambert's reflection, of the hemisphere about the mirror direction: above the surface (1 + cos) / 2 of it by projection.
TEST(Phong, WithoutExponentIsLambertianInItsHemisphere) {
    const MaterialsUnderTest<PhongMaterial> phong(glossyOnly(0));
    for (const double cosine : {0.9, 0.6, 0.2})
        EXPECT_NEAR(sampledAlbedo(phong.wide(), directionOf(cosine, 1), 128), (1 + cosine) / 2, 1e-3);
}

TEST(Phong, TermsThatSumToMoreThanOneAreScaledDown) {
    MaterialTable table;
    PlainMaterialInput input({color("kd", 0.8f, 0.8f, 0.2f), color("ks", 0.6f, 0.1f, 0.1f)}, table.tables());
    table.add("phong", input);
    ASSERT_EQ(input.warnings.size(), 1u);
    EXPECT_NE(input.warnings[0].find("kd + ks is more than 1"), std::string::npos);
    const Textures textures;
    const ShadingContext<float> nowhere{textures, table.tableData(), {}};
    const auto bsdf = PhongMaterial::bsdf(table.records<PhongMaterial, float>(0u), nowhere);
    EXPECT_FLOAT_EQ(bsdf.kd.r, 0.8f / 1.4f);
    EXPECT_FLOAT_EQ(bsdf.ks.r, 0.6f / 1.4f);
    EXPECT_EQ(bsdf.kd.g, 0.8f);
    EXPECT_EQ(bsdf.ks.b, 0.1f);
}

TEST(Phong, RefusesExponentsOutOfRange) {
    for (const float exponent : {-1.f, 10001.f}) {
        MaterialTables tables;
        PlainMaterialInput input({number("exponent", exponent)}, tables);
        EXPECT_THROW(PhongMaterial::make(input), Error) << exponent;
        EXPECT_THROW(BlinnMaterial::make(input), Error) << exponent;
    }
}

}  // namespace
}  // namespace penumbra::test
