#include "materials/registry.h"

#include <algorithm>

namespace penumbra {

std::vector<PluginInfo> materialPlugins() {
    std::vector<PluginInfo> result;
    forEachType(MaterialTypes{}, [&]<Material M>() { result.push_back(M::kInfo); });
    result.push_back(MixMaterial::kInfo);
    return result;
}

void MaterialTable::finish() {
    for (std::size_t i = 0; i < mixMembers_.size(); ++i) {
        mixes_[i].first = id(mixMembers_[i][0]);
        mixes_[i].second = id(mixMembers_[i][1]);
    }
    mixMembers_ = {};
    if (!given_.empty()) reliefs_.resize(size());
    for (const auto& [handle, relief] : given_) {
        reliefs_[id(handle)] = relief;
        hasRelief_[handle.tag] = true;
    }
    given_ = {};
    mixesAreTextured_ =
        std::any_of(mixes_.begin(), mixes_.end(), [](const MixMaterial& m) { return m.amount.texture != kNoTexture; });
}

}  // namespace penumbra
