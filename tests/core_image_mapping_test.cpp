// Mappings of textures: coordinates against their definitions, footprints against differences, whole textures in their
// spaces.
#include "tests/texture_fixture.h"

#include <array>
#include <cmath>
#include <random>

namespace penumbra {
namespace {

using namespace test;

const Vec3<float> kUp{0, 0, 1};

TextureMapping mapping(Input input) {
    return TextureMapping::make(input);
}

Matrix4 somewhere() {
    return translation(1, -2, 0.5) * rotation(50, 1, 2, -1) * scaling(2, 0.5, -1.5);
}

/// Where a texture in `space` sees the point p of its own space.
TextureContext<float> seenFrom(const Matrix4& space, const Vec3<float>& p, float width = 0) {
    const Affine<float> toWorld = loadAffine<float>(std::array{toRecord(space)}.data(), 0u);
    return atPoint(toWorld.point(p), kUp, width);
}

void expectPlace(const TextureMapping& m, const TextureContext<float>& at, float s, float t) {
    const MappedPoint<float> found = m.map(at);
    EXPECT_NEAR(found.s, s, 2e-6f);
    EXPECT_NEAR(found.t, t, 2e-6f);
}

TEST(CoreImageMapping, PlanarProjectsOnTwoVectors) {
    const TextureMapping standard = mapping(numberInput().text("mapping", "planar"));
    expectPlace(standard, atPoint(Vec3<float>{0.25f, -3, 7}), 0.25f, -3);
    const Matrix4 space = somewhere();
    const TextureMapping m = mapping(numberInput()
                                         .text("mapping", "planar")
                                         .vector("v1", 1, 2, 0.5f)
                                         .vector("v2", 0, -1, 3)
                                         .number("udelta", 0.25f)
                                         .number("vdelta", -0.5f)
                                         .placed(space));
    expectPlace(m, seenFrom(space, {0.5f, 0.25f, 2}), 0.5f + 0.5f + 1 + 0.25f, -0.25f + 6 - 0.5f);
}

TEST(CoreImageMapping, SphericalIsPolarAngleThenAzimuth) {
    const Matrix4 space = somewhere();
    const TextureMapping m = mapping(numberInput().text("mapping", "spherical").placed(space));
    for (const float radius : {0.1f, 1.f, 30.f}) {
        for (const auto& [theta, phi] :
             {std::pair{0.3f, 0.2f}, {1.5f, 1.8f}, {1.6f, 3.f}, {2.9f, 4.4f}, {0.7f, 6.2f}}) {
            const Vec3<float> p = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
            expectPlace(m, seenFrom(space, p * radius), theta / kPi, phi / (2 * kPi));
        }
    }
    const TextureMapping plain = mapping(numberInput().text("mapping", "spherical"));
    expectPlace(plain, atPoint(Vec3<float>{0, 0, 2}), 0, 0);
    expectPlace(plain, atPoint(Vec3<float>{0, 0, -2}), 1, 0);
    expectPlace(plain, atPoint(Vec3<float>{0, 0, 0}), 0.5f, 0);  // any place would do: the angle of no direction
}

TEST(CoreImageMapping, CylindricalIsAzimuthFromBehindThenHeight) {
    const Matrix4 space = somewhere();
    const TextureMapping m = mapping(numberInput().text("mapping", "cylindrical").placed(space));
    for (const float phi : {-3.f, -1.2f, 0.f, 0.4f, 2.9f})
        expectPlace(m, seenFrom(space, {0.7f * std::cos(phi), 0.7f * std::sin(phi), phi}), (kPi + phi) / (2 * kPi),
                    phi);
}

TEST(CoreImageMapping, OnlyPlanarIsShiftedAndOnlyUvScaled) {
    const auto unknown = [](const char* kind, const char* parameter) {
        Input input = numberInput().text("mapping", kind).number(parameter, 2);
        TextureMapping::make(input);
        Warnings warnings;
        input.parameters().warnUnused({}, "texture", warnings);
        return warnings.all().size();
    };
    EXPECT_EQ(unknown("uv", "uscale"), 0u);
    EXPECT_EQ(unknown("planar", "uscale"), 1u);
    EXPECT_EQ(unknown("planar", "vdelta"), 0u);
    EXPECT_EQ(unknown("spherical", "udelta"), 1u);
    EXPECT_EQ(unknown("cylindrical", "vscale"), 1u);
}

/// The steepest change of a coordinate within the surface, by central differences in double steps round the circle.
template <class Coordinate>
float steepestBySearch(const Coordinate& coordinate, const TextureContext<float>& at) {
    const Frame<float> frame = Frame<float>::fromNormal(at.n);
    const float h = 2e-3f;
    float most = 0;
    for (int i = 0; i < 360; ++i) {
        const float a = kTwoPi * float(i) / 360;
        const Vec3<float> d = frame.s * std::cos(a) + frame.t * std::sin(a);
        TextureContext<float> ahead = at, behind = at;
        ahead.p = at.p + d * h;
        behind.p = at.p - d * h;
        most = std::max(most, std::fabs(coordinate(ahead) - coordinate(behind)) / (2 * h));
    }
    return most;
}

TEST(CoreImageMapping, FootprintsAreTheSteepestRiseWithinTheSurface) {
    std::mt19937 random(11);
    const auto number = [&] { return float(std::int32_t(random())) * 0x1p-31f; };
    for (const char* kind : {"planar", "spherical", "cylindrical"}) {
        SCOPED_TRACE(kind);
        Input input = numberInput().text("mapping", kind).placed(somewhere());
        if (kind == std::string("planar")) input.vector("v1", 0.5f, 1, -1).vector("v2", 2, 0, 0.3f);
        const TextureMapping m = mapping(input);
        int compared = 0;
        while (compared < 200) {
            const Vec3<float> direction = normalize(Vec3<float>{number(), number(), number()});
            TextureContext<float> at = atPoint(Vec3<float>{number() * 4, number() * 4, number() * 4}, direction, 0.01f);
            const Vec3<float> inside = m.space.point(at);
            const MappedPoint<float> place = m.map(at);
            // Away from the axis, where curvature spoils the differences, and from the seam.
            if (std::hypot(inside.x, inside.y) < 0.3f) continue;
            const auto interior = [](float x) { return std::fabs(x - 0.5f) < 0.48f; };
            const auto s = [&](const TextureContext<float>& c) { return m.map(c).s; };
            const auto t = [&](const TextureContext<float>& c) { return m.map(c).t; };
            if (kind != std::string("spherical") || interior(place.t)) {
                const float expected = 0.01f * steepestBySearch(t, at);
                EXPECT_NEAR(place.widthT, expected, 0.01f * expected + 4e-6f);
            }
            if (kind != std::string("cylindrical") || interior(place.s)) {
                const float expected = 0.01f * steepestBySearch(s, at);
                EXPECT_NEAR(place.widthS, expected, 0.01f * expected + 4e-6f);
            }
            ++compared;
        }
    }
}

TEST(CoreImageMapping, AlongTheNormalNothingIsCovered) {
    const TextureMapping m = mapping(numberInput().text("mapping", "planar"));
    const MappedPoint<float> facing = m.map(atPoint(Vec3<float>{1, 2, 3}, Vec3<float>{1, 0, 0}, 0.5f));
    EXPECT_EQ(facing.widthS, 0);
    EXPECT_EQ(facing.widthT, 0.5f);
    const TextureMapping shrunk = mapping(numberInput().text("mapping", "planar").placed(scaling(0.25, 1, 1)));
    EXPECT_EQ(shrunk.map(atPoint(Vec3<float>{1, 2, 3}, kUp, 0.5f)).widthS, 2);
}

TEST(CoreImageMapping, AnImageIsBlurredByItsMappedFootprint) {
    std::vector<float> stripes(64 * 64);
    for (std::size_t i = 0; i < stripes.size(); ++i)
        stripes[i] = float(i % 2);
    const One t("imagemap", numberInput().file("a", grey(64, 64, stripes)).text("mapping", "planar"));
    // The footprint counts twice: at 1/128 it covers one texel, at 1/64 two, and so on.
    EXPECT_EQ(t.number(atPoint(Vec3<float>{1.5f / 64, 0.5f, 9}, kUp, 0.9f / 128)), 1);
    EXPECT_EQ(t.number(atPoint(Vec3<float>{1.5f / 64, 0.5f, 9}, kUp, 1.1f / 64)), 0.5f);
}

TEST(CoreImageMapping, AnyBitsAsPlaces) {
    const float infinity = std::numeric_limits<float>::infinity();
    const float hostile[] = {kNaN, infinity, -infinity, 3.4e38f, -3.4e38f, 1e-45f, 1e-20f, -1e-9f, 1, 0, -0.f};
    for (const char* kind : {"planar", "spherical", "cylindrical"}) {
        const One t("imagemap", numberInput().file("a", grey(2, 2, {1, 2, 3, 4})).text("mapping", kind));
        for (const float x : hostile)
            for (const float y : hostile)
                for (const float width : hostile) {
                    const float value = t.number(atPoint(Vec3<float>{x, y, 0}, kUp, width));
                    EXPECT_TRUE(value >= 1 && value <= 4)
                        << kind << " " << x << " " << y << " " << width << " " << value;
                }
    }
    const One cubes("checkerboard", numberInput().integer("dimension", 3));
    for (const float x : hostile)
        for (const float width : hostile) {
            const float value = cubes.number(atPoint(Vec3<float>{x, 0.5f, 0.5f}, kUp, width));
            EXPECT_TRUE(value >= 0 && value <= 1) << x << " " << width << " " << value;
        }
}

TEST(CoreImageMapping, CheckerboardOfCubes) {
    const Matrix4 space = somewhere();
    const One t("checkerboard", numberInput().integer("dimension", 3).placed(space));
    for (int x = -2; x < 3; ++x)
        for (int y = -2; y < 3; ++y)
            for (int z = -2; z < 3; ++z) {
                const Vec3<float> centre = {float(x) + 0.5f, float(y) + 0.4f, float(z) + 0.6f};
                EXPECT_EQ(t.number(seenFrom(space, centre)), (x + y + z) % 2 == 0 ? 1 : 0) << x << " " << y << " " << z;
            }
    // On an edge between two cubes each counts half, on a corner edge of four, too; far away all is grey.
    const One plain("checkerboard", numberInput().integer("dimension", 3));
    EXPECT_EQ(plain.number(atPoint(Vec3<float>{1, 0.5f, 0.5f}, kUp, 0.1f)), 0.5f);
    EXPECT_NEAR(plain.number(atPoint(Vec3<float>{0.3f, 0.2f, 0.5f}, kUp, 1e3f)), 0.5f, 1e-3f);
    // Seen along an axis, the cubes are not blurred along it: a tent of half-width 0.15 at 0.03 from the edge in x
    // alone.
    const float d = 0.03f / 0.15f, share = 0.5f + 0.5f * d * (2 - d);
    EXPECT_NEAR(plain.number(atPoint(Vec3<float>{0.03f, 0.5f, 0.01f}, kUp, 0.1f)), share, 1e-6f);
}

}  // namespace
}  // namespace penumbra
