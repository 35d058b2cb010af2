// mix: a blend of two textures, (1 - amount) tex1 + amount tex2. The amount may be a texture and is not clamped.
#pragma once

#include "core/image/texture_plugin.h"

namespace penumbra {

struct MixTexture {
    static constexpr ParameterInfo kParameters[] = {
        {"spectrum or float texture", "tex1", "0", "the value where amount is 0"},
        {"spectrum or float texture", "tex2", "1", "the value where amount is 1"},
        {"float texture", "amount", "0.5", "the share of tex2"},
    };
    static constexpr PluginInfo kInfo{"mix", "a blend of two textures", kParameters};

    static TextureOperand make(TextureInput& input, TextureTables& tables) {
        const MixTexture t{input.value("tex1", 0.f), input.value("tex2", 1.f), input.scalar("amount", 0.5f)};
        if (t.amount.isConstant()) {
            const float a = t.amount.constant.r;
            if (a == 0.f) return t.first;
            if (a == 1.f) return t.second;
            if (t.first.isConstant() && t.second.isConstant())
                return {t.first.constant + (t.second.constant - t.first.constant) * a, kNoTexture};
        }
        return tables.append(t, {t.first, t.second, t.amount}, input);
    }

    template <class V, class F>
    V evaluate(const TextureContext<F>& at, const TextureTables& tables) const {
        return tables.blend<V>(first, second, tables.value<F>(amount, at), at);
    }

    TextureOperand first, second, amount;
};

}  // namespace penumbra
