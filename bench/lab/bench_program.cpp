#include "bench/lab/bench_program.h"

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "integrators/registry.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <map>
#include <new>

namespace penumbra {
namespace {

constexpr int kMostSamples = 1 << 30, kMostDepth = 100000, kMostThreads = 1024, kMostTileSize = 4096;

int fail(ErrorKind kind, const char* message) {
    std::fprintf(stderr, "error: %s\n", message);
    return int(kind);
}

/// "512x384".
void setResolution(const std::string& text, BuildOptions& build) {
    int end = 0;
    const int read = std::sscanf(text.c_str(), "%9dx%9d%n", &build.width, &build.height, &end);
    if (read != 2 || std::size_t(end) != text.size() || build.width < 1 || build.height < 1)
        throw Error(ErrorKind::Usage, "--resolution: " + quote(text) + " is not two whole numbers with 'x' between");
}

}  // namespace

BenchProgram::BenchProgram(const std::string& name, const std::string& description)
    : app_(std::make_unique<CLI::App>(description, name)) {
    addSceneOptions();
}

BenchProgram::~BenchProgram() = default;

void BenchProgram::whole(const std::string& name, int& value, int least, int most, const std::string& help) {
    app_->add_option(name, value, help)->check(CLI::Range(least, most))->capture_default_str();
}

void BenchProgram::addSceneOptions() {
    BuildOptions& b = options_.build;
    app_->add_option("SCENE", options_.scene, "the scene (.pbrt, .pbrt.gz)")->required();
    app_->add_flag("--json", json_, "print one JSON object");
    app_->add_option("--spp", b.samplesOverride, "samples per pixel (default: as the scene says)")
        ->check(CLI::Range(1, kMostSamples));
    app_->add_option_function<std::string>(
            "--resolution", [&b](const std::string& text) { setResolution(text, b); },
            "size of the picture (default: as the scene says)")
        ->type_name("WxH");
    app_->add_option("--sampler", b.sampler, "the sampler")->check(CLI::IsMember(pluginNames(SamplerTypes{})));
    app_->add_option("--integrator", b.integrator, "the integrator")
        ->check(CLI::IsMember(pluginNames(IntegratorTypes{})));
    app_->add_option("--maxdepth", b.maxDepth, "scattering events of a path at most")->check(CLI::Range(0, kMostDepth));
    static const std::map<std::string, IntersectionMode> modes{
        {"robust", IntersectionMode::Robust}, {"embree", IntersectionMode::Embree}, {"fast", IntersectionMode::Fast}};
    app_->add_option_function<std::string>(
            "--intersection", [&b](const std::string& name) { b.intersection = modes.at(name); },
            "robust: watertight (the default); embree: the same without the way that small scenes have of their own; "
            "fast: a ray in a million slips through edges")
        ->check(CLI::IsMember(modes));
    app_->add_option("-t,--nthreads", threads_, "threads (default: one per processor)")
        ->check(CLI::Range(1, kMostThreads));
    app_->add_option("--lanes", options_.controls.lanes, "paths side by side: 8 or 1")
        ->check(CLI::IsMember({1, 8}))
        ->capture_default_str();
    whole("--batch", options_.controls.batchSize, 1, kMaxBatch, "paths in flight per thread");
    whole("--tile", options_.tileSize, 1, kMostTileSize, "side of a tile in pixels");
}

void BenchProgram::measureScene(const std::function<std::string(RenderJob&, bool)>& measure) const {
    const ThreadLimit threads(threads_);
    Warnings warnings;
    RenderJob job(options_, warnings);
    for (const std::string& text : warnings.all())
        std::fprintf(stderr, "warning: %s\n", text.c_str());
    const std::string report = measure(job, json_);
    if (std::fputs(report.c_str(), stdout) < 0 || std::fflush(stdout) != 0)
        throw Error(ErrorKind::CannotWrite, "cannot write to standard output");
}

int BenchProgram::run(int argc, char** argv, const std::function<std::string(RenderJob& job, bool json)>& measure) {
    try {
        app_->parse(argc, argv);
        measureScene(measure);
        return 0;
    } catch (const CLI::CallForHelp& help) {
        return app_->exit(help);
    } catch (const CLI::ParseError& e) {
        return fail(ErrorKind::Usage, e.what());
    } catch (const Error& e) {
        return fail(e.kind(), e.what());
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::OutOfMemory, "out of memory");
    } catch (const std::exception& e) {
        return fail(ErrorKind::Internal, e.what());
    }
}

}  // namespace penumbra
