// windy: waves on water: six octaves of noise in the texture's space, whose height follows a second noise of ten times
// the size, the strength of the wind.
#pragma once

#include "core/image/texture_octaves.h"

namespace penumbra {

struct WindyTexture {
    static constexpr PluginInfo kInfo{"windy", "waves whose height varies with the wind (float)", {}};

    static TextureOperand make(TextureInput& input, TextureTables& tables) {
        requireKind(input, TextureKind::Float, kInfo.name);
        return tables.append(WindyTexture{TextureSpace::make(input)}, {}, input);
    }

    template <class F>
    F evaluate(const TextureContext<F>& at, const TextureTables&) const {
        const Vec3<F> p = space.point(at);
        const F width = space.footprint(at), slow(0.1f);
        const F wind = brownianNoise(p * slow, width * slow, {3, 0.5f});
        return abs(wind) * brownianNoise(p, width, {6, 0.5f});
    }

    TextureSpace space;
};

}  // namespace penumbra
