// Choosing from mixes: what share of numbers leads to which material, whatever the tree and the amounts.
#include "tests/materials_fixture.h"

#include <gtest/gtest.h>

#include <limits>

namespace penumbra::test {
namespace {

constexpr std::uint32_t kNumbers = 1u << 16;

/// Four diffuse materials, and mixes of them.
class Mixes : public testing::Test {
protected:
    MaterialTable table;
    Textures textures;
    MaterialHandle leaves[4];

    Mixes() {
        for (MaterialHandle& leaf : leaves)
            leaf = table.add(DiffuseMaterial{});
    }
    MaterialHandle mix(MaterialHandle first, MaterialHandle second, float amount) {
        return table.addMix(first, second, {amount, kNoTexture});
    }
    template <class F>
    UInt<F> choose(const UInt<F>& id, F u) const {
        const ShadingContext<F> nowhere{textures, table.tableData(), {}};
        return chooseFromMixes(table.mixes().data(), id, u, nowhere);
    }
    /// The share of an even grid of numbers that chooses each material.
    std::vector<double> shares(MaterialHandle of) const {
        std::vector<double> result(table.size());
        for (std::uint32_t i = 0; i < kNumbers; ++i)
            result.at(choose(table.id(of), (float(i) + 0.5f) / float(kNumbers))) += 1. / kNumbers;
        return result;
    }
};

TEST_F(Mixes, TheSecondIsMetWithTheProbabilityOfTheAmount) {
    const MaterialHandle m = mix(leaves[0], leaves[1], 0.3f);
    table.finish();
    EXPECT_NEAR(shares(m)[0], 0.7, 1. / kNumbers);
    EXPECT_NEAR(shares(m)[1], 0.3, 1. / kNumbers);
    EXPECT_EQ(table.size(), 4u) << "a mix is no material";
}

TEST_F(Mixes, NestedOnesMultiplyTheirAmounts) {
    const MaterialHandle inner = mix(leaves[0], leaves[1], 0.3f), middle = mix(inner, leaves[2], 0.25f),
                         outer = mix(leaves[3], middle, 0.8f);
    table.finish();
    const std::vector<double> share = shares(outer);
    const double expected[] = {0.8 * 0.75 * 0.7, 0.8 * 0.75 * 0.3, 0.8 * 0.25, 0.2};
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(share[i], expected[i], 3. / kNumbers) << i;
}

/// Each level halves what is left of the number, far beyond its 24 bits.
TEST_F(Mixes, OneNumberServesAChainOfAnyDepth) {
    MaterialHandle chain = leaves[0];
    for (int i = 0; i < 60; ++i)
        chain = mix(leaves[1 + i % 3], chain, 0.5f);
    table.finish();
    const std::vector<double> share = shares(chain);
    EXPECT_NEAR(share[0], 0, 1. / kNumbers);
    EXPECT_NEAR(share[3], 4. / 7, 20. / kNumbers);
    EXPECT_NEAR(share[2], 2. / 7, 20. / kNumbers);
    EXPECT_NEAR(share[1], 1. / 7, 20. / kNumbers);
}

TEST_F(Mixes, AmountsOutsideTheirRangeCountAsItsEnds) {
    constexpr float kInf = std::numeric_limits<float>::infinity(), kNaN = std::numeric_limits<float>::quiet_NaN();
    const float firsts[] = {0.f, -0.f, -3.f, -kInf, kNaN}, seconds[] = {1.f, 1.5f, 1e30f, kInf};
    for (const float amount : firsts)
        mix(leaves[0], leaves[1], amount);
    for (const float amount : seconds)
        mix(leaves[0], leaves[1], amount);
    table.finish();
    for (const float u : {0.f, 0x1p-24f, 0.5f, kOneMinusEpsilon}) {
        for (std::uint32_t i = 0; i < table.mixes().size(); ++i)
            EXPECT_EQ(choose(kMixFlag + i, u), i < std::size(firsts) ? 0u : 1u) << i << " " << u;
    }
}

TEST_F(Mixes, OneLaneAndEightChooseTheSame) {
    std::vector<MaterialHandle> all(leaves, leaves + 4);
    for (std::uint32_t i = 0; i < 12; ++i)
        all.push_back(mix(all[i / 2], all[3 + i], 0.1f + 0.07f * float(i)));
    table.finish();
    const Uniforms u{17};
    for (std::uint32_t group = 0; group < 4000; ++group) {
        Lanes8u id;
        const Lanes8f number = u(group, 0), pick = u(group, 1);
        for (int k = 0; k < 8; ++k)
            setLane(id, k, table.id(all[std::size_t(lane(pick, k) * float(all.size()))]));
        const Lanes8u wide = choose(id, number);
        for (int k = 0; k < 8; ++k)
            ASSERT_EQ(lane(wide, k), choose(lane(id, k), lane(number, k)));
    }
}

}  // namespace
}  // namespace penumbra::test
