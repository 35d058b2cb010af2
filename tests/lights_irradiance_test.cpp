// The irradiance that light sampling gives, against closed forms and between the two strategies: at the default and
// with classic area sampling, at scales from 1e-4 to 1e6. Sums over a grid of sample numbers: no randomness.
#include "tests/lights_cases.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace penumbra::test {
namespace {

constexpr double kPiD = std::numbers::pi;

/// Mean over a side x side grid of u of what `weigh(sample)` makes of a lane's sample.
template <class Weigh>
double gridMean(const LightTable& lights, const Vec3<float>& from, int side, Weigh weigh) {
    double sum = 0;
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; j += 8) {
            const Lanes8f x = toFloat<Lanes8f>(laneIndices<Lanes8f>() + Lanes8u(std::uint32_t(j)));
            const Vec2<Lanes8f> u = {(x + Lanes8f(0.5f)) * Lanes8f(1.f / float(side)),
                                     Lanes8f((float(i) + 0.5f) / float(side))};
            const auto s = sampleLight<Lanes8f>(lights, Lanes8u(0u), broadcast<Lanes8f>(from), u);
            for (int k = 0; k < 8; ++k) {
                if (lane(s.valid, k)) sum += weigh(widened(lane(s.wi, k)), lane(s.L.r, k), lane(s.pdf, k));
            }
        }
    }
    return sum / (double(side) * side);
}

double irradiance(const LightTable& lights, Vec3d from, Vec3d normal, int side = 512) {
    return gridMean(lights, rounded(from), side,
                    [&](const Vec3d& wi, float L, float pdf) { return L * std::max(0.0, dot(wi, normal)) / pdf; });
}

const Spectrum<float> kOne = {1.f, 1.f, 1.f};

/// Both strategies, at three scales: the receiver is at the origin. `toleranceByArea` is larger where the light's
/// horizon cuts through the sample numbers.
template <class Build>
void expectIrradiance(const char* name, double expected, Vec3d normal, double tolerance, double toleranceByArea,
                      Build build) {
    for (const double scale : {1e-4, 1.0, 1e6}) {
        for (const bool classic : {false, true}) {
            LightTable lights;
            build(lights, scale);
            lights.tables.classicArea = classic;
            EXPECT_NEAR(irradiance(lights, {}, normal), expected, (classic ? toleranceByArea : tolerance) * expected)
                << name << (classic ? " by area" : "") << " at scale " << scale;
        }
    }
}

void addSphere(LightTable& lights, double radius, Vec3d center, double scale) {
    SphereLight light;
    ASSERT_TRUE(SphereLight::make(scaling(scale, scale, scale) * translation(center.x, center.y, center.z), radius,
                                  -radius, radius, 2 * kPiD, kOne, 0, light));
    lights.add(light);
}

void addRectangle(LightTable& lights, Vec3d corner, Vec3d ex, Vec3d ey, Vec3d facing, double scale) {
    lights.add(RectangleLight::make(rounded(corner * scale), rounded(ex * scale), rounded(ey * scale), rounded(facing),
                                    kOne, 0));
}

void addDisk(LightTable& lights, Vec3d center, double scale) {
    lights.add(DiskLight::make(rounded(center * scale), rounded(Vec3d{scale, 0, 0}), rounded(Vec3d{0, scale, 0}), 0,
                               kTwoPi, {0, 0, -1}, kOne, 0));
}

const Vec3d kUp{0, 0, 1};

TEST(LightsIrradiance, Sphere) {
    expectIrradiance("sphere along the normal", kPiD / 4, kUp, 2e-5, 1e-3, [](LightTable& l, double s) {
        addSphere(l, 1, {0, 0, 2}, s);
    });
    expectIrradiance("tilted receiver", kPiD / 9 * 0.5, {std::sqrt(0.75), 0, 0.5}, 2e-5, 1e-3,
                     [](LightTable& l, double s) {
                         addSphere(l, 1, {0, 0, 3}, s);
                     });
    expectIrradiance("sphere on the horizon", std::atan(1 / std::sqrt(3.0)) - std::sqrt(3.0) / 4, {1, 0, 0}, 2e-4, 1e-3,
                     [](LightTable& l, double s) {
                         addSphere(l, 1, {0, 0, 2}, s);
                     });
    expectIrradiance("sphere far away", kPiD * 1e-8, kUp, 2e-5, 1e-3, [](LightTable& l, double s) {
        addSphere(l, 1, {0, 0, 1e4}, s);
    });
}

