// Hair: its formulas against a second implementation in double precision, the white furnace, the highlights' places.
#include "tests/materials_fixture.h"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

using F = Lanes8f;
using Hair = MaterialsUnderTest<HairMaterial>;
constexpr double kPiD = 3.14159265358979323846;

/// The closure at a place across the fibre.
template <class T>
HairBsdf<T> closureAt(const Hair& hair, T h) {
    HairBsdf<T> bsdf = hair.closure<T>(UInt<T>(0u));
    bsdf.h = h;
    return bsdf;
}

/// The model as its authors write it: angles, logistic integrals and Bessel functions of the standard library.
struct Reference {
    double sigma = 0, eta = 1.55, betaM = 0.3, betaN = 0.3, alphaDegrees = 2, h = 0;

    double value(const Vec3<float>& wo, const Vec3<float>& wi) const {
        const double thetaO = std::asin(double(wo.x)), thetaI = std::asin(double(wi.x));
        const double phi = std::atan2(double(wi.z), double(wi.y)) - std::atan2(double(wo.z), double(wo.y));
        const double gammaO = std::asin(h), etaAcross = std::sqrt(eta * eta - std::pow(std::sin(thetaO), 2)) / std::cos(thetaO);
        const double gammaT = std::asin(h / etaAcross), thetaT = std::asin(std::sin(thetaO) / eta);
        const double through = std::exp(-2 * sigma * std::cos(gammaT) / std::cos(thetaT));
        const double f = fresnel(std::cos(thetaO) * std::cos(gammaO));
        const double a[] = {f, (1 - f) * (1 - f) * through, (1 - f) * (1 - f) * through * through * f};
        const double rest = a[2] * through * f / (1 - through * f);
        const double v = std::pow(0.726 * betaM + 0.812 * betaM * betaM + 3.7 * std::pow(betaM, 20), 2);
        const double s =
            std::sqrt(kPiD / 8) * (0.265 * betaN + 1.194 * betaN * betaN + 5.372 * std::pow(betaN, 22));
        const double tilt[] = {-2, 1, 4}, variance[] = {v, v / 4, 4 * v};
        double sum = longitudinal(thetaI, thetaO, 4 * v) * rest / (2 * kPiD);
        for (int p = 0; p < 3; ++p) {
            const double middle = 2 * p * gammaT - 2 * gammaO + p * kPiD;
            sum += longitudinal(thetaI, thetaO + tilt[p] * alphaDegrees * kPiD / 180, variance[p]) * a[p] *
                azimuthal(std::remainder(phi - middle, 2 * kPiD), s);
        }
        return sum;
    }

private:
    double fresnel(double c) const {
        const double g = std::sqrt(eta * eta - 1 + c * c);
        return 0.5 * std::pow((g - c) / (g + c), 2) * (1 + std::pow((c * (g + c) - 1) / (c * (g - c) + 1), 2));
    }
    static double longitudinal(double thetaI, double thetaO, double v) {
        const double a = std::cos(thetaI) * std::abs(std::cos(thetaO)) / v, b = std::sin(thetaI) * std::sin(thetaO) / v;
        return std::exp(-b) * std::cyl_bessel_i(0, a) / (2 * v * std::sinh(1 / v));
    }
    static double azimuthal(double x, double s) {
        const auto logistic = [s](double y) { return 1 / (1 + std::exp(-y / s)); };
        const double e = std::exp(-std::abs(x) / s);
        return e / (s * (1 + e) * (1 + e)) / (logistic(kPiD) - logistic(-kPiD));
    }
};

TEST(Hair, IsTheModelOfItsAuthors) {
    struct Case {
        Settings settings;
        Reference reference;
    };
    const Case cases[] = {
        {{color("sigma_a", 0.2f, 0.2f, 0.2f)}, {0.2}},
        {{color("sigma_a", 3, 3, 3), number("beta_m", 0.15f), number("beta_n", 0.7f), number("alpha", 7)},
         {3, 1.55, 0.15, 0.7, 7}},
        {{color("sigma_a", 0, 0, 0), number("eta", 1.33f), number("beta_m", 0.9f), number("beta_n", 0.12f)},
         {0, 1.33, 0.9, 0.12}},
        // Of pigments: 1.3 of the brown one.
        {{}, {1.3 * 0.419}},
        {{number("eumelanin", 0.5f), number("pheomelanin", 2)}, {0.5 * 0.419 + 2 * 0.187}},
    };
    for (const Case& c : cases) {
        const Hair hair(c.settings);
        for (std::uint32_t i = 0; i < 500; ++i) {
            const auto u = [&](std::uint32_t d) { return unitFloat<float>(mixBits(8 * i + d)); };
            const Vec3<float> wo = uniformSphere(Vec2<float>{u(0), u(1)}), wi = uniformSphere(Vec2<float>{u(2), u(3)});
            Reference reference = c.reference;
            reference.h = 1.98 * u(4) - 0.99;
            const double expected = reference.value(wo, wi);
            EXPECT_NEAR(closureAt(hair, float(reference.h)).evaluate(wo, wi).fCos.r, expected, 5e-4 * expected + 1e-6)
                << "wo.x " << wo.x << ", wi.x " << wi.x << ", h " << reference.h;
        }
    }
}

