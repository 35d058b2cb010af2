// Rgb: three linear colour values of cold code (the lanes of hot code have their own Spectrum<F>).
//
// Conventions: linear light, in the primaries of whatever ColorSpace goes with it. Values may be negative (colours
// outside the space) or beyond 1.
#pragma once

#include <algorithm>
#include <cmath>

namespace penumbra {

struct Rgb {
    float r = 0, g = 0, b = 0;

    friend Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
    friend Rgb operator-(Rgb a, Rgb b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
    friend Rgb operator*(Rgb a, Rgb b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
    friend Rgb operator*(Rgb a, float s) { return {a.r * s, a.g * s, a.b * s}; }
    friend Rgb operator*(float s, Rgb a) { return a * s; }
    friend Rgb operator/(Rgb a, float s) { return {a.r / s, a.g / s, a.b / s}; }
    friend bool operator==(const Rgb&, const Rgb&) = default;

    float largest() const { return std::max({r, g, b}); }
    float smallest() const { return std::min({r, g, b}); }
    float mean() const { return (r + g + b) / 3.f; }
    bool isFinite() const { return std::isfinite(r) && std::isfinite(g) && std::isfinite(b); }
};

inline Rgb clamp(Rgb c, float low, float high) {
    return {std::clamp(c.r, low, high), std::clamp(c.g, low, high), std::clamp(c.b, low, high)};
}

}  // namespace penumbra
