#include "lights/light_sampler.h"

#include <algorithm>
#include <limits>

namespace penumbra {

LightSelection lightSelectionFromName(std::string_view name) {
    if (name == "uniform") return LightSelection::Uniform;
    if (name == "power") return LightSelection::Power;
    throw Error(ErrorKind::Usage, "unknown light sampler " + quote(name) + "; known: power, uniform");
}

LightSampler::LightSampler(LightSelection selection, const LightTable& lights, bool includeUniformInfinite) {
    if (lights.size() > kMaxCells) throw Error(ErrorKind::BadData, "more than 2^22 lights");
    std::vector<double> weights(lights.size());
    for (std::uint32_t id = 0; id < lights.size(); ++id) {
        const bool left = !includeUniformInfinite && lights.isA<ConstantInfiniteLight>(id);
        // Beyond floats is the largest: weights that are not finite would count as 0.
        const float power = left ? 0.f : std::min(lights.power(id), std::numeric_limits<float>::max());
        weights[id] = selection == LightSelection::Uniform ? double(power > 0.f) : double(power);
    }
    const auto positive = [](double w) { return w > 0; };
    const auto usable = std::count_if(weights.begin(), weights.end(), positive);
    if (usable == 0) return;
    lights_ = lights.size();
    stride_ = searchStride(weights.size());
    if (usable == 1) only_ = std::find_if(weights.begin(), weights.end(), positive) - weights.begin();
    appendCumulative(weights, table_);
}

}  // namespace penumbra
