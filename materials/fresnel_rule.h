// Which law of reflection a smooth border of matter follows: Fresnel's equations, or Schlick's approximation of them where a
// scene asks for it ("string fresnel" "schlick"), as renderers of other makes use it.
//
// Schlick: R = R0 + (1 - R0) (1 - cos)^5, with R0 of perpendicular light exact and cos on the thinner side, so that total
// reflection stays where it is; directions always follow Snell's law. For glass (1.5) it errs by -0.020 to 0.036; metals it
// makes too bright before grazing angles, where the exact curve has a dip: copper by 0.018, 0.039, 0.036, aluminium by 0.12.
// Thread safety: plain values. Source: Schlick, Computer Graphics Forum 13(3), 1994.
#pragma once

#include "materials/fresnel.h"
#include "materials/material.h"

namespace penumbra {

inline constexpr ParameterInfo kFresnelParameter{"string", "fresnel", "exact",
                                                 "exact, or schlick: Schlick's approximation"};

/// 1 for Schlick's approximation.
inline std::uint32_t readSchlick(MaterialInput& input) {
    const std::string rule = input.parameters().text("fresnel", "exact");
    if (rule != "exact" && rule != "schlick")
        input.fail("unknown fresnel " + quote(rule) + suggestion(rule, std::vector<std::string>{"exact", "schlick"}));
    return rule == "schlick";
}

/// What Schlick adds to R0 of what R0 lacks: (1 - cos)^5.
template <class F>
F schlickShare(F cosine) {
    const F x = F(1.f) - cosine, x2 = x * x;
    return x2 * x2 * x;
}

/// REQUIRES: eta > 0.
template <class F>
DielectricFresnel<F> schlickDielectric(F cosIncident, F eta) {
    const F gSquared = eta * eta - F(1.f) + cosIncident * cosIncident;
    const F g = safeSqrt(gSquared), perpendicular = sqr((eta - F(1.f)) / (eta + F(1.f)));
    const F share = schlickShare(min(select(eta < F(1.f), g / eta, cosIncident), F(1.f)));
    return {select(gSquared <= F(0.f), F(1.f), lerp(share, perpendicular, F(1.f))), g};
}

/// The law of a dielectric's lanes.
template <class F>
struct DielectricRule {
    Mask<F> schlick;

    DielectricFresnel<F> operator()(F cosIncident, F eta) const {
        const DielectricFresnel<F> exact = dielectricFresnel(cosIncident, eta);
        if (none(schlick)) return exact;
        const DielectricFresnel<F> approximate = schlickDielectric(cosIncident, eta);
        return {select(schlick, approximate.reflectance, exact.reflectance), exact.etaCosRefracted};
    }
};

/// The law of a conductor's lanes. Where it is Schlick's, index.difference is the reflectance of perpendicular light.
template <class F>
struct ConductorRule {
    ConductorConstants<Spectrum<F>> index;
    Mask<F> schlick;

    Spectrum<F> operator()(F cosIncident) const {
        if (none(schlick)) return conductorReflectance(cosIncident, index);
        const F share = schlickShare(cosIncident);
        const Spectrum<F> approximate = index.difference * (F(1.f) - share) + Spectrum<F>::constant(share);
        if (all(schlick)) return approximate;
        return select(schlick, approximate, conductorReflectance(cosIncident, index));
    }
};

}  // namespace penumbra
