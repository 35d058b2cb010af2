// constant: the same value everywhere. It becomes a constant of whoever uses it, and costs nothing at a hit.
#pragma once

#include "core/image/texture_plugin.h"

namespace penumbra {

struct ConstantTexture {
    static constexpr ParameterInfo kParameters[] = {
        {"spectrum or float", "value", "1", "the value"},
    };
    static constexpr PluginInfo kInfo{"constant", "the same value everywhere", kParameters};

    static TextureOperand make(TextureInput& input, TextureTables&) { return input.value("value", 1.f); }
};

}  // namespace penumbra
