// ptex: a texture by faces of a mesh, from a file of Walt Disney Animation Studios' Ptex. Penumbra does not read such
// files; a grey stands in, with a warning.
#pragma once

#include "core/image/texture_plugin.h"

namespace penumbra {

struct PtexTexture {
    static constexpr ParameterInfo kParameters[] = {
        {"string", "filename", "", "not read"},
        {"string", "encoding", "gamma 2.2", "not used"},
        {"float", "scale", "1", "not used"},
    };
    static constexpr PluginInfo kInfo{"ptex", "not supported: a grey of 0.5 stands in, with a warning", kParameters};

    static TextureOperand make(TextureInput& input, TextureTables&) {
        input.warn("Ptex files are not supported; a grey stands in for this one");
        input.parameters().markAllUsed();
        return TextureOperand::number(0.5f);
    }
};

}  // namespace penumbra
