// Film: sums are exact whatever the order; estimates, errors and limits are what the header says. Filters integrate to one.

#include "core/film/film.h"
#include "core/film/filter.h"
#include "core/math/hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace penumbra {
namespace {

TEST(Film, FixedPointIsExact) {
    for (float x : {1.f, -1.f, 0.1f, 3.14159f, 0x1p32f, -0x1.fffffep32f, 0x1p-41f, 0.f})
        EXPECT_EQ(fromFixed(toFixed(x)), double(x)) << x;
    EXPECT_EQ(fromFixed(toFixed(1e-30f)), 0.0);
    EXPECT_EQ(toFixed(0x1p-64f), 1);
    EXPECT_EQ(toFixed(-0x1p-64f), -1);
}

TEST(Film, OrderChangesNoBit) {
    std::vector<float> values;
    for (std::uint32_t i = 0; i < 5000; ++i) values.push_back(std::exp(20.f * unitFloat<float>(mixBits(i)) - 10.f) * (i % 3 ? 1.f : -1.f));
    const auto filled = [&](const std::vector<float>& order) {
        Film film({0, 0, 1, 1}, 1, 1);
        for (float v : order) film.add(0, 0, {v, 2 * v, 0}, 1.f, true);
        return film;
    };
    const Film first = filled(values);
    std::mt19937 shuffle(1);
    for (int i = 0; i < 5; ++i) {
        std::shuffle(values.begin(), values.end(), shuffle);
        EXPECT_TRUE(filled(values) == first);
    }
    long double exact = 0;
    for (float v : values) exact += v;
    EXPECT_NEAR(first.estimate(0).mean[0], double(exact / 5000), std::fabs(double(exact)) * 1e-14);
}

/// Eight at a time or one by one: the same bits, or none of the eight.
TEST(Film, GroupsInRunsChangeNoBit) {
    Film each({0, 0, 1, 1}, 1, 1), groups({0, 0, 1, 1}, 1, 1);
    PixelRun run, single;
    for (std::uint32_t i = 0; i < PixelRun::kMost / 8; ++i) {
        Spectrum<Lanes8f> value;
        Lanes8f sign;
        const unsigned hit = mixBits(i) & 0xFFu;
        for (int k = 0; k < 8; ++k) {
            const auto v = [&](std::uint32_t c) {
                const std::uint32_t bits = mixBits(3 * (8 * i + std::uint32_t(k)) + c);
                const float u = unitFloat<float>(mixBits(bits));
                return (bits & 1 ? -1.f : 1.f) * (i % 3 == 0 ? std::nextafter(0x1p5f, 0.f) : std::exp2(21.9f * u - 17.f));
            };
            const Spectrum<float> one{v(0), v(1), v(2)};
            setLane(value.r, k, one.r);
            setLane(value.g, k, one.g);
            setLane(value.b, k, one.b);
            setLane(sign, k, k % 3 ? 1.f : -1.f);
            ASSERT_TRUE(single.add(one, k % 3 ? 1.f : -1.f, hit >> k & 1u));
        }
        Mask8 met(false);
        for (int k = 0; k < 8; ++k)
            if (hit >> k & 1u) met = met | (laneIndices<Lanes8f>() == Lanes8u(std::uint32_t(k)));
        ASSERT_TRUE(run.add(value, sign, met));
        for (const float v : {NAN, INFINITY, -0x1p5f, 0x1p-18f, 1e-40f}) {
            Spectrum<Lanes8f> bad = value;
            setLane(bad.g, int(i % 8), v);
            ASSERT_FALSE(run.add(bad, sign, met)) << v;
        }
    }
    each.add(0, single);
    groups.add(0, run);
    EXPECT_TRUE(each == groups);
    EXPECT_EQ(run.samples(), std::uint32_t(PixelRun::kMost));
}

/// Runs of samples leave the very bits that samples one by one leave, up to the largest run of the largest values.
TEST(Film, RunsChangeNoBit) {
    Film each({0, 0, 1, 1}, 1, 1), runs({0, 0, 1, 1}, 1, 1);
    const float largest = std::nextafter(0x1p5f, 0.f);
    PixelRun run;
    int inRun = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const auto value = [&](std::uint32_t c) {
            const float u = unitFloat<float>(mixBits(4 * i + c));
            const float v = i < 5000 ? largest : i < 6000 ? 0x1p-17f : u < 0.1f ? 0.f : std::exp2(8.f * u);
            return mixBits(4 * i + c) & 1 && i >= 5000 ? -v : v;
        };
        const Spectrum<float> v{value(0), value(1) / 0x1p7f, i >= 6000 ? value(2) / 0x1p12f : value(2)};
        const float sign = i % 5 ? 1.f : -1.f;
        each.add(0, i, v, sign, i % 3 == 0);
        if (run.add(v, sign, i % 3 == 0)) ++inRun;
        else runs.add(0, i, v, sign, i % 3 == 0);
        if (i % PixelRun::kMost == PixelRun::kMost - 1 || i == 19999) {
            runs.add(0, run);
            run = {};
        }
    }
    EXPECT_GT(inRun, 6000);
    EXPECT_LT(inRun, 19000);
    EXPECT_TRUE(each == runs);
    for (const float v : {NAN, INFINITY, -0x1p5f, 0x1p-18f, 1e-40f})
        EXPECT_FALSE(run.add({0, v, 0}, 1, true)) << v;
}

