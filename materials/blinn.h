// "blinn": a Lambertian term and a lobe of cos^n of the half vector's angle, Blinn's variant of Phong's model.
//
//   f = kd / pi + ks (n + 2) (n + 4) / (8 pi (2^(-n/2) + n)) cos^n b,    b: angle between normal and half vector.
// The lobe reflects ks of perpendicular light; towards grazing angles it falls like the square of the cosine. For the same
// look as "phong" the exponent is about four times as high.
// Thread safety: plain values. Sources: Blinn, SIGGRAPH 1977 (the half vector); the factor is the inverse of
// 2 pi int cos^n(t/2) cos t sin t dt over 0 <= t <= pi/2.
#pragma once

#include "materials/cosine_lobe.h"

namespace penumbra {

template <class F>
struct BlinnLobe {
    F exponent, factor;

    static BlinnLobe make(F n) {
        const F halved = exp(n * F(-0.34657359f));  // 2^(-n/2)
        return {n, (n + F(2.f)) * (n + F(4.f)) * F(0.125f * kInvPi) / (halved + n)};
    }

    F value(const Vec3<F>& wo, const Vec3<F>& wi) const {
        const Vec3<F> h = wo + wi;
        return factor * powerOfCosine(cosine(h, lengthSquared(h)), exponent) * wi.z;
    }
    F pdf(const Vec3<F>& wo, const Vec3<F>& wi) const {
        const Vec3<F> h = wo + wi;
        const F h2 = lengthSquared(h);
        // dh/dwi = 1 / (4 wo.h), and of unit vectors wo.h is half the length of their sum.
        return powerCosineDensity(cosine(h, h2), exponent) * F(0.5f) / sqrt(max(h2, F(1e-12f)));
    }
    Vec3<F> sample(const Vec3<F>& wo, const Vec2<F>& u) const {
        const Vec3<F> h = powerCosineHemisphere(u, exponent);
        const F c = dot(wo, h);
        const Vec3<F> wi = h * (F(2.f) * c) - wo;
        return select(c > F(0.f), wi, -wo);  // seen from behind, the facet reflects nothing
    }
    F albedo(F c) const { return (F(2.f) + exponent * c * c) / (exponent + F(2.f)); }

private:
    static F cosine(const Vec3<F>& h, F lengthSquaredOfH) { return h.z / sqrt(max(lengthSquaredOfH, F(1e-12f))); }
};

struct BlinnMaterial : CosineLobeInputs {
    static constexpr PluginInfo kInfo{"blinn", "Lambertian and a power of the half vector's cosine, two-sided", kParameters};
    static constexpr bool kPassThrough = false;
    static constexpr bool kUsesLobe = true;
    template <class F>
    using Bsdf = CosineLobeBsdf<F, BlinnLobe<F>>;

    static BlinnMaterial make(MaterialInput& input) { return {CosineLobeInputs::make(input)}; }

    template <class F>
    static Bsdf<F> bsdf(const Records<F, BlinnMaterial>& m, const ShadingContext<F>& at) {
        return closure<BlinnLobe<F>>(m, at);
    }
};

}  // namespace penumbra
