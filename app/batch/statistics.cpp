#include "app/batch/statistics.h"

#include "app/batch/recipe.h"
#include "core/base/parallel.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

namespace penumbra {
namespace {

double perSecond(std::uint64_t count, double seconds) {
    return seconds > 0 ? double(count) / seconds : 0;
}

/// Three significant digits, and the largest prefix that leaves at least 1 before the point.
std::string scaledText(double value, double base, std::initializer_list<const char*> units) {
    auto unit = units.begin();
    while (value >= base && unit + 1 != units.end()) {
        value /= base;
        ++unit;
    }
    const int decimals = unit == units.begin() || value >= 100 ? 0 : value >= 10 ? 1 : 2;
    return fmt::format("{:.{}f}{}", value, decimals, *unit);
}

std::string line(std::string_view name, const std::string& value) {
    return fmt::format("  {:<18} {}\n", name, value);
}

}  // namespace

PictureError pictureError(const Film& film) {
    PictureError result;
    double sum = 0, squares = 0;
    std::uint64_t known = 0;
    for (std::size_t i = 0; i < film.pixelCount(); ++i) {
        const PixelEstimate e = film.estimate(i);
        bool allKnown = true;
        for (std::size_t c = 0; c < 3; ++c) {
            sum += e.mean[c];
            if (!std::isfinite(e.standardError[c])) {
                allKnown = false;
                continue;
            }
            squares += e.standardError[c] * e.standardError[c];
            ++known;
        }
        result.unknownPixels += !allKnown;
    }
    if (film.pixelCount()) result.mean = sum / double(3 * film.pixelCount());
    if (known) result.rootMeanSquare = std::sqrt(squares / double(known));
    if (result.mean > 0) result.relative = result.rootMeanSquare / result.mean;
    result.isKnown = known > 0;
    return result;
}

std::string errorText(const PictureError& error) {
    if (!error.isKnown) return "unknown: it takes two samples a pixel";
    std::string text = fmt::format("{:.2g} % of the mean", 100 * error.relative);
    if (error.unknownPixels) text += fmt::format(", unknown in {} pixels", error.unknownPixels);
    return text;
}

double ClampBias::relativeTo(double pictureMean) const {
    const double lost = (meanLost[0] + meanLost[1] + meanLost[2]) / 3;
    return pictureMean + lost > 0 ? lost / (pictureMean + lost) : 0;
}

ClampBias clampBias(const RenderJob& job) {
    const RenderCounts counts = job.countsSoFar();
    ClampBias bias;
    bias.limit = job.scene().film.maxComponent;
    bias.samples = counts.clamped.samples;
    if (bias.samples)
        for (std::size_t c = 0; c < 3; ++c)
            bias.meanLost[c] = counts.clamped.sum(c) / double(counts.paths) * job.scene().filter.normalization();
    return bias;
}

std::string clampText(const ClampBias& bias, const PictureError& error) {
    return fmt::format("{} sample{} limited to {}: a bias; on average the picture is too dark by {:.2g} %",
                       bias.samples, bias.samples == 1 ? "" : "s", bias.limit, 100 * bias.relativeTo(error.mean));
}

RenderStatistics statisticsOf(const RenderJob& job) {
    const RenderCounts& c = job.counts();
    const Scene& scene = job.scene();
    RenderStatistics s;
    s.times = job.times();
    s.threads = ThreadLimit::current();
    s.counts = c;
    s.samplesPerSecond = perSecond(c.paths, s.times.render);
    s.raysPerSecond = perSecond(c.rays + c.shadowRays, s.times.render);
    s.meanLiveLanes = c.groups ? double(c.liveLanes) / double(c.groups) : 0;
    s.filmBytes = job.film().memoryBytes();
    s.geometryBytes = scene.geometry.memoryBytes();
    s.textureBytes = scene.textures.bytes();
    s.peakMemoryBytes = peakMemoryBytes();
    s.error = pictureError(job.film());
    s.clamp = clampBias(job);
    return s;
}

std::string statisticsText(const RenderStatistics& s) {
    std::string text = "statistics\n";
    text += line("parse", fmt::format("{:.3f} s", s.times.parse));
    text += line("build", fmt::format("{:.3f} s", s.times.build));
    text +=
        line("render", fmt::format("{:.3f} s on {} thread{}", s.times.render, s.threads, s.threads == 1 ? "" : "s"));
    text += line("samples", fmt::format("{} ({}/s)", countText(double(s.counts.paths)), countText(s.samplesPerSecond)));
    text += line("rays", fmt::format("{} ({}/s): {} to surfaces, {} to lights",
                                     countText(double(s.counts.rays + s.counts.shadowRays)), countText(s.raysPerSecond),
                                     countText(double(s.counts.rays)), countText(double(s.counts.shadowRays))));
    text += line("live lanes", fmt::format("{:.2f} in a shading call", s.meanLiveLanes));
    text += line("memory", fmt::format("film {}, geometry {}, textures {}; process {} at its peak",
                                       bytesText(double(s.filmBytes)), bytesText(double(s.geometryBytes)),
                                       bytesText(double(s.textureBytes)), bytesText(double(s.peakMemoryBytes))));
    text += line("invalid samples", std::to_string(s.counts.invalid));
    if (s.clamp.limit < kInfinity) text += line("clamped", clampText(s.clamp, s.error));
    text += line("standard error", errorText(s.error));
    return text;
}

std::string statisticsJson(const RenderStatistics& s, const RenderJob& job) {
    const auto known = [&](double e) { return s.error.isKnown ? nlohmann::ordered_json(e) : nlohmann::ordered_json(); };
    const nlohmann::ordered_json recipe = nlohmann::ordered_json::parse(recipeJson(job));
    nlohmann::ordered_json json = {
        {"schema", 1},
        {"recipe", recipe},
        {"seconds", {{"parse", s.times.parse}, {"build", s.times.build}, {"render", s.times.render}}},
        {"threads", s.threads},
        {"samples", s.counts.paths},
        {"samples_per_second", s.samplesPerSecond},
        {"rays", s.counts.rays},
        {"shadow_rays", s.counts.shadowRays},
        {"rays_per_second", s.raysPerSecond},
        {"mean_live_lanes", s.meanLiveLanes},
        {"bytes",
         {{"film", s.filmBytes},
          {"geometry", s.geometryBytes},
          {"textures", s.textureBytes},
          {"peak_rss", s.peakMemoryBytes}}},
        {"invalid_samples", s.counts.invalid},
        {"standard_error",
         {{"rms", known(s.error.rootMeanSquare)},
          {"relative", known(s.error.relative)},
          {"unknown_pixels", s.error.unknownPixels}}},
    };
    if (recipe.contains("clamp")) {
        json["bias"]["clamp"] = recipe["clamp"];
        json["bias"]["clamp"]["relative"] = s.clamp.relativeTo(s.error.mean);
    }
    return json.dump();
}

std::string bytesText(double bytes) {
    return scaledText(bytes, 1024, {" B", " KiB", " MiB", " GiB", " TiB"});
}
std::string countText(double count) {
    return scaledText(count, 1000, {"", " k", " M", " G", " T"});
}

std::uint64_t peakMemoryBytes() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return std::uint64_t(usage.ru_maxrss) * 1024;
}

std::uint64_t presentMemoryBytes() {
    std::uint64_t pages = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    return resident * std::uint64_t(::sysconf(_SC_PAGESIZE));
}

}  // namespace penumbra
