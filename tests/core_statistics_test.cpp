// The statistics of core/statistics against published values, and against their own definition: p-values of true
// hypotheses are uniform. Seeds are fixed; the one statistical bar names its chance of a false alarm.
#include "core/statistics/distributions.h"
#include "core/statistics/hypothesis_tests.h"
#include "core/statistics/multiple_comparisons.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace penumbra {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Gosset's sleep data (Student 1908): additional hours with two drugs.
const std::vector<double> kDrug1{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
const std::vector<double> kDrug2{1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};

/// Uniform in (0, 1), the same on every platform (std's distributions are not).
double uniform(std::mt19937_64& generator) {
    return (static_cast<double>(generator() >> 12) + 0.5) * 0x1p-52;
}

std::vector<double> normals(std::mt19937_64& generator, std::size_t n, double mean, double deviation) {
    std::vector<double> values(n);
    for (double& v : values)
        v = mean + deviation * normalQuantile(uniform(generator));
    return values;
}

TEST(CoreStatistics, DistributionsMatchTables) {
    EXPECT_NEAR(normalSurvival(1.959963984540054), 0.025, 1e-15);
    EXPECT_NEAR(normalSurvival(6) / 9.865876450376946e-10, 1, 1e-12);
    EXPECT_NEAR(normalQuantile(0.975), 1.959963984540054, 1e-13);
    EXPECT_NEAR(studentSurvival(2.2281388519862744, 10), 0.025, 1e-14);
    EXPECT_NEAR(studentSurvival(1, 1), 0.25, 1e-15);  // Cauchy
    EXPECT_NEAR(studentQuantile(0.995, 15), 2.946712883475227, 1e-12);
    EXPECT_NEAR(chiSquareSurvival(3.841458820694124, 1), 0.05, 1e-14);
    EXPECT_NEAR(chiSquareSurvival(10, 2), std::exp(-5.0), 1e-15);
    // critical values of D at 5 % (Massey 1951, to its five digits), within the 1 % that the header promises
    EXPECT_NEAR(kolmogorovSurvival(0.45427, 8), 0.05, 5e-4);
    EXPECT_NEAR(kolmogorovSurvival(0.29408, 20), 0.05, 5e-4);
}

TEST(CoreStatistics, DistributionsAtTheEnds) {
    EXPECT_EQ(studentSurvival(kInfinity, 5), 0);
    EXPECT_EQ(studentSurvival(-kInfinity, 5), 1);
    EXPECT_EQ(chiSquareSurvival(kInfinity, 5), 0);
    EXPECT_EQ(chiSquareSurvival(0, 5), 1);
    EXPECT_TRUE(std::isnan(studentSurvival(kNaN, 5)));
    EXPECT_TRUE(std::isnan(chiSquareSurvival(kNaN, 5)));
    EXPECT_EQ(kolmogorovSurvival(0, 10), 1);
    EXPECT_LT(kolmogorovSurvival(1, 100), 1e-80);
}

TEST(CoreStatistics, Moments) {
    const Moments m = momentsOf(kDrug1);
    EXPECT_NEAR(m.mean, 0.75, 1e-15);
    EXPECT_NEAR(std::sqrt(m.variance), 1.7890096577590, 1e-12);
    EXPECT_NEAR(m.standardError(), 1.7890096577590 / std::sqrt(10.0), 1e-12);
    const Interval i = confidenceInterval(m, 0.95);
    EXPECT_NEAR(i.low, -0.5297804, 1e-7);
    EXPECT_NEAR(i.high, 2.0297804, 1e-7);
    EXPECT_TRUE(i.contains(0));
    EXPECT_FALSE(i.contains(3));

    // a large mean must not swallow a small spread
    const Moments far = momentsOf(std::vector<double>{1e9 + 1, 1e9 + 2, 1e9 + 3});
    EXPECT_DOUBLE_EQ(far.variance, 1);
    EXPECT_TRUE(std::isnan(momentsOf(std::vector<double>{1.0}).variance));
}

TEST(CoreStatistics, StudentAndWelchOnTheSleepData) {
    const TestResult one = studentTest(momentsOf(kDrug1), 0);
    EXPECT_NEAR(one.statistic, 1.325710, 1e-6);
    EXPECT_NEAR(one.pValue, 0.2175978, 1e-7);
    const TestResult two = welchTest(momentsOf(kDrug1), momentsOf(kDrug2));
    EXPECT_NEAR(two.statistic, -1.860813, 1e-6);
    EXPECT_NEAR(two.degreesOfFreedom, 17.77647, 1e-5);
    EXPECT_NEAR(two.pValue, 0.07939414, 1e-8);
    EXPECT_NEAR(zTest(3, 1, 2).pValue, 0.3173105, 1e-7);
}

TEST(CoreStatistics, TestsWithoutSpreadDecideExactly) {
    const Moments same = momentsOf(std::vector<double>{2, 2, 2, 2});
    EXPECT_EQ(studentTest(same, 2).pValue, 1);
    EXPECT_EQ(studentTest(same, 2.001).pValue, 0);
    EXPECT_EQ(studentTest(same, 2.001, 0.01).pValue, 1);
    EXPECT_EQ(studentTest(same, 2.1, 0.01).pValue, 0);
    EXPECT_EQ(welchTest(same, same).pValue, 1);
    EXPECT_EQ(welchTest(same, momentsOf(std::vector<double>{3, 3})).pValue, 0);
    EXPECT_EQ(equivalenceTest(same, 2.001, 0.01).pValue, 0);
    EXPECT_EQ(equivalenceTest(same, 2.1, 0.01).pValue, 1);
    EXPECT_EQ(equivalenceTest(same, 2.5, 0.5).pValue, 0.5);  // exactly at the margin: undecided
}

TEST(CoreStatistics, NotANumberIsNeverAccepted) {
    const Moments broken = momentsOf(std::vector<double>{1, kNaN, 1});
    EXPECT_EQ(studentTest(broken, 1).pValue, 0);
    EXPECT_EQ(studentTest(broken, 1, 10).pValue, 0);
    EXPECT_EQ(welchTest(broken, momentsOf(kDrug1)).pValue, 0);
    EXPECT_EQ(zTest(kNaN, 0, 1).pValue, 0);
    EXPECT_EQ(equivalenceTest(broken, 1, 10).pValue, 1);
    EXPECT_EQ(uniformityTest(std::vector<double>{0.5, kNaN}).pValue, 0);
    EXPECT_EQ(chiSquareTest(std::vector<double>{kNaN, 10}, std::vector<double>{10, 10}).pValue, 0);
}

TEST(CoreStatistics, EquivalenceNeedsPrecisionNotOnlyAgreement) {
    const Moments coarse{16, 1.0, 0.16}, fine{16, 1.0, 1e-6};
    EXPECT_GT(studentTest(coarse, 1).pValue, 0.99);
    EXPECT_GT(equivalenceTest(coarse, 1, 0.001).pValue, 0.4);
    EXPECT_LT(equivalenceTest(fine, 1, 0.001).pValue, 0.001);
    // by hand: t = (0.001 - 0.0005) / (0.001 / 4) = 2 with 15 degrees of freedom
    EXPECT_NEAR(equivalenceTest(fine, 1.0005, 0.001).pValue, studentSurvival(2, 15), 1e-9);
}

TEST(CoreStatistics, ChiSquare) {
    // Mendel's peas, 9:3:3:1
    const std::vector<double> peas{315, 101, 108, 32}, ratio{312.75, 104.25, 104.25, 34.75};
    const TestResult mendel = chiSquareTest(peas, ratio);
    EXPECT_NEAR(mendel.statistic, 0.470024, 1e-6);
    EXPECT_EQ(mendel.degreesOfFreedom, 3);
    EXPECT_NEAR(mendel.pValue, 0.9254259, 1e-7);
    EXPECT_EQ(chiSquareTest(peas, ratio, 5, 1).degreesOfFreedom, 2);

    // 2 + 3 pool into one cell of 5; statistic (7-5)^2/5 + (48-50)^2/50
    const TestResult pooled = chiSquareTest(std::vector<double>{3, 48, 4}, std::vector<double>{2, 50, 3});
    EXPECT_EQ(pooled.degreesOfFreedom, 1);
    EXPECT_NEAR(pooled.statistic, 0.8 + 0.08, 1e-12);
    // 1 + 4 make a cell; the other 4 is a remainder that joins it, and one cell alone says nothing
    EXPECT_EQ(chiSquareTest(std::vector<double>{4, 4, 1}, std::vector<double>{4, 4, 1}).pValue, 1);
    // all too small together: nothing to test
    EXPECT_EQ(chiSquareTest(std::vector<double>{1, 0}, std::vector<double>{1, 1}).pValue, 1);
    // a sample where none may fall
    EXPECT_EQ(chiSquareTest(std::vector<double>{1, 99, 100}, std::vector<double>{0, 100, 100}).pValue, 0);
    EXPECT_EQ(chiSquareTest(std::vector<double>{0, 100, 100}, std::vector<double>{0, 100, 100}).pValue, 1);
}

TEST(CoreStatistics, HolmAndSidak) {
    const std::vector<double> adjusted = holmAdjusted(std::vector<double>{0.01, 0.04, 0.03, 0.005});
    const std::vector<double> known{0.03, 0.06, 0.06, 0.02};
    for (std::size_t i = 0; i < known.size(); ++i)
        EXPECT_NEAR(adjusted[i], known[i], 1e-15);
    EXPECT_EQ(holmAdjusted(std::vector<double>{0.9, 0.8})[0], 1);
    EXPECT_TRUE(holmAdjusted({}).empty());
    EXPECT_NEAR(sidakLevel(0.05, 10), 0.005116196891823743, 1e-15);
    EXPECT_NEAR(sidakLevel(1e-3, 1000000) * 1e9 / 1.000500333583622, 1, 1e-9);
}

// 400 repetitions each; every uniformity bar below fails a right implementation with probability 1e-4.
TEST(CoreStatistics, PValuesOfTrueHypothesesAreUniform) {
    std::mt19937_64 generator(20240501);
    std::vector<double> student, welch, chiSquare, uniformity;
    for (int repetition = 0; repetition < 400; ++repetition) {
        const Moments a = momentsOf(normals(generator, 8, 3, 2)), b = momentsOf(normals(generator, 20, 3, 0.5));
        student.push_back(studentTest(a, 3).pValue);
        welch.push_back(welchTest(a, b).pValue);

        std::vector<double> counts(10, 0.0), values(1000);
        for (double& v : values) {
            v = uniform(generator);
            ++counts[static_cast<std::size_t>(10 * v)];
        }
        chiSquare.push_back(chiSquareTest(counts, std::vector<double>(10, 100.0)).pValue);
        uniformity.push_back(uniformityTest(values).pValue);
    }
    EXPECT_GT(uniformityTest(student).pValue, 1e-4);
    EXPECT_GT(uniformityTest(welch).pValue, 1e-4);
    EXPECT_GT(uniformityTest(chiSquare).pValue, 1e-4);
    EXPECT_GT(uniformityTest(uniformity).pValue, 1e-4);
}

TEST(CoreStatistics, WrongHypothesesAreRejected) {
    std::mt19937_64 generator(7);
    EXPECT_LT(studentTest(momentsOf(normals(generator, 64, 1.01, 0.01)), 1).pValue, 1e-6);
    std::vector<double> squares(400);
    for (double& v : squares)
        v = std::pow(uniform(generator), 1.5);
    EXPECT_LT(uniformityTest(squares).pValue, 1e-6);
    EXPECT_LT(chiSquareTest(std::vector<double>{150, 90, 60}, std::vector<double>{100, 100, 100}).pValue, 1e-6);
}

}  // namespace
}  // namespace penumbra
