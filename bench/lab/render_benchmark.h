// The render benchmark: how fast a scene renders, whole, the way `penumbra render` does it.
//
// The first renders are not timed: they bring files, code and the film's pages into memory. Every render traces the
// same rays, so the spread of the times is the machine's.
//
// Thread safety: one benchmark at a time; it uses the threads that the process is limited to.
#pragma once

#include "app/batch/render_job.h"
#include "bench/lab/measure.h"

namespace penumbra {

struct RenderBenchmarkOptions {
    int warmups = 1, repeats = 5;
};

struct RenderBenchmark {
    RenderBenchmarkOptions options;
    int threads = 0;
    std::uint64_t samples = 0;    ///< of one render
    std::vector<double> seconds;  ///< of each timed render
    Spread samplesPerSecond;
    double raysPerSample = 0, shadowRaysPerSample = 0;  ///< to the nearest surface; towards lights
    double meanLiveLanes = 0;                           ///< of a shading call
    std::uint64_t peakMemoryBytes = 0;                  ///< of the process
};

/// REQUIRES: the job has not run. Its film is afterwards of no use: it holds every sample several times.
RenderBenchmark measureRender(RenderJob& job, const RenderBenchmarkOptions& options);

}  // namespace penumbra
