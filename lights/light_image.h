// Images on lights: their pixels are rows of numbers in LightTables, and a direction is answered by the nearest one, as
// the pbrt format has it.
#pragma once

#include "lights/light.h"

#include <cmath>

namespace penumbra {

/// Where the next `count` numbers of the tables will stand. Error(BadData) where lanes could not reach them all.
std::uint32_t roomForNumbers(const LightTables& tables, std::size_t count);

/// What is negative or not finite counts as black.
inline float usable(float x) {
    return std::isfinite(x) && x > 0.f ? x : 0.f;
}

/// The pixel of n at x in [0, 1]; what lies outside, or is not a number, takes a border's.
template <class F>
UInt<F> nearestPixel(F x, const UInt<F>& n) {
    const F size = toFloat<F>(n);
    return min(toUInt(clamp(x * size, F(0.f), size)), n - UInt<F>(1u));
}

}  // namespace penumbra
