// "thindielectric": a smooth pane so thin that light leaves it where it came in. Both faces reflect, to and fro without end,
// so with R of one face at that angle and T = 1 - R the pane reflects R + T^2 R / (1 - R^2) and lets the rest straight through,
// unscaled, for it ends in the medium in which it began. Alike from both sides.
// Thread safety: plain values. Source: the geometric series of reflections within a slab (Born & Wolf, 7.6, incoherent).
#pragma once

#include "materials/fresnel.h"
#include "materials/material.h"

namespace penumbra {

template <class F>
struct ThinDielectricBsdf {
    F eta;

    BsdfEval<F> evaluate(const Vec3<F>&, const Vec3<F>&) const { return {Spectrum<F>::constant(F(0.f)), F(0.f)}; }

    BsdfSample<F> sample(const Vec3<F>& wo, F uLobe, const Vec2<F>&) const {
        const F reflected = reflectance(wo);
        const Mask<F> reflects = uLobe < reflected;
        const Vec3<F> wi = {-wo.x, -wo.y, flipSign(!reflects, wo.z)};
        // Each lobe is taken as often as it carries light, so its weight is one.
        return {wi, Spectrum<F>::constant(F(1.f)), select(reflects, reflected, F(1.f) - reflected), F(1.f), Mask<F>(true), wo.z != F(0.f)};
    }

    Mask<F> smoothOnly() const { return Mask<F>(true); }
    Spectrum<F> albedo(const Vec3<F>&) const { return Spectrum<F>::constant(F(1.f)); }

private:
    /// Of the whole pane: R + T^2 R / (1 - R^2) = 2 R / (1 + R).
    F reflectance(const Vec3<F>& wo) const {
        const F r = dielectricFresnel(min(abs(wo.z), F(1.f)), eta).reflectance;
        return F(2.f) * r / (F(1.f) + r);
    }
};

struct ThinDielectricMaterial {
    static constexpr ParameterInfo kParameters[] = {
        {"float", "eta", "1.5", "relative index of refraction; a spectrum counts with its mean"},
    };
    static constexpr PluginInfo kInfo{"thindielectric", "thin smooth pane: mirror reflection, straight transmission", kParameters};
    static constexpr bool kPassThrough = false;
    static constexpr bool kUsesLobe = true;
    template <class F>
    using Bsdf = ThinDielectricBsdf<F>;

    float eta = 1.5f;

    static ThinDielectricMaterial make(MaterialInput& input) { return {input.dielectricIndex("eta", 1.5f)}; }

    template <class F>
    static ThinDielectricBsdf<F> bsdf(const Records<F, ThinDielectricMaterial>& m, const ShadingContext<F>&) {
        return {m(&ThinDielectricMaterial::eta)};
    }
};

}  // namespace penumbra
