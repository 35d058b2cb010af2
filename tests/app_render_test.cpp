// penumbra render: the picture, its header, its replay, and how it ends early.

#include "core/image/exr.h"
#include "tests/run_program.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <nlohmann/json.hpp>

#include <charconv>
#include <cmath>
#include <sstream>
#include <thread>

namespace penumbra {
namespace {

class RenderCommand : public testing::Test {
protected:
    const TemporaryFolder folder;
    const std::string scene = folder.file("scene.pbrt", kSmallScene);

    /// Renders quietly to that file and returns its bytes.
    std::string render(const std::string& name, std::vector<std::string> options = {}) const {
        std::vector<std::string> arguments{"render", scene, "-o", folder.path(name), "--quiet"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProgramRun run = runProgram(arguments);
        EXPECT_EQ(run.code, 0) << run.err;
        EXPECT_EQ(run.err, "");
        return readBytes(folder.path(name));
    }
};

nlohmann::json recipeOf(const ExrFile& file) {
    for (const auto& [name, value] : file.header.attributes)
        if (name == "penumbra") return nlohmann::json::parse(std::get<std::string>(value));
    ADD_FAILURE() << "no recipe";
    return {};
}

/// A limit on what may be lost: names of temporary files have ".tmp." in them.
std::vector<std::string> leftovers(const std::string& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (contains(entry.path().filename().string(), ".tmp.")) names.push_back(entry.path().filename());
    return names;
}

TEST_F(RenderCommand, SameBytesForAnyThreadsAndLanesAndOnEveryRun) {
    const std::string once = render("a.exr");
    EXPECT_EQ(render("b.exr"), once);
    EXPECT_EQ(render("c.exr", {"-t", "1"}), once);
    EXPECT_EQ(render("d.exr", {"-t", "3"}), once);
    EXPECT_EQ(render("e.exr", {"--lanes", "1"}), once);
    EXPECT_NE(render("f.exr", {"--seed", "1"}), once);
}

TEST_F(RenderCommand, OrderOfOptionsDoesNotMatter) {
    const std::string picture = folder.path("a.exr"), other = folder.path("b.exr");
    EXPECT_EQ(runProgram({"render", "--spp", "2", scene, "--quiet", "-o", picture}).code, 0);
    EXPECT_EQ(runProgram({"render", "-o", other, "--quiet", scene, "--spp=2"}).code, 0);
    EXPECT_EQ(readBytes(picture), readBytes(other));
}

TEST_F(RenderCommand, TheHeaderRepeatsThePicture) {
    const std::string bytes =
        render("a.exr", {"--spp", "8", "--resolution", "20x10", "--seed", "7", "--strategy", "bsdf", "-t", "1"});
    const ExrFile file = readExr(folder.path("a.exr"));
    EXPECT_EQ(file.header.dataWindow.width(), 20);
    for (const char* channel : {"R", "G", "B", "A", "SE.R", "SE.G", "SE.B"})
        EXPECT_TRUE(file.find(channel)) << channel;
    const nlohmann::json recipe = recipeOf(file);
    EXPECT_EQ(recipe.at("samples"), (nlohmann::json{0, 8}));
    EXPECT_EQ(recipe.at("seed"), 7);
    EXPECT_EQ(recipe.at("scene"), scene);
    EXPECT_EQ(recipe.at("scene_sha256").get<std::string>().size(), 64u);

    std::istringstream words(recipe.at("command").get<std::string>());
    std::vector<std::string> command{std::istream_iterator<std::string>(words), {}};
    ASSERT_EQ(command.front(), "penumbra");
    command.erase(command.begin());
    command.insert(command.end(), {"--quiet", "-o", folder.path("again.exr")});
    EXPECT_EQ(runProgram(command).code, 0);
    EXPECT_EQ(readBytes(folder.path("again.exr")), bytes);
}

TEST_F(RenderCommand, ReplayPrintsWhatThePictureHolds) {
    render("a.exr", {"--spp", "1"});
    const ExrFile file = readExr(folder.path("a.exr"));
    int lit = 0;
    for (const auto& [x, y] : {std::pair{0, 0}, {16, 12}, {17, 15}, {31, 23}, {16, 3}}) {
        const ProgramRun run = runProgram(
            {"render", scene, "--spp", "1", "--pixel", std::to_string(x) + "," + std::to_string(y), "--sample", "0"});
        EXPECT_EQ(run.code, 0) << run.err;
        std::istringstream values(run.out);
        for (const char* channel : {"R", "G", "B"}) {
            float value = -1;
            values >> value;
            const float held = (*file.find(channel))[std::size_t(y * 32 + x)];
            // Of the default filter only the sign and the normalisation lie between a single sample and the pixel.
            EXPECT_FLOAT_EQ(value, held) << x << "," << y << " " << channel;
            lit += held > 0;
        }
    }
    EXPECT_GT(lit, 6);
    EXPECT_EQ(runProgram({"render", scene, "--pixel", "32,0", "--sample", "0"}).code, 64);
    EXPECT_EQ(runProgram({"render", scene, "--pixel", "0,0", "--sample", "4"}).code, 64);
}

TEST_F(RenderCommand, WritesEveryKindOfPictureAndTheFilmsOwnName) {
    EXPECT_TRUE(render("a.png").starts_with("\x89PNG"));
    EXPECT_TRUE(render("a.jpg").starts_with("\xff\xd8\xff"));
    EXPECT_TRUE(render("a.hdr").starts_with("#?"));
    EXPECT_TRUE(render("a.pfm").starts_with("PF"));
    EXPECT_TRUE(render("a.tif").starts_with("II"));
    ProgramSurroundings there;
    there.folder = folder.path("");
    EXPECT_EQ(runProgram({"render", "scene.pbrt", "--quiet"}, there).code, 0);
    EXPECT_TRUE(std::filesystem::exists(folder.path("film.exr")));
}

TEST_F(RenderCommand, ReadsStandardInputWithTheSameHash) {
    render("a.exr");
    ProgramSurroundings piped;
    piped.input = kSmallScene;
    ASSERT_EQ(runProgram({"render", "-", "-o", folder.path("b.exr"), "--quiet"}, piped).code, 0);
    EXPECT_EQ(recipeOf(readExr(folder.path("b.exr"))).at("scene_sha256"),
              recipeOf(readExr(folder.path("a.exr"))).at("scene_sha256"));
}

TEST_F(RenderCommand, SaysItsProgressAndWhatItWrote) {
    const ProgramRun run = runProgram({"render", scene, "-o", folder.path("a.exr")});
    EXPECT_EQ(run.code, 0);
    EXPECT_EQ(run.out, "");
    EXPECT_TRUE(contains(run.err, "Progress: 100%\n")) << run.err;
    EXPECT_TRUE(contains(run.err, "wrote " + folder.path("a.exr") + ": 32x24, 4 samples per pixel")) << run.err;
    EXPECT_TRUE(contains(run.err, "% of the mean")) << run.err;
    EXPECT_FALSE(contains(run.err, "\x1b")) << "colours or redrawing without a terminal";
}

TEST_F(RenderCommand, StatisticsAndProgressAsJson) {
    const ProgramRun run = runProgram({"render", "--stats=json", scene, "-o", folder.path("a.exr"), "--quiet"});
    const nlohmann::json statistics = nlohmann::json::parse(run.out);
    EXPECT_EQ(statistics.at("samples"), 32 * 24 * 4);
    EXPECT_GE(statistics.at("rays").get<int>(), 32 * 24 * 4);
    EXPECT_GT(statistics.at("mean_live_lanes").get<double>(), 1);
    EXPECT_LE(statistics.at("mean_live_lanes").get<double>(), 8);
    EXPECT_GT(statistics.at("bytes").at("peak_rss").get<double>(), 1e6);
    EXPECT_GT(statistics.at("standard_error").at("relative").get<double>(), 0);

    const ProgramRun text = runProgram({"render", "--stats", scene, "-o", folder.path("a.exr"), "--quiet"});
    EXPECT_EQ(text.out, "");
    EXPECT_TRUE(contains(text.err, "live lanes")) << text.err;

    std::istringstream lines(runProgram({"render", scene, "-o", folder.path("a.exr"), "--progress", "json"}).out);
    std::string line, last;
    while (std::getline(lines, line)) {
        EXPECT_TRUE(nlohmann::json::accept(line)) << line;
        last = line;
    }
    EXPECT_EQ(nlohmann::json::parse(last).at("event"), "done");
}

TEST_F(RenderCommand, ThreadsComeFromTheSchedulerWhereNobodyAsks) {
    const auto threads = [&](const char* variable, const char* value, std::vector<std::string> more) {
        std::vector<std::string> arguments{"render", scene, "-o", folder.path("a.exr"), "--quiet", "--stats=json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        ProgramSurroundings surroundings;
        surroundings.environment = {{variable, value}};
        return nlohmann::json::parse(runProgram(arguments, surroundings).out).at("threads").get<int>();
    };
    EXPECT_EQ(threads("SLURM_CPUS_PER_TASK", "3", {}), 3);
    EXPECT_EQ(threads("CUE_THREADS", "5", {}), 5);
    EXPECT_EQ(threads("SLURM_CPUS_PER_TASK", "3", {"-t", "2"}), 2);
    EXPECT_NE(threads("SLURM_CPUS_PER_TASK", "seven", {}), 7);
}

TEST_F(RenderCommand, InvalidSamplesAreReportedWithTheCommandsThatReplayThem) {
    // A light beyond the range of the film's sums.
    const std::string bright =
        folder.file("bright.pbrt",
                    "Camera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 3\n"
                    "Sampler \"sobol\" \"integer pixelsamples\" 2\nWorldBegin\n"
                    "LightSource \"infinite\" \"rgb L\" [1e30 1e30 1e30]\n");
    const std::vector<std::string> arguments{"render", bright, "-o", folder.path("a.exr")};
    const ProgramRun run = runProgram(arguments);
    EXPECT_EQ(run.code, 0);
    EXPECT_TRUE(contains(run.err, "warning: 24 of 24 samples were not finite")) << run.err;
    EXPECT_TRUE(contains(run.err, "  penumbra render " + bright + " --pixel 0,0 --sample 1\n")) << run.err;
    EXPECT_TRUE(contains(run.err, "and 20 more")) << run.err;
    EXPECT_EQ(recipeOf(readExr(folder.path("a.exr"))).at("invalid_samples"), 24);
    EXPECT_EQ((*readExr(folder.path("a.exr")).find("R"))[0], 0.f);

    const ProgramRun replay = runProgram({"render", bright, "--pixel", "0,0", "--sample", "1"});
    EXPECT_EQ(replay.out, "nan nan nan\n");
    EXPECT_TRUE(contains(replay.err, "invalid")) << replay.err;
    std::vector<std::string> strict = arguments;
    strict.push_back("--strict");
    EXPECT_EQ(runProgram(strict).code, 65);
}

/// Minutes of work, to be interrupted.
std::vector<std::string> longRender(const std::string& scene, const std::string& picture) {
    return {"render", scene, "-o", picture, "--spp", "65536", "--resolution", "640x480", "-t", "1"};
}

/// Waits until that is true, for a minute at most.
void waitUntil(const std::function<bool()>& isTrue) {
    using namespace std::chrono_literals;
    for (int i = 0; i < 1200 && !isTrue(); ++i)
        std::this_thread::sleep_for(50ms);
}

TEST_F(RenderCommand, SignalsEndItWithNoPictureAndNothingLeftBehind) {
    for (const auto& [signal, code] : {std::pair{SIGINT, 130}, {SIGTERM, 143}, {SIGHUP, 129}}) {
        folder.file("a.exr", "the old picture");
        StartedProgram program(longRender(scene, folder.path("a.exr")));
        waitUntil([&] { return contains(program.errSoFar(), "Progress:"); });
        program.signal(signal);
        const ProgramRun run = program.wait();
        EXPECT_EQ(run.code, code) << run.err;
        EXPECT_TRUE(contains(run.err, "error: interrupted: no picture was written")) << run.err;
        EXPECT_EQ(readBytes(folder.path("a.exr")), "the old picture");
        EXPECT_TRUE(leftovers(folder.path("")).empty());
    }
}

TEST_F(RenderCommand, ASignalWhileTheSceneIsReadEndsItAtOnce) {
    ProgramSurroundings endless;  // a pipe that nobody closes or writes to
    endless.inChild = [] {
        int ends[2];
        if (::pipe(ends) != 0 || ::dup2(ends[0], STDIN_FILENO) < 0) ::_exit(126);
    };
    StartedProgram program({"render", "-", "-o", folder.path("a.exr")}, endless);
    waitUntil([&] { return program.handles(SIGTERM); });
    program.signal(SIGTERM);
    EXPECT_EQ(program.wait().code, 143);
}

TEST_F(RenderCommand, AFileLimitIsAWriteErrorAndKeepsTheOldPicture) {
    folder.file("a.exr", "the old picture");
    ProgramSurroundings small;
    small.inChild = [] {
        const rlimit limit{4096, 4096};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    };
    const ProgramRun run = runProgram({"render", scene, "-o", folder.path("a.exr"), "--quiet"}, small);
    EXPECT_EQ(run.code, 74) << run.err;
    EXPECT_EQ(readBytes(folder.path("a.exr")), "the old picture");
    EXPECT_TRUE(leftovers(folder.path("")).empty());
}

}  // namespace
}  // namespace penumbra
