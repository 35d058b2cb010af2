// The closed-form suite itself: its expected values, and that its judgement accepts a right renderer and rejects a
// wrong one. A renderer is imitated here by numbers of known mean and noise; seeds are fixed.
#include "tests/proof/closed_form.h"

#include "core/statistics/distributions.h"
#include "core/statistics/hypothesis_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>

namespace penumbra {
namespace {

constexpr double kPi = std::numbers::pi;

const std::vector<AnalyticScene>& scenes() {
    static const std::vector<AnalyticScene> all = analyticScenes();
    return all;
}

/// A renderer that is right up to a factor, with relative noise like a picture of 2^14 samples of deviation 1.
PictureMean imitation(double factor, double noise = 0x1p-7, std::uint32_t run = 0) {
    return [=](const AnalyticScene& scene, int samplesPerPixel, std::uint32_t seed) {
        std::vector<std::uint32_t> words{run, seed};
        words.insert(words.end(), scene.id.begin(), scene.id.end());
        std::seed_seq mix(words.begin(), words.end());
        std::mt19937_64 generator(mix);
        std::array<double, 3> mean{};
        double z = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const bool same = c > 0 && scene.expected[c] == scene.expected[0];
            if (!same) z = normalQuantile((static_cast<double>(generator() >> 12) + 0.5) * 0x1p-52);
            const double error = scene.exact ? 0 : noise * std::sqrt(64. / samplesPerPixel) * z;
            mean[c] = scene.expected[c] * factor * (1 + error);
        }
        return mean;
    };
}

std::vector<ClosedFormMeasurement> measureAll(const PictureMean& render) {
    std::vector<ClosedFormMeasurement> all;
    for (const AnalyticScene& scene : scenes())
        for (const ClosedFormMeasurement& m : measureClosedForm(scene, render, 64, 16, 1))
            all.push_back(m);
    return all;
}

std::size_t accepted(const std::vector<ClosedFormVerdict>& verdicts) {
    return static_cast<std::size_t>(
        std::count_if(verdicts.begin(), verdicts.end(), [](const ClosedFormVerdict& v) { return v.accepted; }));
}

/// What a Lambert receiver of albedo .5 shows, back to irradiance.
double irradiance(double pixel) {
    return 2 * kPi * pixel;
}

// Values that were found by independent numerical routes (quadratures, series, radiosity), not by the scenes' formulas.
TEST(ClosedFormScenes, ValuesMatchIndependentOnes) {
    std::map<std::string, double> value;
    for (const AnalyticScene& s : scenes())
        value[s.id] = s.expected[0];
    const auto near = [&](const std::string& id, double actual, double known) {
        EXPECT_NEAR(actual / known, 1, 2e-9) << id;
    };
    near("A2", value.at("A2 eight bounces"), 0.998046875);
    near("A6", value.at("A6"), 3.813559322);
    near("A7", value.at("A7"), 0.2970297030);
    near("B1", irradiance(value.at("B1")), 0.7853981634);
    near("B2", irradiance(value.at("B2")), 0.1745329252);
    near("B3", irradiance(value.at("B3")), 0.09058607371);
    near("B5", irradiance(value.at("B5")), 0.8683148537);
    near("B6", irradiance(value.at("B6")), 0.2683240463);
    near("B7", irradiance(value.at("B7")), 0.4352098757);
    near("B7b", irradiance(value.at("B7b")), 1.740839503);
    near("B8", irradiance(value.at("B8")), 0.1750941439);
    near("B12", 2 * value.at("B12"), 0.8535533906);
    near("B15", irradiance(value.at("B15")), 0.6801767204);
    near("B19", irradiance(value.at("B19")), 0.5235987756);
    near("B21", irradiance(value.at("B21")), 0.8704197514);
    near("C1", 2 * value.at("C1"), 0.1998248957);
    near("C2", 2 * value.at("C2"), 0.2000437761);
    near("C4", 2 * value.at("C4") * 4 / kPi, 0.3819660113);
    near("C5", 2 * value.at("C5") * 4 / kPi, 0.1464466094);
    near("D3", value.at("D3 gaussian"), 0.6949570004);
    near("D4", value.at("D4 mitchell"), 0.7129448785);
    near("D5", value.at("D5"), 0.8044988905);
    near("D10", value.at("D10") * 4, 0.3926990817);
    near("F2", value.at("F2"), 0.07396449704);
    near("F3", value.at("F3"), 0.9230769231);
    near("F4", value.at("F4"), 0.3391111229);
    near("F8", value.at("F8"), 0.09177795934);
    near("F9", value.at("F9"), 0.5963457597);
    near("F10", value.at("F10"), 0.6328334076);
    near("F11", value.at("F11"), 0.9233716475);
    EXPECT_NEAR(value.at("B9 triangle"), .0965678, 1e-7);
    EXPECT_NEAR(value.at("B9 sinking triangle"), .0446276, 1e-7);
    EXPECT_NEAR(value.at("B9 sinking rectangle"), .0869994, 1e-7);
    EXPECT_NEAR(value.at("F13 0"), .3043, 5e-5);
    EXPECT_NEAR(value.at("F13 75"), .4581, 5e-5);
}

TEST(ClosedFormScenes, AreWellFormed) {
    std::set<std::string> ids;
    for (const AnalyticScene& s : scenes()) {
        EXPECT_TRUE(ids.insert(s.id).second) << s.id << " occurs twice";
        EXPECT_NE(s.text.find("WorldBegin"), std::string::npos) << s.id;
        EXPECT_FALSE(s.claim.empty()) << s.id;
        for (const double e : s.expected)
            EXPECT_TRUE(std::isfinite(e) && e > 0) << s.id;
        for (const AnalyticSceneFile& f : s.files)
            EXPECT_NE(s.text.find("\"" + f.name + "\""), std::string::npos) << s.id;
    }
    EXPECT_GE(ids.size(), 60u);
}

TEST(ClosedFormJudgement, AcceptsARightRenderer) {
    const std::vector<ClosedFormVerdict> verdicts = judgeDifference(measureAll(imitation(1)), 1e-3);
    EXPECT_EQ(accepted(verdicts), verdicts.size()) << closedFormTable(verdicts);
}

// 200 families at alpha 5 %: the number of families with a rejection is binomial with mean <= 10; more than 22 has
// probability 1.5e-4.
TEST(ClosedFormJudgement, KeepsTheFamilysLevel) {
    int rejected = 0;
    std::vector<double> pValues;
    for (std::uint32_t run = 1; run <= 200; ++run) {
        std::vector<ClosedFormMeasurement> measurements;
        for (std::size_t i = 0; i < scenes().size(); i += 8)
            for (const auto& m : measureClosedForm(scenes()[i], imitation(1, 0x1p-7, run), 64, 8, 1))
                measurements.push_back(m);
        const std::vector<ClosedFormVerdict> verdicts = judgeDifference(measurements, 0.05);
        rejected += accepted(verdicts) < verdicts.size();
        pValues.push_back(studentTest(measurements.back().replicates, measurements.back().expected).pValue);
    }
    EXPECT_LE(rejected, 22);
    EXPECT_GT(rejected, 0);  // nor is the test blind: none at all has probability 4e-5
    EXPECT_GT(uniformityTest(pValues).pValue, 1e-4);
}

TEST(ClosedFormJudgement, RejectsABiasOfOnePercentEverywhere) {
    for (const double factor : {0.99, 1.01}) {
        std::vector<ClosedFormMeasurement> fine;
        for (const AnalyticScene& s : scenes())
            for (const auto& m : measureClosedForm(s, imitation(factor, 1e-3), 64, 16, 1))
                fine.push_back(m);
        const std::vector<ClosedFormVerdict> verdicts = judgeDifference(fine, 1e-3);
        EXPECT_EQ(accepted(verdicts), 0u) << closedFormTable(verdicts);
    }
}

TEST(ClosedFormJudgement, EquivalenceIsEarnedByPrecision) {
    const auto margin = [](const ClosedFormMeasurement&) { return 1e-3; };
    const AnalyticScene& scene = scenes().front();
    ASSERT_FALSE(scene.exact);
    const auto judged = [&](double factor, double noise) {
        return judgeEquivalence(measureClosedForm(scene, imitation(factor, noise), 64, 64, 1), margin, 1e-3)[0]
            .accepted;
    };
    EXPECT_TRUE(judged(1, 1e-4));
    EXPECT_FALSE(judged(1, 1e-1));      // right, but not shown to be
    EXPECT_FALSE(judged(1.002, 1e-4));  // wrong
}

TEST(ClosedFormJudgement, ExactScenesForgiveNothing) {
    const auto exact = std::find_if(scenes().begin(), scenes().end(), [](const AnalyticScene& s) { return s.exact; });
    ASSERT_NE(exact, scenes().end());
    const auto judged = [&](const PictureMean& render) {
        return judgeDifference(measureClosedForm(*exact, render, 4, 4, 1), 1e-3)[0].accepted;
    };
    EXPECT_TRUE(judged(imitation(1 + 5e-6)));
    EXPECT_FALSE(judged(imitation(1 + 2e-5)));
    EXPECT_FALSE(judged([&](const AnalyticScene& s, int, std::uint32_t seed) {  // one bad render among good ones
        std::array<double, 3> mean = s.expected;
        if (seed == 3) mean.fill(std::numeric_limits<double>::quiet_NaN());
        return mean;
    }));
}

TEST(ClosedFormJudgement, GreyChannelsCountOnceAndNaNNeverPasses) {
    const AnalyticScene& grey = scenes().front();
    EXPECT_EQ(measureClosedForm(grey, imitation(1), 64, 4, 1).size(), 1u);
    const PictureMean blueBroken = [&](const AnalyticScene& s, int spp, std::uint32_t seed) {
        std::array<double, 3> mean = imitation(1)(s, spp, seed);
        mean[2] = std::numeric_limits<double>::quiet_NaN();
        return mean;
    };
    const std::vector<ClosedFormVerdict> verdicts =
        judgeDifference(measureClosedForm(grey, blueBroken, 64, 4, 1), 1e-3);
    ASSERT_EQ(verdicts.size(), 2u);
    EXPECT_TRUE(verdicts[0].accepted);
    EXPECT_FALSE(verdicts[1].accepted);
}

}  // namespace
}  // namespace penumbra
