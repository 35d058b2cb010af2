// What a light is to an integrator, over lanes.
//
// Conventions: radiance in the film's linear RGB; wi points from the shading point to the light and is a unit vector;
// densities are per solid angle at the shading point. Both strategies return {L, pdf}, so multiple importance sampling
// is two lines in an integrator that never asks what kind of light it has. The probability of *picking* the light is
// not in `pdf`: the light sampler (light_sampler.h) owns it.
//
// A light type is a plain struct of 32-bit words (one row of a table, read through Records) with
//   static constexpr PluginInfo kInfo;
//   static constexpr bool kInfinite;   // lives on the sphere of directions: met by rays that leave the scene
//   static constexpr bool kDelta;      // no ray meets it by chance
//   template <class F> static LightSample<F> sample(const Records<F, T>&, const LightTables&, const Vec3<F>& p, const Vec2<F>& u);
//   template <class F> static LightEval<F> evaluate(const Records<F, T>&, const LightTables&, const LightHit<F>&);   // not delta
//   float power(const LightTables&) const;   // emitted flux (luminance weight), for light selection; infinite lights use the scene radius
// See lights/registry.h.
#pragma once

#include "core/base/plugin.h"
#include "core/math/records.h"

#include <vector>

namespace penumbra {

template <class F>
struct LightSample {
    Vec3<F> wi;          ///< unit
    F distance;          ///< to the sampled point; kInfinity for infinite and distant lights
    Spectrum<F> L;       ///< radiance arriving; for delta lights the irradiance-like weight (I / d^2, or E), with pdf 1
    F pdf;               ///< per solid angle; 1 for delta lights
    Mask<F> valid;       ///< false: nothing arrives (back side, outside the cone, zero density)
};

/// What a ray that met a light knows. For infinite lights only `wi` matters.
template <class F>
struct LightHit {
    Vec3<F> from;        ///< the shading point that the ray left
    Vec3<F> p;           ///< the point met
    Vec3<F> n;           ///< unit geometric normal there, on the side that the shape's orientation says is outside
    Vec3<F> wi;          ///< unit direction of the ray (from -> p)
};

template <class F>
struct LightEval {
    Spectrum<F> L;
    F pdf;               ///< density with which sample() would have chosen this direction; 0 where it never would
};

/// Variable-length data of lights (images and their distributions): one float array and one word array for the whole
/// scene; lights hold offsets into them.
struct LightTables {
    std::vector<float> numbers;
    std::vector<std::uint32_t> words;
    Vec3<float> sceneCenter{};      ///< bounding sphere of the scene
    float sceneRadius = 1.f;
    bool classicArea = false;       ///< --light-sampling area: uniform points on every area light
};

}  // namespace penumbra
