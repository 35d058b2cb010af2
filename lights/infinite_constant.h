// ConstantInfiniteLight: the same radiance from every direction; `LightSource "infinite"` without an image.
//
// Sampled uniformly over the sphere, where it is sampled at all: BSDF sampling is nearly perfect for it, so light
// samplers leave it out unless they are told that there is no other strategy (LightSampler's includeUniformInfinite).
#pragma once

#include "core/math/warps.h"
#include "lights/infinite_light.h"

namespace penumbra {

struct ConstantInfiniteLight {
    static constexpr const PluginInfo& kInfo = kInfiniteInfo;
    static constexpr bool kInfinite = true;
    static constexpr bool kDelta = false;

    Spectrum<float> radiance;

    float power(const LightTables& tables) const { return infinitePower(average(radiance), tables); }

    std::optional<LightBounds> bounds(const LightTables&) const { return {}; }

    template <class F>
    static LightSample<F> sample(const Records<F, ConstantInfiniteLight>& light, const LightTables&, const Vec3<F>&,
                                 const Vec2<F>& u) {
        const Spectrum<F> L = light(&ConstantInfiniteLight::radiance);
        return lightSample(!isBlack(L), uniformSphere(u), F(kInfinity), L, F(kInvFourPi), Mask<F>(false));
    }
    template <class F>
    static LightEval<F> evaluate(const Records<F, ConstantInfiniteLight>& light, const LightTables&,
                                 const LightHit<F>&) {
        const Spectrum<F> L = light(&ConstantInfiniteLight::radiance);
        return lightEval(!isBlack(L), L, F(kInvFourPi));
    }
};

}  // namespace penumbra
