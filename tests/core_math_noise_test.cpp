// Gradient noise against its definition in double precision, with a value that Perlin's own program gives; its sums
// over octaves against theirs.
#include "core/math/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace penumbra {
namespace {

/// The definition, corner by corner: the weights are products of fades, the gradients stand in a table.
double noiseByDefinition(double x, double y, double z) {
    static constexpr int kGradients[16][3] = {{1, 1, 0},  {-1, 1, 0},  {1, -1, 0}, {-1, -1, 0}, {1, 0, 1},  {-1, 0, 1},
                                              {1, 0, -1}, {-1, 0, -1}, {0, 1, 1},  {0, -1, 1},  {0, 1, -1}, {0, -1, -1},
                                              {1, 1, 0},  {-1, 1, 0},  {0, 1, -1}, {0, -1, -1}};
    const double p[] = {x, y, z};
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1, d[3];
        std::uint32_t hash = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const int side = corner >> axis & 1;
            const double cell = std::floor(p[axis]), t = p[axis] - cell, fade = t * t * t * (t * (t * 6 - 15) + 10);
            weight *= side ? fade : 1 - fade;
            d[axis] = t - side;
            hash = detail::kNoisePermutation[(hash + std::uint32_t(int(cell) + side)) & 255];
        }
        const int* const g = kGradients[hash & 15];
        sum += weight * (g[0] * d[0] + g[1] * d[1] + g[2] * d[2]);
    }
    return sum;
}

struct Places {
    std::mt19937 random{21};
    float number(float size) { return float(std::int32_t(random())) * 0x1p-31f * size; }
    Vec3<float> place(float size) { return {number(size), number(size), number(size)}; }
};

TEST(CoreMathNoise, IsAPermutation) {
    std::array<int, 256> seen{};
    for (const std::uint32_t p : detail::kNoisePermutation) {
        ASSERT_LT(p, 256u);
        EXPECT_EQ(seen[p]++, 0);
    }
}

TEST(CoreMathNoise, KnownValues) {
    EXPECT_NEAR(gradientNoise(Vec3<float>{3.14f, 42, 7}), 0.13691995878400012, 1e-6);  // the reference program of 2002
    EXPECT_EQ(gradientNoise(Vec3<float>{0.5f, 0.5f, 0.5f}), -0.125f);
    for (int i = -5; i < 5; ++i)
        EXPECT_EQ(gradientNoise(Vec3<float>{float(i), float(3 * i), float(-7 * i)}), 0);
}

TEST(CoreMathNoise, FollowsItsDefinition) {
    Places places;
    double sum = 0, sumOfSizes = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
        const Vec3<float> p = places.place(100);
        const float noise = gradientNoise(p);
        ASSERT_NEAR(noise, noiseByDefinition(double(p.x), double(p.y), double(p.z)), 2e-6);
        sum += double(noise);
        sumOfSizes += std::fabs(double(noise));
    }
    EXPECT_NEAR(sum / n, 0, 0.01);  // five standard errors
    EXPECT_NEAR(sumOfSizes / n, 0.217, 0.006);
}

TEST(CoreMathNoise, HasAPeriodOf256) {
    Places places;
    for (int i = 0; i < 1000; ++i) {
        // On a grid that 256 more does not round away.
        const auto onGrid = [&] { return std::floor(places.number(100) * 1024) / 1024; };
        const Vec3<float> p = {onGrid(), onGrid(), onGrid()}, shifted = {p.x + 256, p.y - 512, p.z + 256 * 17};
        EXPECT_EQ(gradientNoise(p), gradientNoise(shifted));
    }
}

TEST(CoreMathNoise, IsFiniteEverywhere) {
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    for (const float x : {nan, infinity, -infinity, 3.4e38f, -3.4e38f, 1e-45f, -1e-9f, 16777216.f, -1e10f})
        for (const float y : {0.3f, nan, -3.4e38f}) {
            EXPECT_LE(std::fabs(gradientNoise(Vec3<float>{x, y, 0.7f})), 1.5f) << x << " " << y;
            EXPECT_TRUE(std::isfinite(turbulentNoise(Vec3<float>{x, y, 0.7f}, x, {32, 0.5f}))) << x << " " << y;
            EXPECT_TRUE(std::isfinite(brownianNoise(Vec3<float>{x, y, 0.7f}, x, {32, 0.5f}))) << x << " " << y;
        }
}

