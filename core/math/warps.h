// Maps from the unit square to the domains that rendering samples, and their densities.
#pragma once

#include "core/math/vector.h"

namespace penumbra {

/// True where the uniform number u falls below p; the part of the unit interval that it fell into is then stretched to a whole
/// one, so that u can decide something else. `u` stays below 1.
template <class F>
Mask<F> takeBelow(F p, F& u) {
    const Mask<F> below = u < p;
    const F low = select(below, F(0.f), p), length = select(below, p, F(1.f) - p);
    u = min((u - low) / max(length, F(1e-20f)), F(kOneMinusEpsilon));
    return below;
}

/// Uniform on the unit disk, by the concentric map (Shirley & Chiu 1997, J. Graphics Tools 2(3)): area-preserving and
/// continuous, so that stratification survives.
template <class F>
Vec2<F> concentricDisk(const Vec2<F>& u) {
    const F x = F(2.f) * u.x - F(1.f), y = F(2.f) * u.y - F(1.f);
    const Mask<F> wide = abs(x) > abs(y);
    const F r = select(wide, x, y), other = select(wide, y, x);
    const F phi = select(r == F(0.f), F(0.f), other / select(r == F(0.f), F(1.f), r)) * F(kPi / 4.f);
    F s, c;
    sinCos(phi, s, c);
    return {r * select(wide, c, s), r * select(wide, s, c)};
}

/// Cosine-weighted about +z (density cos / pi per solid angle; Malley's method).
template <class F>
Vec3<F> cosineHemisphere(const Vec2<F>& u) {
    const Vec2<F> d = concentricDisk(u);
    return {d.x, d.y, safeSqrt(F(1.f) - d.x * d.x - d.y * d.y)};
}

/// Uniform on the unit sphere (density 1 / 4 pi per solid angle).
template <class F>
Vec3<F> uniformSphere(const Vec2<F>& u) {
    const F z = F(1.f) - F(2.f) * u.x, r = safeSqrt(F(1.f) - z * z);
    F s, c;
    sinCos(F(kTwoPi) * u.y, s, c);
    return {r * c, r * s, z};
}

}  // namespace penumbra
