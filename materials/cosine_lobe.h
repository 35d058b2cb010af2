// What "phong" and "blinn" share: a Lambertian term and a glossy one, kd / pi + ks g(wo, wi), where g is a power of a cosine
// that is normalised to reflect all of perpendicular light and never reflects more.
//
// kd + ks is at most 1: where they say more, both are scaled down. Alike from both sides. Sampling: either term in proportion
// to what it reflects, roughly. A type Lobe for the glossy term has, for directions above the surface,
//   static Lobe make(F exponent);
//   F value(wo, wi) const;          // g cos wi
//   F pdf(wo, wi) const;            // of sample()
//   Vec3<F> sample(wo, u) const;    // may end below the surface, which absorbs it
//   F albedo(F cosine) const;       // of g from that angle, roughly: right for perpendicular light and for n = 0
// Thread safety: plain values.
#pragma once

#include "core/math/warps.h"
#include "materials/material.h"

namespace penumbra {

/// cos^n, and 0 below the horizon even for n = 0.
template <class F>
F powerOfCosine(F cosine, F exponent) {
    return select(cosine > F(0.f), pow(min(cosine, F(1.f)), exponent), F(0.f));
}

/// About +z with the density (n + 1) / (2 pi) cos^n.
template <class F>
Vec3<F> powerCosineHemisphere(const Vec2<F>& u, F exponent) {
    const F z = pow(F(1.f) - u.y, F(1.f) / (exponent + F(1.f)));
    const F radius = safeSqrt(F(1.f) - z * z);
    F s, c;
    sinCos(F(kTwoPi) * u.x, s, c);
    return {radius * c, radius * s, z};
}
template <class F>
F powerCosineDensity(F cosine, F exponent) {
    return (exponent + F(1.f)) * F(kInvTwoPi) * powerOfCosine(cosine, exponent);
}

template <class F, class Lobe>
struct CosineLobeBsdf {
    Spectrum<F> kd, ks;
    Lobe lobe;

    BsdfEval<F> evaluate(const Vec3<F>& woGiven, const Vec3<F>& wiGiven) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        const Vec3<F> wi{wiGiven.x, wiGiven.y, flipSign(below, wiGiven.z)};
        const BsdfEval<F> value = aboveSurface(wo, wi);
        const Mask<F> lit = (wo.z > F(0.f)) & (wi.z > F(0.f));
        return {select(lit, value.fCos, Spectrum<F>::constant(F(0.f))), select(lit, value.pdf, F(0.f))};
    }

    BsdfSample<F> sample(const Vec3<F>& woGiven, F uLobe, const Vec2<F>& u) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        Vec3<F> wi = select(uLobe < glossyProbability(wo), lobe.sample(wo, u), cosineHemisphere(u));
        const BsdfEval<F> value = aboveSurface(wo, wi);
        const Mask<F> valid = (wo.z > F(0.f)) & (wi.z > F(0.f)) & (value.pdf > F(1e-20f));
        const Spectrum<F> weight = value.fCos * (F(1.f) / max(value.pdf, F(1e-20f)));
        wi.z = flipSign(below, wi.z);
        return {wi, weight, value.pdf, F(1.f), Mask<F>(false), valid};
    }

    Mask<F> smoothOnly() const { return Mask<F>(false); }
    Spectrum<F> albedo(const Vec3<F>& wo) const { return kd + ks * lobe.albedo(min(abs(wo.z), F(1.f))); }

private:
    F glossyProbability(const Vec3<F>& wo) const {
        const F glossy = average(ks) * lobe.albedo(min(wo.z, F(1.f)));
        return glossy / max(average(kd) + glossy, F(1e-20f));
    }
    BsdfEval<F> aboveSurface(const Vec3<F>& wo, const Vec3<F>& wiGiven) const {
        const Vec3<F> wi{wiGiven.x, wiGiven.y, max(wiGiven.z, F(0.f))};
        const F diffuse = wi.z * F(kInvPi);
        return {kd * diffuse + ks * lobe.value(wo, wi), lerp(glossyProbability(wo), diffuse, lobe.pdf(wo, wi))};
    }
};

/// The parameters of both; derive from it.
struct CosineLobeInputs {
    static constexpr float kMostExponent = 1e4f;
    static constexpr ParameterInfo kParameters[] = {
        {"spectrum", "kd", "0.5", "reflectance of the diffuse term; texture or any spectrum"},
        {"spectrum", "ks", "0.2", "reflectance of the glossy term for perpendicular light; texture or any spectrum"},
        {"float", "exponent", "50", "of the cosine, 0 to 10000: the higher, the smaller the highlight; texture or number"},
    };

    SpectrumInput kd, ks;
    ScalarInput exponent;

    static CosineLobeInputs make(MaterialInput& input) {
        const CosineLobeInputs m{input.albedo("kd", {0.5f, 0.5f, 0.5f}), input.albedo("ks", {0.2f, 0.2f, 0.2f}),
                                 input.scalar("exponent", 50.f)};
        if (!(m.exponent.constant >= 0 && m.exponent.constant <= kMostExponent))
            input.fail("exponent is " + std::to_string(m.exponent.constant) + ", outside the allowed range, 0 to 10000");
        const bool constant = m.kd.texture == kNoTexture && m.ks.texture == kNoTexture;
        if (constant && maxComponent(m.kd.constant + m.ks.constant) > 1.0001f)
            input.warn("kd + ks is more than 1; both are scaled down, so that no light is made");
        return m;
    }

    /// The closure of M, a type derived from this one; Lobe is made of the exponent.
    template <class Lobe, class F, class M>
    static CosineLobeBsdf<F, Lobe> closure(const Records<F, M>& m, const ShadingContext<F>& at) {
        Spectrum<F> kd = at.spectrum(m, static_cast<SpectrumInput M::*>(&CosineLobeInputs::kd));
        Spectrum<F> ks = at.spectrum(m, static_cast<SpectrumInput M::*>(&CosineLobeInputs::ks));
        const F exponent = at.scalar(m, static_cast<ScalarInput M::*>(&CosineLobeInputs::exponent));
        const auto settle = [](F& d, F& s) {
            const F scale = F(1.f) / max(d + s, F(1.f));
            d *= scale;
            s *= scale;
        };
        settle(kd.r, ks.r);
        settle(kd.g, ks.g);
        settle(kd.b, ks.b);
        return {kd, ks, Lobe::make(clamp(exponent, F(0.f), F(kMostExponent)))};
    }
};

}  // namespace penumbra
