// The coated metal: its closed forms where it has them, and the layered random walk that its estimates are estimates
// of.
#include "core/statistics/multiple_comparisons.h"
#include "tests/layered_walk.h"
#include "tests/materials_fixture.h"

#include <gtest/gtest.h>

#include <complex>

namespace penumbra::test {
namespace {

using F = Lanes8f;
using Coated = MaterialsUnderTest<CoatedConductorMaterial>;

/// Fresnel's equations as they stand in the books, unpolarised.
double metalReflectance(double cosine, std::complex<double> index) {
    const std::complex<double> refracted = std::sqrt(1.0 - (1 - cosine * cosine) / (index * index));
    const auto s = (cosine - index * refracted) / (cosine + index * refracted);
    const auto p = (index * cosine - refracted) / (index * cosine + refracted);
    return (std::norm(s) + std::norm(p)) / 2;
}

struct Mirrors {
    double eta = 1.5, thickness = 0.01, metalEta = 0.9765, metalK = 2.6211;
    int bounces = 5;

    /// What two smooth layers reflect.
    double reflectance(double cosine) const {
        const double inside = std::sqrt(1 - (1 - cosine * cosine) / (eta * eta));
        const double top = metalReflectance(cosine, eta), crossings = std::exp(-2 * thickness / inside);
        const double metal = crossings * metalReflectance(inside, std::complex(metalEta, metalK) / eta);
        double sum = top;
        for (int k = 0; k < bounces; ++k)
            sum += (1 - top) * (1 - top) * metal * std::pow(metal * top, k);
        return sum;
    }
};

TEST(CoatedConductor, SmoothLayersHaveTheirClosedForm) {
    const Coated copper(Settings{}), thick(Settings{number("interface.eta", 2), number("thickness", 0.3f), integer("maxdepth", 4)});
    const Mirrors thickSum{2, 0.3, 0.9765, 2.6211, 2};
    for (const double cosine : {1.0, 0.7, 0.3, 0.1, 0.02}) {
        const Vec3<float> wo = directionOf(cosine, 0.3);
        EXPECT_NEAR(copper.closure<float>(0u).albedo(wo).g, Mirrors{}.reflectance(cosine), 2e-5) << cosine;
        EXPECT_NEAR(thick.closure<float>(0u).albedo(wo).g, thickSum.reflectance(cosine), 2e-5) << cosine;
        const BsdfSample<float> s = copper.closure<float>(0u).sample(wo, 0.9f, {0.1f, 0.7f});
        EXPECT_TRUE(s.valid && s.delta);
        EXPECT_NEAR(s.weight.g, Mirrors{}.reflectance(cosine), 2e-5) << cosine;
        EXPECT_NEAR(s.wi.x, -wo.x, 1e-6);
    }
}

/// Copper under the default coat. The published figures are of a spectral rendering; copper's three channels stand for
/// its spectrum in air, and under a coat come as near as this.
TEST(CoatedConductor, HasThePublishedReflectance) {
    const Spectrum<float> albedo = Coated(Settings{}).closure<float>(0u).albedo({0, 0, 1});
    EXPECT_NEAR(albedo.r, 0.915, 0.012);
    EXPECT_NEAR(albedo.g, 0.547, 0.012);
    EXPECT_NEAR(albedo.b, 0.440, 0.012);
}

/// By reflectance: the index 1 + ik over that of the coat.
TEST(CoatedConductor, ReflectanceIsThatOfTheBareMetal) {
    const double r = 0.7, k = 2 * std::sqrt(r / (1 - r));
    const Coated coated(Settings{color("reflectance", 0.7f, 0.7f, 0.7f)});
    EXPECT_NEAR(coated.closure<float>(0u).albedo(directionOf(0.6, 0)).r, (Mirrors{1.5, 0.01, 1, k, 5}.reflectance(0.6)),
                2e-5);
}

/// Light that meets the metal once, through a smooth coat, is known exactly: no chance is left.
TEST(CoatedConductor, SmoothCoatIsExactUpToTheFirstMeeting) {
    const float alpha = 0.3f;
    const Coated coated(Settings{number("conductor.roughness", alpha), plainAlpha(), integer("maxdepth", 1)});
    const Vec3<float> wo = directionOf(0.8, 0.4), wi = directionOf(0.5, 2.9);
    const auto inside = [](const Vec3<float>& w) {
        return Vec3<float>{w.x / 1.5f, w.y / 1.5f, std::sqrt(1 - (1 - w.z * w.z) / 2.25f)};
    };
    const Vec3<float> o = inside(wo), i = inside(wi), h = normalize(o + i);
    const auto through = [](const Vec3<float>& out, const Vec3<float>& in) {
        return (1 - metalReflectance(out.z, 1.5)) * std::exp(-0.01 / in.z);
    };
    const double k = alpha * alpha, d = k / (3.14159265358979 * std::pow(h.z * h.z * (k - 1) + 1, 2));
    const auto lambda = [&](double z) { return (std::sqrt(1 + k * (1 / (z * z) - 1)) - 1) / 2; };
    const double metal = metalReflectance(dot(o, h), std::complex(0.9765, 2.6211) / 1.5) * d /
        (4 * o.z * i.z * (1 + lambda(o.z) + lambda(i.z)));
    const double expected = through(wo, o) * through(wi, i) * metal / 2.25 * wi.z;
    for (const float chance : {0.f, 0.4f, 0.9f})
        EXPECT_NEAR(coated.closure<float>(0u, chance).evaluate(wo, wi).fCos.g, expected, 1e-4 * expected);
}

// ------------------------------------------------------------------------------------------------ estimates

struct Layers {
    float coatX, coatY, metalX, metalY, eta, thickness;
    int maxDepth;
    double cosine;

