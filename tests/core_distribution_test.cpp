// Piecewise-constant distributions: exact probabilities, no cell lost, one lane like eight.
#include "core/math/distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace penumbra {
namespace {

std::vector<float> tableOf(const std::vector<double>& weights) {
    std::vector<float> table;
    appendCumulative(weights, table);
    return table;
}

Cell<float> cellOf(const std::vector<float>& table, float u) {
    const std::uint32_t cells = std::uint32_t(table.size() - 1);
    return sampleCell<float>(table.data(), 0, cells, searchStride(cells), u);
}

TEST(CoreDistribution, ProbabilitiesAreProportional) {
    const std::vector<float> table = tableOf({1, 0, 3, 4, 0});
    const std::vector<float> expected = {0, 0.125f, 0.125f, 0.5f, 1, 1};
    ASSERT_EQ(table.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(table[i], expected[i], 0x1p-22f) << i;
    EXPECT_EQ(tableOf({1, 1}), (std::vector<float>{0, 0.5f, 1}));
}

/// Every u of the grid of 2^-24 that sampling uses falls into its cell, and the count of them is the probability.
TEST(CoreDistribution, ProbabilityIsTheMeasureOfTheNumbersThatChooseTheCell) {
    const std::vector<double> weights = {1e-9, 5, 0, 2.5, 1e-12, 0.1};
    const std::vector<float> table = tableOf(weights);
    std::vector<std::uint32_t> counts(weights.size(), 0);
    for (std::uint32_t i = 0; i < (1u << 24); ++i)
        ++counts[cellOf(table, float(i) * 0x1p-24f).index];
    for (std::uint32_t i = 0; i < weights.size(); ++i) {
        EXPECT_EQ(float(counts[i]) * 0x1p-24f, cellProbability<float>(table.data(), 0, i)) << i;
        EXPECT_EQ(counts[i] > 0, weights[i] > 0) << i;
    }
}

TEST(CoreDistribution, HostileWeights) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(tableOf({nan, 1, -5, infinity}), (std::vector<float>{0, 0, 1, 1, 1}));
    EXPECT_EQ(tableOf({0, 0, 0, 0}), (std::vector<float>{0, 0.25f, 0.5f, 0.75f, 1}));
    EXPECT_EQ(tableOf({1e308, 1e308}), (std::vector<float>{0, 0.5f, 1}));  // the sum overflows
    EXPECT_EQ(tableOf({1e-320, 0}), (std::vector<float>{0, 1, 1}));
    EXPECT_EQ(tableOf({7}), (std::vector<float>{0, 1}));
    EXPECT_EQ(cellOf(tableOf({7}), kOneMinusEpsilon).index, 0u);
}

TEST(CoreDistribution, CellsAreFoundForEverySize) {
    std::mt19937 generator(1);
    for (std::size_t n = 1; n < 70; ++n) {
        std::vector<double> weights(n);
        for (double& w : weights)
            w = generator() % 3 == 0 ? 0 : double(generator() % 1000);
        const std::vector<float> table = tableOf(weights);
        for (int k = 0; k < 200; ++k) {
            const float u = float(generator() >> 8) * 0x1p-24f;
            const Cell<float> cell = cellOf(table, u);
            EXPECT_TRUE(table[cell.index] <= u && u < table[cell.index + 1]);
            EXPECT_TRUE(cell.inside >= 0.f && cell.inside < 1.f);
            EXPECT_FLOAT_EQ(table[cell.index] + cell.inside * cell.probability, u);
        }
    }
}

TEST(CoreDistribution, EightLanesWithTablesOfTheirOwn) {
    std::vector<float> table;
    std::vector<std::uint32_t> first, cells;
    std::mt19937 generator(2);
    for (std::size_t n = 1; n <= 40; n += 3) {
        std::vector<double> weights(n);
        for (double& w : weights)
            w = double(generator() % 100);
        first.push_back(std::uint32_t(table.size()));
        cells.push_back(std::uint32_t(n));
        appendCumulative(weights, table);
    }
    for (int round = 0; round < 1000; ++round) {
        Lanes8u start, count, stride;
        Lanes8f u;
        for (int i = 0; i < 8; ++i) {
            const std::size_t which = generator() % first.size();
            setLane(start, i, first[which]);
            setLane(count, i, cells[which]);
            setLane(stride, i, searchStride(cells[which]));
            setLane(u, i, float(generator() >> 8) * 0x1p-24f);
        }
        const Cell<Lanes8f> wide = sampleCell(table.data(), start, count, stride, u);
        for (int i = 0; i < 8; ++i) {
            const Cell<float> one =
                sampleCell<float>(table.data(), lane(start, i), lane(count, i), lane(stride, i), lane(u, i));
            EXPECT_EQ(lane(wide.index, i), one.index);
            EXPECT_EQ(floatBits(lane(wide.probability, i)), floatBits(one.probability));
            EXPECT_EQ(floatBits(lane(wide.inside, i)), floatBits(one.inside));
        }
    }
}

TEST(CoreDistribution, GridCellsHaveTheirWeight) {
    const std::vector<float> weights = {1, 2, 0, 0, 0, 0, 3, 0, 2};
    std::vector<float> table(5, 0.f);  // what else the array holds
    appendCumulativeGrid(weights, 3, 3, table);
    std::vector<double> counts(9, 0.0);
    constexpr int kSide = 512;
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            const Vec2<float> u = {(float(i) + 0.5f) / kSide, (float(j) + 0.5f) / kSide};
            const std::uint32_t stride = searchStride(3);
            const GridCell<float> cell = sampleGrid<float>(table.data(), 5, 3, 3, stride, stride, u);
            ++counts[cell.y * 3 + cell.x];
            EXPECT_NEAR(cell.probability, weights[cell.y * 3 + cell.x] / 8, 1e-6);
        }
    }
    for (std::size_t i = 0; i < 9; ++i)
        EXPECT_NEAR(counts[i] / (kSide * kSide), weights[i] / 8, 2.0 / kSide) << i;
}

}  // namespace
}  // namespace penumbra