TEST(LightsIrradiance, Disk) {
    expectIrradiance("disk on axis", kPiD / 2, kUp, 2e-5, 2e-5, [](LightTable& l, double s) {
        addDisk(l, {0, 0, 1}, s);
    });
    expectIrradiance("disk off axis", 0.8683148537, kUp, 2e-5, 2e-5, [](LightTable& l, double s) {
        addDisk(l, {1, 0, 1}, s);
    });
    expectIrradiance("disk from a wall", 0.2683240463, {1, 0, 0}, 2e-5, 2e-5, [](LightTable& l, double s) {
        addDisk(l, {2, 0, 1}, s);
    });
    expectIrradiance("ring", kPiD / 2 - kPiD * 0.25 / 1.25, kUp, 2e-5, 2e-5, [](LightTable& l, double s) {
        l.add(DiskLight::make(rounded(kUp * s), rounded(Vec3d{s, 0, 0}), rounded(Vec3d{0, s, 0}), 0.5f, kTwoPi,
                              {0, 0, -1}, kOne, 0));
    });
    expectIrradiance("a third of the disk", kPiD / 6, kUp, 2e-5, 2e-5, [](LightTable& l, double s) {
        l.add(DiskLight::make(rounded(kUp * s), rounded(Vec3d{s, 0, 0}), rounded(Vec3d{0, s, 0}), 0.f, kTwoPi / 3,
                              {0, 0, -1}, kOne, 0));
    });
}

TEST(LightsIrradiance, Rectangle) {
    expectIrradiance("square over its corner", 0.4352098757, kUp, 2e-5, 2e-5, [](LightTable& l, double s) {
        addRectangle(l, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, s);
    });
    expectIrradiance("square over its centre", 1.740839503, kUp, 2e-5, 2e-5, [](LightTable& l, double s) {
        addRectangle(l, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, {0, 0, -1}, s);
    });
    expectIrradiance("wall light on the floor", 0.1750941439, kUp, 2e-5, 2e-5, [](LightTable& l, double s) {
        addRectangle(l, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, s);
    });
}

TEST(LightsIrradiance, TwoTrianglesMakeTheSquare) {
    for (const bool classic : {false, true}) {
        double sum = 0;
        for (const bool second : {false, true}) {
            LightTable lights;
            lights.tables.classicArea = classic;
            const Vec3<float> a = {0, 0, 1}, b = {1, 0, 1}, c = {1, 1, 1}, d = {0, 1, 1};
            lights.add(second ? TriangleLight::make(a, c, d, {0, 0, -1}, kOne, 0)
                              : TriangleLight::make(a, b, c, {0, 0, -1}, kOne, 0));
            sum += irradiance(lights, {}, kUp);
        }
        EXPECT_NEAR(sum, 0.4352098757, 2e-5 * sum);
    }
}

TEST(LightsIrradiance, Skies) {
    LightTable constant;
    constant.add(ConstantInfiniteLight{kOne});
    EXPECT_NEAR(irradiance(constant, {}, kUp), kPiD, 1e-4);

    // One pixel radiates 4 pi / n^2 L, so a receiver that faces its middle gets nearly that.
    LightTable image;
    std::vector<float> rgb(64 * 64 * 3, 0.f);
    rgb[(20 * 64 + 38) * 3] = 1.f;
    const Matrix4 m = rotation(-90, 1, 0, 0);
    image.add(ImageInfiniteLight::make(SkyMap::EqualArea, rgb, 64, 64, kOne, m, image.tables));
    const Vec3<float> d = equalAreaDirection<float>({38.5f / 64, 20.5f / 64});
    EXPECT_NEAR(irradiance(image, {}, transformVector(m, widened(d))), 4 * kPiD / (64 * 64),
                1e-3 * 4 * kPiD / (64 * 64));
}

