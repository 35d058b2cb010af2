// wrinkled: a sum of the absolute values of octaves of noise in the texture's space, with creases where they are 0.
//
// An octave that the footprint covers counts as 0.2, about its mean. (pbrt counts the first of them twice, which makes
// a step of that size where one more is covered. Here there is none.)
#pragma once

#include "core/image/texture_octaves.h"

namespace penumbra {

struct WrinkledTexture {
    static constexpr PluginInfo kInfo{"wrinkled", "a sum of octaves of creased noise (float)", kOctaveParameters};

    static TextureOperand make(TextureInput& input, TextureTables& tables) {
        requireKind(input, TextureKind::Float, kInfo.name);
        return tables.append(WrinkledTexture{TextureSpace::make(input), readOctaves(input)}, {}, input);
    }

    template <class F>
    F evaluate(const TextureContext<F>& at, const TextureTables&) const {
        return turbulentNoise(space.point(at), space.footprint(at), octaves);
    }

    TextureSpace space;
    Octaves octaves;
};

}  // namespace penumbra
