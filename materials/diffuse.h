// "diffuse": Lambert's reflector, f = R / pi, alike from both sides.
//
// Thread safety: plain values. Source: Lambert 1760; samples are cosine-weighted, so their weight is R exactly.
#pragma once

#include "core/math/warps.h"
#include "materials/material.h"

namespace penumbra {

template <class F>
struct DiffuseBsdf {
    Spectrum<F> reflectance;

    BsdfEval<F> evaluate(const Vec3<F>& wo, const Vec3<F>& wi) const {
        const Mask<F> sameSide = wo.z * wi.z > F(0.f);
        const F pdf = select(sameSide, abs(wi.z) * F(kInvPi), F(0.f));
        return {reflectance * pdf, pdf};
    }

    BsdfSample<F> sample(const Vec3<F>& wo, F, const Vec2<F>& u) const {
        Vec3<F> wi = cosineHemisphere(u);
        const F pdf = wi.z * F(kInvPi);
        const Mask<F> valid = (wi.z > F(0.f)) & (wo.z != F(0.f));
        wi.z = flipSign(wo.z < F(0.f), wi.z);
        return {wi, reflectance, pdf, F(1.f), Mask<F>(false), valid};
    }

    Mask<F> smoothOnly() const { return Mask<F>(false); }
    Spectrum<F> albedo(const Vec3<F>&) const { return reflectance; }
};

struct DiffuseMaterial {
    static constexpr ParameterInfo kParameters[] = {
        {"spectrum", "reflectance", "0.5", "fraction of light reflected; texture or any spectrum"},
    };
    static constexpr PluginInfo kInfo{"diffuse", "Lambertian reflection, two-sided", kParameters};
    static constexpr bool kPassThrough = false;
    static constexpr bool kUsesLobe = false;
    template <class F>
    using Bsdf = DiffuseBsdf<F>;

    SpectrumInput reflectance;

    static DiffuseMaterial make(MaterialInput& input) { return {input.albedo("reflectance", {0.5f, 0.5f, 0.5f})}; }

    template <class F>
    static DiffuseBsdf<F> bsdf(const Records<F, DiffuseMaterial>& m, const ShadingContext<F>& at) {
        return {at.spectrum(m, &DiffuseMaterial::reflectance)};
    }
};

}  // namespace penumbra
