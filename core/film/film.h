// Film: exact sums of samples, per pixel and replicate plane.
//
// Sums are exact (exact_sum.h): thread count, order, resume and merging of parts cannot change a bit. Sample values go up to
// 2^33 in magnitude. With one plane (R = 1) the film also keeps sums of squares, in units of 2^-40 in 64 bits, saturating; a saturated pixel's
// error is unknown (NaN). With R >= 2 planes, sample i goes to plane i mod R and the error comes from the planes' means.
//
// Conventions: pixels are those of the crop window, row by row from the top left; a sample is already L times the sign of
// the filter, in sensor RGB. Thread safety: a pixel belongs to one thread at a time; different pixels are independent.
#pragma once

#include "core/film/aov.h"
#include "core/film/exact_sum.h"
#include "core/film/pixel_run.h"
#include "core/math/spectrum.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra {

/// One pixel of one plane.
struct PixelSums {
    ExactSum value[3];
    std::uint32_t samples = 0;
    std::int32_t covered = 0;      ///< samples that hit something, each with the sign of the filter: alpha
    friend bool operator==(const PixelSums&, const PixelSums&) = default;
};

/// Sums of squares of one pixel (R = 1); all ones: saturated.
struct PixelSquares {
    std::uint64_t value[3] = {0, 0, 0};
    friend bool operator==(const PixelSquares&, const PixelSquares&) = default;
};
inline constexpr std::uint64_t kSaturated = ~std::uint64_t(0);

struct CropWindow {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;   ///< pixels of the whole picture; upper ends exclusive
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
};

/// What a pixel shows.
struct PixelEstimate {
    double mean[3];
    double standardError[3];       ///< of the mean; NaN where unknown (one sample, saturation)
    double alpha;
    std::uint32_t samples;
};

class Film {
public:
    Film() = default;
    /// `normalization`: Filter::normalization(). Throws Error(OutOfMemory) where the pixels do not fit.
    Film(const CropWindow& crop, int replicates, double normalization, const AovSet& aovs = {});

    const CropWindow& crop() const { return crop_; }
    int replicates() const { return replicates_; }
    std::size_t pixelCount() const { return std::size_t(crop_.width()) * std::size_t(crop_.height()); }
    std::size_t memoryBytes() const {
        return sums_.size() * sizeof(PixelSums) + squares_.size() * sizeof(PixelSquares) + aovs_.memoryBytes();
    }

    /// Adds sample number `sample` of the pixel. Returns false, and counts the sample as black, where the value is not finite
    /// or beyond 2^33. `sign`: of the filter; `hit`: the camera ray met something.
    bool add(std::size_t pixel, std::uint32_t sample, const Spectrum<float>& value, float sign, bool hit) noexcept {
        PixelSums& p = sums_[pixel * std::size_t(replicates_) + (replicates_ == 1 ? 0 : sample % std::uint32_t(replicates_))];
        ++p.samples;
        p.covered += hit ? (sign < 0.f ? -1 : 1) : 0;
        const float channel[3] = {value.r, value.g, value.b};
        for (float v : channel)
            if (!(abs(v) < kLargestSummand)) return false;
        for (int c = 0; c < 3; ++c) p.value[c].add(toFixed(channel[c]));
        if (replicates_ == 1) addSquares(squares_[pixel], channel);
        return true;
    }

    /// Adds what add() would have added one by one. REQUIRES: replicates() == 1.
    void add(std::size_t pixel, const PixelRun& run) noexcept {
        PixelSums& p = sums_[pixel];
        PixelSquares& s = squares_[pixel];
        p.samples += run.samples();
        p.covered += run.covered();
        for (int c = 0; c < 3; ++c) {
            p.value[c].add(__int128(run.value(c)) << 24);
            addSquare(s.value[c], run.squares(c));
        }
    }

    PixelEstimate estimate(std::size_t pixel) const;
    /// How many samples the pixel has, as its estimate says.
    std::uint32_t samples(std::size_t pixel) const;

    /// What is seen beside the picture; empty where nobody asked for it.
    AovSums& aovs() { return aovs_; }
    const AovSums& aovs() const { return aovs_; }
    /// The channels of the set of aovs(), one after the other.
    void estimateAovs(std::size_t pixel, std::span<float> out) const;

    friend bool operator==(const Film& a, const Film& b) {
        return a.sums_ == b.sums_ && a.squares_ == b.squares_ && a.aovs_ == b.aovs_;
    }

private:
    static void addSquares(PixelSquares& s, const float channel[3]) noexcept {
        for (int c = 0; c < 3; ++c) {
            const double square = double(channel[c]) * double(channel[c]) * 0x1p40;
            addSquare(s.value[c], square < 0x1p63 ? std::uint64_t(square) : kSaturated);
        }
    }
    static void addSquare(std::uint64_t& sum, std::uint64_t add) noexcept {
        sum = add > kSaturated - sum ? kSaturated : sum + add;
    }

    CropWindow crop_;
    int replicates_ = 1;
    double normalization_ = 1;
    std::vector<PixelSums> sums_;          ///< pixel-major, planes of a pixel side by side
    std::vector<PixelSquares> squares_;    ///< R = 1 only
    AovSums aovs_;
};

}  // namespace penumbra
