#include "core/statistics/distributions.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double normalSurvival(double z) {
    return 0.5 * std::erfc(z / std::sqrt(2.0));
}

double normalQuantile(double probability) {
    return boost::math::quantile(boost::math::normal_distribution<double>(), probability);
}

double studentSurvival(double t, double degreesOfFreedom) {
    if (std::isnan(t) || !(degreesOfFreedom > 0)) return kNaN;
    if (std::isinf(t)) return t > 0 ? 0.0 : 1.0;
    return boost::math::cdf(complement(boost::math::students_t_distribution<double>(degreesOfFreedom), t));
}

double studentQuantile(double probability, double degreesOfFreedom) {
    return boost::math::quantile(boost::math::students_t_distribution<double>(degreesOfFreedom), probability);
}

double chiSquareSurvival(double x, double degreesOfFreedom) {
    if (std::isnan(x) || !(degreesOfFreedom > 0)) return kNaN;
    if (x <= 0) return 1.0;
    if (std::isinf(x)) return 0.0;
    return boost::math::cdf(complement(boost::math::chi_squared_distribution<double>(degreesOfFreedom), x));
}

double kolmogorovSurvival(double distance, std::size_t n) {
    const double root = std::sqrt(static_cast<double>(n));
    const double lambda = (root + 0.12 + 0.11 / root) * distance;
    if (std::isnan(lambda)) return kNaN;
    if (lambda < 0.2)
        return 1.0;  // the true value differs from 1 by less than 1e-12; the series converges slowly there
    double sum = 0, sign = 1;
    for (int k = 1; k <= 100; ++k) {
        const double term = std::exp(-2.0 * k * k * lambda * lambda);
        sum += sign * term;
        if (term < 1e-17) break;
        sign = -sign;
    }
    return std::clamp(2 * sum, 0.0, 1.0);
}

}  // namespace penumbra
