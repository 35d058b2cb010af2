// penumbra render: from a scene to a picture, or to the value of one sample.

#include "app/batch/live_display.h"
#include "app/batch/partial_writer.h"
#include "app/batch/recipe.h"
#include "app/batch/render_job.h"
#include "app/batch/statistics.h"
#include "app/commands/arguments.h"
#include "app/commands/commands.h"
#include "app/commands/console.h"
#include "app/commands/interrupt.h"
#include "app/commands/progress.h"
#include "app/commands/threads.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "integrators/registry.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace penumbra {
namespace {

constexpr char kExamples[] =
    "A picture is a function of the scene and the options of \"Sampling\" and \"Light transport\": threads change no\n"
    "bit of it. An EXR holds the picture (R G B A), the standard error of every pixel (SE.R SE.G SE.B), its\n"
    "number of samples, and in its header what it takes to render the same bits again.\n"
    "\n"
    "Examples:\n"
    "  penumbra render cornell.pbrt -o cornell.exr --spp 256\n"
    "  penumbra render cornell.pbrt -o quick.png --spp 16 --resolution 320x240 -t 4\n"
    "  penumbra render cornell.pbrt -o part.exr --cropwindow 0,0.5,0,0.5 -D Film.iso=200\n"
    "  penumbra render cornell.pbrt --pixel 17,42 --sample 3\n";

constexpr int kMostSamples = 1 << 30, kMostDepth = 100000, kMostReplicates = 4096;
constexpr WholeRange kPixelNumbers{0, std::numeric_limits<std::int32_t>::max()}, kSides{1, 1 << 24};

struct RenderRequest {
    RenderOptions options;
    std::optional<std::string> outfile;
    int threads = 0;
    bool quiet = false, strict = false;
    std::optional<std::pair<int, int>> pixel;
    std::optional<std::uint32_t> sample;
    std::string writePartial;  ///< seconds between pictures that are written meanwhile; empty: none are
    std::optional<DisplayAddress> display;
    std::string statistics;  ///< "text", "json", or empty: none
    ProgressStyle progress = ProgressStyle::People;
    int progressDescriptor = STDOUT_FILENO;  ///< of the JSON lines
};

/// "none", "json" or "json:3".
void setProgress(RenderRequest& request, const std::string& text) {
    constexpr int kMostDescriptors = 1 << 20;
    const std::size_t colon = std::min(text.find(':'), text.size());
    const std::string form = text.substr(0, colon);
    if (form != "json" && text != "none")
        throw Error(ErrorKind::Usage,
                    "--progress: unknown form " + quote(text) + "; known: none, json, json:DESCRIPTOR");
    request.progress = form == "json" ? ProgressStyle::Json : ProgressStyle::None;
    if (colon == text.size()) return;
    request.progressDescriptor =
        int(Arguments::parseWhole("--progress", text.substr(colon + 1), {0, kMostDescriptors}));
    if (::fcntl(request.progressDescriptor, F_GETFD) == -1)
        throw Error(ErrorKind::Usage, fmt::format("--progress: descriptor {} is not open", request.progressDescriptor));
}

std::array<float, 4> parseWindow(const std::string& text) {
    std::array<float, 4> window{};
    const std::vector<std::string> words = Arguments::split("--cropwindow", text, window.size());
    for (std::size_t i = 0; i < window.size(); ++i)
        window[i] = float(Arguments::parseReal("--cropwindow", words[i], 0, 1));
    return window;
}

std::array<int, 4> parseBounds(const std::string& text) {
    std::array<int, 4> bounds{};
    const std::vector<std::string> words = Arguments::split("--pixelbounds", text, bounds.size());
    for (std::size_t i = 0; i < bounds.size(); ++i)
        bounds[i] = int(Arguments::parseWhole("--pixelbounds", words[i], kPixelNumbers));
    return bounds;
}

/// Names with commas between, "all", or "none".
AovSet parseAovs(const std::string& text) {
    std::vector<std::string> known{"all"};
    for (const AovKind& kind : aovKinds())
        known.emplace_back(kind.name);
    AovSet set;
    if (text == "none") return set;
    for (const std::string& word : Arguments::split(text)) {
        Arguments::checkName("--aov", word, known);
        for (const AovKind& kind : aovKinds())
            if (word == kind.name || word == "all") set.add(kind.aov);
    }
    return set;
}

/// A number above 0, or "off".
float parseClamp(const std::string& text) {
    constexpr double kLeast = 1e-6, kMost = 1e9;
    if (text == "off") return kInfinity;
    return float(Arguments::parseReal("--clamp", text, kLeast, kMost));
}

/// Seconds.
double parseInterval(const std::string& text) {
    constexpr double kLeast = 0.01, kMost = 1e6;
    return Arguments::parseReal("--write-partial", text, kLeast, kMost);
}

DisplayAddress parseDisplay(const std::string& text) try { return parseDisplayAddress(text); } catch (const Error& e) {
    throw Error(e.kind(), std::string("--display-server: ") + e.what());
}

void checkRequest(const RenderRequest& request) {
    if (request.options.scene.empty())
        throw Error(ErrorKind::Usage, "a scene is missing: penumbra render SCENE -o PICTURE");
    if (request.pixel.has_value() != request.sample.has_value())
        throw Error(ErrorKind::Usage, "--pixel and --sample belong together: they name the sample to replay");
    if (request.options.build.cropWindow && request.options.build.pixelBounds)
        throw Error(ErrorKind::Usage, "--cropwindow and --pixelbounds say the same thing: give one of them");
    if (!request.writePartial.empty()) parseInterval(request.writePartial);
    if (!request.statistics.empty() && request.statistics != "text" && request.statistics != "json")
        throw Error(ErrorKind::Usage, "--stats: unknown form " + quote(request.statistics) + "; known: text, json");
}

/// Eight lanes must give what one gives.
void replay(const RenderJob& job, const RenderRequest& request) {
    const auto [x, y] = *request.pixel;
    const ReplayedSample sample = job.replay(x, y, *request.sample, 1);
    const Spectrum<float> alone = sample.value, wide = job.replay(x, y, *request.sample, 8).value;
    for (const auto channel : {&Spectrum<float>::r, &Spectrum<float>::g, &Spectrum<float>::b})
        if (floatBits(alone.*channel) != floatBits(wide.*channel) &&
            !(std::isnan(alone.*channel) && std::isnan(wide.*channel)))
            throw Error(
                ErrorKind::Internal,
                fmt::format(
                    "determinism alarm: one lane gives {:.9g} {:.9g} {:.9g}, eight lanes give {:.9g} {:.9g} {:.9g}",
                    alone.r, alone.g, alone.b, wide.r, wide.g, wide.b));
    printOut(fmt::format("{:.9g} {:.9g} {:.9g}\n", alone.r, alone.g, alone.b));
    if (std::isnan(alone.r) && !request.quiet)
        printWarning(
            "the sample is not finite, or beyond the range of the film: the film counts it as invalid and holds black "
            "for it");
    if (sample.unlimited && !request.quiet)
        printWarning(fmt::format("the sample is limited to {}: it was {:.9g} {:.9g} {:.9g}", job.scene().film.maxComponent,
                                 sample.unlimited->r, sample.unlimited->g, sample.unlimited->b));
}

/// Says which samples were lost, with the commands that replay them.
void reportInvalid(const RenderJob& job) {
    constexpr std::size_t kMostShown = 4;
    const RenderCounts& counts = job.counts();
    std::string text = fmt::format("{} of {} samples were not finite and count as black; to replay {}:", counts.invalid,
                                   counts.paths, counts.invalid == 1 ? "it" : "them");
    const std::size_t shown = std::min(kMostShown, counts.firstInvalid.size());
    for (std::size_t i = 0; i < shown; ++i)
        text += "\n  " + replayCommand(job, counts.firstInvalid[i]);
    if (counts.invalid > shown) text += fmt::format("\n  and {} more", counts.invalid - shown);
    printWarning(text);
}

void reportPicture(const RenderJob& job, const std::string& path, const std::string& through,
                   const RenderStatistics& statistics) {
    const CropWindow& crop = job.film().crop();
    const int samples = job.scene().samplesPerPixel;
    printNote(fmt::format("wrote {}: {}x{}, {} sample{} per pixel in {:.2f} s; standard error (rms) {}", pathText(path),
                          crop.width(), crop.height(), samples, samples == 1 ? "" : "s", statistics.times.render,
                          errorText(statistics.error)));
    if (!job.film().aovs().empty() && !isExrPath(path)) printWarning(pathText(path) + ": only an EXR holds AOVs");
    if (!through.empty()) printNote("colours went through " + through);
    if (statistics.clamp.samples) printNote(clampText(statistics.clamp, statistics.error));
}

void printStatistics(const RenderJob& job, const RenderRequest& request, const RenderStatistics& statistics) {
    if (request.statistics == "text") printTo(STDERR_FILENO, statisticsText(statistics));
    if (request.statistics == "json") printOut(statisticsJson(statistics, job) + "\n");
}

void printFinalEvent(const RenderJob& job, const std::string& path, const RenderStatistics& statistics,
                     int descriptor) {
    const nlohmann::ordered_json line = {
        {"t", timeText()},
        {"event", "done"},
        {"picture", path},
        {"statistics", nlohmann::ordered_json::parse(statisticsJson(statistics, job))},
    };
    printTo(descriptor, line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

/// Ends a render that a signal stopped: with what there is where partial pictures were asked for, else with no picture.
void stopEarly(const RenderJob& job, const RenderRequest& request, const std::string& path) {
    std::string outcome = "no picture was written";
    if (!request.writePartial.empty()) {
        job.writePicture(path);
        const RenderProgress& p = job.progress();
        outcome = fmt::format("{} holds {:.0f} % of the samples", pathText(path),
                              std::floor(100 * double(p.samplesDone) / double(p.samples)));
    }
    throwIfInterrupted(outcome);
}

/// Renders and writes the picture; a signal meanwhile ends it early, or with the whole picture.
void renderPicture(RenderJob& job, const RenderRequest& request, const std::string& path) {
    const InterruptGuard guard;
    const auto warn = [&request](const std::string& text) {
        if (!request.quiet) printWarning(text);
    };
    std::optional<LiveDisplay> display;  // until the picture is on disk, for which it must not be waited
    if (request.display) display.emplace(job, *request.display, fmt::format("{} ({})", path, ::getpid()), warn);
    const ProgressStyle style =
        request.quiet && request.progress == ProgressStyle::People ? ProgressStyle::None : request.progress;
    bool whole = false;
    {
        std::optional<PartialWriter> partial;
        if (!request.writePartial.empty()) partial.emplace(job, path, parseInterval(request.writePartial), warn);
        const ProgressDisplay progress(job, style, request.progressDescriptor);
        whole = job.run(&stopRequested());
    }
    if (!whole) stopEarly(job, request, path);
    const std::string through = job.writePicture(path);
    const RenderStatistics statistics = statisticsOf(job);
    if (!request.quiet) reportPicture(job, path, through, statistics);
    if (job.counts().invalid && !request.quiet) reportInvalid(job);
    printStatistics(job, request, statistics);
    if (style == ProgressStyle::Json) printFinalEvent(job, path, statistics, request.progressDescriptor);
    if (job.counts().invalid && request.strict)
        throw Error(ErrorKind::BadData, fmt::format("{} samples were not finite (--strict)", job.counts().invalid));
}

void runRender(const RenderRequest& request) {
    checkRequest(request);
    if (request.outfile) {
        checkKeepsInputs(*request.outfile, {.texts = {request.options.scene}, .assets = {}, .hash = ""});
        checkPicturePath(*request.outfile);
    }
    const ThreadLimit threads(chooseThreads(request.threads));
    Warnings warnings(request.strict);
    WarningPrinter printer(warnings, request.quiet);
    RenderOptions options = request.options;
    options.isWatched = !request.writePartial.empty() || request.display;
    RenderJob job(options, warnings);
    printer.flush();
    if (request.pixel) return replay(job, request);
    const std::string path = request.outfile.value_or(job.scene().film.fileName);
    if (!request.outfile) checkInsideRoot(request.options.root, path);
    checkPicturePath(path);
    checkKeepsInputs(path, job.inputs());
    renderPicture(job, request, path);
}

// ---- options --------------------------------------------------------------------------------------------------------

/// A choice among the values of an enumeration by their names.
template <class Value>
void addEnum(Arguments& arguments, const std::string& names, std::vector<std::pair<std::string, Value>> values,
             auto& target, const std::string& help) {
    std::vector<std::string> known;
    for (const auto& value : values)
        known.push_back(value.first);
    arguments.choice(names, known, help, [values, &target](const std::string& name) {
        target = std::find_if(values.begin(), values.end(), [&](const auto& v) { return v.first == name; })->second;
    });
}

void addOutput(Arguments& arguments, RenderRequest& r) {
    arguments.group("Output");
    arguments.text("-o,--outfile", "FILE",
                   "the picture: .exr with its error, or .png .jpg .tif .hdr .pfm (default: the film's filename)",
                   [&r](const std::string& t) { r.outfile = t; });
    arguments.text(
        "--aov", "NAMES",
        "more channels of an EXR, with commas between: albedo, N, Ns, P, Z, uv, time, or all (\"penumbra list "
        "aovs\" says what they are); none for the film's own",
        [&r](const std::string& t) { r.options.build.aovs = parseAovs(t); });
    arguments.optionalText("--write-partial", "30", "SECONDS", r.writePartial,
                           "keeps what there is of the picture on disk meanwhile, whole files only (every 30 seconds)");
    arguments.text("--display-server", "HOST:PORT", "shows the picture in a viewer (tev) while it is rendered",
                   [&r](const std::string& t) { r.display = parseDisplay(t); });
    arguments.flag("--quiet", r.quiet, "say nothing but errors");
    arguments.optionalText("--stats", "text", "json", r.statistics,
                           "what the render took: for people on standard error, as JSON on standard output");
    arguments.text(
        "--progress", "FORM",
        "none, or JSON lines: json (on standard output), json:DESCRIPTOR (default: a bar or lines for people)",
        [&r](const std::string& t) { setProgress(r, t); });
    arguments.flag("--strict", r.strict,
                   "warnings are errors, and so are samples that are not finite (the picture is then still written)");
    addRootOption(arguments, r.options.root);
}

void addSampling(Arguments& arguments, RenderRequest& r) {
    BuildOptions& b = r.options.build;
    arguments.group("Sampling (default: as the scene says)");
    arguments.whole("--spp", "N", {1, kMostSamples}, b.samplesOverride,
                    "samples per pixel; powers of two serve the sobol sampler best");
    arguments.text("--resolution", "WxH", "size of the whole picture in pixels; a crop keeps its fraction",
                   [&b](const std::string& t) {
                       std::tie(b.width, b.height) = Arguments::parsePair("--resolution", t, 'x', kSides);
                   });
    arguments.text("--cropwindow", "X0,X1,Y0,Y1",
                   "renders a part of the picture, in fractions of it: the same bits as that part of the whole",
                   [&b](const std::string& t) { b.cropWindow = parseWindow(t); });
    arguments.text("--pixelbounds", "X0,X1,Y0,Y1", "the same in pixels, X1 and Y1 not included",
                   [&b](const std::string& t) { b.pixelBounds = parseBounds(t); });
    arguments.texts("-D", "KEY=VALUE",
                    "sets what the scene file says before WorldBegin: a parameter (Film.iso=200, Camera.fov=30, "
                    "Integrator.maxdepth=3) or a type (Camera=orthographic); may be given several times",
                    r.options.overrides);
    arguments.whole("--seed", "N", {0, std::numeric_limits<std::uint32_t>::max()}, b.seed,
                    "seed of the sampler, from 0 to 4294967295");
    arguments.choice("--sampler", pluginNames(SamplerTypes{}), "the sampler",
                     [&b](const std::string& t) { b.sampler = t; });
    arguments.whole(
        "--replicates", "N", {1, kMostReplicates}, r.options.replicates,
        "independent randomisations whose spread gives the error (default: 1, which takes samples as independent)");
}

void addTransport(Arguments& arguments, RenderRequest& r) {
    BuildOptions& b = r.options.build;
    arguments.group("Light transport (default: as the scene says)");
    arguments.choice("--integrator", pluginNames(IntegratorTypes{}), "the integrator",
                     [&b](const std::string& t) { b.integrator = t; });
    arguments.whole("--maxdepth", "N", {0, kMostDepth}, b.maxDepth, "scattering events of a path at most");
    addEnum<RouletteRule>(arguments, "--roulette",
                          {{"late", RouletteRule::Late}, {"pbrt", RouletteRule::Pbrt}, {"off", RouletteRule::Off}},
                          b.roulette, "when faint paths may end early (default: late)");
    addEnum<Strategy>(
        arguments, "--strategy", {{"mis", Strategy::Mis}, {"bsdf", Strategy::BsdfOnly}, {"light", Strategy::LightOnly}},
        b.strategy,
        "how light is looked for: both ways combined, scattered rays alone, light samples alone (default: mis)");
    addEnum<LightSelection>(arguments, "--light-selection",
                            {{"bvh", LightSelection::Bvh},
                             {"power", LightSelection::Power},
                             {"uniform", LightSelection::Uniform}},
                            b.lightSelection,
                            "which light is sampled next: by what it may contribute at the place, by its power, or any "
                            "alike (default: bvh)");
    addEnum<bool>(
        arguments, "--light-sampling", {{"solid-angle", false}, {"area", true}}, b.classicArea,
        "how a point on an area light is chosen: by the solid angle it covers, or evenly by area, the classic "
        "estimator of "
        "textbooks: cosine at the surface x cosine at the light x area / distance squared (default: solid-angle)");
    arguments.text("--clamp", "X",
                   "scales samples that are brighter down to X: less noise, but the picture becomes too dark, which its "
                   "header and --stats put in numbers; off lets the film's maxcomponentvalue not count, either",
                   [&b](const std::string& t) { b.clamp = parseClamp(t); });
    addEnum<IntersectionMode>(arguments, "--intersection",
                              {{"robust", IntersectionMode::Robust},
                               {"embree", IntersectionMode::Embree},
                               {"fast", IntersectionMode::Fast}},
                              b.intersection,
                              "watertight, with a way of its own for scenes of few faces; watertight by Embree alone; or "
                              "Embree's faster mode, where a ray in a million slips through an edge (default: robust)");
}

void addRunning(Arguments& arguments, RenderRequest& r) {
    arguments.group("Running");
    arguments.whole("-t,--nthreads", "N", {1, kMostThreads}, r.threads,
                    "threads (default: $SLURM_CPUS_PER_TASK, $CUE_THREADS, else every processor)");
    addEnum<int>(arguments, "--lanes", {{"8", 8}, {"1", 1}}, r.options.controls.lanes,
                 "paths traced side by side; changes no bit (default: 8)");
    arguments.text("--pixel", "X,Y", "with --sample: replay one sample instead of rendering, and print its R G B",
                   [&r](const std::string& t) { r.pixel = Arguments::parsePair("--pixel", t, ',', kPixelNumbers); });
    arguments.whole("--sample", "I", {0, kMostSamples - 1}, r.sample,
                    "the sample of the pixel to replay, counted from 0");
    arguments.help();
}

}  // namespace

Command addRenderCommand(CLI::App& program) {
    CLI::App& command = *program.add_subcommand("render", "render a scene to a picture that carries its error");
    command.footer(kExamples);
    const auto request = std::make_shared<RenderRequest>();
    Arguments arguments(command);
    arguments.positional("SCENE", request->options.scene, "the scene (.pbrt, .pbrt.gz); \"-\" reads standard input");
    addOutput(arguments, *request);
    addSampling(arguments, *request);
    addTransport(arguments, *request);
    addRunning(arguments, *request);
    return {&command, [request] { runRender(*request); }};
}

}  // namespace penumbra
