#include "bench/lab/render_benchmark.h"

#include "app/batch/statistics.h"
#include "core/base/parallel.h"

namespace penumbra {

RenderBenchmark measureRender(RenderJob& job, const RenderBenchmarkOptions& options) {
    RenderBenchmark result;
    result.options = options;
    result.threads = ThreadLimit::current();
    for (int i = 0; i < options.warmups; ++i)
        job.run();
    std::vector<double> rates;
    for (int i = 0; i < options.repeats; ++i) {
        const double before = job.times().render;
        job.run();
        result.seconds.push_back(job.times().render - before);
        rates.push_back(double(job.progress().samples) / result.seconds.back());
    }
    const RenderStatistics statistics = statisticsOf(job);
    const double paths = double(statistics.counts.paths);
    result.samples = job.progress().samples;
    result.samplesPerSecond = spreadOf(rates);
    result.raysPerSample = double(statistics.counts.rays) / paths;
    result.shadowRaysPerSample = double(statistics.counts.shadowRays) / paths;
    result.meanLiveLanes = statistics.meanLiveLanes;
    result.peakMemoryBytes = statistics.peakMemoryBytes;
    return result;
}

}  // namespace penumbra
