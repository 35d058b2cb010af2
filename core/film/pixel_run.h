// Samples of one pixel on their way to a film without further planes: values of everyday size, whose sums fit into 64 bits
// exactly, are summed here at a fraction of the cost, one or eight at a time.
#pragma once

#include "core/math/lanes.h"
#include "core/math/spectrum.h"

#include <bit>
#include <cstdint>

namespace penumbra {

namespace detail {
using V4d = double __attribute__((vector_size(32)));
using V4l = std::int64_t __attribute__((vector_size(32)));

/// Whole numbers below 2^51 in magnitude, as integers: there is no instruction for that, but next to 1.5 * 2^52 they stand in
/// the last bits of a double.
inline V4l toIntegers(V4d whole) {
    const V4d shift = V4d{} + 0x1.8p52;
    return V4l(whole + shift) - V4l(shift);
}
inline std::int64_t sum(V4l v) { return v[0] + v[1] + v[2] + v[3]; }
}  // namespace detail

/// At most kMost samples; a plain value.
class PixelRun {
public:
    static constexpr int kMost = 4096;

    /// As Film::add; false, and nothing is done, where the value is not of everyday size.
    bool add(const Spectrum<float>& value, float sign, bool hit) noexcept {
        const float channel[3] = {value.r, value.g, value.b};
        for (float v : channel)
            if (!isEveryday(v)) return false;
        for (int c = 0; c < 3; ++c) {
            const double v = double(channel[c]);
            values_[c][0] += std::int64_t(v * 0x1p40);
            squares_[c][0] += std::int64_t(v * v * 0x1p40);
        }
        ++samples_;
        covered_ += hit ? (sign < 0.f ? -1 : 1) : 0;
        return true;
    }

    /// The same for eight; all or none.
    bool add(const Spectrum<Lanes8f>& value, Lanes8f sign, Mask8 hit) noexcept {
        const Lanes8f channel[3] = {value.r, value.g, value.b};
        if (!all(isEveryday(channel[0]) & isEveryday(channel[1]) & isEveryday(channel[2]))) return false;
        for (int c = 0; c < 3; ++c) {
            const __m256 v = __m256(channel[c].v);
            addFour(c, _mm256_cvtps_pd(_mm256_castps256_ps128(v)));
            addFour(c, _mm256_cvtps_pd(_mm256_extractf128_ps(v, 1)));
        }
        samples_ += 8;
        const unsigned met = bits(hit), negative = bits(Mask8(sign < Lanes8f(0.f)));
        covered_ += std::popcount(met & ~negative) - std::popcount(met & negative);
        return true;
    }

    std::uint32_t samples() const { return samples_; }
    std::int32_t covered() const { return covered_; }   ///< as PixelSums
    std::int64_t value(int c) const { return detail::sum(values_[c]); }   ///< in units of 2^-40
    std::uint64_t squares(int c) const { return std::uint64_t(detail::sum(squares_[c])); }   ///< as PixelSquares

private:
    /// 0, or at least 2^-17, which has no bits below 2^-40, and below 2^5, of which kMost squares stay below 2^62.
    template <class F>
    static Mask<F> isEveryday(F v) {
        constexpr std::uint32_t kLeast = std::bit_cast<std::uint32_t>(0x1p-17f), kEnd = std::bit_cast<std::uint32_t>(0x1p5f);
        const UInt<F> magnitude = floatBits(v) & UInt<F>(0x7FFFFFFFu);
        return (magnitude == UInt<F>(0u)) | (magnitude - UInt<F>(kLeast) < UInt<F>(kEnd - kLeast));
    }
    void addFour(int c, __m256d x) {
        const detail::V4d v = detail::V4d(x), unit = detail::V4d{} + 0x1p40;
        values_[c] += detail::toIntegers(v * unit);
        const __m256d squares = _mm256_round_pd(__m256d(v * v * unit), _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
        squares_[c] += detail::toIntegers(detail::V4d(squares));
    }

    detail::V4l values_[3] = {}, squares_[3] = {};   ///< the four of a channel count together
    std::uint32_t samples_ = 0;
    std::int32_t covered_ = 0;
};

}  // namespace penumbra
