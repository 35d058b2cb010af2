// Spectrum: the quantity that light carries along a path. Linear RGB in the film's colour space now; a mode with four
// hero wavelengths replaces this type alone, because colours enter transport only through the scene's builder and leave
// it only through the film.
#pragma once

#include "core/math/lanes.h"

namespace penumbra {

template <class F>
struct Spectrum {
    F r, g, b;
    static Spectrum constant(F x) { return {x, x, x}; }
    friend Spectrum operator+(const Spectrum& a, const Spectrum& b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
    friend Spectrum operator-(const Spectrum& a, const Spectrum& b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
    friend Spectrum operator*(const Spectrum& a, const Spectrum& b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
    friend Spectrum operator/(const Spectrum& a, const Spectrum& b) { return {a.r / b.r, a.g / b.g, a.b / b.b}; }
    friend Spectrum operator*(const Spectrum& a, F s) { return {a.r * s, a.g * s, a.b * s}; }
    friend Spectrum operator*(F s, const Spectrum& a) { return {a.r * s, a.g * s, a.b * s}; }
    Spectrum& operator+=(const Spectrum& b) { r += b.r; g += b.g; this->b += b.b; return *this; }
    Spectrum& operator*=(const Spectrum& s) { r *= s.r; g *= s.g; b *= s.b; return *this; }
    Spectrum& operator*=(F s) { r *= s; g *= s; b *= s; return *this; }
};

template <class F> F maxComponent(const Spectrum<F>& s) { return max(s.r, max(s.g, s.b)); }
template <class F> F average(const Spectrum<F>& s) { return (s.r + s.g + s.b) * F(1.f / 3.f); }
template <class F> Mask<F> isBlack(const Spectrum<F>& s) { return (s.r == F(0.f)) & (s.g == F(0.f)) & (s.b == F(0.f)); }
template <class F> Spectrum<F> select(const Mask<F>& m, const Spectrum<F>& a, const Spectrum<F>& b) {
    return {select(m, a.r, b.r), select(m, a.g, b.g), select(m, a.b, b.b)};
}
template <class F> Spectrum<float> lane(const Spectrum<F>& a, int i) { return {lane(a.r, i), lane(a.g, i), lane(a.b, i)}; }

}  // namespace penumbra
