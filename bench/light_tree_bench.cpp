// How the rules of light selection (`bvh`, `power`, `uniform`) fare with the number of lights: a floor below 100 to 100 000
// triangles that shine down, of the same flux and area in all. What counts is variance times time, which is mean squared
// error times time at any number of samples: the smaller, the better. All renders are done in turns, round by round, and the
// medians printed.
#include "app/batch/render_job.h"
#include "bench/lab/measure.h"
#include "core/base/parallel.h"
#include "scenes/readers.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace penumbra {
namespace {

constexpr int kSide = 128;

/// Lights over [-10, 10]^2 at heights of 0.3 to 2, seen from below all of them.
std::string sceneText(int lights) {
    std::mt19937 generator(1);
    const auto random = [&](double low, double high) { return low + (high - low) * (generator() * 0x1p-32); };
    const double side = std::sqrt(8. / lights);  // of a right-angled triangle: the area is 4 in all
    std::string points, indices;
    for (int i = 0; i < lights; ++i) {
        const double x = random(-10, 10), y = random(-10, 10), z = random(0.3, 2);
        points += fmt::format("{:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}\n", x, y, z, x, y + side, z,
                              x + side, y, z);
        indices += fmt::format("{} {} {}\n", 3 * i, 3 * i + 1, 3 * i + 2);
    }
    return fmt::format(
        "Integrator \"path\" \"integer maxdepth\" 1\nPixelFilter \"box\"\n"
        "Film \"rgb\" \"integer xresolution\" {0} \"integer yresolution\" {0}\n"
        "LookAt 0 0 0.2  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [ -8 8 -8 8 ]\n"
        "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ .5 .5 .5 ]\n"
        "Shape \"trianglemesh\" \"point3 P\" [ -10 -10 0 10 -10 0 10 10 0 -10 10 0 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n"
        "AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ]\n"
        "Shape \"trianglemesh\" \"point3 P\" [ {1} ] \"integer indices\" [ {2} ]\n",
        kSide, points, indices);
}

struct Candidate {
    const char* rule;
    LightSelection selection;
    int lights;
    std::vector<double> seconds, variances;  ///< for a sample of every pixel; of one sample, over the mean squared

    double cost() const { return spreadOf(variances).median * spreadOf(seconds).median; }
};

void measure(Candidate& c, int samples, std::uint32_t seed) {
    Warnings warnings(true);
    RenderOptions options;
    options.build.samplesOverride = samples;
    options.build.seed = seed;
    options.build.sampler = "independent";
    options.build.lightSelection = c.selection;
    RenderJob job(readSceneText(sceneText(c.lights), "lights.pbrt", ".", warnings), options, warnings);
    c.seconds.push_back(secondsOf([&] { job.run(); }) / samples);
    double mean = 0, variance = 0;
    for (std::size_t i = 0; i < job.film().pixelCount(); ++i) {
        const PixelEstimate e = job.film().estimate(i);
        mean += e.mean[1];
        variance += e.standardError[1] * e.standardError[1] * samples;
    }
    const double count = double(job.film().pixelCount());
    c.variances.push_back(variance / count / (mean / count * (mean / count)));
}

std::string report(const std::vector<Candidate>& candidates) {
    std::string text = fmt::format("{:<8} {:>8} {:>18} {:>18} {:>16}\n", "rule", "lights", "variance / mean^2",
                                   "M samples/s", "variance x time");
    const auto find = [&](LightSelection selection, int lights) -> const Candidate& {
        return *std::find_if(candidates.begin(), candidates.end(), [&](const Candidate& c) {
            return c.selection == selection && c.lights == lights;
        });
    };
    const double unit = find(LightSelection::Bvh, 100).cost();
    for (const Candidate& c : candidates)
        text += fmt::format("{:<8} {:>8} {:>18.3f} {:>18.2f} {:>16.2f}\n", c.rule, c.lights, spreadOf(c.variances).median,
                            kSide * kSide / spreadOf(c.seconds).median * 1e-6, c.cost() / unit);
    const double many = find(LightSelection::Bvh, 100000).cost();
    return text + fmt::format("bvh, 100000 lights against 100: {:.2f}; power against bvh at 100000: {:.1f}\n", many / unit,
                              find(LightSelection::Power, 100000).cost() / many);
}

}  // namespace
}  // namespace penumbra

int main(int argc, char** argv) {
    using namespace penumbra;
    int rounds = 5, samples = 16, threads = 1;
    CLI::App app("light_tree_bench: variance times time of the rules of light selection", "light_tree_bench");
    app.add_option("--rounds", rounds, "renders of each, in turns (default: 5)")->check(CLI::Range(1, 1000));
    app.add_option("--spp", samples, "samples per pixel (default: 16)")->check(CLI::Range(2, 4096));
    app.add_option("-t,--nthreads", threads, "threads (default: 1)")->check(CLI::Range(1, 1024));
    CLI11_PARSE(app, argc, argv);
    try {
        const ThreadLimit limit(threads);
        std::vector<Candidate> candidates;
        for (const int lights : {100, 1000, 10000, 100000})
            candidates.push_back({"bvh", LightSelection::Bvh, lights, {}, {}});
        for (const int lights : {100, 100000}) {
            candidates.push_back({"power", LightSelection::Power, lights, {}, {}});
            candidates.push_back({"uniform", LightSelection::Uniform, lights, {}, {}});
        }
        for (int round = 0; round < rounds; ++round)
            for (Candidate& c : candidates)
                measure(c, samples, std::uint32_t(round));
        std::fputs(report(candidates).c_str(), stdout);
    } catch (const Error& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return int(error.kind());
    }
}
