// SpotLight: a point light whose intensity falls from I within a cone to nothing outside a wider one; `LightSource
// "spot"`.
//
// Between the cones the intensity is I t^2 (3 - 2 t), t going linearly in the cosine from 0 at the outer cone to 1 at
// the inner one. Cosines are kept as versines (1 - cosine), so that narrow beams lose no digits: with the angle's
// direction w and the axis a, versine = |w - a|^2 / 2.
//
// Invariants: axis is a unit vector of the light's space; 0 <= versineInner <= versineOuter <= 2.
#pragma once

#include "lights/placed_light.h"

namespace penumbra {

inline constexpr ParameterInfo kSpotParameters[] = {
    {"spectrum", "I", "white", "radiant intensity on the axis"},
    {"float", "scale", "1", "factor on I"},
    {"float", "power", "0", "where positive, the flux in watts instead of I's size"},
    {"point3", "from", "0 0 0", "where it is ..."},
    {"point3", "to", "0 0 1", "... and a point that it shines at"},
    {"float", "coneangle", "30", "degrees between the axis and the edge of the light"},
    {"float", "conedeltaangle", "5", "degrees over which the light falls off inside the edge"},
};

struct SpotLight : PlacedLight {
    static constexpr PluginInfo kInfo = {"spot", "light from a point, within a cone", kSpotParameters};
    static constexpr bool kInfinite = false;
    static constexpr bool kDelta = true;

    Vec3<float> axis;
    float versineInner, versineOuter;
    Spectrum<float> intensity;

    /// `axis` of the light's space, not 0; angles from it in degrees, at most 180. Error(BadData) where the matrix is
    /// singular.
    static SpotLight make(const Matrix4& worldFromLight, Vec3d from, Vec3d axis, double innerAngle, double outerAngle,
                          const Spectrum<float>& intensity);

    /// Flux of a light whose intensity on the axis is 1.
    float unitPower() const { return kPi * (versineInner + versineOuter); }
    float power(const LightTables&) const { return unitPower() * average(intensity); }

    std::optional<LightBounds> bounds(const LightTables&) const;

    template <class F>
    static LightSample<F> sample(const Records<F, SpotLight>& light, const LightTables&, const Vec3<F>& p,
                                 const Vec2<F>&) {
        return sampleFromPoint(light(&SpotLight::position), p, [&](const Vec3<F>& w) {
            const F versine = F(0.5f) * lengthSquared(directionInLight(light, w) - light(&SpotLight::axis));
            const F outer = light(&SpotLight::versineOuter), width = outer - light(&SpotLight::versineInner);
            const F t = clamp((outer - versine) / max(width, F(1e-30f)), F(0.f), F(1.f));
            return light(&SpotLight::intensity) * (t * t * (F(3.f) - F(2.f) * t));
        });
    }
};

}  // namespace penumbra
