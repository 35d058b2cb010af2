// The table of lights, light selection, and what lies beside the lights themselves: the equal-area map, images, and the
// rectangles that pairs of triangles make.
#include "lights/light_sampler.h"
#include "tests/lights_cases.h"

#include <gtest/gtest.h>

#include <random>

namespace penumbra::test {
namespace {

const Spectrum<float> kWhite = {1.f, 1.f, 1.f};

/// Ids: 0 rectangle (flux pi), 1 sky, 2 point (flux 3 pi), 3 black point, 4 rectangle (flux 4 pi).
LightTable mixedTable() {
    LightTable table;
    const Vec3<float> x = {1, 0, 0}, y = {0, 1, 0}, down = {0, 0, -1}, corner = {0, 0, 1};
    table.add(RectangleLight::make(corner, x, y, down, kWhite, 0));
    table.add(ConstantInfiniteLight{kWhite});
    table.add(PointLight{{0, 0, 2}, kWhite * 0.75f});
    table.add(PointLight{{0, 0, 2}, kWhite * 0.f});
    table.add(RectangleLight::make(corner, x, y * 2.f, down, kWhite, kLightTwoSided));
    return table;
}

TEST(LightsRegistry, PluginsAreListedOnce) {
    std::vector<std::string> names;
    for (const PluginInfo& info : lightPlugins())
        names.emplace_back(info.name);
    EXPECT_EQ(names, (std::vector<std::string>{"diffuse", "point", "spot", "goniometric", "projection", "distant",
                                               "infinite"}));
    for (const PluginInfo& info : lightPlugins())
        EXPECT_FALSE(info.summary.empty() || info.parameters.empty()) << info.name;
}

TEST(LightsRegistry, IdsAreDenseAndFindTheirLight) {
    const LightTable table = mixedTable();
    EXPECT_EQ(table.size(), 5u);
    EXPECT_TRUE(table.isA<RectangleLight>(4));
    EXPECT_EQ(table.row(4), 1u);
    EXPECT_FLOAT_EQ(table.power(0), kPi);
    EXPECT_FLOAT_EQ(table.power(2), 3 * kPi);
    EXPECT_FLOAT_EQ(table.power(4), 4 * kPi);
    EXPECT_EQ(std::vector<std::uint32_t>(table.infiniteIds().begin(), table.infiniteIds().end()),
              std::vector<std::uint32_t>{1});
    EXPECT_EQ(sampleLight<float>(table, 2, {}, {0.f, 0.f}).distance, 2.f);
    EXPECT_TRUE(isBlack(evaluateLight<float>(table, 2, {{}, {0, 0, 2}, {0, 0, 1}}).L));  // no ray meets a point
}

TEST(LightsRegistry, PowersOfTheOtherShapes) {
    LightTable table;
    table.tables.sceneRadius = 2.f;
    SphereLight sphere, part, ellipsoid;
    ASSERT_TRUE(SphereLight::make(translation(1, 2, 3), 2, -2, 2, 10, kWhite, 0, sphere));
    ASSERT_TRUE(SphereLight::make(Matrix4{}, 2, 0, 1, kPi, kWhite, kLightTwoSided, part));
    ASSERT_TRUE(SphereLight::make(scaling(1, 1, 2), 1, -1, 1, 10, kWhite, 0, ellipsoid));
    EXPECT_NEAR(table.power(table.add(sphere)), 16 * kPi * kPi, 1e-3);
    EXPECT_NEAR(table.power(table.add(part)), 2 * kPi * (2 * kPi), 1e-3);
    // A prolate spheroid: 2 pi (1 + c / e asin e) with e^2 = 3 / 4.
    const double e = std::sqrt(0.75), area = 2 * std::numbers::pi * (1 + 2 / e * std::asin(e));
    EXPECT_NEAR(table.power(table.add(ellipsoid)), kPi * area, 0.01);
    EXPECT_NEAR(table.power(table.add(DiskLight::make({}, {3, 0, 0}, {0, 3, 0}, 0.5f, kPi, {0, 0, 1}, kWhite, 0))),
                kPi * kPi * 9 * 0.75 / 2, 1e-4);
    CylinderLight cylinder, elliptic;
    ASSERT_TRUE(CylinderLight::make(translation(1, 2, 3), 2, -1, 3, 10, kWhite, 0, cylinder));
    ASSERT_TRUE(CylinderLight::make(scaling(1, 2, 1), 1, 0, 1, 10, kWhite, kLightTwoSided, elliptic));
    EXPECT_NEAR(table.power(table.add(cylinder)), 16 * kPi * kPi, 1e-3);
    // The girth of an ellipse with the half axes 2 and 1: 8 E(e), e^2 = 3 / 4.
    EXPECT_NEAR(table.power(table.add(elliptic)), 2 * kPi * 8 * std::comp_ellint_2(std::sqrt(0.75)), 1e-3);
    EXPECT_FALSE(CylinderLight::make(scaling(1, 0, 1), 1, -1, 1, 7, kWhite, 0, cylinder));
    EXPECT_NEAR(table.power(table.add(TriangleLight::make({}, {2, 0, 0}, {0, 3, 0}, {0, 0, 1}, kWhite, 0))), 3 * kPi,
                1e-5);
    EXPECT_NEAR(table.power(table.add(DistantLight{{0, 0, 1}, kWhite})), 4 * kPi, 1e-5);
    EXPECT_NEAR(table.power(table.add(ConstantInfiniteLight{kWhite})), 16 * kPi * kPi, 1e-4);
}

TEST(LightsRegistry, SelectionByPower) {
    LightTable table = mixedTable();
    const LightSampler sampler(LightSelection::Power, table, false);
    const double expected[] = {1.0 / 8, 0, 3.0 / 8, 0, 4.0 / 8};
    for (std::uint32_t id = 0; id < 5; ++id)
        EXPECT_NEAR(sampler.probability<float>({}, id), expected[id], 1e-6) << id;

    // Numbers on a grid spread over the lights in proportion.
    std::vector<int> counts(5, 0);
    for (int i = 0; i < 800; ++i) {
        std::uint32_t id;
        float probability;
        sampler.pick<float>({}, (float(i) + 0.5f) / 800, id, probability);
        ++counts[id];
        EXPECT_EQ(probability, sampler.probability<float>({}, id));
    }
    EXPECT_EQ(counts, (std::vector<int>{100, 0, 300, 0, 400}));

    table.tables.sceneRadius = 1.f;
    const LightSampler withSky(LightSelection::Power, table, true);
    EXPECT_NEAR(withSky.probability<float>({}, 1), 4 * kPi / (4 * kPi + 8), 1e-6);
}

TEST(LightsRegistry, SelectionUniform) {
    const LightTable table = mixedTable();
    const LightSampler sampler(LightSelection::Uniform, table, false);
    const double expected[] = {1.0 / 3, 0, 1.0 / 3, 0, 1.0 / 3};  // a black light is none
    for (std::uint32_t id = 0; id < 5; ++id)
        EXPECT_NEAR(sampler.probability<float>({}, id), expected[id], 1e-6) << id;
    EXPECT_NEAR(LightSampler(LightSelection::Uniform, table, true).probability<float>({}, 1), 0.25, 1e-6);
}

TEST(LightsRegistry, SelectionOfOneOrNone) {
    LightTable table;
    EXPECT_TRUE(LightSampler(LightSelection::Power, table, true).empty());
    table.add(ConstantInfiniteLight{kWhite});
    const LightSampler none(LightSelection::Power, table, false);
    EXPECT_TRUE(none.empty());
    EXPECT_EQ(none.probability<float>({}, 0), 0.f);
    const LightSampler one(LightSelection::Power, table, true);
    Lanes8u id;
    Lanes8f probability;
    one.pick<Lanes8f>({}, Lanes8f(0.7f), id, probability);
    EXPECT_TRUE(all(id == Lanes8u(0u)) && all(probability == Lanes8f(1.f)) && one.probability<float>({}, 0) == 1.f);
}

/// Directions and places of the table in the format's description, and mirrored octants.
TEST(LightsRegistry, EqualAreaMap) {
    struct {
        Vec3<float> d;
        float s, t;
    } const known[] = {{{0, 0, 1}, 0.5f, 0.5f},
                       {{1, 0, 0}, 1.f, 0.5f},
                       {{0, -1, 0}, 0.5f, 0.f},
                       {{0.70711f, 0.70711f, 0}, 0.75f, 0.75f},
                       {{0.6f, 0, 0.8f}, 0.72361f, 0.5f},
                       {{0.6f, 0.48f, 0.64f}, 0.67113f, 0.62887f},
                       {{-0.6f, 0.48f, -0.64f}, 0.12887f, 0.82887f},
                       {{0.48f, -0.6f, 0.64f}, 0.62887f, 0.32887f},
                       {{0.38419f, -0.66543f, 0.64f}, 0.6f, 0.3f},
                       {{-0.38367f, -0.38367f, -0.84f}, 0.1f, 0.1f}};
    for (const auto& k : known) {
        const Vec2<float> st = equalAreaSquare(k.d);
        EXPECT_NEAR(st.x, k.s, 2e-5);
        EXPECT_NEAR(st.y, k.t, 2e-5);
        const Vec3<float> d = equalAreaDirection<float>({k.s, k.t});
        EXPECT_LT(length(d - k.d), 5e-5f);
    }
    double mean = 0;
    constexpr int kSide = 256;
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            const Vec2<float> st = {(float(i) + 0.5f) / kSide, (float(j) + 0.5f) / kSide};
            const Vec3<float> d = equalAreaDirection(st);
            const Vec2<float> back = equalAreaSquare(d);
            EXPECT_NEAR(back.x, st.x, 1e-6);
            EXPECT_NEAR(back.y, st.y, 1e-6);
            mean += std::max(d.z, 0.f);
        }
    }
    EXPECT_NEAR(mean / (kSide * kSide), 0.25, 2e-5);  // the grid knows it to 1 / kSide^2
}

