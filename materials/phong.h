// "phong": a Lambertian term and a lobe of cos^n about the mirror direction, the modified Phong model.
//
//   f = kd / pi + ks (n + 2) / (2 pi) cos^n a,    a: angle between wi and the mirror image of wo.
// The lobe reflects ks of perpendicular light and less at grazing angles, where the surface cuts it.
// Thread safety: plain values. Sources: Phong, CACM 18(6), 1975; Lafortune & Willems, "Using the modified Phong reflectance
// model for physically based rendering", 1994 (normalisation, sampling).
#pragma once

#include "materials/cosine_lobe.h"

namespace penumbra {

template <class F>
struct PhongLobe {
    F exponent;

    static PhongLobe make(F exponent) { return {exponent}; }

    F value(const Vec3<F>& wo, const Vec3<F>& wi) const {
        return (exponent + F(2.f)) * F(kInvTwoPi) * powerOfCosine(cosine(wo, wi), exponent) * wi.z;
    }
    F pdf(const Vec3<F>& wo, const Vec3<F>& wi) const { return powerCosineDensity(cosine(wo, wi), exponent); }
    Vec3<F> sample(const Vec3<F>& wo, const Vec2<F>& u) const {
        // A frame about the mirror direction r, whose z is not negative (Duff et al., JCGT 6(1), 2017).
        const Vec3<F> w = powerCosineHemisphere(u, exponent), r{-wo.x, -wo.y, wo.z};
        const F a = F(-1.f) / (F(1.f) + r.z), b = r.x * r.y * a;
        const Vec3<F> s{F(1.f) + r.x * r.x * a, b, -r.x}, t{b, F(1.f) + r.y * r.y * a, -r.y};
        return s * w.x + t * w.y + r * w.z;
    }
    F albedo(F c) const { return (F(2.f) + exponent * c) / (exponent + F(2.f)); }

private:
    static F cosine(const Vec3<F>& wo, const Vec3<F>& wi) { return wo.z * wi.z - wo.x * wi.x - wo.y * wi.y; }
};

struct PhongMaterial : CosineLobeInputs {
    static constexpr PluginInfo kInfo{"phong", "Lambertian and a power of the cosine to the mirror direction, two-sided",
                                      kParameters};
    static constexpr bool kPassThrough = false;
    static constexpr bool kUsesLobe = true;
    template <class F>
    using Bsdf = CosineLobeBsdf<F, PhongLobe<F>>;

    static PhongMaterial make(MaterialInput& input) { return {CosineLobeInputs::make(input)}; }

    template <class F>
    static Bsdf<F> bsdf(const Records<F, PhongMaterial>& m, const ShadingContext<F>& at) {
        return closure<PhongLobe<F>>(m, at);
    }
};

}  // namespace penumbra
