// bilerp: bilinear between four values at the corners of the unit square of (s, t), and beyond it the same function: it
// is not clamped.
#pragma once

#include "core/image/texture_mapping.h"
#include "core/image/texture_plugin.h"

namespace penumbra {

struct BilerpTexture {
    static constexpr auto kParameters = TextureMapping::parameters({
        {"spectrum or float", "v00", "0", "the value at s = 0, t = 0"},
        {"spectrum or float", "v01", "1", "the value at s = 0, t = 1"},
        {"spectrum or float", "v10", "0", "the value at s = 1, t = 0"},
        {"spectrum or float", "v11", "1", "the value at s = 1, t = 1"},
    });
    static constexpr PluginInfo kInfo{"bilerp", "bilinear between four values", kParameters};

    static TextureOperand make(TextureInput& input, TextureTables& tables) {
        BilerpTexture t;
        t.mapping = TextureMapping::make(input);
        t.v00 = input.value("v00", 0.f);
        t.v01 = input.value("v01", 1.f);
        t.v10 = input.value("v10", 0.f);
        t.v11 = input.value("v11", 1.f);
        return tables.append(t, {t.v00, t.v01, t.v10, t.v11}, input);
    }

    template <class V, class F>
    V evaluate(const TextureContext<F>& at, const TextureTables& tables) const {
        const MappedPoint<F> m = mapping.map(at);
        const V low = tables.blend<V>(v00, v10, m.s, at), high = tables.blend<V>(v01, v11, m.s, at);
        return low + (high - low) * m.t;
    }

    TextureMapping mapping;
    TextureOperand v00, v01, v10, v11;
};

}  // namespace penumbra
