// Integer hashes over lanes: the source of all randomness. Nothing here keeps state.
#pragma once

#include "core/math/lanes.h"

namespace penumbra {

/// A bijection of 32 bits with good avalanche (the "lowbias32" constants of Wellons' hash prospector, bias 0.17).
template <class U>
U mixBits(U x) {
    x = x ^ (x >> 16);
    x = x * U(0x21F0AAADu);
    x = x ^ (x >> 15);
    x = x * U(0x735A2D97u);
    x = x ^ (x >> 15);
    return x;
}

/// Hash of a sequence: combine(combine(seed, a), b).
template <class U>
U combineBits(U h, U x) {
    return mixBits(h ^ (x * U(0x9E3779B9u) + U(0x85EBCA6Bu)));
}

/// Uniform in [0, 1) on a grid of 2^-24: never 1.
template <class F>
F unitFloat(UInt<F> x) {
    return toFloat<F>(x >> 8) * F(0x1p-24f);
}

}  // namespace penumbra
