#include "samplers/registry.h"

namespace penumbra {

const PluginInfo& Sampler::info() const {
    const PluginInfo* found = nullptr;
    dispatch(SamplerTypes{}, tag_, [&]<class T>() { found = &T::kInfo; });
    return *found;
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
