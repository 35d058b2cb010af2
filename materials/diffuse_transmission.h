// "diffusetransmission": a thin sheet such as paper or a leaf, f = R / pi on the side of wo and T / pi on the other.
//
// Sampling: a cosine lobe on either side, in proportion to the means of R and T. R + T beyond 1 makes energy; as in pbrt-v4,
// that is the scene's affair. Thread safety: plain values.
#pragma once

#include "core/math/warps.h"
#include "materials/material.h"

namespace penumbra {

template <class F>
struct DiffuseTransmissionBsdf {
    Spectrum<F> reflectance, transmittance;

    BsdfEval<F> evaluate(const Vec3<F>& wo, const Vec3<F>& wi) const {
        const Mask<F> reflects = wo.z * wi.z > F(0.f), transmits = wo.z * wi.z < F(0.f);
        const F cosine = select(reflects | transmits, abs(wi.z) * F(kInvPi), F(0.f));
        const F reflected = reflectedShare();
        return {select(reflects, reflectance, transmittance) * cosine,
                select(reflects, reflected, F(1.f) - reflected) * cosine};
    }

    BsdfSample<F> sample(const Vec3<F>& wo, F uLobe, const Vec2<F>& u) const {
        const F reflected = reflectedShare();
        const Mask<F> reflects = uLobe < reflected;
        const F share = select(reflects, reflected, F(1.f) - reflected);
        Vec3<F> wi = cosineHemisphere(u);
        const F pdf = wi.z * F(kInvPi) * share;
        const Mask<F> valid = (wi.z > F(0.f)) & (wo.z != F(0.f)) & (share > F(0.f));
        const Mask<F> below = wo.z < F(0.f);
        wi.z = flipSign((below & reflects) | !(below | reflects), wi.z);
        const Spectrum<F> color = select(reflects, reflectance, transmittance);
        return {wi, color * (F(1.f) / max(share, F(1e-20f))), pdf, F(1.f), Mask<F>(false), valid};
    }

    Mask<F> smoothOnly() const { return Mask<F>(false); }
    Spectrum<F> albedo(const Vec3<F>&) const { return reflectance + transmittance; }

private:
    /// The probability with which sample() reflects.
    F reflectedShare() const {
        const F r = average(reflectance), t = average(transmittance);
        return r / max(r + t, F(1e-20f));
    }
};

struct DiffuseTransmissionMaterial {
    static constexpr ParameterInfo kParameters[] = {
        {"spectrum", "reflectance", "0.25", "fraction of light reflected; texture or any spectrum"},
        {"spectrum", "transmittance", "0.25", "fraction of light let through; texture or any spectrum"},
        {"float", "scale", "1", "multiplies both; neither gets beyond 1"},
    };
    static constexpr PluginInfo kInfo{"diffusetransmission", "Lambertian reflection and transmission of a thin sheet", kParameters};
    static constexpr bool kPassThrough = false;
    static constexpr bool kUsesLobe = true;
    template <class F>
    using Bsdf = DiffuseTransmissionBsdf<F>;

    SpectrumInput reflectance, transmittance;
    float scale = 1.f;

    static DiffuseTransmissionMaterial make(MaterialInput& input) {
        const float scale = input.parameters().number("scale", 1.f);
        return {input.albedo("reflectance", {0.25f, 0.25f, 0.25f}), input.albedo("transmittance", {0.25f, 0.25f, 0.25f}),
                scale > 0.f ? scale : 0.f};
    }

    template <class F>
    static DiffuseTransmissionBsdf<F> bsdf(const Records<F, DiffuseTransmissionMaterial>& m, const ShadingContext<F>& at) {
        using M = DiffuseTransmissionMaterial;
        const F scale = m(&M::scale);
        const auto scaled = [&](const Spectrum<F>& c) {
            const Spectrum<F> s = c * scale;
            return Spectrum<F>{min(s.r, F(1.f)), min(s.g, F(1.f)), min(s.b, F(1.f))};
        };
        return {scaled(at.spectrum(m, &M::reflectance)), scaled(at.spectrum(m, &M::transmittance))};
    }
};

}  // namespace penumbra
