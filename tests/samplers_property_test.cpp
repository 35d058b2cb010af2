// What every registered sampler must satisfy, as a fold over SamplerTypes; and the exact identities of particular ones.

#include "core/statistics/distributions.h"
#include "samplers/registry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace penumbra {
namespace {

template <class Function>
void forEachSampler(int samples, Function&& f) {
    const ParameterSet none;
    for (const std::string& name : pluginNames(SamplerTypes{})) {
        SamplerInput input{none, samples};
        Sampler sampler;
        ASSERT_TRUE(makeSampler(name, input, sampler));
        EXPECT_EQ(input.samplesPerPixel, samples) << name;
        SCOPED_TRACE(name);
        f(name, sampler);
    }
}

SampleAddress<float> address(std::uint32_t pixel, std::uint32_t sample, std::uint32_t seed = 1) {
    return addressOf<float>(pixel, sample, 1, seed);
}

TEST(Samplers, DrawsArePureFunctionsInTheUnitInterval) {
    forEachSampler(64, [](const std::string&, const Sampler& s) {
        for (std::uint32_t i = 0; i < 512; ++i) {
            const auto a = address(i / 64, i % 64);
            const float x = s.at<float>(a, 3).get1(Dim::Lobe);
            const Vec2<float> u = s.at<float>(a, 2).get2(Dim::Direction);
            s.at<float>(address(77, 5), 9).get1(Dim::Roulette);   // go elsewhere, come back
            EXPECT_EQ(x, s.at<float>(a, 3).get1(Dim::Lobe));
            EXPECT_EQ(u.y, s.at<float>(a, 2).get2(Dim::Direction).y);
            for (float v : {x, u.x, u.y}) {
                EXPECT_GE(v, 0.f);
                EXPECT_LT(v, 1.f);
            }
        }
    });
}

TEST(Samplers, EightLanesGiveTheBitsOfOne) {
    for (std::uint32_t replicates : {1u, 4u})
        forEachSampler(60, [&](const std::string&, const Sampler& s) {
            for (std::uint32_t i = 0; i < 1024; i += 8) {
                std::uint32_t pixel[8], sample[8];
                for (std::uint32_t k = 0; k < 8; ++k) pixel[k] = mixBits(i + k) & 0xFFFFFu, sample[k] = (i * 3 + k) % 200;
                const auto wide = addressOf<Lanes8f>(load<Lanes8f>(pixel), load<Lanes8f>(sample), replicates, 5);
                const auto u = s.at<Lanes8f>(wide, 4).get2(Dim::LightPosition);
                const auto v = s.at<Lanes8f>(wide, 1).get1(Dim::Roulette);
                for (int k = 0; k < 8; ++k) {
                    const auto a = addressOf<float>(pixel[k], sample[k], replicates, 5);
                    EXPECT_EQ(s.at<float>(a, 4).get2(Dim::LightPosition).x, lane(u.x, k));
                    EXPECT_EQ(s.at<float>(a, 4).get2(Dim::LightPosition).y, lane(u.y, k));
                    EXPECT_EQ(s.at<float>(a, 1).get1(Dim::Roulette), lane(v, k));
                }
            }
        });
}

/// p-value of the hypothesis that pairs of numbers fill the unit square evenly, over independent pixels.
template <class Draw>
double uniformityPValue(Draw draw) {
    constexpr int kCells = 16, kDraws = 100000;
    std::vector<double> observed(kCells * kCells, 0.0), expected(kCells * kCells, double(kDraws) / (kCells * kCells));
    for (std::uint32_t i = 0; i < kDraws; ++i) {
        const Vec2<float> u = draw(i);
        ++observed[std::size_t(int(u.x * kCells) * kCells + int(u.y * kCells))];
    }
    double chi2 = 0;
    for (std::size_t c = 0; c < observed.size(); ++c) chi2 += (observed[c] - expected[c]) * (observed[c] - expected[c]) / expected[c];
    return chiSquareSurvival(chi2, double(kCells * kCells - 1));
}

TEST(Samplers, EverySampleIsUniformAndEveryPairOfDrawsIndependent) {
    // Across pixels the numbers of one address are independent. 7 tests for each of the samplers: Sidak at 1e-3 in all.
    const double level = 1 - std::pow(1 - 1e-3, 1.0 / (7.0 * SamplerTypes::size));
    forEachSampler(64, [&](const std::string&, const Sampler& s) {
        const auto at = [](std::uint32_t i) { return address(i, 37); };
        EXPECT_GT(uniformityPValue([&](std::uint32_t i) { return s.at<float>(at(i), 0).get2(Dim::Filter); }), level);
        EXPECT_GT(uniformityPValue([&](std::uint32_t i) { return s.at<float>(at(i), 3).get2(Dim::Direction); }), level);
        EXPECT_GT(uniformityPValue([&](std::uint32_t i) {
            return Vec2<float>{s.at<float>(at(i), 1).get1(Dim::Lobe), s.at<float>(at(i), 1).get1(Dim::Roulette)};
        }), level) << "two dimensions of one vertex";
        EXPECT_GT(uniformityPValue([&](std::uint32_t i) {
            return Vec2<float>{s.at<float>(at(i), 1).get2(Dim::LightPosition).x, s.at<float>(at(i), 1).get2(Dim::Direction).x};
        }), level) << "light and direction";
        EXPECT_GT(uniformityPValue([&](std::uint32_t i) {
            return Vec2<float>{s.at<float>(at(i), 1).get2(Dim::Direction).x, s.at<float>(at(i), 2).get2(Dim::Direction).x};
        }), level) << "two vertices";
        EXPECT_GT(uniformityPValue([&](std::uint32_t i) {
            return Vec2<float>{s.at<float>(address(i, 3), 1).get1(Dim::Lobe), s.at<float>(address(i + 1, 3), 1).get1(Dim::Lobe)};
        }), level) << "neighbouring pixels";
        EXPECT_GT(uniformityPValue([&](std::uint32_t i) {
            return Vec2<float>{s.at<float>(address(i, 3, 1), 1).get1(Dim::Lobe), s.at<float>(address(i, 3, 2), 1).get1(Dim::Lobe)};
        }), level) << "neighbouring seeds";
    });
}

TEST(Samplers, ReplicatesAreIndependentRandomisationsOfTheSamePoints) {
    const Sampler s{SobolSampler{}};
    // Samples i = 4 k + plane are the first points of each plane: each plane's 16 points are a net of their own.
    for (std::uint32_t plane = 0; plane < 4; ++plane) {
        int cells[16] = {};
        for (std::uint32_t k = 0; k < 16; ++k) {
            const Vec2<float> u = s.at<float>(addressOf<float>(9, 4 * k + plane, 4, 1), 1).get2(Dim::LightPosition);
            ++cells[int(u.x * 4) * 4 + int(u.y * 4)];
        }
        for (int c : cells) EXPECT_EQ(c, 1);
    }
}

TEST(SobolSampler, EveryElementaryIntervalHasOnePoint) {
    const Sampler s{SobolSampler{}};
    for (Dim dim : {Dim::Direction, Dim::Filter})
        for (std::uint32_t pixel = 0; pixel < 20; ++pixel)
            for (int logN = 2; logN <= 10; logN += 2)
                for (int a = 0; a <= logN; ++a) {
                    const std::uint32_t n = 1u << logN;
                    std::vector<int> cells(n, 0);
                    for (std::uint32_t i = 0; i < n; ++i) {
                        const Vec2<float> u = s.at<float>(address(pixel, i), dim == Dim::Filter ? 0 : 1).get2(dim);
                        ++cells[(std::uint32_t(u.x * float(1 << a)) << (logN - a)) + std::uint32_t(u.y * float(1 << (logN - a)))];
                    }
                    for (int c : cells) ASSERT_EQ(c, 1);
                }
}

TEST(SobolSampler, EveryNumberIsStratifiedAlone) {
    const Sampler s{SobolSampler{}};
    for (Dim dim : {Dim::Lobe, Dim::LightPick, Dim::Roulette, Dim::ShadowRoulette, Dim::Material})
        for (std::uint32_t pixel = 0; pixel < 20; ++pixel) {
            std::vector<int> cells(256, 0);
            for (std::uint32_t i = 0; i < 256; ++i) ++cells[std::size_t(s.at<float>(address(pixel, i), 5).get1(dim) * 256)];
            for (int c : cells) ASSERT_EQ(c, 1);
        }
}

/// Mean squared error of the average of f over n points of a pair of dimensions, over many pixels.
template <class Integrand>
double meanSquaredError(const Sampler& s, std::uint32_t n, std::uint32_t pixels, double truth, Integrand f) {
    double sum = 0;
    for (std::uint32_t p = 0; p < pixels; ++p) {
        double mean = 0;
        for (std::uint32_t i = 0; i < n; ++i) {
            const Vec2<float> u = s.at<float>(address(p, i), 1).get2(Dim::Direction);
            mean += f(double(u.x), double(u.y)) / n;
        }
        sum += (mean - truth) * (mean - truth) / pixels;
    }
    return sum;
}

TEST(SobolSampler, ErrorFallsAsThatOfExactOwenScrambling) {
    // Published measurements of exactly scrambled Sobol points at 1024 samples: gauss 1.15e-10, bilinear 3.81e-10,
    // disk 4.72e-6. 2000 randomisations estimate a mean squared error to about 4 %; 20 % is five of those.
    const Sampler s{SobolSampler{}};
    const double gauss = 0.5577462853510337;
    EXPECT_NEAR(meanSquaredError(s, 1024, 2000, gauss, [](double x, double y) { return std::exp(-x * x - y * y); }) / 1.15e-10, 1, 0.2);
    EXPECT_NEAR(meanSquaredError(s, 1024, 2000, 0.25, [](double x, double y) { return x * y; }) / 3.81e-10, 1, 0.2);
    EXPECT_NEAR(meanSquaredError(s, 1024, 2000, 0.5, [](double x, double y) { return x * x + y * y < 2 / 3.14159265358979 ? 1.0 : 0.0; }) / 4.72e-6, 1, 0.2);
}

TEST(StratifiedSampler, EveryStratumHasOneSampleAndTheErrorIsThatOfJitter) {
    const ParameterSet none;
    SamplerInput input{none, 1024};
    Sampler s;
    ASSERT_TRUE(makeSampler("stratified", input, s));
    for (std::uint32_t pixel = 0; pixel < 20; ++pixel)
        for (std::uint32_t pass = 0; pass < 2; ++pass) {
            std::vector<int> cells(1024, 0);
            for (std::uint32_t i = 0; i < 1024; ++i) {
                const Vec2<float> u = s.at<float>(address(pixel, pass * 1024 + i), 1).get2(Dim::LightPosition);
                ++cells[std::size_t(int(u.x * 32) * 32 + int(u.y * 32))];
            }
            for (int c : cells) ASSERT_EQ(c, 1);
        }
    // Exact: (1/18 - 1/(144 N)) / N^2 for the bilinear integrand.
    const double exact = (1.0 / 18 - 1.0 / (144 * 1024)) / 1024 / 1024;
    EXPECT_NEAR(meanSquaredError(s, 1024, 2000, 0.25, [](double x, double y) { return x * y; }) / exact, 1, 0.2);
}

TEST(IndependentSampler, ErrorIsThatOfRandomNumbers) {
    const Sampler s{IndependentSampler{}};
    EXPECT_NEAR(meanSquaredError(s, 256, 4000, 0.25, [](double x, double y) { return x * y; }) / (7.0 / 144 / 256), 1, 0.12);
}

}  // namespace
}  // namespace penumbra
