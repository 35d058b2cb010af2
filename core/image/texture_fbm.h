// fbm: fractional Brownian motion, a sum of octaves of noise in the texture's space; its values lie on both sides of 0.
#pragma once

#include "core/image/texture_octaves.h"

namespace penumbra {

struct FbmTexture {
    static constexpr PluginInfo kInfo{"fbm", "a sum of octaves of noise (float)", kOctaveParameters};

    static TextureOperand make(TextureInput& input, TextureTables& tables) {
        requireKind(input, TextureKind::Float, kInfo.name);
        return tables.append(FbmTexture{TextureSpace::make(input), readOctaves(input)}, {}, input);
    }

    template <class F>
    F evaluate(const TextureContext<F>& at, const TextureTables&) const {
        return brownianNoise(space.point(at), space.footprint(at), octaves);
    }

    TextureSpace space;
    Octaves octaves;
};

}  // namespace penumbra
