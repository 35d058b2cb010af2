#include "app/batch/recipe.h"

#include "app/batch/statistics.h"
#include "core/base/version.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace penumbra {
namespace {

/// As a shell reads it back.
std::string shellQuoted(const std::string& word) {
    constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-+:=,@%";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
    std::string quoted = "'";
    for (const char c : word)
        quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

const char* lightSamplingName(bool classicArea) {
    return classicArea ? "area" : "solid-angle";
}
const char* intersectionName(IntersectionMode mode) {
    switch (mode) {
        case IntersectionMode::Embree: return "embree";
        case IntersectionMode::Fast: return "fast";
        case IntersectionMode::Robust: break;
    }
    return "robust";
}

}  // namespace

const char* lightSelectionName(LightSelection selection) {
    switch (selection) {
        case LightSelection::Uniform: return "uniform";
        case LightSelection::Power: return "power";
        case LightSelection::Bvh: break;
    }
    return "bvh";
}

std::string repeatCommand(const RenderOptions& options) {
    const BuildOptions& b = options.build;
    std::string command = "penumbra render " + shellQuoted(options.scene);
    const auto add = [&](const char* option, const auto& value) { command += fmt::format(" {} {}", option, value); };
    for (const std::string& setting : options.overrides)
        add("-D", shellQuoted(setting));
    if (b.samplesOverride > 0) add("--spp", b.samplesOverride);
    if (b.width > 0) add("--resolution", fmt::format("{}x{}", b.width, b.height));
    if (b.cropWindow) add("--cropwindow", fmt::format("{}", fmt::join(*b.cropWindow, ",")));
    if (b.pixelBounds) add("--pixelbounds", fmt::format("{}", fmt::join(*b.pixelBounds, ",")));
    if (b.seed) add("--seed", *b.seed);
    if (!b.sampler.empty()) add("--sampler", b.sampler);
    if (!b.integrator.empty()) add("--integrator", b.integrator);
    if (b.maxDepth) add("--maxdepth", *b.maxDepth);
    if (b.roulette) add("--roulette", rouletteName(*b.roulette));
    if (b.strategy) add("--strategy", strategyName(*b.strategy));
    if (b.lightSelection) add("--light-selection", lightSelectionName(*b.lightSelection));
    if (b.classicArea) add("--light-sampling", lightSamplingName(true));
    if (b.intersection != IntersectionMode::Robust) add("--intersection", intersectionName(b.intersection));
    if (options.replicates != 1) add("--replicates", options.replicates);
    if (b.aovs)
        add("--aov", b.aovs->empty() ? std::string("none") : fmt::format("{}", fmt::join(aovNames(*b.aovs), ",")));
    if (b.clamp) add("--clamp", *b.clamp == kInfinity ? std::string("off") : fmt::format("{}", *b.clamp));
    return command;
}

std::string replayCommand(const RenderJob& job, InvalidSample sample) {
    const CropWindow& crop = job.film().crop();
    const int width = crop.width(), pixel = int(sample.pixel);
    return fmt::format("{} --pixel {},{} --sample {}", repeatCommand(job.options()), crop.x0 + pixel % width,
                       crop.y0 + pixel / width, sample.sample);
}

std::string recipeJson(const RenderJob& job) {
    const Scene& s = job.scene();
    const RenderOptions& o = job.options();
    const IntegratorSettings& i = s.integrator;
    const CropWindow& crop = job.film().crop();
    nlohmann::ordered_json recipe = {
        {"schema", 1},
        {"program", std::string("penumbra ") + kVersion},
        {"command", repeatCommand(o)},
        {"scene", o.scene},
        {"scene_sha256", job.inputs().hash},
        {"resolution", {s.film.width, s.film.height}},
        {"crop", {crop.x0, crop.y0, crop.x1, crop.y1}},
        {"samples", {0, s.samplesPerPixel}},
        {"seed", s.seed},
        {"replicates", o.replicates},
        {"sampler", s.sampler.info().name},
        {"integrator", i.name},
        {"maxdepth", i.maxDepth},
        {"roulette", rouletteName(i.roulette)},
        {"strategy", strategyName(i.strategy)},
        {"light_selection", lightSelectionName(i.lightSelection)},
        {"light_sampling", lightSamplingName(o.build.classicArea)},
        {"intersection", intersectionName(o.build.intersection)},
        {"color_space", s.film.colorSpace},
        {"embree", Accelerator::libraryVersion()},
        {"native", kNativeBuild},
        {"warnings", job.warningCount()},
        {"invalid_samples", job.countsSoFar().invalid},
        {"error", o.replicates == 1 ? "independent-sample estimate" : "spread of replicates"},
    };
    if (!s.film.aovs.empty())
        recipe["aovs"] = {{"names", aovNames(s.film.aovs)}, {"space", s.film.aovsInCameraSpace ? "camera" : "world"}};
    if (const ClampBias bias = clampBias(job); bias.limit < kInfinity)
        recipe["clamp"] = {{"limit", bias.limit}, {"samples", bias.samples}, {"mean_lost", bias.meanLost}};
    if (!job.isWhole())
        recipe["partial"] = {{"samples_done", job.progress().samplesDone.load()}, {"samples", job.progress().samples}};
    // A file name need not be UTF-8.
    return recipe.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace penumbra
