// TextureMapping: from the point of a look-up to the plane of a two-dimensional texture.
//
// "uv": s = uscale u + udelta, t = vscale v + vdelta. The footprint is stretched like the coordinate. The format's
// other mappings (planar, spherical, cylindrical) take TextureContext::p; they warn, and uv stands in for them.
#pragma once

#include "core/base/plugin.h"
#include "core/image/texture.h"

#include <cmath>

namespace penumbra {

template <class F>
struct MappedPoint {
    F s, t;
    F widthS, widthT;  ///< the footprint, along s and along t
};

struct TextureMapping {
    // The rows that every plug-in with a mapping shows among its parameters.
    static constexpr ParameterInfo kMapping{"string", "mapping", "uv", "how the surface is laid on the plane: uv"};
    static constexpr ParameterInfo kUScale{"float", "uscale", "1", "s = uscale u + udelta"};
    static constexpr ParameterInfo kVScale{"float", "vscale", "1", "t = vscale v + vdelta"};
    static constexpr ParameterInfo kUDelta{"float", "udelta", "0", "see uscale"};
    static constexpr ParameterInfo kVDelta{"float", "vdelta", "0", "see vscale"};

    static TextureMapping make(TextureInput& input);

    template <class F>
    MappedPoint<F> map(const TextureContext<F>& at) const {
        return {at.uv.x * F(uScale) + F(uDelta), at.uv.y * F(vScale) + F(vDelta), at.footprint * F(std::fabs(uScale)),
                at.footprint * F(std::fabs(vScale))};
    }

    float uScale = 1, vScale = 1, uDelta = 0, vDelta = 0;
};

}  // namespace penumbra
