// Textures that blend others and textures of noise, against their definitions.
#include "tests/texture_fixture.h"

#include <cmath>

namespace penumbra {
namespace {

using namespace test;

const Vec3<float> kUp{0, 0, 1};

TextureOperand number(float x) {
    return TextureOperand::number(x);
}

std::string errorOf(const char* className, Input input) {
    Textures textures;
    try {
        textures.add(className, input);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

// ------------------------------------------------------------------------------------------------ blends

TEST(CoreImageProcedural, MixOfConstantsIsConstant) {
    Textures textures;
    Input input = colorInput()
                      .operand("tex1", TextureOperand::color({0.2f, 0.4f, 0.8f}))
                      .operand("tex2", TextureOperand::color({1, 0, 0.4f}))
                      .operand("amount", number(0.25f));
    const TextureOperand made = textures.add("mix", input);
    ASSERT_TRUE(made.isConstant());
    expectColor(made.constant, 0.4f, 0.3f, 0.7f, 1e-7f);
    Input standard = numberInput();
    EXPECT_EQ(textures.add("mix", standard).constant.r, 0.5f);
}

TEST(CoreImageProcedural, MixByATexture) {
    Textures textures;
    Input one = numberInput().file("one", grey(1, 1, {0.3f})), two = numberInput().file("two", grey(1, 1, {0.7f}));
    Input amounts = numberInput().file("amounts", grey(4, 1, {0, 1, 0.5f, 2})).text("filter", "point");
    const TextureOperand first = textures.add("imagemap", one), second = textures.add("imagemap", two);
    Input input = numberInput()
                      .operand("tex1", first)
                      .operand("tex2", second)
                      .operand("amount", textures.add("imagemap", amounts));
    const std::uint32_t mix = textures.add("mix", input).texture;
    const float expected[] = {0.3f, 0.7f, 0.5f, 1.1f};  // exact at both ends, not clamped beyond
    EXPECT_EQ(textures.scalar<float>(mix, at(0.125f, 0.5f)), expected[0]);
    EXPECT_EQ(textures.scalar<float>(mix, at(0.375f, 0.5f)), expected[1]);
    EXPECT_FLOAT_EQ(textures.scalar<float>(mix, at(0.625f, 0.5f)), expected[2]);
    EXPECT_FLOAT_EQ(textures.scalar<float>(mix, at(0.875f, 0.5f)), expected[3]);
    // A constant amount of 0 or 1 is the texture itself.
    Input none = numberInput().operand("tex1", first).operand("tex2", second).operand("amount", number(0));
    Input all = numberInput().operand("tex1", first).operand("tex2", second).operand("amount", number(1));
    EXPECT_EQ(textures.add("mix", none).texture, first.texture);
    EXPECT_EQ(textures.add("mix", all).texture, second.texture);
}

TEST(CoreImageProcedural, DirectionMixFollowsTheNormal) {
    const Input values = numberInput().operand("tex1", number(3)).operand("tex2", number(7));
    const auto facing = [](const One& t, float x, float y, float z) {
        return t.number(atPoint(Vec3<float>{5, 6, 7}, Vec3<float>{x, y, z}));
    };
    const One up("directionmix", values);
    EXPECT_EQ(facing(up, 0, 1, 0), 3);
    EXPECT_EQ(facing(up, 0, -1, 0), 3);
    EXPECT_EQ(facing(up, 1, 0, 0), 7);
    EXPECT_FLOAT_EQ(facing(up, 0.8f, 0.6f, 0), 0.6f * 3 + 0.4f * 7);
    // The direction is taken along by the transformation, as a vector.
    const One turned("directionmix", Input(values).vector("dir", 0, 2, 0).placed(
                                         translation(9, 9, 9) * rotation(90, 0, 0, 1) * scaling(1, 5, 1)));
    EXPECT_NEAR(facing(turned, 1, 0, 0), 3, 1e-6f);
    EXPECT_NEAR(facing(turned, 0, 1, 0), 7, 1e-6f);
    EXPECT_NE(errorOf("directionmix", Input(values).vector("dir", 0, 0, 0)).find("no direction"), std::string::npos);
    EXPECT_NE(errorOf("directionmix", Input(values).placed(scaling(1, 0, 1))).find("no direction"), std::string::npos);
}

TEST(CoreImageProcedural, BilerpIsBilinearEverywhere) {
    const One t("bilerp", numberInput()
                              .operand("v00", number(1))
                              .operand("v01", number(2))
                              .operand("v10", number(4))
                              .operand("v11", number(8)));
    EXPECT_EQ(t.number(0, 0), 1);
    EXPECT_EQ(t.number(0, 1), 2);
    EXPECT_EQ(t.number(1, 0), 4);
    EXPECT_EQ(t.number(1, 1), 8);
    EXPECT_EQ(t.number(0.5f, 0.5f), 15 / 4.f);
    EXPECT_FLOAT_EQ(t.number(0.25f, 0.75f), (3 * (3 * 2 + 1 * 8) + (3 * 1 + 1 * 4)) / 16.f);
    EXPECT_EQ(t.number(2, 0), 7);  // beyond the square, the same function
    const One colors("bilerp", colorInput().operand("v10", TextureOperand::color({1, 0.5f, 0})).number("uscale", 2));
    expectColor(colors.color(0.25f, 0), 0.5f, 0.25f, 0);
}

// ------------------------------------------------------------------------------------------------ dots

TEST(CoreImageProcedural, DotsAreDiscsInTwoOfFiveCells) {
    // `inside` is the value around the dots: the names are pbrt's.
    const One t("dots", numberInput().operand("inside", number(0)).operand("outside", number(1)));
    int cells = 0, dotted = 0;
    for (int x = -20; x < 20; ++x)
        for (int y = -20; y < 20; ++y) {
            int inside = 0, points = 0;
            double sumX = 0, sumY = 0;
            const int n = 50;
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const float dx = (float(i) + 0.5f) / n - 0.5f, dy = (float(j) + 0.5f) / n - 0.5f;
                    const bool isDot = t.number(float(x) + dx, float(y) + dy) == 1;
                    ++points;
                    inside += isDot;
                    sumX += isDot ? double(dx) : 0;
                    sumY += isDot ? double(dy) : 0;
                }
            ++cells;
            if (inside == 0) continue;
            ++dotted;
            EXPECT_NEAR(double(inside) / points, M_PI * 0.35 * 0.35, 0.012);
            EXPECT_LT(std::max(std::fabs(sumX), std::fabs(sumY)) / inside, 0.15);  // so the whole dot is in its cell
        }
    EXPECT_NEAR(double(dotted) / cells, 0.395, 0.08);  // of the whole period it is 0.395
}

TEST(CoreImageProcedural, DotsChooseBetweenTextures) {
    Textures textures;
    Input board = numberInput().number("uscale", 50);
    Input input = numberInput().operand("inside", number(5)).operand("outside", textures.add("checkerboard", board));
    const std::uint32_t dots = textures.add("dots", input).texture;
    int found[6]{};
    for (int i = 0; i < 1000; ++i)
        ++found[int(textures.scalar<float>(dots, at(float(i) * 0.0137f, float(i) * 0.0091f)))];
    EXPECT_GT(found[0], 20);
    EXPECT_GT(found[1], 20);
    EXPECT_EQ(found[0] + found[1] + found[5], 1000);
}

// ------------------------------------------------------------------------------------------------ noise

const Matrix4 kSpace = translation(1, 2, 3) * rotation(40, 1, 1, 0) * scaling(0.5, 0.5, 0.5);

/// The same place in the space of kSpace.
Vec3<float> inSpace(const Vec3<float>& p) {
    Matrix4 inverse;
    invert(kSpace, inverse);
    const AffineRecord record = toRecord(inverse);
    return loadAffine<float>(&record, 0u).point(p);
}

TEST(CoreImageProcedural, NoiseLivesInTheTexturesSpace) {
    const One fbm("fbm", numberInput().integer("octaves", 4).number("roughness", 0.7f).placed(kSpace));
    const One wrinkled("wrinkled", numberInput().placed(kSpace)), windy("windy", numberInput().placed(kSpace));
    for (int i = 0; i < 100; ++i) {
        const Vec3<float> p = {0.37f * float(i), 5 - 0.21f * float(i), 0.013f * float(i * i)}, q = inSpace(p);
        const float width = i % 2 ? 0.03f : 0.f;  // twice as wide in the space, which is half as large
        const TextureContext<float> context = atPoint(p, kUp, width);
        EXPECT_NEAR(fbm.number(context), brownianNoise(q, 2 * width, {4, 0.7f}), 1e-4f);
        EXPECT_NEAR(wrinkled.number(context), turbulentNoise(q, 2 * width, {8, 0.5f}), 1e-4f);
        const float wind = std::fabs(brownianNoise(q * 0.1f, 0.2f * width, {3, 0.5f}));
        EXPECT_NEAR(windy.number(context), wind * brownianNoise(q, 2 * width, {6, 0.5f}), 1e-4f);
    }
}

TEST(CoreImageProcedural, AFootprintIsTheMeanStretchWithinTheSurface) {
    TextureSpace space;
    Input input = numberInput().placed(scaling(0.5, 0.25, 1));
    space = TextureSpace::make(input);
    EXPECT_FLOAT_EQ(space.footprint(atPoint(Vec3<float>{0, 0, 0}, kUp, 0.1f)), 0.1f * std::sqrt((4 + 16) / 2.f));
    EXPECT_FLOAT_EQ(space.footprint(atPoint(Vec3<float>{0, 0, 0}, Vec3<float>{1, 0, 0}, 0.1f)),
                    0.1f * std::sqrt((1 + 16) / 2.f));
}

/// Cubic Bezier in double, by de Casteljau.
double bezier(const double (&c)[4], double t) {
    double p[4] = {c[0], c[1], c[2], c[3]};
    for (int n = 3; n > 0; --n)
        for (int i = 0; i < n; ++i)
            p[i] += (p[i + 1] - p[i]) * t;
    return p[0];
}

TEST(CoreImageProcedural, MarbleIsASplineOfASine) {
    const One t("marble", colorInput().number("variation", 0).number("scale", 2));
    const double red[] = {0.58, 0.58, 0.58, 0.5, 0.6, 0.58, 0.58, 0.2, 0.58};
    const double blue[] = {0.6, 0.6, 0.6, 0.5, 0.58, 0.6, 0.6, 0.33, 0.6};
    for (int i = -300; i < 300; ++i) {
        const float y = 0.031f * float(i);
        const double along = 6 * (0.5 + 0.5 * std::sin(2.0 * double(y)));
        const int first = std::min(int(along), 5);
        const auto value = [&](const double* c) {
            return 1.5 * bezier({c[first], c[first + 1], c[first + 2], c[first + 3]}, along - first);
        };
        const Spectrum<float> c = t.color(atPoint(Vec3<float>{float(i), y, 3}));
        EXPECT_NEAR(c.r, value(red), 2e-5) << y;
        EXPECT_NEAR(c.b, value(blue), 2e-5) << y;
    }
    // The noise shifts the veins.
    const One veined("marble", colorInput().number("variation", 3).integer("octaves", 1));
    const Vec3<float> p = {0.4f, 0.3f, 0.2f}, shifted = {0.4f, 0.3f + 3 * gradientNoise(p), 0.2f};
    const One plain("marble", colorInput().number("variation", 0));
    const Spectrum<float> a = veined.color(atPoint(p)), b = plain.color(atPoint(shifted));
    expectColor(a, b.r, b.g, b.b, 1e-5f);
}

TEST(CoreImageProcedural, MarbleIsAnSrgbAlbedo) {
    Input input = colorInput(SpectrumRole::Illuminant).number("variation", 0);
    input.film = findColorSpace("rec2020");
    const One t("marble", input);
    const Rgb expected = apply(reflectanceConversion(srgbColorSpace(), *input.film), {0.87f, 0.87f, 0.9f});
    expectColor(t.color(atPoint(Vec3<float>{0, -kHalfPi, 0})), expected.r, expected.g, expected.b, 1e-6f);
}

TEST(CoreImageProcedural, ErrorsOfNoise) {
    for (const char* name : {"fbm", "wrinkled", "windy"})
        EXPECT_NE(errorOf(name, colorInput()).find("\"float\" textures only"), std::string::npos) << name;
    EXPECT_NE(errorOf("marble", numberInput()).find("\"spectrum\" textures only"), std::string::npos);
    EXPECT_NE(errorOf("fbm", numberInput().integer("octaves", 2000000000)).find("octaves 2000000000"),
              std::string::npos);
    EXPECT_NE(errorOf("wrinkled", numberInput().integer("octaves", -1)).find("octaves -1"), std::string::npos);
    EXPECT_NE(errorOf("windy", numberInput().placed(scaling(0, 0, 0))).find("no inverse"), std::string::npos);
}

TEST(CoreImageProcedural, PtexIsRefused) {
    Textures textures;
    Input input = colorInput().text("filename", "a.ptx");
    const TextureOperand made = textures.add("ptex", input);
    ASSERT_TRUE(made.isConstant());
    EXPECT_EQ(made.constant.g, 0.5f);
    ASSERT_EQ(input.warnings.size(), 1u);
    EXPECT_NE(input.warnings[0].find("not supported"), std::string::npos);
}

}  // namespace
}  // namespace penumbra
