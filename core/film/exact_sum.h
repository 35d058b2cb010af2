// Exact sums: what makes a picture independent of the order in which its samples come.
//
// A sum is a 128-bit integer in units of 2^-64, so addition is associative and commutative. Summands go up to 2^33 in
// magnitude; what is smaller than 2^-64 is cut off. There is room for 2^30 of the largest.
#pragma once

#include "core/math/lanes.h"

#include <cstdint>

namespace penumbra {

inline constexpr float kLargestSummand = 0x1p33f;   ///< itself excluded

/// x in units of 2^-64, rounded towards zero. REQUIRES: |x| < 2^33.
inline __int128 toFixed(float x) {
    const std::uint32_t b = floatBits(x);
    const int exponent = int(b >> 23 & 0xFFu);
    const int shift = exponent - 86;   // value = mantissa * 2^(exponent - 150), and 150 - 64 = 86
    const __int128 mantissa = exponent == 0 ? 0 : __int128((b & 0x7FFFFFu) | 0x800000u);
    const __int128 magnitude = shift >= 0 ? mantissa << shift : shift > -24 ? mantissa >> -shift : 0;
    return b >> 31 ? -magnitude : magnitude;
}
/// Nearest double.
double fromFixed(__int128 x);

/// A 128-bit sum with the alignment of 64 bits, so that a pixel packs tightly.
struct ExactSum {
    std::uint64_t low = 0;
    std::int64_t high = 0;
    void add(__int128 x) {
        const __int128 sum = value() + x;
        low = std::uint64_t(sum);
        high = std::int64_t(sum >> 64);
    }
    __int128 value() const { return (__int128(high) << 64) | low; }
    friend bool operator==(const ExactSum&, const ExactSum&) = default;
};

}  // namespace penumbra
