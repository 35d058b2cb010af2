// Samples and rays per second of rendering a scene.
#include "bench/lab/bench_program.h"
#include "bench/lab/report.h"

int main(int argc, char** argv) {
    using namespace penumbra;
    RenderBenchmarkOptions options;
    BenchProgram program("render_bench", "render_bench: how many samples and rays per second a scene renders at");
    program.whole("--repeats", options.repeats, 1, 10000, "timed renders");
    program.whole("--warmup", options.warmups, 0, 10000, "renders before them that are not timed");
    return program.run(argc, argv, [&](RenderJob& job, bool json) {
        const RenderBenchmark result = measureRender(job, options);
        return json ? renderBenchmarkJson(result, job) : renderBenchmarkText(result, job);
    });
}
