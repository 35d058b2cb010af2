#include "lights/light_sampler.h"

#include <algorithm>
#include <limits>

namespace penumbra {

LightSampler::LightSampler(LightSelection selection, const LightTable& lights, bool includeUniformInfinite) {
    if (lights.size() > kMaxCells) throw Error(ErrorKind::BadData, "more than 2^22 lights");
    std::vector<double> powers(lights.size());
    for (std::uint32_t id = 0; id < lights.size(); ++id) {
        const bool left = !includeUniformInfinite && lights.isA<ConstantInfiniteLight>(id);
        // Beyond floats is the largest: weights that are not finite would count as 0.
        powers[id] = left ? 0. : double(std::min(lights.power(id), std::numeric_limits<float>::max()));
    }
    const auto positive = [](double w) { return w > 0; };
    const auto usable = std::count_if(powers.begin(), powers.end(), positive);
    if (usable == 0) return;
    if (usable == 1) only_ = std::find_if(powers.begin(), powers.end(), positive) - powers.begin();
    if (selection == LightSelection::Bvh && usable > 1) buildTree(lights, powers);
    if (isByPlace()) return;
    if (selection == LightSelection::Uniform)
        for (double& power : powers)
            power = double(power > 0);
    buildTable(powers);
}

void LightSampler::buildTable(const std::vector<double>& weights) {
    cells_ = std::uint32_t(weights.size());
    stride_ = searchStride(weights.size());
    appendCumulative(weights, table_);
}

void LightSampler::buildTree(const LightTable& lights, const std::vector<double>& powers) {
    std::vector<LightBounds> bounds;  // with millions of lights the largest thing there is, so it must not grow by doubling
    bounds.reserve(lights.size());
    std::vector<std::uint32_t> placed;
    std::vector<double> weights = {0};
    lightOf_ = {0};
    double besides = 0;
    for (std::uint32_t id = 0; id < lights.size(); ++id) {
        if (!(powers[id] > 0)) continue;
        if (const std::optional<LightBounds> b = lights.bounds(id)) {
            bounds.push_back(*b);
            placed.push_back(id);
        } else {
            lightOf_.push_back(id);
            weights.push_back(powers[id]);
            besides += powers[id];
        }
    }
    if (placed.empty()) {
        lightOf_.clear();
        return;
    }
    // The tree counts as one light beside the others, but has at least two units a light.
    const double count = double(weights.size() - 1);
    for (double& w : weights)
        w *= count / std::max(besides, std::numeric_limits<double>::min());
    weights[0] = 1;
    const double least = 2 * double(placed.size()) / LightTree::kUnits;
    if (least * (count + 1) > 1) weights[0] = count * least / (1 - least);
    buildTable(weights);
    cellOf_.assign(lights.size(), 0);
    for (std::uint32_t cell = 1; cell < lightOf_.size(); ++cell)
        cellOf_[lightOf_[cell]] = cell;
    tree_ = LightTree(bounds, placed, lights.size(), std::uint32_t(table_[1] * float(LightTree::kUnits)));
}

}  // namespace penumbra
