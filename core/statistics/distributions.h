// Tail probabilities and quantiles of the distributions that the tests of this folder compare with.
//
// Conventions: "survival" is P(X > x), computed directly, so that small p-values keep their digits. Arguments may be
// infinite; a NaN gives NaN. Quantiles take probabilities in (0, 1).
//
// Thread safety: pure functions.
#pragma once

#include <cstddef>

namespace penumbra {

double normalSurvival(double z);
double normalQuantile(double probability);

/// Student's t with a real number of degrees of freedom > 0 (Welch's test needs fractions).
double studentSurvival(double t, double degreesOfFreedom);
double studentQuantile(double probability, double degreesOfFreedom);

double chiSquareSurvival(double x, double degreesOfFreedom);

/// P(D_n > distance) of the two-sided Kolmogorov statistic of n values, by the asymptotic series with Stephens'
/// correction for finite n (Stephens 1970: good to about 1 % of p for n >= 8).
double kolmogorovSurvival(double distance, std::size_t n);

}  // namespace penumbra
