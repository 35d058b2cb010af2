// What a BSDF is to an integrator, over lanes.
//
// Conventions: directions are unit vectors in the local frame, z = shading normal, x = tangent; wo and wi both point
// away from the surface; evaluate() includes |cos wi|; densities are per solid angle. A BSDF is a flat value
// ("closure") built once per hit with every texture already looked up; it never sees a sampler, it receives numbers in
// [0,1). Radiance is transported: transmission from medium i to medium t scales by (n_i / n_t)^2.
//
// A material type is a plain struct of 32-bit words (one row of a table, read through Records) with
//   static constexpr PluginInfo kInfo;
//   static constexpr bool kUsesLobe;         // false: sample() does not look at uLobe, which then need not be drawn
//   static constexpr bool kPassThrough;      // true: a mere border of media, which rays cross as if it were not there
//   static constexpr bool kEstimates;        // (may be absent, for false) true: evaluate() is an unbiased estimate, by
//                                            // numbers that follow from ShadingContext::chance
//   static constexpr bool kReciprocal;       // (may be absent, for true) false: a model that is not
//   static constexpr bool kNeedsUv;          // (may be absent, for false) true: looks at uv, textures or not
//   bool needsTangent() const;               // (may be absent, for false) true: the x axis of the frame matters
//   template <class F> using Bsdf = ...;     // the closure it builds
//   static M make(MaterialInput&);           // from parameters, at scene build (cold)
//   template <class F> static Bsdf<F> bsdf(const Records<F, M>&, const ShadingContext<F>&);
// and a closure has
//   BsdfEval<F> evaluate(const Vec3<F>& wo, const Vec3<F>& wi) const;   // delta lobes give 0
//   BsdfSample<F> sample(const Vec3<F>& wo, F uLobe, const Vec2<F>& u) const;
//   Mask<F> smoothOnly() const;                  // true: nothing but delta lobes, so light sampling is pointless
//   Spectrum<F> albedo(const Vec3<F>& wo) const; // estimate of the directional reflectance, for AOVs
// The concepts at the end of materials/registry.h check this.
//
// Whatever unit vectors come in (wo.z = 0, both directions in the surface), results are finite and not negative. A lane
// that is not valid carries unspecified, but finite, values.
#pragma once

#include "core/math/spectrum.h"
#include "core/math/vector.h"

namespace penumbra {

/// Whether the closures of a material estimate: two hits with the same directions differ, and only their mean is the
/// BSDF.
template <class M>
inline constexpr bool kIsEstimate = requires { requires M::kEstimates; };

template <class M>
inline constexpr bool kIsReciprocal = !requires { requires !M::kReciprocal; };

template <class F>
struct BsdfEval {
    Spectrum<F> fCos;  ///< f(wo, wi) |cos wi|
    F pdf;             ///< density with which sample() chooses wi (its non-delta lobes)
};

template <class F>
struct BsdfSample {
    Vec3<F> wi;
    Spectrum<F> weight;  ///< f |cos wi| / pdf
    F pdf;               ///< per solid angle; for a delta lobe the probability of the lobe (any positive number)
    F eta;               ///< relative index crossed: index on wi's side over index on wo's side; 1 for reflection
    Mask<F> delta;       ///< a delta lobe was chosen
    Mask<F> valid;       ///< false: absorbed
};

}  // namespace penumbra
