#include "core/statistics/multiple_comparisons.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace penumbra {

std::vector<double> holmAdjusted(std::span<const double> pValues) {
    std::vector<std::size_t> order(pValues.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return pValues[a] < pValues[b]; });

    std::vector<double> adjusted(pValues.size());
    double largest = 0;
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        const double remaining = static_cast<double>(order.size() - rank);
        largest = std::max(largest, std::min(1.0, remaining * pValues[order[rank]]));
        adjusted[order[rank]] = largest;
    }
    return adjusted;
}

double sidakLevel(double alpha, std::size_t tests) {
    // 1 - (1 - alpha)^(1/m) without cancellation
    return -std::expm1(std::log1p(-alpha) / static_cast<double>(tests));
}

}  // namespace penumbra
