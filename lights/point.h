// PointLight: radiant intensity I, the same in all directions, from a point; `LightSource "point"`.
//
// Irradiance at distance d is I / d^2; nothing arrives at the point itself.
#pragma once

#include "lights/placed_light.h"

namespace penumbra {

inline constexpr ParameterInfo kPointParameters[] = {
    {"spectrum", "I", "white", "radiant intensity"},
    {"float", "scale", "1", "factor on I"},
    {"float", "power", "0", "where positive, the flux in watts instead of I's size"},
    {"point3", "from", "0 0 0", "where it is"},
};

struct PointLight {
    static constexpr PluginInfo kInfo = {"point", "light from a point, the same in all directions", kPointParameters};
    static constexpr bool kInfinite = false;
    static constexpr bool kDelta = true;

    Vec3<float> position;
    Spectrum<float> intensity;

    float power(const LightTables&) const { return 4.f * kPi * average(intensity); }

    std::optional<LightBounds> bounds(const LightTables&) const {
        return LightBounds::ofPoint(position, average(intensity));
    }

    template <class F>
    static LightSample<F> sample(const Records<F, PointLight>& light, const LightTables&, const Vec3<F>& p,
                                 const Vec2<F>&) {
        return sampleFromPoint(light(&PointLight::position), p,
                               [&](const Vec3<F>&) { return light(&PointLight::intensity); });
    }
};

}  // namespace penumbra
