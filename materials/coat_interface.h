// The dielectric interface of a coat, smooth or rough (GGX), and the gap below it: what layered materials share.
//
// Conventions: z > 0 is outside, z < 0 inside the coat; eta is the index inside over that outside. Fractions are of
// light (energy), masking included; they carry no factor of eta. Thread safety: pure functions. Sources: Walter et al.,
// EGSR 2007 (eq. 16-21); Guo, Hasan & Zhao, SIGGRAPH Asia 2018 (layers as a walk).
#pragma once

#include "materials/fresnel.h"
#include "materials/microfacet.h"

namespace penumbra {

inline constexpr ParameterInfo kGapThicknessParameter{"float", "thickness", "0.01",
                                                      "of the gap, which absorbs one e-fold a unit"};
inline constexpr ParameterInfo kGapAlbedoParameter{"spectrum", "albedo", "0",
                                                   "of scattering in the gap (lessens its absorption)"};

/// What the gap of a coat absorbs of a perpendicular crossing: `thickness`, `albedo`, `g`, `nsamples` of the scene
/// format. Scattering in the gap is not simulated: gaps are optically thin, and light that scatters mostly goes on to
/// where it went anyway, so only the absorbed part of the extinction, (1 - albedo) thickness, counts. A warning says so.
float readOpticalThickness(MaterialInput& input);

/// The base is met every other of `maxdepth` events: (maxdepth + 1) / 2 times.
std::uint32_t readBaseBounces(MaterialInput& input);

/// Where the facet m sends light that comes from w, and how much; z > 0 is w's side, whichever that is.
template <class F>
struct FacetMeeting {
    Vec3<F> reflected, refracted;
    F up, down;  ///< fractions; of use only where reflected.z > 0, refracted.z < 0
};

/// `eta` relative to w's side, `inverse` 1 / eta.
template <class F>
FacetMeeting<F> meetFacet(const Ggx<F>& ggx, const Vec3<F>& w, const Vec3<F>& m, F eta, F inverse) {
    const F c = clamp(dot(w, m), F(0.f), F(1.f));
    const DielectricFresnel<F> fresnel = dielectricFresnel(c, eta);
    const Vec3<F> reflected = m * (F(2.f) * c) - w;
    const Vec3<F> refracted = (m * (c - fresnel.etaCosRefracted) - w) * inverse;
    return {reflected, refracted, fresnel.reflectance * ggx.shadowing(w, reflected),
            (F(1.f) - fresnel.reflectance) * ggx.shadowing(w, refracted)};
}

/// sum_{k < count} x^k per channel, by Horner's scheme; stops early where more terms change nothing.
template <class F>
Spectrum<F> geometricSum(const Spectrum<F>& x, const UInt<F>& count) {
    const Spectrum<F> one = Spectrum<F>::constant(F(1.f));
    Spectrum<F> sum = Spectrum<F>::constant(F(0.f));
    for (std::uint32_t k = 0;; ++k) {
        const Spectrum<F> next = select(UInt<F>(k) < count, sum * x + one, sum);
        if (all((next.r == sum.r) & (next.g == sum.g) & (next.b == sum.b))) return sum;
        sum = next;
    }
}

template <class F>
struct CoatInterface {
    F eta, inverseEta, opticalThickness;
    Ggx<F> ggx;
    Mask<F> smooth;

    /// A way that light goes on: a fraction 0 where there is none.
    struct Passage {
        Vec3<F> w;
        F fraction;
    };

    /// What the gap leaves of light that crosses it in a direction of this cosine.
    F crossing(F cosine) const { return exp(-opticalThickness / max(abs(cosine), F(1e-6f))); }

    /// Light from outside is refracted; w.z > 0.
    Passage enter(const Vec3<F>& w, const Vec2<F>& u) const {
        const FacetMeeting<F> f = meet(w, u, eta, inverseEta);
        return {f.refracted, select((w.z > F(0.f)) & (f.refracted.z < F(0.f)), f.down, F(0.f))};
    }
    /// Light from within, w.z > 0 (towards the interface), is sent back: the result points away from it.
    Passage sendBack(const Vec3<F>& w, const Vec2<F>& u) const {
        const FacetMeeting<F> f = meet(w, u, inverseEta, eta);
        return {-f.reflected, select((w.z > F(0.f)) & (f.reflected.z > F(0.f)), f.up, F(0.f))};
    }

    /// Rough lanes: light that leaves along wi (outside, z > 0) of what comes to the interface along v (towards it, z >
    /// 0).
    struct Exit {
        F fCos;     ///< f(v, wi) |cos wi|, of radiance: it loses the eta^2 that it gained on the way in
        F density;  ///< with which enter(wi) finds -v
    };
    Exit leave(const Vec3<F>& v, const Vec3<F>& wi) const {
        // The generalised half vector on wi's side, for wi outside and -v inside (Walter et al., eq. 16).
        Vec3<F> h = wi - v * eta;
        h = flipSign(h.z < F(0.f), h);
        const F h2 = max(lengthSquared(h), F(1e-30f)), inverse2 = F(1.f) / h2, inverse = sqrt(inverse2);
        const F outside = dot(wi, h) * inverse, inside = dot(v, h) * inverse;
        const Mask<F> meets = (outside > F(0.f)) & (inside > F(0.f)) & (v.z > F(0.f)) & (wi.z > F(0.f));
        const F density = ggx.density(h, h2);
        const F fresnel = dielectricFresnel(clamp(outside, F(0.f), F(1.f)), eta).reflectance;
        // Refraction has the Jacobian eta^2 |v.m| / |h|^2 where reflection has 1 / (4 wi.m).
        const F jacobian = F(4.f) * outside * inside * eta * eta * inverse2;
        const F value = ggx.reflection(v, wi, density).fCos * jacobian * (F(1.f) - fresnel);
        return {select(meets, value, F(0.f)), select(meets, ggx.reflection(wi, v, density).pdf * jacobian, F(0.f))};
    }

private:
    FacetMeeting<F> meet(const Vec3<F>& w, const Vec2<F>& u, F relative, F inverse) const {
        const Vec3<F> above{w.x, w.y, max(w.z, F(1e-7f))};
        Vec3<F> m{F(0.f), F(0.f), F(1.f)};
        if (any(!smooth)) m = select(smooth, m, ggx.sampleVisible(above, u));
        FacetMeeting<F> f = meetFacet(ggx, above, m, relative, inverse);
        if (any(smooth)) {
            const F up = dielectricFresnel(min(above.z, F(1.f)), relative).reflectance;
            f.up = select(smooth, up, f.up);
            f.down = select(smooth, F(1.f) - up, f.down);
        }
        return f;
    }
};

}  // namespace penumbra