TEST(LightsRegistry, ImagesAnswerByTheNearestPixel) {
    LightTable table;
    std::vector<float> rgb(4 * 4 * 3);
    for (std::size_t i = 0; i < 16; ++i)
        rgb[3 * i] = float(i + 1);
    rgb[3 * 15] = -1.f;
    rgb[3 * 14] = std::numeric_limits<float>::quiet_NaN();
    table.add(ImageInfiniteLight::make(SkyMap::EqualArea, rgb, 4, 4, kWhite * 2.f, Matrix4{}, table.tables));
    const auto look = [&](float s, float t) {
        return evaluateLight<float>(table, 0, {{}, {}, equalAreaDirection<float>({s, t})});
    };
    EXPECT_EQ(look(0.26f, 0.01f).L.r, 4.f);
    EXPECT_EQ(look(0.99f, 0.49f).L.r, 16.f);
    EXPECT_EQ(look(0.01f, 0.51f).L.r, 18.f);
    for (const float s : {0.6f, 0.9f}) {
        EXPECT_EQ(look(s, 0.9f).L.r, 0.f);
        EXPECT_EQ(look(s, 0.9f).pdf, 0.f);
    }
    const double sum = 14 * 15 / 2;
    EXPECT_NEAR(look(0.26f, 0.01f).pdf, 2 / sum * 16 / (4 * std::numbers::pi), 1e-6);
    EXPECT_THROW(ImageInfiniteLight::make(SkyMap::EqualArea, rgb, 0, 4, kWhite, Matrix4{}, table.tables), Error);
    EXPECT_THROW(ImageInfiniteLight::make(SkyMap::EqualArea, rgb, 4, 4, kWhite, scaling(1, 0, 1), table.tables), Error);

    LightTable black;
    black.add(
        ImageInfiniteLight::make(SkyMap::LatLong, std::vector<float>(12, 0.f), 2, 2, kWhite, Matrix4{}, black.tables));
    EXPECT_FALSE(sampleLight<float>(black, 0, {}, {0.3f, 0.3f}).valid);
    EXPECT_TRUE(LightSampler(LightSelection::Power, black, true).empty());
}

