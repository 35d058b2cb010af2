// sin, cos, exp, log, pow, atan2, asin, acos, besselI0Scaled over lanes: our own, because the C library picks variants by
// processor and so would not give the same bits everywhere (and has none for eight lanes).
//
// Method: argument reduction and minimax polynomials (degrees as in the classical single-precision Cephes set); the
// accuracy stated at each function is measured by tests/core_lane_math_test.cpp.
#pragma once

#include "core/math/lanes.h"

#include <limits>

namespace penumbra {

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kTwoPi = 6.28318530717958647692f;
inline constexpr float kHalfPi = 1.57079632679489661923f;
inline constexpr float kInvPi = 0.31830988618379067154f;
inline constexpr float kInvTwoPi = 0.15915494309189533577f;
inline constexpr float kInvFourPi = 0.07957747154594766788f;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// The largest float below one.
inline constexpr float kOneMinusEpsilon = 0x1.fffffep-1f;

/// Sine and cosine together; |x| <= 8192, absolute error below 1e-7.
template <class F>
inline void sinCos(F x, F& s, F& c) {
    // x = n pi/2 + r, |r| <= pi/4; pi/2 in three parts so that n times each of the first two is exact.
    const F n = roundToEven(x * F(0.63661977236758134f));
    const F r = ((x - n * F(1.5703125f)) - n * F(4.837512969970703125e-4f)) - n * F(7.549789948768648e-8f);
    const F r2 = r * r;
    const F sinR = r + r * r2 * (F(-1.6666654611e-1f) + r2 * (F(8.3321608736e-3f) + r2 * F(-1.9515295891e-4f)));
    const F cosR = (F(1.f) - F(0.5f) * r2) +
                   r2 * r2 * (F(4.166664568298827e-2f) + r2 * (F(-1.388731625493765e-3f) + r2 * F(2.443315711809948e-5f)));
    const Int<F> q = toInt(n);
    const Mask<F> swap = (q & Int<F>(1)) != Int<F>(0);
    const F a = select(swap, cosR, sinR), b = select(swap, sinR, cosR);
    s = flipSign((q & Int<F>(2)) != Int<F>(0), a);
    c = flipSign(((q + Int<F>(1)) & Int<F>(2)) != Int<F>(0), b);
}
template <class F> inline F sin(F x) { F s, c; sinCos(x, s, c); return s; }
template <class F> inline F cos(F x) { F s, c; sinCos(x, s, c); return c; }

/// e^x; relative error below 1.5e-7; 0 below -87.3, clamped to about 1.6e38 above 88.
template <class F>
inline F exp(F x) {
    const F y = clamp(x, F(-87.3365f), F(88.0f));
    const F n = roundToEven(y * F(1.44269504088896341f));
    const F r = (y - n * F(0.693359375f)) - n * F(-2.12194440e-4f);
    const F p = F(5.0000001201e-1f) +
                r * (F(1.6666665459e-1f) +
                     r * (F(4.1665795894e-2f) + r * (F(8.3334519073e-3f) + r * (F(1.3981999507e-3f) + r * F(1.9875691500e-4f)))));
    const F e = (r * r * p + r) + F(1.f);
    const F scale = floatFromBits(asUInt((toInt(n) + Int<F>(127)) << 23));
    return select(x < F(-87.3365f), F(0.f), e * scale);
}

/// Natural logarithm of x > 0 (normal); relative error below 2e-7 away from 1, absolute below 1e-7 near it. log(0) = -inf.
template <class F>
inline F log(F x) {
    const UInt<F> b = floatBits(x);
    Int<F> e = asInt(b >> 23) - Int<F>(126);
    F m = floatFromBits((b & UInt<F>(0x007FFFFFu)) | UInt<F>(0x3F000000u));   // in [0.5, 1)
    const Mask<F> small = m < F(0.70710678118654752f);
    e = select(small, e - Int<F>(1), e);
    m = select(small, m + m, m) - F(1.f);
    const F z = m * m;
    const F p =
        m * z *
        (F(3.3333331174e-1f) +
         m * (F(-2.4999993993e-1f) +
              m * (F(2.0000714765e-1f) +
                   m * (F(-1.6668057665e-1f) +
                        m * (F(1.4249322787e-1f) +
                             m * (F(-1.2420140846e-1f) +
                                  m * (F(1.1676998740e-1f) + m * (F(-1.1514610310e-1f) + m * F(7.0376836292e-2f)))))))));
    const F ef = toFloat<F>(e);
    const F y = (p + ef * F(-2.12194440e-4f)) - F(0.5f) * z;
    return select(x <= F(0.f), F(-kInfinity), (m + y) + ef * F(0.693359375f));
}

/// x^y for x >= 0; relative error about 1e-7 (1 + |y log x|); 0^y = 0 for y > 0.
template <class F>
inline F pow(F x, F y) {
    return select(x <= F(0.f), select(y == F(0.f), F(1.f), F(0.f)), exp(y * log(max(x, F(1.17549435e-38f)))));
}

/// Arc tangent of y/x in the right quadrant, in (-pi, pi]; absolute error below 4e-7. atan2(0, 0) = 0.
template <class F>
inline F atan2(F y, F x) {
    const F ax = abs(x), ay = abs(y);
    const F hi = max(ax, ay), lo = min(ax, ay);
    const F t = select(hi > F(0.f), lo / max(hi, F(1.17549435e-38f)), F(0.f));   // in [0, 1]
    // atan t = pi/4 + atan((t-1)/(t+1)) above tan(pi/8)
    const Mask<F> upper = t > F(0.4142135623730950f);
    const F u = select(upper, (t - F(1.f)) / (t + F(1.f)), t);
    const F z = u * u;
    F a = u + u * z * (F(-3.33329491539e-1f) + z * (F(1.99777106478e-1f) + z * (F(-1.38776856032e-1f) + z * F(8.05374449538e-2f))));
    a = select(upper, a + F(0.78539816339744831f), a);
    a = select(ay > ax, F(kHalfPi) - a, a);
    a = select(x < F(0.f), F(kPi) - a, a);
    return copySign(a, y);
}

/// Arc sine, arguments clamped to [-1, 1]; absolute error below 4e-7.
template <class F>
inline F asin(F x) {
    const F a = min(abs(x), F(1.f));
    const Mask<F> large = a > F(0.5f);
    const F z = select(large, F(0.5f) * (F(1.f) - a), a * a);
    const F s = select(large, sqrt(z), a);
    const F p = s + s * z *
                        (F(1.6666752422e-1f) +
                         z * (F(7.4953002686e-2f) + z * (F(4.5470025998e-2f) + z * (F(2.4181311049e-2f) + z * F(4.2163199048e-2f)))));
    return copySign(select(large, F(kHalfPi) - F(2.f) * p, p), x);
}
template <class F> inline F acos(F x) {
    // Through asin of the half angle near +-1, where pi/2 - asin(x) would cancel.
    const F a = min(abs(x), F(1.f));
    const F near = F(2.f) * asin(sqrt(F(0.5f) * (F(1.f) - a)));
    const F far = F(kHalfPi) - asin(a);
    const F positive = select(a > F(0.5f), near, far);
    return select(x < F(0.f), F(kPi) - positive, positive);
}

/// e^-x I0(x), I0 the modified Bessel function of the first kind and order 0, for x >= 0; relative error below 6e-7
/// (Abramowitz & Stegun 1964, 9.8.1 and 9.8.2).
template <class F>
inline F besselI0Scaled(F x) {
    const F t = sqr(x * F(1.f / 3.75f)), inverse = F(3.75f) / max(x, F(3.75f));
    const F low = F(1.f) +
                  t * (F(3.5156229f) +
                       t * (F(3.0899424f) +
                            t * (F(1.2067492f) + t * (F(0.2659732f) + t * (F(0.0360768f) + t * F(0.0045813f))))));
    const F high = F(0.39894228f) +
                   inverse * (F(0.01328592f) +
                              inverse * (F(0.00225319f) +
                                         inverse * (F(-0.00157565f) +
                                                    inverse * (F(0.00916281f) +
                                                               inverse * (F(-0.02057706f) +
                                                                          inverse * (F(0.02635537f) +
                                                                                     inverse * (F(-0.01647633f) +
                                                                                                inverse * F(0.00392377f))))))));
    return select(x < F(3.75f), low * exp(-x), high / sqrt(max(x, F(3.75f))));
}

}  // namespace penumbra