/// A core that absorbs nothing keeps all light, wherever it is met: the sum of its lobes, and samples one by one.
TEST(Hair, WhiteFurnace) {
    for (const float beta : {0.02f, 0.3f, 1.f}) {
        const Hair hair(Settings{color("sigma_a", 0, 0, 0), number("beta_m", beta), number("beta_n", beta)});
        const Uniforms u{5};
        for (std::uint32_t group = 0; group < 2000; ++group) {
            const Vec3<F> wo = uniformSphere(Vec2<F>{u(group, 0), u(group, 1)});
            const auto bsdf = closureAt(hair, F(2.f) * u(group, 2) - F(1.f));
            const Spectrum<F> albedo = bsdf.albedo(wo);
            const BsdfSample<F> s = bsdf.sample(wo, u(group, 3), {u(group, 4), u(group, 5)});
            for (int k = 0; k < 8; ++k) {
                EXPECT_NEAR(lane(albedo.r, k), 1, 1e-5);
                ASSERT_TRUE(lane(s.valid, k));
                EXPECT_NEAR(lane(s.weight.g, k), 1, 1e-4);
            }
        }
    }
}

TEST(Hair, IntegratesToItsAlbedo) {
    const Hair hair(Settings{color("sigma_a", 0.1f, 0.5f, 2), number("beta_m", 0.4f), number("beta_n", 0.5f)});
    for (const float h : {-0.8f, 0.f, 0.5f}) {
        const HairBsdf<F> bsdf = closureAt(hair, F(h));
        for (const Vec3<float>& wo : {directionOf(1, 0), directionOf(0.3, 0.2), directionOf(-0.7, 1.2)}) {
            const SphereIntegrator integrator(bsdf, wo);
            const Integral upper = integrator.hemisphere(true), lower = integrator.hemisphere(false);
            const Spectrum<float> albedo = lane(bsdf.albedo(broadcast<F>(wo)), 0);
            EXPECT_NEAR(upper[0] + lower[0], 1, 1e-4);
            EXPECT_NEAR(upper[1] + lower[1], albedo.r, 1e-4);
            EXPECT_NEAR(upper[2] + lower[2], albedo.g, 1e-4);
            EXPECT_NEAR(upper[3] + lower[3], albedo.b, 1e-4);
        }
    }
}

/// The scales turn the first reflection towards the root by twice their tilt.
TEST(Hair, ScalesShiftTheHighlight) {
    const auto brightest = [](float alpha) {
        const Hair hair(Settings{color("sigma_a", 1e4f, 1e4f, 1e4f), number("beta_m", 0.05f), number("alpha", alpha)});
        const HairBsdf<float> bsdf = closureAt(hair, 0.f);
        double best = 0, at = 0;
        for (int i = -400; i <= 400; ++i) {
            const double theta = i * 0.1 * kPiD / 180;
            const Vec3<float> wi{float(std::sin(theta)), 0, float(std::cos(theta))};
            const double value = bsdf.evaluate({0, 0, 1}, wi).fCos.r;
            if (value > best) best = value, at = i * 0.1;
        }
        return at;
    };
    EXPECT_NEAR(brightest(0), 0, 0.11);
    EXPECT_NEAR(brightest(2.5f), 5, 0.11);
    EXPECT_NEAR(brightest(-2.5f), -5, 0.11);
}

/// The colour asked for is that of a wide head of hair, not of a fibre: eq. 9 of the paper, at the default roughness.
TEST(Hair, ReflectanceFixesAbsorption) {
    const Hair hair(Settings{color("reflectance", 1, 0.5f, 0.1f)});
    const Spectrum<float> sigma = hair.closure<float>(0u).absorption;
    const double fit = 5.969 - 0.215 * 0.3 + 2.532 * 0.09 - 10.73 * 0.027 + 5.574 * 0.0081 + 0.245 * 0.00243;
    EXPECT_NEAR(sigma.r, 0, 1e-7);
    EXPECT_NEAR(sigma.g, std::pow(std::log(0.5) / fit, 2), 1e-6);
    EXPECT_NEAR(sigma.b, std::pow(std::log(0.1) / fit, 2), 1e-6);
}

TEST(Hair, HeightComesFromV) {
    const Hair hair(Settings{});
    EXPECT_NEAR(hair.closure<float>(0u).h, 2 * 0.7f - 1, 1e-6);
}

}  // namespace
}  // namespace penumbra::test
