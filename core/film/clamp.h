// A limit on the samples of a picture (--clamp, the film's maxcomponentvalue): less noise for a bias, and how large it is.
//
// A sample whose largest component is above the limit is scaled down to it as a whole, so its hue stays. A picture made so is
// too dark by what its samples lost; that is summed exactly, as the film sums, so it is the same in any order.
#pragma once

#include "core/film/film.h"

namespace penumbra {

/// Scales `value` down to the limit. Returns what it lost: black where it was within.
inline Spectrum<float> limitSample(Spectrum<float>& value, float limit) {
    const float largest = maxComponent(value);
    if (!(largest > limit)) return Spectrum<float>::constant(0.f);
    const Spectrum<float> whole = value;
    value = value * (limit / largest);
    return whole - value;
}

/// What the limit took from samples.
struct ClampedLight {
    std::uint64_t samples = 0;   ///< that lost something

    /// `lost`: times the sign of the filter, as samples are; finite. More than 2^56 counts as that.
    void add(const Spectrum<float>& lost) noexcept {
        constexpr float kMost = 0x1p56f;
        ++samples;
        const float channel[3] = {lost.r, lost.g, lost.b};
        for (int c = 0; c < 3; ++c) sums_[c].add(toFixed(min(max(channel[c], -kMost), kMost) * kUnit));
    }
    void add(const ClampedLight& other) noexcept {
        samples += other.samples;
        for (int c = 0; c < 3; ++c) sums_[c].add(other.sums_[c].value());
    }
    double sum(std::size_t channel) const { return fromFixed(sums_[channel].value()) / double(kUnit); }

private:
    /// A power of two, so that scaling is exact, and room for 2^39 samples of the largest size.
    static constexpr float kUnit = 0x1p-32f;
    ExactSum sums_[3];
};

}  // namespace penumbra
