// The render benchmark: it counts what it renders, and its JSON holds what its documentation promises.

#include "bench/lab/render_benchmark.h"
#include "bench/lab/report.h"
#include "scenes/readers.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra {
namespace {

/// A camera inside a sphere that is lit from its centre: of every path of one scattering, two rays meet it and one
/// looks for the light.
constexpr char kScene[] = R"(
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 16 "integer yresolution" 8
Sampler "sobol" "integer pixelsamples" 4
Integrator "path" "integer maxdepth" 1
WorldBegin
LightSource "point"
Material "diffuse"
Translate 0.25 0 0
Shape "sphere" "float radius" 3
)";

RenderJob makeJob() {
    Warnings warnings;
    return RenderJob(readSceneText(kScene, "test.pbrt", ".", warnings), RenderOptions{}, warnings);
}

TEST(LabSpread, IsOfSortedValues) {
    const Spread odd = spreadOf({3, 1, 2}), even = spreadOf({4, 1, 3, 2}), one = spreadOf({5});
    EXPECT_EQ(odd.min, 1);
    EXPECT_EQ(odd.median, 2);
    EXPECT_EQ(odd.max, 3);
    EXPECT_EQ(even.median, 2.5);
    EXPECT_EQ(one.min, 5);
    EXPECT_EQ(one.median, 5);
    EXPECT_EQ(one.max, 5);
}

TEST(LabRenderBenchmark, CountsWhatARenderTraces) {
    RenderJob job = makeJob();
    const RenderBenchmark result = measureRender(job, {.warmups = 1, .repeats = 3});
    EXPECT_EQ(result.seconds.size(), 3u);
    EXPECT_EQ(result.samples, 16u * 8u * 4u);
    EXPECT_EQ(job.counts().paths, 4 * result.samples);  // the one to warm up is a render, too
    EXPECT_EQ(result.shadowRaysPerSample, 1);
    EXPECT_GE(result.raysPerSample, 1);
    EXPECT_GT(result.samplesPerSecond.min, 0);
    EXPECT_GT(result.meanLiveLanes, 0);
    EXPECT_LE(result.meanLiveLanes, 8);
}

TEST(LabReport, OfARenderKeepsItsSchema) {
    RenderJob job = makeJob();
    const RenderBenchmark result = measureRender(job, {.warmups = 0, .repeats = 2});
    const auto json = nlohmann::json::parse(renderBenchmarkJson(result, job));
    EXPECT_EQ(json.at("schema"), 1);
    EXPECT_EQ(json.at("benchmark"), "render");
    EXPECT_EQ(json.at("recipe").at("sampler"), "sobol");
    EXPECT_FALSE(json.at("recipe").contains("invalid_samples"));
    EXPECT_EQ(json.at("warmups"), 0);
    EXPECT_EQ(json.at("seconds").at("render").size(), 2u);
    EXPECT_EQ(json.at("samples"), result.samples);
    EXPECT_EQ(json.at("samples_per_second").at("median"), result.samplesPerSecond.median);
    EXPECT_EQ(json.at("shadow_rays_per_second").at("max"), result.samplesPerSecond.max);  // one shadow ray a sample
    for (const char* field : {"threads", "lanes", "batch", "tile", "nearest_rays_per_sample", "shadow_rays_per_sample",
                              "mean_live_lanes", "peak_rss_bytes"})
        EXPECT_TRUE(json.at(field).is_number()) << field;
}

}  // namespace
}  // namespace penumbra
