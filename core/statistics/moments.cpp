#include "core/statistics/moments.h"

#include "core/statistics/distributions.h"

#include <cmath>
#include <limits>

namespace penumbra {

double Moments::standardError() const {
    return std::sqrt(variance / static_cast<double>(count));
}

Moments momentsOf(std::span<const double> values) {
    Moments result;
    result.count = values.size();
    const double n = static_cast<double>(values.size());
    double sum = 0;
    for (const double v : values)
        sum += v;
    result.mean = values.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / n;

    double squares = 0, rest = 0;
    for (const double v : values) {
        const double d = v - result.mean;
        squares += d * d;
        rest += d;
    }
    result.variance =
        values.size() < 2 ? std::numeric_limits<double>::quiet_NaN() : (squares - rest * rest / n) / (n - 1);
    return result;
}

Interval confidenceInterval(const Moments& moments, double confidence) {
    const double t = studentQuantile(0.5 + 0.5 * confidence, moments.degreesOfFreedom());
    const double half = t * moments.standardError();
    return {moments.mean - half, moments.mean + half};
}

}  // namespace penumbra
