// What a sampler gets when it is made, and what it answers.
#pragma once

#include "core/base/parameters.h"

namespace penumbra {

struct SamplerInput {
    const ParameterSet& parameters;      ///< of the scene's Sampler directive; empty where the command line chose another type
    int samplesOverride = 0;             ///< --spp; 0: as the scene says
    int samplesPerPixel = 0;             ///< answer: what the sampler will deliver

    int countOr(int fromScene) const {
        const int n = samplesOverride > 0 ? samplesOverride : fromScene;
        return n > 0 ? n : 1;
    }
};

}  // namespace penumbra
