// Gradient noise over lanes, and its sums over octaves.
//
// The noise is Perlin's improved one (SIGGRAPH 2002) with his permutation and the assignment of gradients that pbrt
// has: 0 at the points of the integer lattice, continuous with two derivatives, mostly within (-1, 1), with a period of
// 256. Places that are not finite count as lattice points.
//
// Octaves: number i has 1.99^i times the frequency and omega^i times the amplitude of the first. `width` is the
// footprint of the look-up: octaves whose waves it covers are left out, those near the limit fade (pbrt: Pharr, Jakob,
// Humphreys, Physically Based Rendering, 3rd ed., 10.6.3).
#pragma once

#include "core/math/vector.h"

#include <array>

namespace penumbra {
namespace detail {

inline constexpr std::array<std::uint32_t, 256> kNoisePermutation{
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

/// The cell of the lattice, modulo its period, and the place within it.
template <class F>
struct LatticePlace {
    UInt<F> cell;
    F offset;

    explicit LatticePlace(F x) {
        const F whole = floor(x);
        cell = toUInt(clamp(whole - F(256.f) * floor(whole * F(1.f / 256.f)), F(0.f), F(255.f)));  // NaN becomes 0
        offset = clamp(x - whole, F(0.f), F(1.f));
    }
    F fade() const { return offset * offset * offset * (offset * (offset * F(6.f) - F(15.f)) + F(10.f)); }
};

template <class F>
UInt<F> permute(const UInt<F>& i) {
    return gather(kNoisePermutation.data(), i & UInt<F>(255u));
}

/// The gradient that the hash chooses, times the vector from its corner.
template <class F>
F gradientDot(const UInt<F>& hash, F x, F y, F z) {
    const UInt<F> h = hash & UInt<F>(15u);
    const Mask<F> diagonal = (h & UInt<F>(14u)) == UInt<F>(12u);  // 12 or 13
    const F u = select((h < UInt<F>(8u)) | diagonal, x, y), v = select((h < UInt<F>(4u)) | diagonal, y, z);
    return flipSign((h & UInt<F>(1u)) != UInt<F>(0u), u) + flipSign((h & UInt<F>(2u)) != UInt<F>(0u), v);
}

}  // namespace detail

template <class F>
F gradientNoise(const Vec3<F>& p) {
    using namespace detail;
    const LatticePlace<F> x(p.x), y(p.y), z(p.z);
    const UInt<F> one(1u);
    const F back(1.f);
    const auto blend = [](F a, F b, F weight) { return a + (b - a) * weight; };
    // Both ends of the edge along z, of the edges along x in a face, of the two faces.
    const auto alongZ = [&](const UInt<F>& hash, F dx, F dy) {
        return blend(gradientDot(permute<F>(hash + z.cell), dx, dy, z.offset),
                     gradientDot(permute<F>(hash + z.cell + one), dx, dy, z.offset - back), z.fade());
    };
    const auto alongY = [&](const UInt<F>& column, F dx) {
        return blend(alongZ(permute<F>(column + y.cell), dx, y.offset),
                     alongZ(permute<F>(column + y.cell + one), dx, y.offset - back), y.fade());
    };
    return blend(alongY(permute<F>(x.cell), x.offset), alongY(permute<F>(x.cell + one), x.offset - back), x.fade());
}

struct Octaves {
    int count = 8;
    float omega = 0.5f;
};

namespace detail {

/// Sums amplitude times term(noise, share) over the octaves; share is 1 where the octave counts whole, 0 where it is
/// covered.
template <class F, class Term>
F sumOctaves(const Vec3<F>& p, F width, const Octaves& octaves, const Term& term) {
    const F log2Width = log(max(width, F(1e-30f))) * F(1.44269504088896341f);
    const F whole = clamp(F(-1.f) - log2Width, F(0.f), F(float(octaves.count)));
    F sum(0.f);
    float frequency = 1.f, amplitude = 1.f;
    for (int i = 0; i < octaves.count; ++i, frequency *= 1.99f, amplitude *= octaves.omega) {
        const F part = clamp((whole - F(float(i)) - F(0.3f)) * F(1.f / 0.4f), F(0.f), F(1.f));
        const F share = part * part * (F(3.f) - F(2.f) * part);
        F noise(0.f);
        if (any(share > F(0.f))) noise = gradientNoise(p * F(frequency));
        sum += F(amplitude) * term(noise, share);
    }
    return sum;
}

}  // namespace detail

/// Fractional Brownian motion: the sum of the octaves.
template <class F>
F brownianNoise(const Vec3<F>& p, F width, const Octaves& octaves) {
    return detail::sumOctaves(p, width, octaves, [](F noise, F share) { return noise * share; });
}

/// The sum of the octaves' absolute values. What is left out counts as 0.2, about its mean.
template <class F>
F turbulentNoise(const Vec3<F>& p, F width, const Octaves& octaves) {
    return detail::sumOctaves(p, width, octaves,
                              [](F noise, F share) { return F(0.2f) + (abs(noise) - F(0.2f)) * share; });
}

}  // namespace penumbra
