#include "core/film/aov.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra {
namespace {

using Mean = AovKind::Mean;
constexpr AovKind kKinds[] = {
    {Aov::Albedo, "albedo", "RGB", Mean::OfAll, 0},      {Aov::Normal, "N", "XYZ", Mean::Direction, 3},
    {Aov::ShadingNormal, "Ns", "XYZ", Mean::Direction, 6}, {Aov::Position, "P", "XYZ", Mean::OfHits, 9},
    {Aov::Depth, "Z", "", Mean::OfHits, 12},             {Aov::DepthAlongX, "dzdx", "", Mean::OfHits, 13},
    {Aov::DepthAlongY, "dzdy", "", Mean::OfHits, 14},    {Aov::Uv, "uv", "UV", Mean::OfHits, 15},
    {Aov::Time, "time", "", Mean::OfHits, 17},
};
static_assert(std::rbegin(kKinds)->first + 1 == kAovChannels);

constexpr PluginInfo kPlugins[] = {
    {"albedo", "share of light that the surface reflects or lets through; 0 where nothing was met", {}},
    {"N", "geometric normal, towards the viewer; 0 where nothing was met", {}},
    {"Ns", "shading normal, towards the viewer; 0 where nothing was met", {}},
    {"P", "place in the world; NaN where nothing was met", {}},
    {"Z", "depth along the camera's axis (all round: distance); NaN where nothing was met", {}},
    {"dzdx", "change of Z across a pixel, left to right, without its sign; NaN where nothing was met", {}},
    {"dzdy", "change of Z across a pixel, top to bottom, without its sign; NaN where nothing was met", {}},
    {"uv", "surface parameters; NaN where nothing was met", {}},
    {"time", "when it was seen, from 0 (start) to 1 (end of the motion); NaN where nothing was met", {}},
};
static_assert(std::size(kPlugins) == std::size(kKinds));

}  // namespace

std::span<const AovKind> aovKinds() { return kKinds; }
std::span<const PluginInfo> aovPlugins() { return kPlugins; }

std::size_t AovSet::channels() const {
    std::size_t sum = 0;
    for (const AovKind& kind : kKinds)
        if (has(kind.aov)) sum += kind.channels();
    return sum;
}

std::vector<std::string> aovNames(const AovSet& set) {
    std::vector<std::string> names;
    for (const AovKind& kind : kKinds)
        if (set.has(kind.aov)) names.emplace_back(kind.name);
    return names;
}

AovSums::AovSums(const AovSet& set, std::size_t pixels)
    : set_(set), channels_(set.channels()), sums_(channels_ * pixels), hits_(set.empty() ? 0 : pixels) {}

void AovSums::add(std::size_t pixel, const AovValues& values, float sign) noexcept {
    for (const AovKind& kind : kKinds)
        if (set_.has(kind.aov))
            for (std::size_t c = 0; c < kind.channels(); ++c)
                if (!(abs(values[kind.first + c]) < kLargestSummand)) return;
    ++hits_[pixel];
    ExactSum* sum = &sums_[pixel * channels_];
    for (const AovKind& kind : kKinds) {
        if (!set_.has(kind.aov)) continue;
        const bool isSigned = kind.mean == Mean::OfAll && sign < 0.f;
        for (std::size_t c = 0; c < kind.channels(); ++c) {
            const float value = values[kind.first + c];
            (sum++)->add(toFixed(isSigned ? -value : value));
        }
    }
}

void AovSums::estimate(std::size_t pixel, std::uint32_t samples, double normalization, std::span<float> out) const {
    const double hits = hits_[pixel];
    const ExactSum* sum = &sums_[pixel * channels_];
    auto to = out.begin();
    for (const AovKind& kind : kKinds) {
        if (!set_.has(kind.aov)) continue;
        double values[3] = {}, squared = 0;
        for (std::size_t c = 0; c < kind.channels(); ++c) {
            values[c] = fromFixed((sum++)->value());
            squared += values[c] * values[c];
        }
        double scale = 0;
        switch (kind.mean) {
            case Mean::OfAll: scale = samples ? normalization / samples : 0; break;
            case Mean::OfHits: scale = hits > 0 ? 1 / hits : std::numeric_limits<double>::quiet_NaN(); break;
            case Mean::Direction: scale = squared > 0 ? 1 / std::sqrt(squared) : 0; break;
        }
        for (std::size_t c = 0; c < kind.channels(); ++c) *to++ = float(values[c] * scale);
    }
}

}  // namespace penumbra
