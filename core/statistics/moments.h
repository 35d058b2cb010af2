// Mean and variance of independent values (replicates, repeated runs), and what they say about the true mean.
//
// Conventions: `variance` is that of one value, unbiased (divided by n - 1); standardError() is that of the mean.
// The values must be independent: the samples of one low-discrepancy pixel are not (their naive standard error is up to
// 170 times too large), its replicates are.
//
// Thread safety: pure functions and plain values.
#pragma once

#include <cstddef>
#include <span>

namespace penumbra {

struct Moments {
    std::size_t count = 0;
    double mean = 0;
    double variance = 0;  ///< NaN for fewer than two values

    double standardError() const;
    double degreesOfFreedom() const { return static_cast<double>(count) - 1; }
};

/// Two passes with the rounding of the mean corrected (Chan, Golub, LeVeque 1983, eq. 1.7).
Moments momentsOf(std::span<const double> values);

struct Interval {
    double low = 0, high = 0;
    double halfWidth() const { return 0.5 * (high - low); }
    bool contains(double x) const { return low <= x && x <= high; }
};

/// Student's two-sided interval for the true mean. REQUIRES: count >= 2, confidence in (0, 1).
Interval confidenceInterval(const Moments& moments, double confidence);

}  // namespace penumbra
