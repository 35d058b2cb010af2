// Hypothesis tests: Student, Welch, z, chi-square, Kolmogorov-Smirnov, and equivalence by two one-sided tests.
//
// Conventions: a small p-value speaks against the hypothesis that the function's comment names. For the difference
// tests that hypothesis is "equal", so they can only find a bias; equivalenceTest's hypothesis is "different by the
// margin or more", so a small p proves closeness. NaN input gives p = 0 in the former (never silently accepted) and p =
// 1 in the latter.
//
// Thread safety: pure functions.
#pragma once

#include "core/statistics/moments.h"

#include <span>

namespace penumbra {

struct TestResult {
    double statistic = 0;
    double degreesOfFreedom = 0;  ///< 0 where the reference distribution has none
    double pValue = 1;
};

/// Hypothesis: the true mean is within `tolerance` of `expected` (two-sided; with tolerance 0, Student's test).
/// A tolerance > 0 allows for known rounding; the test is then conservative. No spread at all: p is 1 inside, 0
/// outside.
TestResult studentTest(const Moments& sample, double expected, double tolerance = 0);

/// Hypothesis: equal true means; variances may differ (Welch 1947).
TestResult welchTest(const Moments& a, const Moments& b);

/// Hypothesis: `value`, normal with the given standard deviation, has the mean `expected` (two-sided).
TestResult zTest(double value, double expected, double standardDeviation);

/// Hypothesis: the true mean differs from `expected` by `margin` or more (Schuirmann 1987: two one-sided Student tests;
/// p is the larger of the two). Accepting equivalence at p < alpha is wrong with probability at most alpha.
TestResult equivalenceTest(const Moments& sample, double expected, double margin);

/// Hypothesis: the counts are multinomial with these expectations. Cells expecting fewer than `smallest` are pooled, in
/// ascending order of their expectations, into cells that expect at least that much; a last remainder joins the
/// smallest other cell. A count where nothing is expected gives p = 0. `fitted` = parameters estimated from the same
/// counts. REQUIRES: equal sizes, expectations >= 0; their sum need not equal that of the counts exactly, but ought to
/// be close.
TestResult chiSquareTest(std::span<const double> observed, std::span<const double> expected, double smallest = 5,
                         int fitted = 0);

/// Hypothesis: the values are independent and uniform on [0, 1] (Kolmogorov-Smirnov, two-sided).
TestResult uniformityTest(std::span<const double> values);

}  // namespace penumbra
