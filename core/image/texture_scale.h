// scale: the product of a texture and a number, both of which may be textures.
//
// A constant factor of an image goes into the image's own scale, that is before its inversion, as the pbrt format has
// it.
#pragma once

#include "core/image/texture_imagemap.h"

namespace penumbra {

struct ScaleTexture {
    static constexpr ParameterInfo kParameters[] = {
        {"spectrum or float texture", "tex", "1", "what is scaled"},
        {"float texture", "scale", "1", "the factor"},
    };
    static constexpr PluginInfo kInfo{"scale", "the product of a texture and a number", kParameters};

    static TextureOperand make(TextureInput& input, TextureTables& tables) {
        TextureOperand tex = input.value("tex", 1.f), scale = input.scalar("scale", 1.f);
        if (input.kind() == TextureKind::Float && tex.isConstant())
            std::swap(tex, scale);  // two numbers: either may be it
        if (!scale.isConstant()) return tables.append(ScaleTexture{tex, scale}, {tex, scale}, input);
        const float factor = scale.constant.r;
        if (tex.isConstant()) return {tex.constant * factor, kNoTexture};
        if (factor == 1.f) return tex;
        if (const ImageTexture* found = tables.find<ImageTexture>(tex)) {
            ImageTexture image = *found;
            image.scale *= factor;
            return tables.append(image, {}, input);
        }
        return tables.append(ScaleTexture{tex, scale}, {tex, scale}, input);
    }

    template <class V, class F>
    V evaluate(const TextureContext<F>& at, const TextureTables& tables) const {
        return tables.value<V>(texture, at) * tables.value<F>(factor, at);
    }

    TextureOperand texture, factor;
};

}  // namespace penumbra