TEST(CoreMathNoise, SumsOfWholeOctaves) {
    Places places;
    for (int i = 0; i < 200; ++i) {
        const Vec3<float> p = places.place(5);
        double brownian = 0, turbulent = 0, frequency = 1, amplitude = 1;
        for (int octave = 0; octave < 5; ++octave, frequency *= 1.99, amplitude *= 0.6) {
            const auto scaled = [&](float x) { return frequency * double(x); };
            const double noise = noiseByDefinition(scaled(p.x), scaled(p.y), scaled(p.z));
            brownian += amplitude * noise;
            turbulent += amplitude * std::fabs(noise);
        }
        EXPECT_NEAR(brownianNoise(p, 0.f, {5, 0.6f}), brownian, 5e-5);
        EXPECT_NEAR(turbulentNoise(p, 0.f, {5, 0.6f}), turbulent, 5e-5);
        EXPECT_EQ(brownianNoise(p, 0.f, {0, 0.6f}), 0);
    }
}

TEST(CoreMathNoise, FootprintsTakeOctavesAway) {
    const Vec3<float> p = {0.3f, 1.7f, -2.2f};
    const Octaves octaves{6, 0.5f};
    // At a width of 2^-(n + 1) the first n octaves are whole; from 1/2 on, none is.
    for (int n = 0; n <= 6; ++n) {
        const float width = std::exp2(float(-n - 1));
        EXPECT_NEAR(brownianNoise(p, width, octaves), brownianNoise(p, 0.f, {n, 0.5f}), 1e-6f) << n;
        float covered = 0;
        for (int i = n; i < 6; ++i)
            covered += 0.2f * std::exp2(float(-i));
        EXPECT_NEAR(turbulentNoise(p, width, octaves), turbulentNoise(p, 0.f, {n, 0.5f}) + covered, 1e-6f) << n;
    }
    EXPECT_EQ(brownianNoise(p, 0.5f, octaves), 0);
    EXPECT_EQ(brownianNoise(p, 1e30f, octaves), 0);
    // Half-way, half of the octave: the fade is a smooth step from 0.3 to 0.7.
    const float half = brownianNoise(p, std::exp2(-2.5f), octaves);
    EXPECT_NEAR(half, gradientNoise(p) + 0.25f * gradientNoise(p * 1.99f), 1e-5f);
}

TEST(CoreMathNoise, NothingJumpsAsTheFootprintGrows) {
    const Vec3<float> p = {0.3f, 1.7f, -2.2f};
    float brownian = brownianNoise(p, 1e-3f, {8, 0.5f}), turbulent = turbulentNoise(p, 1e-3f, {8, 0.5f});
    for (float width = 1e-3f; width < 2; width *= 1.001f) {
        const float b = brownianNoise(p, width, {8, 0.5f}), t = turbulentNoise(p, width, {8, 0.5f});
        EXPECT_NEAR(b, brownian, 0.006f) << width;  // a fade takes 0.4 octaves: 277 steps, at most 1.5 times as steep
        EXPECT_NEAR(t, turbulent, 0.006f) << width;
        brownian = b;
        turbulent = t;
    }
}

TEST(CoreMathNoise, OneLaneAndEightGiveTheSameBits) {
    Places places;
    for (int round = 0; round < 2000; ++round) {
        Vec3<Lanes8f> wide;
        Lanes8f width;
        for (int i = 0; i < 8; ++i) {
            setLane(wide.x, i, places.number(1000));
            setLane(wide.y, i, places.number(1000));
            setLane(wide.z, i, places.number(3));
            setLane(width, i, std::exp2(places.number(12)));
        }
        const Lanes8f b = brownianNoise(wide, width, {6, 0.5f}), t = turbulentNoise(wide, width, {6, 0.5f});
        for (int i = 0; i < 8; ++i) {
            ASSERT_EQ(lane(b, i), brownianNoise(lane(wide, i), lane(width, i), {6, 0.5f}));
            ASSERT_EQ(lane(t, i), turbulentNoise(lane(wide, i), lane(width, i), {6, 0.5f}));
        }
    }
}

}  // namespace
}  // namespace penumbra
