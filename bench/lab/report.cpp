#include "bench/lab/report.h"

#include "app/batch/recipe.h"
#include "app/batch/statistics.h"
#include "core/base/parallel.h"
#include "core/base/text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace penumbra {
namespace {

using Json = nlohmann::ordered_json;

std::string line(std::string_view name, const std::string& value) {
    return fmt::format("  {:<16} {}\n", name, value);
}

std::string rateText(const Spread& s) {
    return fmt::format("{}/s ({} to {})", countText(s.median), countText(s.min), countText(s.max));
}

Spread scaled(const Spread& s, double factor) {
    return {s.min * factor, s.median * factor, s.max * factor};
}

std::string headline(const char* what, const RenderJob& job, int threads) {
    const Scene& s = job.scene();
    const CropWindow& crop = job.film().crop();
    return fmt::format("{} of {}: {}x{}, {} spp, {}, {} thread{}, {}\n", what, pathText(job.options().scene),
                       crop.width(), crop.height(), s.samplesPerPixel, s.sampler.info().name, threads,
                       threads == 1 ? "" : "s", Accelerator::libraryVersion());
}

Json spreadJson(const Spread& s) {
    return {{"min", s.min}, {"median", s.median}, {"max", s.max}};
}

/// What both programs say of what was measured.
Json commonJson(const char* benchmark, const RenderJob& job, int threads) {
    Json recipe = Json::parse(recipeJson(job));
    for (const char* ofPictures : {"invalid_samples", "error"})
        recipe.erase(ofPictures);
    const RenderControls& c = job.options().controls;
    return {
        {"schema", kBenchmarkSchema},
        {"benchmark", benchmark},
        {"recipe", recipe},
        {"threads", threads},
        {"parallel", parallelLibraryVersion()},
        {"lanes", c.lanes},
        {"batch", c.batchSize},
        {"tile", job.options().tileSize},
    };
}

}  // namespace

std::string renderBenchmarkText(const RenderBenchmark& r, const RenderJob& job) {
    std::string text = headline("render_bench", job, r.threads);
    text += line("parse, build", fmt::format("{:.3f} s, {:.3f} s", job.times().parse, job.times().build));
    text += line("renders", fmt::format("{} of {} samples, after {} to warm up", r.seconds.size(),
                                        countText(double(r.samples)), r.options.warmups));
    text += line("samples", rateText(r.samplesPerSecond));
    text += line("nearest rays", rateText(scaled(r.samplesPerSecond, r.raysPerSample)));
    text += line("shadow rays", rateText(scaled(r.samplesPerSecond, r.shadowRaysPerSample)));
    text += line("rays a sample", fmt::format("{:.3f} nearest, {:.3f} shadow", r.raysPerSample, r.shadowRaysPerSample));
    text += line("live lanes", fmt::format("{:.2f} in a shading call", r.meanLiveLanes));
    return text + line("peak memory", bytesText(double(r.peakMemoryBytes)));
}

std::string renderBenchmarkJson(const RenderBenchmark& r, const RenderJob& job) {
    Json json = commonJson("render", job, r.threads);
    json.update(Json{
        {"warmups", r.options.warmups},
        {"seconds", {{"parse", job.times().parse}, {"build", job.times().build}, {"render", r.seconds}}},
        {"samples", r.samples},
        {"samples_per_second", spreadJson(r.samplesPerSecond)},
        {"nearest_rays_per_second", spreadJson(scaled(r.samplesPerSecond, r.raysPerSample))},
        {"shadow_rays_per_second", spreadJson(scaled(r.samplesPerSecond, r.shadowRaysPerSample))},
        {"nearest_rays_per_sample", r.raysPerSample},
        {"shadow_rays_per_sample", r.shadowRaysPerSample},
        {"mean_live_lanes", r.meanLiveLanes},
        {"peak_rss_bytes", r.peakMemoryBytes},
    });
    return json.dump() + "\n";
}

std::string rayRoofText(const RayRoof& r, const RenderJob& job) {
    const double samples = double(r.samples);
    std::string text = headline("ray_roof", job, r.threads);
    text += line("recorded",
                 fmt::format("{} of {} tiles at {} spp: {} samples, {} packets of {:.2f} rays", r.tiles,
                             r.tilesOfPicture, r.samplesPerPixel, countText(samples), countText(double(r.rays.packets)),
                             double(r.rays.rays + r.rays.shadowRays) / double(r.rays.packets)));
    text += line("rays a sample", fmt::format("{:.3f} nearest, {:.3f} shadow", double(r.rays.rays) / samples,
                                              double(r.rays.shadowRays) / samples));
    text += line("rendering", rateText(r.render) + fmt::format(", {} rounds", r.options.rounds));
    text += line("replay, packets", rateText(r.packets));
    text += line("replay, singly", rateText(r.singly));
    return text + line("fraction of roof",
                       fmt::format("{:.3f} ({:.3f} to {:.3f}); the roof are {}", r.fraction.median, r.fraction.min,
                                   r.fraction.max, r.packetsAreRoof ? "packets" : "single rays"));
}

std::string rayRoofJson(const RayRoof& r, const RenderJob& job) {
    Json json = commonJson("ray_roof", job, r.threads);
    json.update(Json{
        {"rounds", r.options.rounds},
        {"memory_bytes", r.options.memoryBytes},
        {"tiles", {{"measured", r.tiles}, {"of_picture", r.tilesOfPicture}}},
        {"samples_per_pixel", r.samplesPerPixel},
        {"samples", r.samples},
        {"packets", r.rays.packets},
        {"nearest_rays", {{"traced", r.rays.rays}, {"hit", r.rays.hits}}},
        {"shadow_rays", {{"traced", r.rays.shadowRays}, {"occluded", r.rays.occluded}}},
        {"samples_per_second",
         {{"render", spreadJson(r.render)}, {"packets", spreadJson(r.packets)}, {"singly", spreadJson(r.singly)}}},
        {"roof", r.packetsAreRoof ? "packets" : "singly"},
        {"fraction_of_roof", spreadJson(r.fraction)},
    });
    return json.dump() + "\n";
}

}  // namespace penumbra
