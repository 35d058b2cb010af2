// Textures against values worked out by hand on small images made here, against their own definitions at high
// resolution, and one lane against eight, bit for bit.
#include "tests/texture_fixture.h"

#include <cmath>
#include <cstring>
#include <random>

namespace penumbra {
namespace {

using namespace test;

/// 4 x 2; the top row is 1 2 3 4, the bottom row 5 6 7 8.
Image numbered() {
    return grey(4, 2, {1, 2, 3, 4, 5, 6, 7, 8});
}

One imagemap(Input input) {
    return One("imagemap", std::move(input));
}

// ------------------------------------------------------------------------------------------------ places and borders

TEST(CoreImageTexture, VZeroIsTheBottomRow) {
    const One t = imagemap(numberInput().file("a", numbered()).text("filter", "point"));
    EXPECT_EQ(t.number(0.125f, 0.25f), 5);
    EXPECT_EQ(t.number(0.125f, 0.75f), 1);
    EXPECT_EQ(t.number(0.999f, 0.01f), 8);
    EXPECT_EQ(t.number(0.999f, 0.99f), 4);
}

TEST(CoreImageTexture, TexelCentresAndBlends) {
    const One t = imagemap(numberInput().file("a", numbered()));
    EXPECT_EQ(t.number(0.125f, 0.75f), 1);
    EXPECT_EQ(t.number(0.625f, 0.25f), 7);
    EXPECT_EQ(t.number(0.25f, 0.75f), 1.5f);
    EXPECT_EQ(t.number(0.125f, 0.5f), 3);
    EXPECT_EQ(t.number(0.25f, 0.5f), 3.5f);
    EXPECT_FLOAT_EQ(t.number(0.125f + 0.25f * 0.3f, 0.75f), 1.3f);
}

struct WrapCase {
    const char* wrap;
    float left, right, above, below;  // bilinear, half a texel beyond each edge's centre
    float pointLeft, pointAbove;
};

TEST(CoreImageTexture, WrapModes) {
    // At u = 0 the neighbours are texel 0 and what lies left of it; v = 1 is the top edge.
    const WrapCase cases[] = {
        {"repeat", (1 + 4) / 2.f, (4 + 1) / 2.f, (1 + 5) / 2.f, (5 + 1) / 2.f, 4, 5},
        {"black", 0.5f, 2, 0.5f, 2.5f, 0, 0},
        {"clamp", 1, 4, 1, 5, 1, 1},
        // Left of (0, 0) lies (0, 1); above it lies (3, 0).
        {"octahedralsphere", (1 + 5) / 2.f, (4 + 8) / 2.f, (1 + 4) / 2.f, (5 + 8) / 2.f, 1, 1},
    };
    for (const WrapCase& c : cases) {
        SCOPED_TRACE(c.wrap);
        const One t = imagemap(numberInput().file("a", numbered()).text("wrap", c.wrap));
        EXPECT_EQ(t.number(0, 0.75f), c.left);
        EXPECT_EQ(t.number(c.wrap == std::string("repeat") ? 2.f : 1.f, 0.75f), c.right);
        EXPECT_EQ(t.number(0.125f, 1), c.above);
        EXPECT_EQ(t.number(0.125f, 0), c.below);
        const One p = imagemap(numberInput().file("a", numbered()).text("wrap", c.wrap).text("filter", "point"));
        EXPECT_EQ(p.number(-0.01f, 0.75f), c.pointLeft);
        EXPECT_EQ(p.number(0.125f, 1.01f), c.pointAbove);
    }
}

TEST(CoreImageTexture, CoordinatesFarAway) {
    const One repeat = imagemap(numberInput().file("a", numbered()));
    EXPECT_EQ(repeat.number(-6.875f, 3.75f), 1);
    EXPECT_EQ(repeat.number(1e9f, 0.75f), 2.5f);  // the same as u = 0
    const One black = imagemap(numberInput().file("a", numbered()).text("wrap", "black"));
    EXPECT_EQ(black.number(1e9f, 0.75f), 0);
    EXPECT_EQ(black.number(0.5f, -1e30f), 0);
    const One clamped = imagemap(numberInput().file("a", numbered()).text("wrap", "clamp"));
    EXPECT_EQ(clamped.number(1e9f, 1e9f), 4);
    EXPECT_EQ(clamped.number(-1e38f, -1e38f), 5);
}

TEST(CoreImageTexture, AnyBitsAsCoordinates) {
    const float infinity = std::numeric_limits<float>::infinity();
    const float hostile[] = {kNaN, -kNaN, infinity, -infinity, 3.4e38f, -3.4e38f, 1e-45f, -1e-45f, -1e-9f, 1, 0, -0.f};
    for (const char* wrap : {"repeat", "black", "clamp", "octahedralsphere"}) {
        for (const char* filter : {"point", "bilinear", "trilinear"}) {
            const One t = imagemap(numberInput().file("a", numbered()).text("wrap", wrap).text("filter", filter));
            for (const float u : hostile)
                for (const float v : hostile)
                    for (const float footprint : hostile) {
                        const float x = t.number(u, v, footprint);
                        EXPECT_TRUE(x >= 0 && x <= 8) << wrap << " " << filter << " " << u << " " << v << " " << x;
                    }
        }
    }
    const One board("checkerboard", numberInput());
    for (const float u : hostile)
        for (const float footprint : hostile)
            board.number(u, 0.5f, footprint);
}

TEST(CoreImageTexture, SmallestImages) {
    const One dot = imagemap(numberInput().file("a", grey(1, 1, {0.25f})).text("filter", "trilinear"));
    for (const float u : {-3.f, 0.f, 0.3f, 1.f, 77.f})
        EXPECT_EQ(dot.number(u, 1 - u, u), 0.25f);
    const One line = imagemap(numberInput().file("a", grey(1, 3, {3, 2, 1})));
    EXPECT_EQ(line.number(0.9f, 0.5f), 2);
    EXPECT_EQ(line.number(-5.f, 1.f / 6), 1);
    EXPECT_FLOAT_EQ(line.number(0.f, 1.f / 3), 1.5f);
}

// ------------------------------------------------------------------------------------------------ levels

TEST(CoreImageTexture, PyramidOfPowersOfTwo) {
    const ImagePyramid p(numbered());
    ASSERT_EQ(p.levelCount(), 3);
    EXPECT_EQ(p.texel(1, 0, 0).r, (1 + 2 + 5 + 6) / 4.f);
    EXPECT_EQ(p.texel(1, 1, 0).r, (3 + 4 + 7 + 8) / 4.f);
    EXPECT_EQ(p.texel(2, 0, 0).r, 4.5f);
}

TEST(CoreImageTexture, PyramidOfOddSizesWeighsByArea) {
    const ImagePyramid p(grey(5, 1, {1, 2, 4, 8, 16}));
    ASSERT_EQ(p.levelCount(), 4);                                // 5, 3, 2, 1
    EXPECT_FLOAT_EQ(p.texel(1, 0, 0).r, (1 * 3 + 2 * 2) / 5.f);  // each covers 5/3 texels
    EXPECT_FLOAT_EQ(p.texel(1, 1, 0).r, (2 * 1 + 4 * 3 + 8 * 1) / 5.f);
    EXPECT_FLOAT_EQ(p.texel(1, 2, 0).r, (8 * 2 + 16 * 3) / 5.f);
    EXPECT_FLOAT_EQ(p.texel(3, 0, 0).r, 31 / 5.f);
}

TEST(CoreImageTexture, PyramidKeepsTheMean) {
    std::mt19937 random(1);
    for (const auto& [width, height] : {std::pair{7, 13}, {64, 33}, {1, 100}, {100, 3}, {31, 1}}) {
        std::vector<float> values(std::size_t(width) * height * 3);
        double mean = 0;
        for (float& v : values)
            v = float(random() & 0xFFFF) / 65536.f;
        for (std::size_t i = 0; i < values.size(); i += 3)
            mean += values[i];
        mean /= width * height;
        const ImagePyramid p(Image(width, height, 3, values));
        EXPECT_NEAR(p.texel(p.levelCount() - 1, 0, 0).r, mean, 1e-6) << width << " x " << height;
    }
}

TEST(CoreImageTexture, BytesAreAveragedInLinearLight) {
    const TransferFunction srgb = TransferFunction::srgb();
    const ImagePyramid p(bytes(2, 1, 1, {0, 255}, srgb));
    // Half the light is sRGB 188 (0.5029), not 128 (0.216).
    EXPECT_EQ(p.texel(1, 0, 0).r, srgb.decodeTable()[188]);
}

TEST(CoreImageTexture, BytesAreRoundedOnceToTheNearestCode) {
    std::mt19937 random(2);
    for (const TransferFunction& encoding : {TransferFunction::linear(), TransferFunction::srgb(),
                                             TransferFunction::gamma(2.2f), TransferFunction::gamma(0.5f)}) {
        SCOPED_TRACE(encoding.name());
        const std::array<float, 256> decode = encoding.decodeTable();
        const int size = 64;
        std::vector<std::uint8_t> codes(size * size);
        std::vector<float> linear(size * size);
        const std::uint32_t mask = 0x3F;  // dark values too: there the codes lie nearest
        for (std::size_t i = 0; i < codes.size(); ++i) {
            codes[i] = std::uint8_t(i % 128 < 64 ? random() & mask : random() & 0xFF);
            linear[i] = decode[codes[i]];
        }
        const ImagePyramid rounded(bytes(size, size, 1, codes, encoding)), exact(grey(size, size, linear));
        for (int level = 0; level < exact.levelCount(); ++level) {
            for (int i = 0, n = size >> level; i < n * n; ++i) {
                const float value = exact.texel(level, i % n, i / n).r, stored = rounded.texel(level, i % n, i / n).r;
                float best = 2;
                for (const float d : decode)
                    best = std::fabs(d - value) < std::fabs(best - value) ? d : best;
                EXPECT_NEAR(std::fabs(stored - value), std::fabs(best - value), 1e-6f);
            }
        }
    }
}

TEST(CoreImageTexture, LevelFollowsTheFootprint) {
    std::vector<float> values(16);
    for (std::size_t i = 0; i < 16; ++i)
        values[i] = i % 4 < 2 ? 0.f : 1.f;  // left half 0, right half 1
    values[0] = 16;
    const Image image = grey(4, 4, values);  // levels: texel (0, 0) 16, then (16 + 0 + 0 + 0) / 4, then the mean
    const One t = imagemap(numberInput().file("a", image).text("filter", "point"));
    const float mean = (16 + 8) / 16.f;
    // w = 2 footprints covers w * 4 texels; the level is floor(log2) of that.
    EXPECT_EQ(t.number(0.01f, 0.99f, 0), 16);
    EXPECT_EQ(t.number(0.01f, 0.99f, 0.124f), 16);  // 0.99 texels
    EXPECT_EQ(t.number(0.01f, 0.99f, 0.249f), 16);  // 1.99
    EXPECT_EQ(t.number(0.01f, 0.99f, 0.25f), 4);    // 2: level 1
    EXPECT_EQ(t.number(0.01f, 0.99f, 0.499f), 4);
    EXPECT_EQ(t.number(0.01f, 0.99f, 0.5f), mean);  // 4: level 2
    EXPECT_EQ(t.number(0.01f, 0.99f, 1e30f), mean);
    // The mapping stretches the footprint, by the larger factor.
    const One stretched =
        imagemap(numberInput().file("a", image).text("filter", "point").number("uscale", 0.5f).number("vscale", -2));
    EXPECT_EQ(stretched.number(0.02f, 0.005f, 0.124f), 16);
    EXPECT_EQ(stretched.number(0.02f, 0.005f, 0.126f), 4);
}

TEST(CoreImageTexture, BilinearTakesTheFinerLevelAndTrilinearBlends) {
    const Image image = grey(4, 4, {16, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    const auto make = [&](const char* filter) {
        return imagemap(numberInput().file("a", image).text("filter", filter).text("wrap", "clamp"));
    };
    const One bilinear = make("bilinear"), trilinear = make("trilinear");
    EXPECT_EQ(bilinear.number(0, 1, 0.2f), 16);
    EXPECT_EQ(trilinear.number(0, 1, 0.125f), 16);
    for (const float covered : {1.25f, 1.9f, 2.f, 3.f, 3.999f, 4.f, 9.f}) {  // texels
        const float level = std::min(std::log2(covered), 2.f);
        const float expected = level < 1 ? 16 + (4 - 16) * level : 4 + (1 - 4) * (level - 1);
        EXPECT_NEAR(trilinear.number(0, 1, covered / 8), expected, 1e-5f) << covered;
    }
    const One ewa = make("ewa");
    EXPECT_EQ(ewa.number(0.3f, 0.8f, 0.17f), trilinear.number(0.3f, 0.8f, 0.17f));
}

TEST(CoreImageTexture, EqualTexelsGiveTheirExactValue) {
    std::mt19937 random(3);
    const One t = imagemap(numberInput()
                               .file("a", bytes(37, 5, 3, std::vector<std::uint8_t>(37 * 5 * 3, 187)))
                               .text("filter", "trilinear"));
    for (int i = 0; i < 1000; ++i) {
        const auto next = [&] { return float(random()) * 0x1p-32f; };
        EXPECT_EQ(t.number(next(), next(), next()), 187 / 255.f);
    }
}

// ------------------------------------------------------------------------------------------------ values

TEST(CoreImageTexture, EncodingsDecodeThroughTheTable) {
    for (const TransferFunction& encoding :
         {TransferFunction::linear(), TransferFunction::srgb(), TransferFunction::gamma(2.2f)}) {
        const std::array<float, 256> decode = encoding.decodeTable();
        std::vector<std::uint8_t> ramp(256), rgb;
        for (int i = 0; i < 256; ++i) {
            ramp[std::size_t(i)] = std::uint8_t(i);
            for (const int c : {i, 255 - i, i / 2})
                rgb.push_back(std::uint8_t(c));
        }
        const One number = imagemap(numberInput().file("a", bytes(256, 1, 1, ramp, encoding)));
        const One color = imagemap(colorInput().file("a", bytes(256, 1, 3, rgb, encoding)));
        for (int i = 0; i < 256; ++i) {
            const float u = (float(i) + 0.5f) / 256;
            EXPECT_EQ(number.number(u, 0.5f), decode[std::size_t(i)]);
            expectColor(color.color(u, 0.5f), decode[std::size_t(i)], decode[std::size_t(255 - i)],
                        decode[std::size_t(i / 2)]);
        }
    }
}

TEST(CoreImageTexture, ScaleThenInvert) {
    const Image image = grey(2, 1, {0.25f, 0.75f});
    const One scaled = imagemap(numberInput().file("a", image).number("scale", 2));
    EXPECT_EQ(scaled.number(0.25f, 0.5f), 0.5f);
    EXPECT_EQ(scaled.number(0.75f, 0.5f), 1.5f);  // a number is not clamped
    const One inverted = imagemap(numberInput().file("a", image).number("scale", 2).flag("invert", true));
    EXPECT_EQ(inverted.number(0.25f, 0.5f), 0.5f);
    EXPECT_EQ(inverted.number(0.75f, 0.5f), 0);  // 1 - 1.5, not below 0
    const One color = imagemap(colorInput().file("a", Image(1, 1, 3, {0.25f, 0.5f, 4.f})).flag("invert", true));
    expectColor(color.color(0.5f, 0.5f), 0.75f, 0.5f, 0);
}

TEST(CoreImageTexture, MappingScalesAndShifts) {
    const One t = imagemap(numberInput()
                               .file("a", numbered())
                               .text("filter", "point")
                               .number("uscale", 2)
                               .number("vscale", -1)
                               .number("udelta", 0.25f)
                               .number("vdelta", 1));
    EXPECT_EQ(t.number(0.05f, 0.25f), 2);  // (0.35, 0.75)
    EXPECT_EQ(t.number(0.3f, 0.75f), 8);   // (0.85, 0.25)
}

TEST(CoreImageTexture, NumbersFromColours) {
    EXPECT_FLOAT_EQ(imagemap(numberInput().file("a", bytes(1, 1, 3, {255, 0, 51}))).number(0, 0), 0.4f);
    EXPECT_FLOAT_EQ(imagemap(numberInput().file("a", Image(1, 1, 3, {3, 0, 1.5f}))).number(0, 0), 1.5f);
    // Opaque everywhere: the mean. Else: alpha, of every texel.
    EXPECT_FLOAT_EQ(imagemap(numberInput().file("a", bytes(1, 1, 4, {255, 0, 51, 255}))).number(0, 0), 0.4f);
    EXPECT_FLOAT_EQ(imagemap(numberInput().file("a", Image(1, 1, 4, {3, 0, 1.5f, 1}))).number(0, 0), 1.5f);
    const One byteAlpha = imagemap(numberInput().file("a", bytes(2, 1, 4, {255, 0, 51, 255, 0, 0, 0, 102})));
    EXPECT_EQ(byteAlpha.number(0.25f, 0.5f), 1);
    EXPECT_FLOAT_EQ(byteAlpha.number(0.75f, 0.5f), 0.4f);
    const One floatAlpha = imagemap(numberInput().file("a", Image(2, 1, 4, {3, 0, 1.5f, 1, 0, 0, 0, 0.5f})));
    EXPECT_EQ(floatAlpha.number(0.25f, 0.5f), 1);
    EXPECT_EQ(floatAlpha.number(0.75f, 0.5f), 0.5f);
    // A spectrum does not look at alpha, and grey is replicated.
    expectColor(imagemap(colorInput().file("a", bytes(1, 1, 4, {255, 0, 51, 7}))).color(0, 0), 1, 0, 0.2f, 1e-7f);
    expectColor(imagemap(colorInput().file("a", bytes(1, 1, 1, {51}))).color(0, 0), 0.2f, 0.2f, 0.2f, 1e-7f);
    expectColor(imagemap(colorInput().file("a", grey(1, 1, {0.3f}))).color(0, 0), 0.3f, 0.3f, 0.3f);
}

TEST(CoreImageTexture, GreyBytesOfEverySizeUnpack) {
    for (int width = 1; width <= 9; ++width) {
        std::vector<std::uint8_t> codes(std::size_t(width) * 3);
        for (std::size_t i = 0; i < codes.size(); ++i)
            codes[i] = std::uint8_t(200 - 7 * i);
        const ImagePyramid p(bytes(width, 3, 1, codes));
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < width; ++x)
                EXPECT_EQ(p.texel(0, x, y).g, float(codes[std::size_t(y * width + x)]) / 255)
                    << width << " " << x << " " << y;
    }
}

TEST(CoreImageTexture, RolesOfAColour) {
    const Image image(1, 1, 3, {2.f, 0.5f, -1.f});
    expectColor(imagemap(colorInput(SpectrumRole::Albedo).file("a", image)).color(0, 0), 1, 0.5f, 0);
    expectColor(imagemap(colorInput(SpectrumRole::Unbounded).file("a", image)).color(0, 0), 2, 0.5f, 0);
    expectColor(imagemap(colorInput(SpectrumRole::Illuminant).file("a", image)).color(0, 0), 2, 0.5f, 0);
}

TEST(CoreImageTexture, ColoursGoToTheFilmsSpace) {
    const ColorSpace& aces = *findColorSpace("aces2065-1");
    const ColorSpace& wide = *findColorSpace("rec2020");
    const Rgb c{0.2f, 0.3f, 0.4f};
    const Image image(1, 1, 3, {c.r, c.g, c.b}, aces);
    const auto lookUp = [&](SpectrumRole role) {
        Input input = colorInput(role).file("a", image);
        input.film = &wide;
        return One("imagemap", input).color(0.5f, 0.5f);
    };
    const Rgb reflectance = apply(reflectanceConversion(aces, wide), c), light = apply(lightConversion(aces, wide), c);
    expectColor(lookUp(SpectrumRole::Albedo), reflectance.r, reflectance.g, reflectance.b, 1e-6f);
    expectColor(lookUp(SpectrumRole::Illuminant), light.r, light.g, light.b, 1e-6f);
    EXPECT_GT(std::fabs(light.r - reflectance.r), 1e-3f);  // the two differ, so the test can tell them apart
    // Bytes too, and numbers are never converted.
    Input input = colorInput().file("a", bytes(1, 1, 3, {51, 102, 153}));
    input.film = &wide;
    const Rgb fromBytes = apply(reflectanceConversion(srgbColorSpace(), wide), {0.2f, 0.4f, 0.6f});
    expectColor(One("imagemap", input).color(0, 0), fromBytes.r, fromBytes.g, fromBytes.b, 1e-6f);
    Input number = numberInput().file("a", image);
    number.film = &wide;
    EXPECT_FLOAT_EQ(One("imagemap", number).number(0, 0), 0.3f);
}

TEST(CoreImageTexture, ValuesThatAreNotFiniteCountAsZero) {
    Input input = numberInput().file("a", grey(2, 2, {kNaN, 4, std::numeric_limits<float>::infinity(), 4}));
    Textures textures;
    const TextureOperand made = textures.add("imagemap", input);
    ASSERT_EQ(input.warnings.size(), 1u);
    EXPECT_NE(input.warnings[0].find("2 values"), std::string::npos) << input.warnings[0];
    EXPECT_EQ(textures.scalar<float>(made.texture, at(0.25f, 0.75f)), 0);
    EXPECT_EQ(textures.scalar<float>(made.texture, at(0.25f, 0.75f, 100.f)), 2);
}

// ------------------------------------------------------------------------------------------------ checkerboard

TEST(CoreImageTexture, CheckerboardParity) {
    const One t("checkerboard", colorInput()
                                    .operand("tex1", TextureOperand::color({0.8f, 0.1f, 0.2f}))
                                    .operand("tex2", TextureOperand::color({0.3f, 0.4f, 0.5f}))
                                    .number("uscale", 2));
    for (int y = -3; y < 3; ++y)
        for (int x = -5; x < 5; ++x) {
            const Spectrum<float> c = t.color((float(x) + 0.3f) / 2, float(y) + 0.7f);
            if ((x + y) % 2 == 0) {
                expectColor(c, 0.8f, 0.1f, 0.2f);
            } else {
                expectColor(c, 0.3f, 0.4f, 0.5f);
            }
        }
    // Cells own their lower edges where the footprint is a point.
    expectColor(t.color(0, 0), 0.8f, 0.1f, 0.2f);
    expectColor(t.color(0.5f, 0), 0.3f, 0.4f, 0.5f);
    expectColor(t.color(0.5f, 1), 0.8f, 0.1f, 0.2f);
    const One standard("checkerboard", numberInput());
    EXPECT_EQ(standard.number(0.5f, 0.5f), 1);
    EXPECT_EQ(standard.number(1.5f, 0.5f), 0);
}

/// The mean of the stripes under a tent, by brute force (midpoints).
double stripesByIntegration(double x, double r) {
    const int n = 200000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const double d = (i + 0.5) / n * 2 - 1;
        const double parity = std::fmod(std::floor(x + d * r), 2.0);
        sum += (1 - std::fabs(d)) * (parity == 0 ? 1 : -1);
    }
    return sum * 2 / n;
}

TEST(CoreImageTexture, CheckerboardIsFilteredByATent) {
    const double footprints[] = {1e-4, 0.01, 0.1, 0.3, 0.333, 0.34, 0.5, 0.7, 1.0, 1.7, 4.0};
    std::mt19937 random(4);
    const One t("checkerboard", numberInput().number("vscale", 0.5f));
    for (const double footprint : footprints) {
        for (int i = 0; i < 6; ++i) {
            const auto place = [&] { return float(double(random() >> 8) * 0x1p-24 * 6 - 3); };
            // The first two near an edge, so that narrow tents meet one.
            const float u = i < 2 ? float(1 + (i - 0.4) * footprint) : place(), v = place();
            const double stripes = stripesByIntegration(double(u), 1.5 * footprint) *
                                   stripesByIntegration(double(0.5f * v), 0.75 * footprint);
            EXPECT_NEAR(t.number(u, v, float(footprint)), 0.5 + 0.5 * stripes, 3e-5)
                << u << " " << v << " " << footprint;
        }
    }
    EXPECT_NEAR(t.number(0.3f, 0.4f, 1e20f), 0.5f, 1e-6f);
    EXPECT_EQ(t.number(1, 0.4f, 0.1f), 0.5f);  // on an edge: half of each
}

TEST(CoreImageTexture, CheckerboardWeighsOnlyWhatItSees) {
    // Inside a cell the value is exactly that cell's, whatever the other is.
    const One t(
        "checkerboard",
        numberInput().operand("tex1", TextureOperand::number(0.1f)).operand("tex2", TextureOperand::number(1e30f)));
    EXPECT_EQ(t.number(0.5f, 0.5f, 0.01f), 0.1f);
    EXPECT_EQ(t.number(1.5f, 0.5f, 0.01f), 1e30f);
}

// ------------------------------------------------------------------------------------------------ textures of textures

TEST(CoreImageTexture, ConstantsStayConstants) {
    Textures textures;
    Input constant = colorInput().operand("value", TextureOperand::color({0.1f, 0.2f, 0.3f}));
    const TextureOperand c = textures.add("constant", constant);
    ASSERT_TRUE(c.isConstant());
    expectColor(c.constant, 0.1f, 0.2f, 0.3f);
    Input scaled = colorInput().operand("tex", c).operand("scale", TextureOperand::number(2));
    const TextureOperand s = textures.add("scale", scaled);
    ASSERT_TRUE(s.isConstant());
    expectColor(s.constant, 0.2f, 0.4f, 0.6f);
    EXPECT_EQ(textures.count(), 0u);
}

TEST(CoreImageTexture, ScaleOfTextures) {
    Textures textures;
    Input colors = colorInput().file("c", Image(2, 1, 3, {0.5f, 0.25f, 1, 1, 0.5f, 0.125f})).text("filter", "point");
    Input numbers = numberInput().file("n", grey(1, 2, {0.5f, 3})).text("filter", "point");
    Input product = colorInput()
                        .operand("tex", textures.add("imagemap", colors))
                        .operand("scale", textures.add("imagemap", numbers));
    const TextureOperand made = textures.add("scale", product);
    expectColor(textures.spectrum<float>(made.texture, at(0.25f, 0.75f)), 0.25f, 0.125f, 0.5f);
    expectColor(textures.spectrum<float>(made.texture, at(0.25f, 0.25f)), 1, 0.75f, 1);  // an albedo: clamped
    expectColor(textures.spectrum<float>(made.texture, at(0.75f, 0.25f)), 1, 1, 0.375f);
    // Only whoever looks an albedo up gets it clamped: a scale outside may bring 1.5 back.
    Input dimmed = colorInput().operand("tex", made).operand("scale", TextureOperand::number(0.5f));
    const TextureOperand again = textures.add("scale", dimmed);
    expectColor(textures.spectrum<float>(again.texture, at(0.25f, 0.25f)), 0.75f, 0.375f, 1);
}

TEST(CoreImageTexture, AConstantScaleOfAnImageComesBeforeItsInversion) {
    Textures textures;
    Input image = numberInput().file("a", grey(1, 1, {0.25f})).flag("invert", true);
    const TextureOperand inverted = textures.add("imagemap", image);
    Input first = numberInput().operand("tex", inverted).operand("scale", TextureOperand::number(2));
    Input second = numberInput().operand("scale", inverted).operand("tex", TextureOperand::number(2));
    Input third =
        numberInput().operand("tex", textures.add("scale", first)).operand("scale", TextureOperand::number(1.5f));
    EXPECT_EQ(textures.scalar<float>(inverted.texture, at(0.5f, 0.5f)), 0.75f);
    for (Input* input : {&first, &second})
        EXPECT_EQ(textures.scalar<float>(textures.add("scale", *input).texture, at(0.5f, 0.5f)), 0.5f);
    EXPECT_EQ(textures.scalar<float>(textures.add("scale", third).texture, at(0.5f, 0.5f)), 0.25f);
    // A factor of one is the texture itself.
    const std::size_t count = textures.count();
    Input same = numberInput().operand("tex", inverted).operand("scale", TextureOperand::number(1));
    EXPECT_EQ(textures.add("scale", same).texture, inverted.texture);
    EXPECT_EQ(textures.count(), count);
}

TEST(CoreImageTexture, DepthAndCostAreBounded) {
    Textures textures;
    Input board = numberInput();
    const TextureOperand ground = textures.add("checkerboard", board);
    TextureOperand chain = ground;
    for (std::uint32_t depth = 2; depth <= kTextureDepthLimit; ++depth) {
        Input input = numberInput().operand("tex1", chain);
        chain = textures.add("checkerboard", input);
    }
    Input deeper = numberInput().operand("tex1", chain);
    EXPECT_THROW(textures.add("checkerboard", deeper), Error);
    EXPECT_TRUE(std::isfinite(textures.scalar<float>(chain.texture, at(0.3f, 0.4f, 0.5f))));
    // Twice the one before, each time: few textures, many look-ups.
    TextureOperand doubled = ground;
    std::size_t made = 0;
    try {
        for (; made < kTextureDepthLimit; ++made) {
            Input input = numberInput().operand("tex1", doubled).operand("tex2", doubled);
            doubled = textures.add("checkerboard", input);
        }
        FAIL() << "no limit";
    } catch (const Error& error) {
        EXPECT_EQ(made, 7u);  // 2^8 - 1 evaluations are allowed, 2^9 - 1 are not
        EXPECT_NE(std::string(error.what()).find("511"), std::string::npos) << error.what();
    }
}

// ------------------------------------------------------------------------------------------------ building

TEST(CoreImageTexture, OneImageForAllThatUseTheFile) {
    Textures textures;
    Input a = colorInput(SpectrumRole::Albedo).file("a", numbered());
    Input b = colorInput(SpectrumRole::Illuminant).file("a", numbered());
    Input c = numberInput().file("a", numbered()).text("wrap", "clamp");
    Input d = numberInput().file("a", numbered()).text("encoding", "linear");
    Input e = numberInput().file("b", numbered());
    for (Input* input : {&a, &b, &c})
        textures.add("imagemap", *input);
    EXPECT_EQ(textures.imageCount(), 1u);
    EXPECT_EQ(a.reads + b.reads + c.reads, 1);
    textures.add("imagemap", d);
    textures.add("imagemap", e);
    EXPECT_EQ(textures.imageCount(), 3u);
    EXPECT_EQ(textures.count(), 5u);
}

TEST(CoreImageTexture, MemoryIsCounted) {
    const auto held = [](const Image& image) {
        Textures textures;
        Input input = numberInput().file("a", image);
        textures.add("imagemap", input);
        return textures.bytes();
    };
    const std::size_t texels = 256 * 256, all = texels * 4 / 3, fixed = 4096;
    const auto near = [&](std::size_t bytes, std::size_t expected) {
        return bytes >= expected && bytes < expected + fixed;
    };
    EXPECT_TRUE(near(held(bytes(256, 256, 1, std::vector<std::uint8_t>(texels))), all));
    EXPECT_TRUE(near(held(bytes(256, 256, 3, std::vector<std::uint8_t>(texels * 3))), all * 4));
    EXPECT_TRUE(near(held(bytes(256, 256, 4, std::vector<std::uint8_t>(texels * 4))), all * 4));
    EXPECT_TRUE(near(held(grey(256, 256, std::vector<float>(texels))), all * 4));
    EXPECT_TRUE(near(held(Image(256, 256, 3, std::vector<float>(texels * 3))), all * 12));
}

TEST(CoreImageTexture, ErrorsAndWarningsSayWhere) {
    Textures textures;
    const auto message = [&](const char* className, Input input) -> std::string {
        try {
            textures.add(className, input);
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).rfind("test.pbrt:1:1: texture 'tested': ", 0), 0u) << error.what();
            return std::to_string(int(error.kind())) + " " + error.what();
        }
        return "no error";
    };
    const auto contains = [](const std::string& text, const char* part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    contains(message("imagemap", numberInput()), "filename");
    contains(message("imagemap", numberInput().text("filename", "gone.png")), "66 ");
    contains(message("imagemap", numberInput().file("a", numbered()).text("wrap", "repaet")), "'repeat'");
    contains(message("imagemap", numberInput().file("a", numbered()).text("filter", "trilinaer")), "'trilinear'");
    contains(message("imagemap", numberInput().file("a", numbered()).text("encoding", "gama 2")), "'gama 2'");
    contains(message("imagemap", numberInput().file("a", numbered()).text("mapping", "plannar")), "'planar'");
    contains(message("checkerboard", numberInput().integer("dimension", 4)), "dimension 4");
    contains(message("checkerboard", numberInput().text("mapping", "planar").placed(scaling(1, 0, 1))), "no inverse");
    contains(message("checkerboard", numberInput().integer("dimension", 3).placed(scaling(1, 0, 1))), "no inverse");
    const auto warning = [&](const char* className, Input input) {
        textures.add(className, input);
        EXPECT_EQ(input.warnings.size(), 1u);
        return input.warnings.empty() ? std::string() : input.warnings[0];
    };
    contains(warning("imagemap", numberInput().file("a", numbered()).text("filter", "ewa")), "trilinear");
    EXPECT_TRUE(Textures::knows("imagemap"));
    EXPECT_FALSE(Textures::knows("marbel"));
}

// ------------------------------------------------------------------------------------------------ lanes

std::uint32_t bitsOf(float x) {
    return std::isnan(x) ? 0x7FC00000u : floatBits(x);
}

/// A scene of every format, wrap mode, filter and class: ids of numbers and of colours.
struct Zoo {
    Textures textures;
    std::vector<std::uint32_t> numbers, colors;