TEST(Film, StandardErrorOfIndependentSamples) {
    Film film({0, 0, 1, 1}, 1, 1);
    for (float v : {1.f, 2.f, 3.f, 4.f}) film.add(0, 0, {v, 0, 7}, 1.f, v > 2);
    const PixelEstimate e = film.estimate(0);
    EXPECT_DOUBLE_EQ(e.mean[0], 2.5);
    EXPECT_NEAR(e.standardError[0], std::sqrt(5.0 / 3 / 4), 1e-12);
    EXPECT_NEAR(e.standardError[2], 0, 1e-9);
    EXPECT_DOUBLE_EQ(e.alpha, 0.5);
    EXPECT_EQ(e.samples, 4u);
}

TEST(Film, ReplicatesGiveTheSpreadOfTheirMeans) {
    Film film({0, 0, 1, 1}, 2, 1);
    // Plane 0 gets 1 and 3, plane 1 gets 5 and 7.
    film.add(0, 0, {1, 0, 0}, 1, true);
    film.add(0, 1, {5, 0, 0}, 1, true);
    film.add(0, 2, {3, 0, 0}, 1, true);
    film.add(0, 3, {7, 0, 0}, 1, true);
    EXPECT_EQ(film.samples(0), 4u);
    const PixelEstimate e = film.estimate(0);
    EXPECT_DOUBLE_EQ(e.mean[0], 4);
    EXPECT_NEAR(e.standardError[0], 2, 1e-12);   // means 2 and 6: sd 2.83, over sqrt 2
}

TEST(Film, WhatCannotBeSummedIsCountedBlack) {
    Film film({0, 0, 1, 1}, 1, 1);
    EXPECT_TRUE(film.add(0, 0, {1, 1, 1}, 1, true));
    EXPECT_FALSE(film.add(0, 1, {NAN, 1, 1}, 1, true));
    EXPECT_FALSE(film.add(0, 2, {1, INFINITY, 1}, 1, true));
    EXPECT_FALSE(film.add(0, 3, {1, 1, -0x1p33f}, 1, true));
    EXPECT_DOUBLE_EQ(film.estimate(0).mean[0], 0.25);
}

TEST(Film, SaturatedSquaresMakeTheErrorUnknown) {
    Film film({0, 0, 1, 1}, 1, 1);
    film.add(0, 0, {1e5f, 1, 1}, 1, true);
    film.add(0, 1, {1e5f, 1, 1}, 1, true);
    EXPECT_TRUE(std::isnan(film.estimate(0).standardError[0]));
    EXPECT_FALSE(std::isnan(film.estimate(0).standardError[1]));
}

