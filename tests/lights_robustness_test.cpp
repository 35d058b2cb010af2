// Lights where they are hard: from behind, in their plane, on their edges, at their centre, at extreme distances and
// with the extreme sample numbers. Nothing may be NaN, and nothing may arrive where nothing can.
#include "tests/lights_cases.h"

#include <gtest/gtest.h>

#include <random>

namespace penumbra::test {
namespace {

const float kEnds[] = {0.f, 0x1p-24f, 0.25f, 0.5f, 0.75f, kOneMinusEpsilon};

void expectSound(const LightSample<float>& s, const std::string& name) {
    const bool unit = std::abs(dot(s.wi, s.wi) - 1.f) < 1e-5f;
    const bool positive = s.pdf > 0.f && isFinite(s.pdf) && s.distance >= 0.f;
    const bool light = s.L.r >= 0.f && s.L.g >= 0.f && s.L.b >= 0.f && isFinite(s.L.r + s.L.g + s.L.b);
    EXPECT_TRUE(unit && positive && light) << name << ": wi " << s.wi.x << ' ' << s.wi.y << ' ' << s.wi.z
                                           << ", distance " << s.distance << ", pdf " << s.pdf << ", L " << s.L.r;
    if (!s.valid) {
        EXPECT_TRUE(s.L.r == 0.f && s.L.g == 0.f && s.L.b == 0.f && s.pdf == 1.f) << name;
    }
}

void expectSoundFrom(const LightCase& c, const Vec3<float>& from, const std::string& where) {
    for (const float x : kEnds) {
        for (const float y : kEnds) {
            const LightSample<float> s = sampleLight<float>(c.lights, 0, from, {x, y});
            expectSound(s, c.name + where);
            const Vec3<float> p = from + s.wi * min(s.distance, 1e10f);
            const LightEval<float> e = evaluateLight<float>(c.lights, 0, {from, p, s.wi});
            EXPECT_TRUE(e.pdf >= 0.f && isFinite(e.pdf) && e.L.r >= 0.f && isFinite(e.L.r))
                << c.name << where << ' ' << e.pdf;
        }
    }
}

TEST(LightsRobustness, NoCaseGivesNaN) {
    for (const double scale : {1e-4, 1.0, 1e6}) {
        for (const LightCase& c : allLightCases(scale)) {
            expectSoundFrom(c, c.from, " at scale " + std::to_string(scale));
            for (const float far : {1e-6f, 1e-3f, 1e3f, 1e6f, 1e9f}) {
                for (const Vec3<float>& d :
                     {Vec3<float>{1, 0, 0}, Vec3<float>{0, 0, -1}, Vec3<float>{0.3f, -0.5f, 0.8f}})
                    expectSoundFrom(c, c.from + d * far, " from " + std::to_string(far) + " away");
            }
        }
    }
}

TEST(LightsRobustness, PointsOfTheLightItselfGiveNoNaN) {
    for (const LightCase& c : allLightCases()) {
        std::mt19937 generator(3);
        for (int i = 0; i < 200; ++i) {
            const Vec2<float> u = {float(generator() >> 8) * 0x1p-24f, float(generator() >> 8) * 0x1p-24f};
            const LightSample<float> s = sampleLight<float>(c.lights, 0, c.from, u);
            if (s.valid && s.distance < kInfinity) expectSoundFrom(c, c.from + s.wi * s.distance, " on itself");
        }
    }
}

template <class T>
LightTable tableOf(const T& light) {
    LightTable table;
    table.add(light);
    return table;
}

void expectDark(const LightTable& lights, const Vec3<float>& from, const Vec3<float>& p, const char* name) {
    for (const bool classic : {false, true}) {
        LightTable table = lights;
        table.tables.classicArea = classic;
        for (const float x : kEnds) {
            for (const float y : kEnds)
                EXPECT_FALSE(sampleLight<float>(table, 0, from, {x, y}).valid) << name;
        }
        const LightEval<float> e = evaluateLight<float>(table, 0, {from, p, normalize(p - from)});
        EXPECT_TRUE(isBlack(e.L) && e.pdf == 0.f) << name;
    }
}

TEST(LightsRobustness, FlatLightsAreDarkBehindAndInTheirPlane) {
    const Vec3<float> x = {1, 0, 0}, y = {0, 1, 0}, zero = {}, down = {0, 0, -1}, middle = {0.25f, 0.25f, 0};
    const LightTable flat[] = {tableOf(RectangleLight::make(zero, x, y, down, kTestRadiance, 0)),
                               tableOf(TriangleLight::make(zero, x, y, down, kTestRadiance, 0)),
                               tableOf(DiskLight::make(zero, x, y, 0.f, kTwoPi, down, kTestRadiance, 0))};
    for (const LightTable& lights : flat) {
        expectDark(lights, {0.2f, 0.1f, 1.f}, middle, "behind");
        expectDark(lights, {0.2f, 0.1f, 1e-6f}, middle, "just behind");
        expectDark(lights, {3.f, 0.f, 0.f}, middle, "in the plane");
        expectDark(lights, zero, middle, "at a corner");
        expectDark(lights, {0.5f, 0.f, 0.f}, middle, "on an edge");
        EXPECT_TRUE(sampleLight<float>(lights, 0, {0.2f, 0.1f, -1.f}, {0.5f, 0.5f}).valid);
    }
}

TEST(LightsRobustness, SpheresAreDarkOnTheirInside) {
    const auto sphere = [](std::uint32_t flags) {
        SphereLight light;
        EXPECT_TRUE(SphereLight::make(translation(1, 2, 3), 2, -2, 2, 7, kTestRadiance, flags, light));
        return tableOf(light);
    };
    const Vec3<float> inside = {1.5f, 2.f, 3.f}, center = {1, 2, 3}, outside = {1, 2, 9}, onIt = {1, 2, 5};
    expectDark(sphere(0), inside, onIt, "inside");
    expectDark(sphere(0), center, onIt, "centre");
    expectDark(sphere(kLightReversed), outside, onIt, "outside of a reversed one");
    EXPECT_TRUE(sampleLight<float>(sphere(kLightReversed), 0, center, {0.3f, 0.4f}).valid);
    EXPECT_TRUE(sampleLight<float>(sphere(kLightTwoSided), 0, inside, {0.3f, 0.4f}).valid);
    EXPECT_TRUE(sampleLight<float>(sphere(0), 0, outside, {0.3f, 0.4f}).valid);
    SphereLight light;
    EXPECT_FALSE(SphereLight::make(scaling(1, 0, 1), 1, -1, 1, 7, kTestRadiance, 0, light));
}

TEST(LightsRobustness, FlagsOfDeltaAndUnmetLights) {
    EXPECT_TRUE(sampleLight<float>(tableOf(PointLight{{0, 0, 1}, kTestRadiance}), 0, {}, {0.f, 0.f}).delta);
    EXPECT_FALSE(sampleLight<float>(tableOf(PointLight{{0, 0, 1}, kTestRadiance}), 0, {0, 0, 1}, {0.f, 0.f}).valid);
    const Vec3<float> x = {1, 0, 0}, y = {0, 1, 0}, corner = {0, 0, 1}, down = {0, 0, -1};
    for (const std::uint32_t flags : {0u, kLightUnmet}) {
        const LightTable lights = tableOf(RectangleLight::make(corner, x, y, down, kTestRadiance, flags));
        EXPECT_EQ(sampleLight<float>(lights, 0, {}, {0.5f, 0.5f}).delta, flags == kLightUnmet);
    }
}

/// Every sampled point lies on the light, though it may be huge, tiny or seen at a grazing angle.
TEST(LightsRobustness, SampledPointsLieOnTheRectangle) {
    std::mt19937 generator(5);
    const auto power = [&](double low, double high) {
        return float(std::pow(10, low + (high - low) * (generator() * 0x1p-32)));
    };
    for (int i = 0; i < 20000; ++i) {
        const float width = power(-3, 3), height = power(-3, 3), h = power(-4, 2), offset = power(-3, 2);
        const auto light = RectangleLight::make({-offset, offset * 0.5f, h}, {width, 0, 0}, {0, height, 0}, {0, 0, -1},
                                                kTestRadiance, 0);
        const Vec2<float> u = {float(generator() >> 8) * 0x1p-24f, float(generator() >> 8) * 0x1p-24f};
        const LightSample<float> s = sampleLight<float>(tableOf(light), 0, {}, u);
        ASSERT_TRUE(s.valid);
        const Vec3<float> q = s.wi * s.distance;
        const float slack = 1e-5f * s.distance;
        EXPECT_NEAR(q.z, h, slack);
        EXPECT_TRUE(q.x >= -offset - slack && q.x <= width - offset + slack) << q.x;
        EXPECT_TRUE(q.y >= offset * 0.5f - slack && q.y <= offset * 0.5f + height + slack) << q.y;
    }
}

}  // namespace
}  // namespace penumbra::test
