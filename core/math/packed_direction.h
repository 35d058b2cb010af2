// A unit vector in one word, to 16 bits a coordinate of the octahedral map (Cigolle et al. 2014, "A survey of efficient
// representations for independent unit vectors", JCGT 3(2)): off by at most 5e-5.
#pragma once

#include "core/math/vector.h"

namespace penumbra {

template <class F>
UInt<F> packDirection(const Vec3<F>& d) {
    const F scale = F(1.f) / (abs(d.x) + abs(d.y) + abs(d.z));
    const F x = d.x * scale, y = d.y * scale;
    const Mask<F> lower = d.z < F(0.f);
    const F u = select(lower, copySign(F(1.f) - abs(y), x), x), v = select(lower, copySign(F(1.f) - abs(x), y), y);
    const auto step = [](F t) { return toUInt(clamp(t * F(32767.f) + F(32767.5f), F(0.f), F(65535.f))); };
    return step(u) | (step(v) << 16);
}

template <class F>
Vec3<F> unpackDirection(const UInt<F>& word) {
    const auto coordinate = [](const UInt<F>& step) { return toFloat<F>(step) * F(1.f / 32767.f) - F(1.f); };
    const F u = coordinate(word & UInt<F>(0xFFFFu)), v = coordinate(word >> 16);
    const F z = F(1.f) - abs(u) - abs(v);
    const Mask<F> lower = z < F(0.f);
    const F x = select(lower, copySign(F(1.f) - abs(v), u), u), y = select(lower, copySign(F(1.f) - abs(u), v), v);
    return normalize(Vec3<F>{x, y, z});
}

}  // namespace penumbra
