// directionmix: a blend of two textures by how the surface is turned, a tex1 + (1 - a) tex2 with a = |n . dir|, n the
// geometric normal and dir a direction in the texture's space.
#pragma once

#include "core/image/texture_mapping.h"
#include "core/image/texture_plugin.h"

namespace penumbra {

struct DirectionMixTexture {
    static constexpr ParameterInfo kParameters[] = {
        {"spectrum or float texture", "tex1", "0", "the value where the surface faces along dir"},
        {"spectrum or float texture", "tex2", "1", "the value where the surface is parallel to dir"},
        {"vector3", "dir", "0 1 0", "the direction"},
    };
    static constexpr PluginInfo kInfo{"directionmix", "a blend of two textures by how the surface is turned",
                                      kParameters};

    static TextureOperand make(TextureInput& input, TextureTables& tables);

    template <class V, class F>
    V evaluate(const TextureContext<F>& at, const TextureTables& tables) const {
        const F facing = min(abs(dot(at.n, broadcast<F>(direction))), F(1.f));
        return tables.blend<V>(across, along, facing, at);
    }

    TextureOperand along, across;
    Vec3<float> direction;  ///< a unit vector in world space
};

}  // namespace penumbra
