// Rendering's samples per second as a fraction of what Embree alone reaches on the same rays.
#include "bench/lab/bench_program.h"
#include "bench/lab/report.h"

int main(int argc, char** argv) {
    using namespace penumbra;
    RayRoofOptions options;
    int mebibytes = int(options.memoryBytes >> 20);
    BenchProgram program("ray_roof",
                         "ray_roof: rendering's speed as a fraction of tracing the same rays and doing nothing else");
    program.whole("--rounds", options.rounds, 1, 10000, "measurements of each, in turns");
    program.whole("--memory", mebibytes, 1, 1 << 20,
                  "MiB for the recorded rays: they decide how many tiles are measured");
    return program.run(argc, argv, [&](RenderJob& job, bool json) {
        options.memoryBytes = std::size_t(mebibytes) << 20;
        const RayRoof result = measureRayRoof(job, options);
        return json ? rayRoofJson(result, job) : rayRoofText(result, job);
    });
}
