// The equal-area octahedral map between the unit square and the sphere of directions (Clarberg 2008, "Fast equal-area
// mapping of the (hemi)sphere using SIMD", J. Graphics Tools 13(3)), which environment images of the pbrt format use:
// every pixel of an n x n image covers 4 pi / n^2 steradians.
//
// Conventions: (s, t) in [0, 1]^2, t grows downwards in the image; +z is the centre of the square, -z its four corners,
// +x the middle of the right edge, +y the middle of the bottom edge.
#pragma once

#include "core/math/vector.h"

namespace penumbra {

template <class F>
Vec3<F> equalAreaDirection(const Vec2<F>& st) {
    const F u = F(2.f) * st.x - F(1.f), v = F(2.f) * st.y - F(1.f);
    const F au = abs(u), av = abs(v);
    const F side = (F(1.f) - au) - av;  // positive in the upper half
    const F r = F(1.f) - abs(side);
    const F turn = select(r > F(0.f), (av - au) / select(r > F(0.f), r, F(1.f)), F(0.f));
    F s, c;
    sinCos(F(kPi / 4.f) * (F(1.f) + turn), s, c);
    const F rho = r * safeSqrt(F(2.f) - r * r);
    return {copySign(rho * c, u), copySign(rho * s, v), copySign(F(1.f) - r * r, side)};
}

/// The place of a unit vector.
template <class F>
Vec2<F> equalAreaSquare(const Vec3<F>& d) {
    const F x = abs(d.x), y = abs(d.y), z = abs(d.z);
    // r = sqrt(1 - |z|), without the cancellation near the poles.
    const F r = sqrt((x * x + y * y) / (F(1.f) + z));
    const F b = r * (atan2(y, x) * F(2.f * kInvPi)), a = r - b;
    const Mask<F> lower = d.z < F(0.f);
    const F s = select(lower, F(1.f) - b, a), t = select(lower, F(1.f) - a, b);
    return {F(0.5f) * (F(1.f) + copySign(s, d.x)), F(0.5f) * (F(1.f) + copySign(t, d.y))};
}

}  // namespace penumbra
