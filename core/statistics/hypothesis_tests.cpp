#include "core/statistics/hypothesis_tests.h"

#include "core/statistics/distributions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace penumbra {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The distance in standard errors; a distance without spread is infinitely many, none is none.
double inStandardErrors(double distance, double standardError) {
    if (distance == 0) return 0;
    return standardError == 0 ? std::copysign(kInfinity, distance) : distance / standardError;
}

double orZero(double p) {
    return std::isnan(p) ? 0.0 : p;
}

struct Cell {
    double observed = 0, expected = 0;
};

/// Cells that all expect at least `smallest` (but for a single cell, where all of them together expect less).
std::vector<Cell> pooled(std::vector<Cell> cells, double smallest) {
    std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.expected < b.expected; });
    std::vector<Cell> result;
    Cell pool;
    for (const Cell& c : cells) {
        pool.observed += c.observed;
        pool.expected += c.expected;
        if (pool.expected >= smallest) {
            result.push_back(pool);
            pool = {};
        }
    }
    if (pool.expected == 0) return result;
    if (result.empty()) return {pool};
    Cell& least = *std::min_element(result.begin(), result.end(),
                                    [](const Cell& a, const Cell& b) { return a.expected < b.expected; });
    least.observed += pool.observed;
    least.expected += pool.expected;
    return result;
}

}  // namespace

TestResult studentTest(const Moments& sample, double expected, double tolerance) {
    const double gap = sample.mean - expected;
    const double beyond = std::copysign(std::max(0.0, std::abs(gap) - tolerance), gap);
    const double t = std::isnan(gap) ? gap : inStandardErrors(beyond, sample.standardError());
    const double dof = sample.degreesOfFreedom();
    return {t, dof, orZero(2 * studentSurvival(std::abs(t), dof))};
}

TestResult welchTest(const Moments& a, const Moments& b) {
    const double va = a.variance / static_cast<double>(a.count), vb = b.variance / static_cast<double>(b.count);
    const double t = inStandardErrors(a.mean - b.mean, std::sqrt(va + vb));
    if (va + vb == 0) return {t, a.degreesOfFreedom() + b.degreesOfFreedom(), t == 0 ? 1.0 : 0.0};
    const double dof = (va + vb) * (va + vb) / (va * va / a.degreesOfFreedom() + vb * vb / b.degreesOfFreedom());
    return {t, dof, orZero(2 * studentSurvival(std::abs(t), dof))};
}

TestResult zTest(double value, double expected, double standardDeviation) {
    const double z = inStandardErrors(value - expected, standardDeviation);
    return {z, 0, orZero(2 * normalSurvival(std::abs(z)))};
}

TestResult equivalenceTest(const Moments& sample, double expected, double margin) {
    const double gap = sample.mean - expected, error = sample.standardError(), dof = sample.degreesOfFreedom();
    const double t = std::min(inStandardErrors(gap + margin, error), inStandardErrors(margin - gap, error));
    const double p = studentSurvival(t, dof);
    return {t, dof, std::isnan(p) || std::isnan(gap) ? 1.0 : p};
}

TestResult chiSquareTest(std::span<const double> observed, std::span<const double> expected, double smallest,
                         int fitted) {
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < observed.size(); ++i) {
        if (!(expected[i] >= 0) || std::isnan(observed[i]) || (expected[i] == 0 && observed[i] != 0))
            return {kInfinity, static_cast<double>(observed.size()) - 1, 0};
        cells.push_back({observed[i], expected[i]});
    }
    cells = pooled(std::move(cells), smallest);
    const double dof = static_cast<double>(cells.size()) - 1 - fitted;
    if (dof < 1) return {0, 0, 1};
    const double statistic = std::accumulate(cells.begin(), cells.end(), 0.0, [](double sum, const Cell& c) {
        const double d = c.observed - c.expected;
        return sum + d * d / c.expected;
    });
    return {statistic, dof, orZero(chiSquareSurvival(statistic, dof))};
}

TestResult uniformityTest(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    for (const double v : sorted)
        if (!(v >= 0 && v <= 1)) return {1, 0, 0};
    if (sorted.empty()) return {0, 0, 1};
    std::sort(sorted.begin(), sorted.end());
    const double n = static_cast<double>(sorted.size());
    double distance = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const double below = static_cast<double>(i) / n, above = static_cast<double>(i + 1) / n;
        distance = std::max({distance, sorted[i] - below, above - sorted[i]});
    }
    return {distance, 0, kolmogorovSurvival(distance, sorted.size())};
}

}  // namespace penumbra
