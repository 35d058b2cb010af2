#include "core/film/film.h"

#include "core/base/error.h"

#include <cmath>
#include <limits>
#include <string>

namespace penumbra {

static_assert(sizeof(PixelSums) == 56 && sizeof(PixelSquares) == 24);

Film::Film(const CropWindow& crop, int replicates, double normalization, const AovSet& aovs)
    : crop_(crop), replicates_(replicates), normalization_(normalization) {
    try {
        sums_.resize(pixelCount() * std::size_t(replicates));
        if (replicates == 1) squares_.resize(pixelCount());
        aovs_ = AovSums(aovs, pixelCount());
    } catch (const std::exception&) {
        throw Error(ErrorKind::OutOfMemory, "not enough memory for a film of " + std::to_string(crop.width()) + "x" +
                                                std::to_string(crop.height()) + " pixels");
    }
}

void Film::estimateAovs(std::size_t pixel, std::span<float> out) const {
    aovs_.estimate(pixel, samples(pixel), normalization_, out);
}

std::uint32_t Film::samples(std::size_t pixel) const {
    std::uint32_t sum = 0;
    for (int r = 0; r < replicates_; ++r) sum += sums_[pixel * std::size_t(replicates_) + std::size_t(r)].samples;
    return sum;
}

PixelEstimate Film::estimate(std::size_t pixel) const {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    PixelEstimate e{};
    const PixelSums* plane = &sums_[pixel * std::size_t(replicates_)];
    std::int64_t covered = 0;
    e.samples = samples(pixel);
    for (int r = 0; r < replicates_; ++r) covered += plane[r].covered;
    const double n = e.samples;
    e.alpha = n > 0 ? std::fmin(std::fmax(double(covered) / n * normalization_, 0.0), 1.0) : 0;
    for (int c = 0; c < 3; ++c) {
        __int128 total = 0;
        for (int r = 0; r < replicates_; ++r) total += plane[r].value[c].value();
        const double sum = fromFixed(total);
        e.mean[c] = n > 0 ? sum / n * normalization_ : 0;
        double variance = kUnknown;   // of the mean
        if (replicates_ == 1) {
            const std::uint64_t squares = squares_[pixel].value[c];
            if (n > 1 && squares != kSaturated)
                variance = std::fmax(0.0, double(squares) * 0x1p-40 - sum * sum / n) / (n - 1) / n;
        } else {
            double mean = 0, spread = 0;
            int planes = 0;
            for (int r = 0; r < replicates_; ++r) planes += plane[r].samples > 0;
            const auto value = [&](int r) { return fromFixed(plane[r].value[c].value()) / plane[r].samples; };
            for (int r = 0; r < replicates_; ++r)
                if (plane[r].samples) mean += value(r) / planes;
            for (int r = 0; r < replicates_; ++r)
                if (plane[r].samples) spread += (value(r) - mean) * (value(r) - mean);
            if (planes > 1) variance = spread / (planes - 1) / planes;
        }
        e.standardError[c] = std::sqrt(variance) * normalization_;
    }
    return e;
}

}  // namespace penumbra