    Coated coated() const {
        return Coated(Settings{number("interface.uroughness", coatX), number("interface.vroughness", coatY),
                               number("conductor.uroughness", metalX), number("conductor.vroughness", metalY), plainAlpha(),
                               number("interface.eta", eta), number("thickness", thickness), integer("maxdepth", maxDepth)});
    }
    LayeredWalk walk() const {
        const float n = 0.9765f / eta, k = 2.6211f / eta;
        const Ggx<float> metal = RoughnessInputs::surface<float>(metalX, metalY).ggx;
        const bool smooth = std::max(metalX, metalY) < kSmoothAlpha;
        return LayeredWalk(eta, thickness, {std::max(coatX, 1e-5f), std::max(coatY, 1e-5f)}, maxDepth,
                           [=](const Vec3<float>& from, LayeredWalk& numbers, double& weight) {
                               const float x = numbers.next(), y = numbers.next();
                               const Vec3<float> m = smooth ? Vec3<float>{0, 0, 1} : metal.sampleVisible(from, {x, y});
                               const Vec3<float> to = m * (2 * dot(from, m)) - from;
                               weight *= to.z > 0 ? metalReflectance(dot(from, m), {n, k}) : 0;
                               if (!smooth && to.z > 0) weight *= metal.shadowing(from, to);
                               return to;
                           });
    }
};
const Layers kLayers[] = {{0.3f, 0.3f, 0.2f, 0.2f, 1.5f, 0.01f, 10, 0.8},   {0.14f, 0.14f, 0.045f, 0.045f, 1.5f, 0.01f, 10, 0.6},
                          {0.4f, 0.1f, 0.f, 0.f, 1.5f, 0.01f, 10, 0.5},     {0.f, 0.f, 0.6f, 0.2f, 1.5f, 0.05f, 10, 0.9},
                          {0.f, 0.f, 0.9f, 0.9f, 1.8f, 0.f, 20, 0.3},       {0.2f, 0.2f, 0.5f, 0.5f, 0.8f, 0.01f, 10, 0.7}};

/// Energy by direction, over 4 x 6 cells of the hemisphere: samples of the closure against walks. Welch's tests; the
/// whole family has a false-alarm rate of 1e-3 (Sidak).
TEST(CoatedConductor, IsTheExpectationOfTheLayeredWalk) {
    constexpr int kCells = 24;
    constexpr std::uint32_t kSamples = 1u << 18;
    const double level = sidakLevel(1e-3, kCells * std::size(kLayers));
    const auto cellOf = [](const Vec3<float>& w) {
        const double turn = std::atan2(double(w.y), double(w.x)) / 6.283185307179586 + 0.5;
        return std::min(int(w.z * w.z * 4), 3) * 6 + std::min(int(turn * 6), 5);
    };
    for (const Layers& layers : kLayers) {
        const Coated coated = layers.coated();
        const Vec3<float> wo = directionOf(layers.cosine, 0.3);
        std::vector<std::vector<double>> sampled(kCells, std::vector<double>(kSamples)), walked = sampled;
        const Uniforms u{17};
        for (std::uint32_t group = 0; group < kSamples / 8; ++group) {
            const BsdfSample<F> s =
                coated.wide(0, u(group, 3)).sample(broadcast<F>(wo), u(group, 0), {u(group, 1), u(group, 2)});
            for (int k = 0; k < 8; ++k)
                if (lane(s.valid, k)) sampled[std::size_t(cellOf(lane(s.wi, k)))][group * 8 + k] = lane(s.weight.g, k);
        }
        LayeredWalk walk = layers.walk();
        for (std::uint32_t i = 0; i < kSamples; ++i) {
            const LayeredWalk::Leaving light = walk.walk(wo);
            walked[std::size_t(cellOf(light.w))][i] = light.weight;
        }
        for (int c = 0; c < kCells; ++c) {
            const Moments ours = momentsOf(sampled[std::size_t(c)]), theirs = momentsOf(walked[std::size_t(c)]);
            if (ours.mean == 0 && theirs.mean == 0) continue;
            EXPECT_GT(welchTest(ours, theirs).pValue, level)
                << "coat " << layers.coatX << ", metal " << layers.metalX << ", cell " << c << ": " << ours.mean << " against "
                << theirs.mean;
        }
    }
}

/// Both ways alike, in the mean over chances: Welch's tests, a false-alarm rate of 1e-3 for all (Sidak).
TEST(CoatedConductor, IsReciprocalInTheMean) {
    const double level = sidakLevel(1e-3, std::size(kLayers));
    for (const Layers& layers : kLayers) {
        const Coated coated = layers.coated();
        const Vec3<float> wo = directionOf(layers.cosine, 0.3), wi = directionOf(0.6, 3.0);
        const Uniforms u{29};
        std::vector<double> there, back;
        for (std::uint32_t group = 0; group < 8192; ++group) {
            const BsdfEval<F> a = coated.wide(0, u(group, 0)).evaluate(broadcast<F>(wo), broadcast<F>(wi)),
                              b = coated.wide(0, u(group, 1)).evaluate(broadcast<F>(wi), broadcast<F>(wo));
            for (int k = 0; k < 8; ++k) {
                there.push_back(lane(a.fCos.g, k) / wi.z);
                back.push_back(lane(b.fCos.g, k) / wo.z);
            }
        }
        EXPECT_GT(welchTest(momentsOf(there), momentsOf(back)).pValue, level)
            << "coat " << layers.coatX << ", metal " << layers.metalX << ": " << momentsOf(there).mean << " against "
            << momentsOf(back).mean;
    }
}

/// A white metal under a clear coat keeps all, but for what masking takes: little where both are nearly smooth, and
/// never does light come of nothing. Student's tests against a false-alarm rate of 1e-3 for all.
TEST(CoatedConductor, KeepsItsEnergy) {
    const auto energy = [](float coat, float metal, double cosine) {
        const Coated coated(Settings{color("reflectance", 1, 1, 1), number("interface.roughness", coat),
                                     number("conductor.roughness", metal), number("thickness", 0), plainAlpha(),
                                     integer("maxdepth", 1000)});
        const Uniforms u{31};
        std::vector<double> values;
        for (std::uint32_t group = 0; group < 8192; ++group) {
            const BsdfSample<F> s = coated.wide(0, u(group, 3))
                                        .sample(broadcast<F>(directionOf(cosine, 1)), u(group, 0), {u(group, 1), u(group, 2)});
            for (int k = 0; k < 8; ++k)
                values.push_back(lane(s.valid, k) ? lane(s.weight.r, k) : 0);
        }
        return momentsOf(values);
    };
    for (const double cosine : {1.0, 0.7, 0.4}) {
        EXPECT_GT(studentTest(energy(0.02f, 0.03f, cosine), 1, 5e-3).pValue, 1e-4) << cosine;
        EXPECT_GT(studentTest(energy(0.f, 0.03f, cosine), 1, 5e-3).pValue, 1e-4) << cosine;
        EXPECT_GT(studentTest(energy(0.03f, 0.f, cosine), 1, 5e-3).pValue, 1e-4) << cosine;
        EXPECT_LT(energy(0.5f, 0.5f, cosine).mean, 1);
    }
}

/// n walks have an n-th of the variance of one.
TEST(CoatedConductor, WalksAverage) {
    const auto variance = [](int walks) {
        const Coated coated(Settings{number("interface.roughness", 0.1f), number("conductor.roughness", 0.1f),
                                     integer("nsamples", walks)});
        const Uniforms u{37};
        std::vector<double> values;
        for (std::uint32_t group = 0; group < 4096; ++group) {
            const BsdfEval<F> e =
                coated.wide(0, u(group, 0)).evaluate(broadcast<F>(directionOf(0.7, 0)), broadcast<F>(directionOf(0.6, 3)));
            for (int k = 0; k < 8; ++k)
                values.push_back(lane(e.fCos.r, k));
        }
        return momentsOf(values).variance;
    };
    EXPECT_NEAR(variance(1) / variance(8), 8, 1);
}

TEST(CoatedConductor, RefusesWhatItCannotMean) {
    const auto make = [](const Settings& settings) {
        MaterialTables tables;
        PlainMaterialInput input(settings, tables);
        return CoatedConductorMaterial::make(input);
    };
    EXPECT_THROW(make({number("interface.eta", 1e4f)}), Error);
    EXPECT_THROW(make({number("conductor.roughness", -1)}), Error);
    EXPECT_THROW(make({integer("nsamples", 0)}), Error);
    EXPECT_THROW(make({integer("maxdepth", -1)}), Error);
    EXPECT_THROW(make({color("reflectance", 1, 1, 1), color("conductor.k", 1, 1, 1)}), Error);
    EXPECT_EQ(make({integer("maxdepth", 2000000000)}).metalBounces, 1000u);
}

}  // namespace
}  // namespace penumbra::test
