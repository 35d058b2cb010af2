#include "tests/proof/closed_form.h"

#include "core/statistics/distributions.h"
#include "core/statistics/hypothesis_tests.h"
#include "core/statistics/multiple_comparisons.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra {

namespace {

ClosedFormVerdict exactVerdict(const ClosedFormMeasurement& m) {
    const bool accepted = m.worst <= kArithmeticTolerance;  // false for NaN
    return {m, accepted ? 1.0 : 0.0, accepted};
}

double largestDeviation(std::span<const double> values, double expected) {
    double worst = 0;
    for (const double v : values) {
        const double d = std::abs(v / expected - 1);
        if (std::isnan(d)) return d;
        worst = std::max(worst, d);
    }
    return worst;
}

}  // namespace

double ClosedFormMeasurement::deviation() const {
    return replicates.mean / expected - 1;
}

double ClosedFormMeasurement::halfWidth(double confidence) const {
    return confidenceInterval(replicates, confidence).halfWidth() / expected;
}

std::vector<ClosedFormMeasurement> measureClosedForm(const AnalyticScene& scene, const PictureMean& render,
                                                     int samplesPerPixel, int replicates, std::uint32_t firstSeed) {
    std::array<std::vector<double>, 3> means;
    for (int r = 0; r < replicates; ++r) {
        const std::array<double, 3> mean = render(scene, samplesPerPixel, firstSeed + static_cast<std::uint32_t>(r));
        for (std::size_t c = 0; c < 3; ++c)
            means[c].push_back(mean[c]);
    }
    std::vector<ClosedFormMeasurement> measurements;
    for (std::size_t c = 0; c < 3; ++c) {
        const auto sameAs = [&](std::size_t k) {
            return scene.expected[k] == scene.expected[c] && means[k] == means[c];
        };
        if ((c > 0 && sameAs(0)) || (c > 1 && sameAs(1))) continue;
        measurements.push_back({scene.id, static_cast<int>(c), scene.exact, scene.expected[c], momentsOf(means[c]),
                                largestDeviation(means[c], scene.expected[c])});
    }
    return measurements;
}

std::vector<ClosedFormVerdict> judgeDifference(std::span<const ClosedFormMeasurement> measurements, double alpha) {
    std::vector<ClosedFormVerdict> verdicts;
    std::vector<double> pValues;
    std::vector<std::size_t> tested;
    for (const ClosedFormMeasurement& m : measurements) {
        verdicts.push_back(exactVerdict(m));
        if (m.exact) continue;
        tested.push_back(verdicts.size() - 1);
        pValues.push_back(studentTest(m.replicates, m.expected, kArithmeticTolerance * std::abs(m.expected)).pValue);
    }
    const std::vector<double> adjusted = holmAdjusted(pValues);
    for (std::size_t i = 0; i < tested.size(); ++i) {
        verdicts[tested[i]].pValue = adjusted[i];
        verdicts[tested[i]].accepted = adjusted[i] > alpha;
    }
    return verdicts;
}

std::vector<ClosedFormVerdict> judgeEquivalence(std::span<const ClosedFormMeasurement> measurements,
                                                const std::function<double(const ClosedFormMeasurement&)>& margin,
                                                double alpha) {
    std::vector<ClosedFormVerdict> verdicts;
    for (const ClosedFormMeasurement& m : measurements) {
        if (m.exact) {
            verdicts.push_back(exactVerdict(m));
            continue;
        }
        const double p = equivalenceTest(m.replicates, m.expected, margin(m) * std::abs(m.expected)).pValue;
        verdicts.push_back({m, p, p <= alpha});
    }
    return verdicts;
}

std::string closedFormTable(std::span<const ClosedFormVerdict> verdicts) {
    std::string text = fmt::format("{:<26} {} {:>13} {:>13} {:>10} {:>9} {:>9}\n", "scene", "c", "expected", "measured",
                                   "deviation", "+-99.9%", "p");
    for (const ClosedFormVerdict& v : verdicts) {
        const ClosedFormMeasurement& m = v.measurement;
        text += fmt::format("{:<26} {} {:>13.8g} {:>13.8g} {:>9.4f}% {:>8.4f}% {:>9.2g}{}\n", m.id, "RGB"[m.channel],
                            m.expected, m.replicates.mean, 100 * m.deviation(), 100 * m.halfWidth(), v.pValue,
                            v.accepted ? "" : "  <--");
    }
    return text;
}

}  // namespace penumbra
