#include "samplers/registry.h"

namespace penumbra {

const PluginInfo& Sampler::info() const {
    return dispatch(SamplerTypes{}, tag_, []<class T>() -> const PluginInfo& { return T::kInfo; });
}

bool makeSampler(std::string_view name, SamplerInput& input, Sampler& out) {
    bool found = false;
    forEachType(SamplerTypes{}, [&]<class T>() {
        if (T::kInfo.name == name) {
            out = T::make(input);
            found = true;
        }
    });
    return found;
}

}  // namespace penumbra
