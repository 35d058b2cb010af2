// AOVs: what the camera rays met, beside the picture: albedo, normals, places, depth.
//
// They are seen by the picture's own samples at the first surface, so lens, motion and filter blur them as they blur the
// picture. The albedo is a mean over all samples and counts the filter's sign, as R G B do; a sample that met nothing counts
// 0. The others are means over the samples that met something, without the sign, so that they lie between what was seen;
// of normals the direction of the mean. Where nothing was met normals are 0, and what has no zero (a place, a depth) is NaN.
//
// Sums are exact as the film's are: order changes no bit. Thread safety: as Film.
#pragma once

#include "core/base/plugin.h"
#include "core/film/exact_sum.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

enum class Aov : std::uint8_t { Albedo, Normal, ShadingNormal, Position, Depth, DepthAlongX, DepthAlongY, Uv, Time };

/// One kind of them: where its channels stand in AovValues, and how they are called ("N.X"; no suffixes: by the name alone).
struct AovKind {
    enum class Mean { OfAll, OfHits, Direction };
    Aov aov;
    std::string_view name, suffixes;
    Mean mean;
    std::size_t first;

    std::size_t channels() const { return suffixes.empty() ? 1 : suffixes.size(); }
};
std::span<const AovKind> aovKinds();
/// Their names and meanings, for `list` and messages.
std::span<const PluginInfo> aovPlugins();

/// What one sample saw: every channel of every kind, in the order of aovKinds().
inline constexpr std::size_t kAovChannels = 18;
using AovValues = std::array<float, kAovChannels>;

/// Some of the kinds.
class AovSet {
public:
    bool has(Aov aov) const { return bits_ >> unsigned(aov) & 1u; }
    void add(Aov aov) { bits_ |= 1u << unsigned(aov); }
    bool empty() const { return bits_ == 0; }
    std::size_t channels() const;
    friend bool operator==(const AovSet&, const AovSet&) = default;

private:
    unsigned bits_ = 0;
};

/// The names of the kinds in a set.
std::vector<std::string> aovNames(const AovSet& set);

/// The sums of a film's AOVs.
class AovSums {
public:
    AovSums() = default;
    AovSums(const AovSet& set, std::size_t pixels);

    const AovSet& set() const { return set_; }
    bool empty() const { return channels_ == 0; }
    std::size_t memoryBytes() const { return bytesPerPixel(set_) * hits_.size(); }
    static std::size_t bytesPerPixel(const AovSet& set) {
        return set.empty() ? 0 : set.channels() * sizeof(ExactSum) + sizeof(std::uint32_t);
    }

    /// A sample of the pixel that met something; `sign` of the filter. Channels of kinds that are not in the set do not
    /// matter. A sample with a value that is not finite or beyond 2^33 is left out.
    void add(std::size_t pixel, const AovValues& values, float sign) noexcept;

    /// All channels of the set, in the order of aovKinds(), of a pixel with so many samples. `normalization` as the film's.
    void estimate(std::size_t pixel, std::uint32_t samples, double normalization, std::span<float> out) const;

    friend bool operator==(const AovSums&, const AovSums&) = default;

private:
    AovSet set_;
    std::size_t channels_ = 0;            ///< of the set
    std::vector<ExactSum> sums_;          ///< pixel-major
    std::vector<std::uint32_t> hits_;     ///< samples that were added, per pixel
};

}  // namespace penumbra