/// The constant sky and a bright cap round the pole, by latitude and longitude.
TEST(LightsIrradiance, SkiesByLatitude) {
    LightTable constant;
    constant.add(ImageInfiniteLight::make(SkyMap::LatLong, std::vector<float>(3 * 16 * 8, 1.f), 16, 8, kOne, Matrix4{},
                                          constant.tables));
    EXPECT_NEAR(irradiance(constant, {}, kUp), kPiD, 1e-3);
    EXPECT_NEAR(constant.rows<ImageInfiniteLight>()[0].mean, 1, 1e-6);

    // The top row of eight reaches to pi / 8 from +z, which is turned to +y.
    LightTable cap;
    std::vector<float> rgb(3 * 16 * 8, 0.f);
    std::fill_n(rgb.begin(), 3 * 16, 1.f);
    cap.add(ImageInfiniteLight::make(SkyMap::LatLong, rgb, 16, 8, kOne, rotation(-90, 1, 0, 0), cap.tables));
    EXPECT_NEAR(irradiance(cap, {}, {0, 1, 0}), kPiD * std::pow(std::sin(kPiD / 8), 2), 1e-4);
}

/// Rows from +z, columns from +x towards +y.
TEST(LightsIrradiance, SkiesByLatitudeStandUpright) {
    LightTable lights;
    std::vector<float> rgb;
    for (int i = 0; i < 4 * 2; ++i)
        rgb.insert(rgb.end(), {float(i + 1), 0.f, 0.f});
    lights.add(ImageInfiniteLight::make(SkyMap::LatLong, rgb, 4, 2, kOne, Matrix4{}, lights.tables));
    const auto look = [&](Vec3d w) { return evaluateLight<float>(lights, 0, {{}, {}, rounded(normalized(w))}).L.r; };
    EXPECT_EQ(look({1, 0.5, 0.1}), 1.f);
    EXPECT_EQ(look({-1, 0.5, 3}), 2.f);
    EXPECT_EQ(look({-1, -0.5, 0.1}), 3.f);
    EXPECT_EQ(look({0.2, -0.5, 0.1}), 4.f);
    EXPECT_EQ(look({1, 0.5, -0.1}), 5.f);
    EXPECT_EQ(look({0.2, -0.5, -9}), 8.f);
}

TEST(LightsIrradiance, DeltaLights) {
    LightTable point;
    point.add(PointLight{{0.f, 3.f, 4.f}, kOne});
    EXPECT_NEAR(irradiance(point, {}, kUp, 8), 0.8 / 25, 1e-7);
    LightTable distant;
    distant.add(DistantLight{{0.f, 0.6f, 0.8f}, kOne});
    EXPECT_NEAR(irradiance(distant, {}, kUp, 8), 0.8, 1e-6);
}

/// The whole field of every case (no cosine at the receiver), but for those where the point nearly touches the light:
/// there the weights by area are too peaked for a grid.
TEST(LightsIrradiance, ClassicAreaSamplingAgreesInExpectation) {
    for (LightCase& c : allLightCases()) {
        if (c.name == "triangle nearly all" || c.name == "sphere near its surface") continue;
        const auto total = [&](bool classic) {
            c.lights.tables.classicArea = classic;
            return gridMean(c.lights, c.from, 1024, [](const Vec3d&, float L, float pdf) { return double(L) / pdf; });
        };
        const double byDefault = total(false), byArea = total(true);
        EXPECT_NEAR(byArea, byDefault, 5e-3 * byDefault) << c.name;
    }
}

TEST(LightsIrradiance, ScaleDoesNotMatter) {
    const auto total = [](const LightCase& c) {
        return gridMean(c.lights, c.from, 256, [](const Vec3d&, float L, float pdf) { return double(L) / pdf; });
    };
    const std::vector<LightCase> ones = allLightCases();
    for (const double scale : {1e-4, 1e6}) {
        const std::vector<LightCase> scaled = allLightCases(scale);
        for (std::size_t i = 0; i < ones.size(); ++i) {
            const double expected = total(ones[i]);
            EXPECT_NEAR(total(scaled[i]), expected, 1e-4 * expected) << scaled[i].name << " at scale " << scale;
        }
    }
}

}  // namespace
}  // namespace penumbra::test
