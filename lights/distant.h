// DistantLight: parallel light, as of a sun without size; `LightSource "distant"`.
//
// `irradiance` is that of a surface which faces the light. Invariant: toLight is a unit vector.
#pragma once

#include "lights/light.h"

namespace penumbra {

inline constexpr ParameterInfo kDistantParameters[] = {
    {"spectrum", "L", "white", "irradiance of a surface that faces the light"},
    {"float", "scale", "1", "factor on L"},
    {"float", "illuminance", "0", "where positive, the illuminance of a facing surface instead of L's size"},
    {"point3", "from", "0 0 0", "the light goes from here ..."},
    {"point3", "to", "0 0 1", "... towards here"},
};

struct DistantLight {
    static constexpr PluginInfo kInfo = {"distant", "parallel light from one direction", kDistantParameters};
    static constexpr bool kInfinite = false;  // no ray meets it
    static constexpr bool kDelta = true;

    Vec3<float> toLight;
    Spectrum<float> irradiance;

    /// Flux through the scene's disk.
    float power(const LightTables& tables) const {
        return kPi * tables.sceneRadius * tables.sceneRadius * average(irradiance);
    }

    std::optional<LightBounds> bounds(const LightTables&) const { return {}; }

    template <class F>
    static LightSample<F> sample(const Records<F, DistantLight>& light, const LightTables&, const Vec3<F>&,
                                 const Vec2<F>&) {
        return lightSample(Mask<F>(true), light(&DistantLight::toLight), F(kInfinity), light(&DistantLight::irradiance),
                           F(1.f), Mask<F>(true));
    }
};

}  // namespace penumbra