    Zoo() {
        std::mt19937 random(5);
        std::vector<Image> images;
        for (const int channels : {1, 3, 4}) {
            for (const auto& [width, height] : {std::pair{16, 8}, {13, 7}, {1, 5}, {1, 1}}) {
                const std::size_t n = std::size_t(width * height * channels);
                std::vector<std::uint8_t> codes(n);
                std::vector<float> values(n);
                for (std::uint8_t& c : codes)
                    c = std::uint8_t(random());
                for (float& v : values)
                    v = float(random() >> 8) * 0x1p-23f - 0.25f;
                images.push_back(bytes(width, height, channels, codes, TransferFunction::srgb()));
                images.push_back(Image(width, height, channels, values, *findColorSpace("rec2020")));
            }
        }
        const char* const wraps[] = {"repeat", "black", "clamp", "octahedralsphere"};
        const char* const filters[] = {"point", "bilinear", "trilinear"};
        for (std::size_t i = 0; i < images.size() * 12; ++i) {
            const std::size_t image = i / 12;
            const auto fill = [&](Input input) {
                input.file(std::to_string(image), images[image])
                    .text("wrap", wraps[i % 4])
                    .text("filter", filters[i % 3]);
                return input.flag("invert", i % 5 == 0).number("uscale", 3).number("vscale", -2).number("udelta", 0.1f);
            };
            add("imagemap", fill(numberInput()), numbers);
            add("imagemap", fill(colorInput(SpectrumRole(i % 3))), colors);
        }
        for (std::size_t i = 0; i < 20; ++i) {
            const auto any = [&](const std::vector<std::uint32_t>& from) {
                return TextureOperand{{}, from[random() % from.size()]};
            };
            add("scale", numberInput().operand("tex", any(numbers)).operand("scale", any(numbers)), numbers);
            add("scale", colorInput().operand("tex", any(colors)).operand("scale", any(numbers)), colors);
            add("checkerboard", numberInput().operand("tex1", any(numbers)).number("uscale", 7), numbers);
            add("checkerboard", colorInput().operand("tex1", any(colors)).operand("tex2", any(colors)), colors);
            add("mix",
                colorInput().operand("tex1", any(colors)).operand("tex2", any(colors)).operand("amount", any(numbers)),
                colors);
            add("directionmix", numberInput().operand("tex1", any(numbers)), numbers);
            add("bilerp", colorInput().operand("v11", any(colors)), colors);
            add("dots", numberInput().operand("inside", any(numbers)), numbers);
            for (const char* const noise : {"fbm", "wrinkled", "windy"})
                add(noise, numberInput().placed(rotation(double(31 * i), 3, 1, 2)), numbers);
            add("marble", colorInput().number("scale", 5), colors);
            const char* const mappings[] = {"planar", "spherical", "cylindrical"};
            const auto turned = [&](Input input) { return input.placed(rotation(double(17 * i), 1, 2, 3)); };
            add("checkerboard", turned(numberInput().text("mapping", mappings[i % 3])), numbers);
            add("checkerboard", turned(colorInput().operand("tex2", any(colors)).integer("dimension", 3)), colors);
        }
    }
    void add(const char* className, Input input, std::vector<std::uint32_t>& ids) {
        ids.push_back(textures.add(className, input).texture);
    }
};

TEST(CoreImageTexture, OneLaneAndEightGiveTheSameBits) {
    const Zoo zoo;
    std::mt19937 random(6);
    const auto coordinate = [&]() -> float {
        switch (random() % 16) {
            case 0:
                return kNaN;
            case 1:
                return float(std::int32_t(random())) * 1e3f;
            case 2:
                return float(random() % 9) * 0.25f - 1;
            default:
                return float(std::int32_t(random())) * 0x1p-30f;
        }
    };
    std::size_t coloured = 0;
    for (int round = 0; round < 100000; ++round) {
        // Every third group shares one texture; in others lanes may have none.
        const std::uint32_t pick = random();
        UInt<Lanes8f> number, color;
        TextureContext<Lanes8f> wide = at(Lanes8f(0.f), Lanes8f(0.f));
        for (int i = 0; i < 8; ++i) {
            const std::uint32_t which = round % 3 == 0 ? pick : round % 3 == 1 ? pick + random() % 3 : random();
            const bool none = round % 3 != 0 && random() % 5 == 0;
            setLane(number, i, none ? kNoTexture : zoo.numbers[which % zoo.numbers.size()]);
            setLane(color, i, none ? kNoTexture : zoo.colors[which % zoo.colors.size()]);
            setLane(wide.uv.x, i, coordinate());
            setLane(wide.uv.y, i, coordinate());
            const auto width = [&] { return std::exp2(float(random() % 1024) / 64 - 12) * float(random() % 4 != 0); };
            setLane(wide.footprint, i, width());
            setLane(wide.width, i, width());
            setLane(wide.p.x, i, coordinate());
            setLane(wide.p.y, i, coordinate());
            setLane(wide.p.z, i, coordinate());
            const float tilt = float(random()) * 0x1p-32f;
            setLane(wide.n.x, i, std::sin(tilt));
            setLane(wide.n.z, i, std::cos(tilt));
        }
        const Lanes8f x = zoo.textures.scalar<Lanes8f>(number, wide);
        const Spectrum<Lanes8f> c = zoo.textures.spectrum<Lanes8f>(color, wide);
        for (int i = 0; i < 8; ++i) {
            const TextureContext<float> one{{lane(wide.uv.x, i), lane(wide.uv.y, i)},
                                            lane(wide.footprint, i),
                                            lane(wide.p, i),
                                            lane(wide.n, i),
                                            lane(wide.width, i)};
            const float x1 = zoo.textures.scalar<float>(lane(number, i), one);
            const Spectrum<float> c1 = zoo.textures.spectrum<float>(lane(color, i), one), c8 = lane(c, i);
            ASSERT_EQ(bitsOf(lane(x, i)), bitsOf(x1))
                << "number " << lane(number, i) << ": " << lane(x, i) << " " << x1;
            ASSERT_EQ(bitsOf(c8.r), bitsOf(c1.r)) << "colour " << lane(color, i);
            ASSERT_EQ(bitsOf(c8.g), bitsOf(c1.g)) << "colour " << lane(color, i);
            ASSERT_EQ(bitsOf(c8.b), bitsOf(c1.b)) << "colour " << lane(color, i);
            if (lane(number, i) == kNoTexture) {
                ASSERT_EQ(x1, 0);
            }
            coloured += c1.r != c1.g && x1 != 0;
        }
    }
    EXPECT_GT(coloured, 100000u);  // the groups were not mostly black or grey
}

TEST(CoreImageTexture, MixedGroupsGiveEveryLaneItsOwn) {
    Textures textures;
    std::vector<std::uint32_t> ids;
    for (int k = 0; k < 3; ++k) {
        Input input = numberInput().file(std::to_string(k), grey(1, 1, {float(k) + 1}));
        ids.push_back(textures.add("imagemap", input).texture);
    }
    const std::uint32_t group[] = {ids[2], ids[0], kNoTexture, ids[0], ids[1], ids[2], kNoTexture, ids[1]};
    const float expected[] = {3, 1, 0, 1, 2, 3, 0, 2};
    const Lanes8f out = textures.scalar<Lanes8f>(load<Lanes8f>(group), at(Lanes8f(0.5f), Lanes8f(0.5f)));
    for (int i = 0; i < 8; ++i)
        EXPECT_EQ(lane(out, i), expected[i]);
    const Lanes8f nothing = textures.scalar<Lanes8f>(Lanes8u(kNoTexture), at(Lanes8f(0.5f), Lanes8f(0.5f)));
    for (int i = 0; i < 8; ++i)
        EXPECT_EQ(lane(nothing, i), 0);
}

}  // namespace
}  // namespace penumbra
