// Fresnel's equations for unpolarised light, over lanes.
//
// Conventions: cosines are those of the angle to the (micro)normal on the incident side, in [0, 1]; eta is the index of
// the far side over that of the incident side. Thread safety: pure functions. Source: Born & Wolf, Principles of
// Optics, 1.5.2 (dielectrics) and 14.2 (metals). Both are brought to one division.
#pragma once

#include "core/math/spectrum.h"
#include "core/math/vector.h"

namespace penumbra {

/// What an interface between dielectrics does at one angle.
template <class F>
struct DielectricFresnel {
    F reflectance;      ///< 1 where total; never above 1
    F etaCosRefracted;  ///< eta times the cosine of the refracted direction; 0 where reflection is total
};

/// REQUIRES: eta > 0.
template <class F>
DielectricFresnel<F> dielectricFresnel(F cosIncident, F eta) {
    const F etaSquared = eta * eta;
    const F c = cosIncident;
    const F gSquared = etaSquared - F(1.f) + c * c;  // (eta cos refracted)^2, by Snell's law
    const Mask<F> total = gSquared <= F(0.f);
    const F g = safeSqrt(gSquared);
    // R = ((s-/s+)^2 + (p-/p+)^2) / 2 with the s and p amplitudes below, on one denominator.
    const F sMinus = c - g, sPlus = c + g;
    const F pMinus = etaSquared * c - g, pPlus = etaSquared * c + g;
    const F numerator = sqr(sMinus * pPlus) + sqr(pMinus * sPlus);
    const F denominator = max(sqr(sPlus * pPlus), F(1e-30f));
    return {select(total, F(1.f), min(F(0.5f) * numerator / denominator, F(1.f))), g};
}

/// What conductorReflectance wants to know of the complex index eta + i k, relative to the incident side.
template <class T>
struct ConductorConstants {
    T difference;  ///< eta^2 - k^2
    T product;     ///< (2 eta k)^2
};

/// The index 1 + i k that reflects r of perpendicular light; r = 1 would need k without end.
template <class F>
ConductorConstants<F> constantsOfReflectance(F reflectance) {
    const F r = min(reflectance, F(0.9999f)), kSquared = F(4.f) * r / (F(1.f) - r);
    return {F(1.f) - kSquared, F(4.f) * kSquared};
}

template <class F>
F conductorReflectance(F cosIncident, F difference, F product) {
    const F c = cosIncident, c2 = c * c, s2 = F(1.f) - c2;
    const F t = difference - s2;
    const F modulus = sqrt(t * t + product);  // a^2 + b^2, where (a + i b)^2 = (eta + i k)^2 - sin^2
    const F a = safeSqrt(F(0.5f) * (modulus + t));
    const F sSum = modulus + c2, sDifference = F(2.f) * a * c;  // R_s = (sum - difference) / (sum + difference)
    const F pSum = modulus * c2 + s2 * s2, pDifference = sDifference * s2;  // R_p = R_s times the same of these
    // (R_s + R_p) / 2 = R_s (1 + R_p / R_s) / 2 = R_s pSum / (pSum + pDifference)
    const F denominator = max((sSum + sDifference) * (pSum + pDifference), F(1e-30f));
    return clamp((sSum - sDifference) * pSum / denominator, F(0.f), F(1.f));
}

/// Per channel. Grey metals (a reflectance without colour) are worth the look: most of a conductor's time goes here.
template <class F>
Spectrum<F> conductorReflectance(F cosIncident, const ConductorConstants<Spectrum<F>>& index) {
    const auto& [difference, product] = index;
    const F r = conductorReflectance(cosIncident, difference.r, product.r);
    if (all((difference.r == difference.g) & (difference.g == difference.b) & (product.r == product.g) &
            (product.g == product.b)))
        return Spectrum<F>::constant(r);
    return {r, conductorReflectance(cosIncident, difference.g, product.g),
            conductorReflectance(cosIncident, difference.b, product.b)};
}

}  // namespace penumbra