TEST(LightsRegistry, RectanglesOfTriangles) {
    using Corners = std::array<Vec3<float>, 3>;
    const Vec3<float> a = {1, 2, 3}, b = {1, 5, 3}, c = {1, 5, 7}, d = {1, 2, 7};
    const auto rectangle = rectangleOfTriangles(Corners{a, b, c}, Corners{a, c, d});
    ASSERT_TRUE(rectangle);
    EXPECT_EQ(length(rectangle->edgeX) * length(rectangle->edgeY), 12.f);
    EXPECT_TRUE(rectangleOfTriangles(Corners{c, a, b}, Corners{d, a, c}));
    EXPECT_TRUE(rectangleOfTriangles(Corners{b, d, a}, Corners{c, d, b}));   // the other diagonal
    EXPECT_FALSE(rectangleOfTriangles(Corners{a, b, c}, Corners{a, d, c}));  // wound otherwise
    EXPECT_FALSE(rectangleOfTriangles(Corners{a, b, c}, Corners{a, b, c}));
    EXPECT_FALSE(rectangleOfTriangles(Corners{a, b, c}, Corners{a, c, Vec3<float>{1, 2.01f, 7}}));  // no parallelogram
    EXPECT_FALSE(rectangleOfTriangles(Corners{a, b, c}, Corners{a, c, Vec3<float>{1.01f, 2, 7}}));  // not flat
    const Vec3<float> shifted = {1, 5.5f, 7}, back = {1, 2.5f, 7};
    EXPECT_FALSE(rectangleOfTriangles(Corners{a, b, shifted}, Corners{a, shifted, back}));  // no right angles
    EXPECT_FALSE(rectangleOfTriangles(Corners{a, a, c}, Corners{a, c, d}));                 // no area
}

}  // namespace
}  // namespace penumbra::test