struct FilterCase {
    const char* name;
    FilterSettings settings;
};

TEST(Filter, SamplesReproduceTheFilterItself) {
    // Along an axis the mean of sign * g(offset) over that of sign must be the filter's own average of g, and the mean of sign
    // the inverse of the normalisation. A fine regular grid leaves an error of about 1e-6 a change of sign.
    const FilterCase cases[] = {
        {"box", {FilterKind::Box, 0.5, 0.5, 0, 0, 0, 0}},
        {"wide box", {FilterKind::Box, 2, 1, 0, 0, 0, 0}},
        {"triangle", {FilterKind::Triangle, 2, 1, 0, 0, 0, 0}},
        {"gaussian", {FilterKind::Gaussian, 1.5, 1.5, 0.5, 0, 0, 0}},
        {"mitchell", {FilterKind::Mitchell, 2, 2, 0, 1.0 / 3, 1.0 / 3, 0}},
        {"sinc", {FilterKind::Sinc, 4, 4, 0, 0, 0, 3}},
        {"wide sinc", {FilterKind::Sinc, 40, 40, 0, 0, 0, 3}},
    };
    const auto g = [](double x) { return std::cos(0.7 * x + 0.3) * std::exp(0.2 * x) + x * x; };
    for (const FilterCase& c : cases) {
        const Filter filter(c.settings);
        for (bool alongX : {true, false}) {
            const double radius = alongX ? c.settings.radiusX : c.settings.radiusY;
            constexpr int n = 1000003, m = 200000;
            double sum = 0, signs = 0, otherSign = 0, integral = 0, weight = 0, absolute = 0;
            for (int i = 0; i < n; ++i) {
                const float u = float((i + 0.5) / n);
                const auto s = filter.sample<float>(alongX ? Vec2<float>{u, 0.5f} : Vec2<float>{0.5f, u});
                sum += double(s.sign) * g(double(alongX ? s.offset.x : s.offset.y)) / n;
                signs += double(s.sign) / n;
                otherSign = double(filter.sample<float>({0.5f, 0.5f}).sign);
            }
            for (int i = 0; i < m; ++i) {
                const double x = radius * (2 * (i + 0.5) / m - 1), f = filterValue(c.settings, radius, x);
                integral += f * g(x);
                weight += f;
                absolute += std::fabs(f);
            }
            EXPECT_NEAR(signs * otherSign, weight / absolute, 2e-5) << c.name;
// Positions: where g, which grows as x^2, is not all there is to see.
            if (radius <= 4) {
                EXPECT_NEAR(sum / signs, integral / weight, 5e-5 * std::max(1.0, radius * radius / 4)) << c.name;
            }
            if (c.settings.radiusX == c.settings.radiusY) {
                EXPECT_NEAR(filter.normalization(), absolute * absolute / weight / weight, 1e-6) << c.name;
            }
        }
    }
}

TEST(Filter, LanesAgree) {
    const Filter filter({FilterKind::Mitchell, 2, 2, 0, 1.0 / 3, 1.0 / 3, 0});
    for (std::uint32_t i = 0; i < 4096; i += 8) {
        float x[8], y[8];
        for (std::uint32_t k = 0; k < 8; ++k) x[k] = unitFloat<float>(mixBits(i + k)), y[k] = unitFloat<float>(mixBits(i + k + 99999));
        const auto wide = filter.sample<Lanes8f>({load<Lanes8f>(x), load<Lanes8f>(y)});
        for (int k = 0; k < 8; ++k) {
            const auto one = filter.sample<float>({x[k], y[k]});
            EXPECT_EQ(one.offset.x, lane(wide.offset.x, k));
            EXPECT_EQ(one.offset.y, lane(wide.offset.y, k));
            EXPECT_EQ(one.sign, lane(wide.sign, k));
        }
    }
}

}  // namespace
}  // namespace penumbra
