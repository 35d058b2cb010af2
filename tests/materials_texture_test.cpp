// Materials whose reflectance or roughness comes from a texture behave like those with the same constant; checked for
// every registered material that lists such a parameter.
#include "tests/materials_fixture.h"
#include "tests/texture_fixture.h"

namespace penumbra::test {
namespace {

constexpr Rgb kInside{0.3f, 0.5f, 0.7f};
constexpr float kInsideNumber = 0.3f;

/// A checkerboard: kInside (or kInsideNumber) where 0 <= u, v < 1, white beside.
Input boardInput(TextureKind kind) {
    const bool isNumber = kind == TextureKind::Float;
    return Input(kind)
        .operand("tex1", isNumber ? TextureOperand::number(kInsideNumber) : TextureOperand::color(kInside))
        .operand("tex2", TextureOperand::number(1));
}

/// Material 0 has the constant, material 1 the texture of the same value.
template <class M>
struct Pair {
    MaterialTable table;
    Textures textures;

    Pair(Settings settings, const Setting& constant) {
        Input board = boardInput(constant.type == "rgb" ? TextureKind::Spectrum : TextureKind::Float);
        const TextureOperand texture = textures.add("checkerboard", board);
        settings.push_back(constant);
        PlainMaterialInput plain(settings, table.tables()), textured(settings, table.tables());
        textured.useTexture(constant.name, texture.texture);
        table.add(M::kInfo.name, plain);
        table.add(M::kInfo.name, textured);
    }
    template <class F>
    typename M::template Bsdf<F> closure(const UInt<F>& index) const {
        const UInt<F> id = index + UInt<F>(table.firstId(kTagOf<M, MaterialTypes>));
        const ShadingContext<F> context{textures, table.tableData(), at(F(0.5f), F(0.5f))};
        return M::bsdf(table.records<M, F>(id), context);
    }
};

/// Coats of textured roughness interpolate their tables over one dimension more: 1e-3.
template <class M>
void expectTextureActsAsConstant(const Settings& settings, const Setting& constant) {
    const Pair<M> pair(settings, constant);
    const auto one = pair.template closure<float>(0u), other = pair.template closure<float>(1u);
    const auto mixed = pair.template closure<Lanes8f>(laneIndices<Lanes8f>() & Lanes8u(1u));
    const std::string name = describe(M::kInfo.name, settings) + " " + constant.name;
    for (int i = 0; i < 12; ++i) {
        const Vec3<float> wo = directionOf(0.95 - 0.06 * i, i), wi = directionOf(0.4 + 0.04 * i, 3.0 + 0.9 * i);
        const BsdfEval<float> a = one.evaluate(wo, wi), b = other.evaluate(wo, wi);
        EXPECT_NEAR(a.fCos.r, b.fCos.r, 1e-3 * a.fCos.r + 1e-7) << name;
        EXPECT_NEAR(a.fCos.g, b.fCos.g, 1e-3 * a.fCos.g + 1e-7) << name;
        EXPECT_NEAR(a.fCos.b, b.fCos.b, 1e-3 * a.fCos.b + 1e-7) << name;
        EXPECT_NEAR(a.pdf, b.pdf, 1e-3 * a.pdf) << name;
        const BsdfEval<Lanes8f> wide = mixed.evaluate(broadcast<Lanes8f>(wo), broadcast<Lanes8f>(wi));
        for (int k = 0; k < 8; ++k) {
            EXPECT_EQ(lane(wide.fCos.g, k), (k % 2 ? b : a).fCos.g) << name;
            EXPECT_EQ(lane(wide.pdf, k), (k % 2 ? b : a).pdf) << name;
        }
    }
    EXPECT_EQ(one.smoothOnly(), other.smoothOnly()) << name;
}

TEST(MaterialTextures, ActLikeTheirValue) {
    int tried = 0;
    forEachType(MaterialTypes{}, [&]<class M>() {
        for (const ParameterInfo& p : M::kInfo.parameters) {
            if (p.name == "reflectance") {
                expectTextureActsAsConstant<M>({}, color("reflectance", kInside.r, kInside.g, kInside.b));
                ++tried;
            }
            if (p.name == "roughness") {
                expectTextureActsAsConstant<M>({}, number("roughness", kInsideNumber));
                expectTextureActsAsConstant<M>({plainAlpha()}, number("roughness", kInsideNumber));
                ++tried;
            }
        }
    });
    EXPECT_GE(tried, 6);
    expectTextureActsAsConstant<ConductorMaterial>({multiscatter()}, number("roughness", kInsideNumber));
    expectTextureActsAsConstant<DielectricMaterial>({multiscatter()}, number("roughness", kInsideNumber));
}

}  // namespace
}  // namespace penumbra::test
