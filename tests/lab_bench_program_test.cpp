// The command line of the benchmark programs: what they take, and how they end.

#include "bench/lab/bench_program.h"
#include "core/base/parallel.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <vector>

namespace penumbra {
namespace {

constexpr char kScene[] = R"(
Film "rgb" "integer xresolution" 8 "integer yresolution" 4
Sampler "sobol" "integer pixelsamples" 2
WorldBegin
LightSource "infinite"
)";

class LabBenchProgram : public ::testing::Test {
protected:
    /// The exit code; what the program was told is in the members below.
    int run(std::vector<std::string> words) {
        words.insert(words.begin(), "bench");
        std::vector<char*> arguments;
        for (std::string& w : words)
            arguments.push_back(w.data());
        BenchProgram program("bench", "a benchmark");
        program.whole("--rounds", rounds, 1, 10, "rounds");
        return program.run(int(arguments.size()), arguments.data(), [&](RenderJob& job, bool json) {
            options = job.options();
            width = job.scene().film.width;
            samplesPerPixel = job.scene().samplesPerPixel;
            threads = ThreadLimit::current();
            isJson = json;
            return std::string();
        });
    }

    TemporaryFolder folder;
    const std::string scene = folder.file("scene.pbrt", kScene);
    RenderOptions options;
    int rounds = 3, width = 0, samplesPerPixel = 0, threads = 0;
    bool isJson = false;
};

TEST_F(LabBenchProgram, RendersAsTheSceneSays) {
    EXPECT_EQ(run({scene}), 0);
    EXPECT_EQ(width, 8);
    EXPECT_EQ(samplesPerPixel, 2);
    EXPECT_EQ(rounds, 3);
    EXPECT_FALSE(isJson);
    EXPECT_EQ(options.build.intersection, IntersectionMode::Robust);
}

TEST_F(LabBenchProgram, TakesOptionsAgainstTheScene) {
    EXPECT_EQ(run({scene,          "--json",  "--spp",      "5",  "--resolution",   "16x12", "--sampler", "stratified",
                   "--integrator", "normals", "--maxdepth", "2",  "--intersection", "fast",  "-t",        "1",
                   "--lanes",      "1",       "--batch",    "64", "--tile",         "8",     "--rounds",  "7"}),
              0);
    EXPECT_TRUE(isJson);
    EXPECT_EQ(width, 16);
    EXPECT_EQ(samplesPerPixel, 5);
    EXPECT_EQ(options.build.sampler, "stratified");
    EXPECT_EQ(options.build.integrator, "normals");
    EXPECT_EQ(options.build.maxDepth, 2);
    EXPECT_EQ(options.build.intersection, IntersectionMode::Fast);
    EXPECT_EQ(threads, 1);
    EXPECT_EQ(options.controls.lanes, 1);
    EXPECT_EQ(options.controls.batchSize, 64);
    EXPECT_EQ(options.tileSize, 8);
    EXPECT_EQ(rounds, 7);
}

TEST_F(LabBenchProgram, EndsWithTheCodeOfTheError) {
    EXPECT_EQ(run({}), 64);
    EXPECT_EQ(run({scene, "--nonsense"}), 64);
    EXPECT_EQ(run({scene, "--rounds", "11"}), 64);
    EXPECT_EQ(run({scene, "--lanes", "4"}), 64);
    EXPECT_EQ(run({scene, "--sampler", "sobl"}), 64);
    EXPECT_EQ(run({scene, "--intersection", "fst"}), 64);
    for (const char* size : {"16", "16x", "x16", "0x4", "-4x4", "16x12x", "16x12 "})
        EXPECT_EQ(run({scene, "--resolution", size}), 64) << size;
    EXPECT_EQ(run({folder.path("missing.pbrt")}), 66);
    EXPECT_EQ(run({folder.file("wrong.pbrt", "WorldBegin\nShape \"sphre\"\n")}), 65);
}

}  // namespace
}  // namespace penumbra
