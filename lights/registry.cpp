#include "lights/registry.h"

#include <algorithm>

namespace penumbra {

std::vector<PluginInfo> lightPlugins() {
    std::vector<PluginInfo> result;
    forEachType(LightTypes{}, [&]<class T>() {
        const auto same = [](const PluginInfo& info) { return info.name == T::kInfo.name; };
        if (std::none_of(result.begin(), result.end(), same)) result.push_back(T::kInfo);
    });
    return result;
}

}  // namespace penumbra
