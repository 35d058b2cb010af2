// Generator matrices of the first dimensions of the Sobol sequence, in a form that eight lanes can apply.
//
// Direction numbers: Joe & Kuo 2008 (SIAM J. Sci. Comput. 30, "new-joe-kuo-6"). A product with a 32x32 matrix over GF(2) is the
// XOR of the columns that the index selects; here columns are taken three at a time through tables of eight entries, which
// one permute instruction looks up in all lanes.
#pragma once

#include "core/math/lanes.h"

namespace penumbra {

inline constexpr int kSobolDimensions = 9;
/// Indices below 2^this take a short cut.
inline constexpr int kSobolShortBits = 12;

namespace detail {

/// entry[d][k][b]: XOR of the columns 3k + j for the set bits j of b, with the bit order of the result reversed (most
/// significant digit of the point in bit 0), as the scrambling hash wants it.
struct SobolTables {
    alignas(32) std::uint32_t entry[kSobolDimensions][11][8];
    constexpr SobolTables() : entry{} {
        struct Polynomial { unsigned degree, coefficients, m[5]; };
        constexpr Polynomial kPolynomials[kSobolDimensions] = {
            {0, 0, {}}, {1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}, {3, 2, {1, 1, 1}},
            {4, 1, {1, 1, 3, 3}}, {4, 4, {1, 3, 5, 13}}, {5, 2, {1, 1, 5, 5, 17}},
            {5, 4, {1, 1, 5, 5, 5}}};
        for (int d = 0; d < kSobolDimensions; ++d) {
            std::uint32_t v[33] = {};
            const Polynomial& p = kPolynomials[d];
            for (unsigned i = 0; i < 32; ++i) {
                if (d == 0) v[i] = 0x80000000u >> i;
                else if (i < p.degree) v[i] = p.m[i] << (31 - i);
                else {
                    v[i] = v[i - p.degree] ^ (v[i - p.degree] >> p.degree);
                    for (unsigned k = 1; k < p.degree; ++k)
                        if (p.coefficients >> (p.degree - 1 - k) & 1u) v[i] ^= v[i - k];
                }
            }
            for (int k = 0; k < 11; ++k)
                for (unsigned b = 0; b < 8; ++b) {
                    std::uint32_t x = 0;
                    for (int j = 0; j < 3 && 3 * k + j < 32; ++j)
                        if (b >> j & 1u) x ^= v[3 * k + j];
                    std::uint32_t reversed = 0;
                    for (int i = 0; i < 32; ++i) reversed |= (x >> i & 1u) << (31 - i);
                    entry[d][k][b] = reversed;
                }
        }
    }
};
inline constexpr SobolTables kSobol{};

}  // namespace detail

/// Coordinate `dimension` of point `index` as a 32-bit fraction with reversed bit order.
template <class U>
U sobolReversed(U index, int dimension) {
    if (dimension == 0) return index;
    const auto& table = detail::kSobol.entry[dimension];
    U x = lookup8(table[0], index);
    for (int k = 1; k < kSobolShortBits / 3; ++k) x = x ^ lookup8(table[k], index >> (3 * k));
    if (any((index >> kSobolShortBits) != U(0u))) [[unlikely]]
        for (int k = kSobolShortBits / 3; k < 11; ++k) x = x ^ lookup8(table[k], index >> (3 * k));
    return x;
}

}  // namespace penumbra
