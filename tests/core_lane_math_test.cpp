// Lanes: one lane and eight give the same bits; our own elementary functions are as accurate as their header says.

#include "core/math/hash.h"
#include "core/math/vector.h"
#include "core/math/warps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace penumbra {
namespace {

float randomFloat(std::uint32_t i, float low, float high) { return low + (high - low) * unitFloat<float>(mixBits(i)); }

/// Largest error of `f` against `exact` over random arguments, and bit equality of the eight-lane version on the way.
template <class One, class Eight, class Exact>
double largestError(float low, float high, One one, Eight eight, Exact exact, bool relative) {
    double worst = 0;
    for (std::uint32_t i = 0; i < (1u << 18); i += 8) {
        float x[8];
        for (std::uint32_t k = 0; k < 8; ++k) x[k] = randomFloat(i + k, low, high);
        const Lanes8f wide = eight(load<Lanes8f>(x));
        for (int k = 0; k < 8; ++k) {
            const float got = one(x[k]);
            EXPECT_EQ(floatBits(got), floatBits(lane(wide, k))) << x[k];
            const double want = exact(double(x[k]));
            worst = std::max(worst, std::fabs(got - want) / (relative ? std::fabs(want) : 1.0));
        }
    }
    return worst;
}

#define PENUMBRA_BOTH(f) [](float x) { return f(x); }, [](Lanes8f x) { return f(x); }

TEST(LaneMath, ElementaryFunctionsAreAccurateAndTheSameInEveryLane) {
    EXPECT_LT(largestError(-10, 10, PENUMBRA_BOTH(sin), [](double x) { return std::sin(x); }, false), 1.2e-7);
    EXPECT_LT(largestError(-8000, 8000, PENUMBRA_BOTH(cos), [](double x) { return std::cos(x); }, false), 1.5e-7);
    EXPECT_LT(largestError(-80, 80, PENUMBRA_BOTH(exp), [](double x) { return std::exp(x); }, true), 1.5e-7);
    EXPECT_LT(largestError(2, 1e6, PENUMBRA_BOTH(log), [](double x) { return std::log(x); }, true), 2e-7);
    EXPECT_LT(largestError(0.5f, 2, PENUMBRA_BOTH(log), [](double x) { return std::log(x); }, false), 1e-7);
    EXPECT_LT(largestError(-1, 1, PENUMBRA_BOTH(asin), [](double x) { return std::asin(x); }, false), 4e-7);
    EXPECT_LT(largestError(-1, 1, PENUMBRA_BOTH(acos), [](double x) { return std::acos(x); }, false), 4e-7);
    const auto one = [](float x) { return atan2(x, 0.3f); };
    const auto eight = [](Lanes8f x) { return atan2(x, Lanes8f(0.3f)); };
    EXPECT_LT(largestError(-20, 20, one, eight, [](double x) { return std::atan2(x, double(0.3f)); }, false), 4e-7);
    const auto onePow = [](float x) { return pow(x, 2.4f); };
    const auto eightPow = [](Lanes8f x) { return pow(x, Lanes8f(2.4f)); };
    EXPECT_LT(largestError(0.01f, 10, onePow, eightPow, [](double x) { return std::pow(x, double(2.4f)); }, true), 1.3e-6);
    const auto scaled = [](double x) { return std::exp(-x) * std::cyl_bessel_i(0, x); };
    EXPECT_LT(largestError(0, 10, PENUMBRA_BOTH(besselI0Scaled), scaled, true), 6e-7);
    EXPECT_LT(largestError(10, 600, PENUMBRA_BOTH(besselI0Scaled), scaled, true), 6e-7);
}

TEST(LaneMath, SpecialArguments) {
    EXPECT_EQ(atan2(0.f, 0.f), 0.f);
    EXPECT_FLOAT_EQ(atan2(0.f, -1.f), kPi);
    EXPECT_FLOAT_EQ(atan2(-1.f, 0.f), -kHalfPi);
    EXPECT_EQ(exp(-200.f), 0.f);
    EXPECT_TRUE(std::isfinite(exp(1000.f)));
    EXPECT_EQ(log(0.f), -kInfinity);
    EXPECT_EQ(pow(0.f, 2.f), 0.f);
    EXPECT_EQ(pow(0.f, 0.f), 1.f);
    EXPECT_FLOAT_EQ(acos(2.f), 0.f);
    EXPECT_FLOAT_EQ(asin(-2.f), -kHalfPi);
    EXPECT_FALSE(isFinite(kInfinity));
    EXPECT_TRUE(isFinite(3e38f));
}

TEST(Lanes, BitOperationsAgreeWithScalarOnes) {
    for (std::uint32_t i = 0; i < 4096; i += 8) {
        std::uint32_t x[8];
        for (std::uint32_t k = 0; k < 8; ++k) x[k] = mixBits(i + k);
        const Lanes8u wide = load<Lanes8f>(x);
        const Lanes8u reversed = reverseBits(wide), hashed = mixBits(wide);
        for (int k = 0; k < 8; ++k) {
            std::uint32_t naive = 0;
            for (int b = 0; b < 32; ++b) naive |= (x[k] >> b & 1u) << (31 - b);
            EXPECT_EQ(lane(reversed, k), naive);
            EXPECT_EQ(reverseBits(x[k]), naive);
            EXPECT_EQ(lane(hashed, k), mixBits(x[k]));
        }
    }
}

TEST(Lanes, PackingKeepsTheOrderOfTheLanes) {
    const Lanes8u value = laneIndices<Lanes8f>() * Lanes8u(10u);
    for (unsigned keep = 0; keep < 256; ++keep) {
        std::uint32_t out[8] = {};
        std::uint16_t narrow[8] = {};
        storePacked(out, value, keep);
        storePackedIndices(narrow, value + Lanes8u(65000u), keep);
        int n = 0;
        for (std::uint32_t k = 0; k < 8; ++k) {
            if (!(keep >> k & 1u)) continue;
            EXPECT_EQ(narrow[n], 65000 + 10 * k);
            EXPECT_EQ(out[n++], 10 * k);
        }
    }
}

TEST(Lanes, RowLoadsTranspose) {
    float table[64];
    for (int i = 0; i < 64; ++i) table[i] = float(i);
    std::uint32_t offset[8] = {0, 5, 60, 7, 11, 3, 40, 22};
    Lanes8f out[4];
    loadRows4(table, load<Lanes8f>(offset), out);
    for (int k = 0; k < 8; ++k)
        for (int c = 0; c < 4; ++c) EXPECT_EQ(lane(out[c], k), table[offset[k] + std::uint32_t(c)]);
}

TEST(Lanes, RowsOfEightComeBackPacked) {
    Lanes8f column[8], back[8];
    for (int c = 0; c < 8; ++c) column[c] = toFloat<Lanes8f>(laneIndices<Lanes8f>()) * Lanes8f(8.f) + Lanes8f(float(c));
    for (unsigned keep = 0; keep < 256; ++keep) {
        float rows[8 * 12];
        storeRows8(rows, 12, column, keep);
        loadRows8(rows, laneIndices<Lanes8f>() * Lanes8u(12u), back);
        int n = 0;
        for (int k = 0; k < 8; ++k) {
            if (!(keep >> k & 1u)) continue;
            for (int c = 0; c < 8; ++c) EXPECT_EQ(lane(back[c], n), float(8 * k + c));
            ++n;
        }
    }
}

TEST(Lanes, RowStoresScatter) {
    float table[64] = {};
    std::uint32_t offset[8] = {0, 12, 60, 4, 28, 40, 20, 52};
    Lanes8f in[4];
    for (int c = 0; c < 4; ++c) in[c] = toFloat<Lanes8f>(laneIndices<Lanes8f>()) * Lanes8f(4.f) + Lanes8f(float(c + 1));
    scatterRows4(table, load<Lanes8f>(offset), in);
    for (int k = 0; k < 8; ++k)
        for (int c = 0; c < 4; ++c) EXPECT_EQ(table[offset[k] + std::uint32_t(c)], float(4 * k + c + 1));
    EXPECT_EQ(table[8], 0.f);
}

TEST(Lanes, SelectAndMasks) {
    const Lanes8f a(1.f), b(2.f);
    const Mask8 even = (laneIndices<Lanes8f>() & Lanes8u(1u)) == Lanes8u(0u);
    EXPECT_EQ(bits(even), 0x55u);
    EXPECT_EQ(bits(!even), 0xAAu);
    EXPECT_EQ(countLanes(even), 4);
    for (int k = 0; k < 8; ++k) EXPECT_EQ(lane(select(even, a, b), k), k % 2 ? 2.f : 1.f);
    EXPECT_EQ(bits(firstLanes<Lanes8f>(3)), 7u);
}

TEST(Warps, ConcentricDiskStaysInsideAndKeepsAreas) {
    // Uniform on the disk: mean of r^2 is 1/2; 2^16 stratified points leave an error far below 1e-4.
    double sum = 0;
    for (int i = 0; i < 256; ++i)
        for (int j = 0; j < 256; ++j) {
            const Vec2<float> d = concentricDisk<float>({(float(i) + 0.5f) / 256, (float(j) + 0.5f) / 256});
            const double r2 = double(d.x) * d.x + double(d.y) * d.y;
            ASSERT_LE(r2, 1 + 1e-6);
            sum += r2 / 65536;
        }
    EXPECT_NEAR(sum, 0.5, 1e-4);
}

TEST(Vector, BasisIsOrthonormalForEveryDirection) {
    for (std::uint32_t i = 0; i < 10000; ++i) {
        const Vec3<float> n = uniformSphere<float>({unitFloat<float>(mixBits(2 * i)), unitFloat<float>(mixBits(2 * i + 1))});
        Vec3<float> s, t;
        orthonormalBasis(n, s, t);
        EXPECT_NEAR(dot(s, s), 1, 1e-5);
        EXPECT_NEAR(dot(t, t), 1, 1e-5);
        EXPECT_NEAR(dot(s, t), 0, 1e-5);
        EXPECT_NEAR(dot(cross(s, t), n), 1, 1e-5);
    }
}

}  // namespace
}  // namespace penumbra
