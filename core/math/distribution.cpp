#include "core/math/distribution.h"

#include <bit>
#include <cmath>

namespace penumbra {
namespace {

constexpr double kSteps = 0x1p24;

double usable(double weight) {
    return std::isfinite(weight) && weight > 0 ? weight : 0;
}

}  // namespace

std::uint32_t searchStride(std::size_t cells) {
    return std::uint32_t(std::bit_ceil(cells) / 2);
}

void appendCumulative(std::span<const double> weights, std::vector<float>& table) {
    double total = 0, positive = 0;
    for (const double w : weights) {
        total += usable(w);
        positive += usable(w) > 0;
    }
    const bool flat = !(total > 0) || !std::isfinite(total);
    if (flat) {
        total = positive = double(weights.size());
    }
    // Each positive cell has one step of its own; the others are dealt out by rounding the running sum, so that no
    // error accumulates and a cell of weight zero gets none.
    const double shared = kSteps - positive;
    double sum = 0, own = 0;
    table.reserve(table.size() + weights.size() + 1);
    table.push_back(0.f);
    for (const double weight : weights) {
        const double w = flat ? 1 : usable(weight);
        sum += w;
        own += w > 0;
        table.push_back(float((own + std::nearbyint(shared * std::fmin(sum / total, 1))) / kSteps));
    }
    // Trailing cells of weight zero share the last value, and it is 1 whatever the rounding of the sum.
    for (std::size_t i = table.size(); i-- > 0 && table[i] == table.back() && table[i] != 1.f;)
        table[i] = 1.f;
}

void appendCumulativeGrid(std::span<const float> weights, std::size_t width, std::size_t height,
                          std::vector<float>& table) {
    std::vector<double> cells(width), rows(height, 0.0);
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x)
            rows[y] += usable(weights[y * width + x]);
    }
    table.reserve(table.size() + (height + 1) + height * (width + 1));
    appendCumulative(rows, table);
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x)
            cells[x] = weights[y * width + x];
        appendCumulative(cells, table);
    }
}

}  // namespace penumbra
