// penumbra render: the picture, its header, its replay, and how it ends early.

#include "core/math/lanes.h"
#include "tests/picture_files.h"

#include <sys/resource.h>
#include <nlohmann/json.hpp>

#include <charconv>
#include <cmath>
#include <sstream>

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
    return nlohmann::json::parse(recipeText(file));
}

/// The pixels of a window of the picture, of all channels, as bits: equal where the same window holds the same.
std::vector<std::uint32_t> bitsOf(const ExrFile& file, PixelWindow window) {
    std::vector<std::uint32_t> bits;
    const PixelWindow& data = file.header.dataWindow;
    for (std::size_t c = 0; c < file.header.channels.size(); ++c)
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x) {
                const std::size_t at = std::size_t(y - data.y0) * std::size_t(data.width()) + std::size_t(x - data.x0);
                bits.push_back(file.floats[c].empty() ? file.uints[c][at] : floatBits(file.floats[c][at]));
            }
    return bits;
}

std::array<int, 4> cornersOf(const PixelWindow& w) {
    return {w.x0, w.y0, w.x1, w.y1};
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

TEST_F(RenderCommand, ACropHasTheBitsOfThatPartOfTheWhole) {
    render("whole.exr", {"--replicates", "2"});
    const ExrFile whole = readExr(folder.path("whole.exr"));
    const std::vector<std::pair<std::vector<std::string>, PixelWindow>> crops{
        {{"--cropwindow", "0.25,0.75,.5,1"}, {8, 12, 24, 24}},
        {{"--pixelbounds", "13,18,7,8"}, {13, 7, 18, 8}},
        {{"--pixelbounds", "30,99,0,2"}, {30, 0, 32, 2}},
        {{"-D", "Film.pixelbounds=13,18,7,8"}, {13, 7, 18, 8}},
    };
    for (auto [options, window] : crops) {
        options.insert(options.end(), {"--replicates", "2"});
        render("crop.exr", options);
        const ExrFile crop = readExr(folder.path("crop.exr"));
        EXPECT_EQ(cornersOf(crop.header.dataWindow), cornersOf(window));
        EXPECT_EQ(cornersOf(crop.header.displayWindow), (std::array{0, 0, 32, 24}));
        EXPECT_EQ(bitsOf(crop, window), bitsOf(whole, window));
        EXPECT_TRUE(contains(recipeOf(crop).at("command"), " " + options[0] + " "));
        if (options[0] != "-D") {
            EXPECT_TRUE(contains(recipeOf(crop).at("command"), options[1].substr(0, 4)));
        }
    }
}

TEST_F(RenderCommand, CropsThatLeaveNothingAreRefused) {
    const auto errorOf = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"render", scene, "-o", folder.path("a.exr")});
        const ProgramRun run = runProgram(options);
        EXPECT_EQ(run.code, 64);
        return run.err;
    };
    EXPECT_EQ(errorOf({"--cropwindow", "0.5,0.5,0,1"}), "error: --cropwindow leaves no pixel of the picture of 32x24\n");
    EXPECT_EQ(errorOf({"--pixelbounds", "40,50,0,1"}), "error: --pixelbounds leaves no pixel of the picture of 32x24\n");
    EXPECT_EQ(errorOf({"--cropwindow", "0,1.5,0,1"}), "error: --cropwindow: '1.5' is not a number from 0 to 1\n");
    EXPECT_EQ(errorOf({"--cropwindow", "0,1"}),
              "error: --cropwindow: '0,1' are 2 values; 4 are needed, with commas between\n");
    EXPECT_TRUE(contains(errorOf({"--cropwindow", "0,1,0,1", "--pixelbounds", "0,1,0,1"}), "give one of them"));
}

TEST_F(RenderCommand, OverridesOfTheSceneAreTheSceneWithThatText) {
    const std::string edited = [&] {
        std::string text = kSmallScene;
        text.replace(text.find("fov\" 40"), 7, "fov\" 55");
        text.replace(text.find("maxdepth\" 4"), 11, "maxdepth\" 2");
        text.insert(text.find("Sampler"), "PixelFilter \"box\"\n");
        return folder.file("edited.pbrt", text);
    }();
    render("a.exr", {"-D", "Camera.fov=55", "-D", "Integrator.maxdepth=9", "-DIntegrator.maxdepth=2", "-D",
                     "PixelFilter=box"});
    EXPECT_EQ(runProgram({"render", edited, "-o", folder.path("b.exr"), "--quiet"}).code, 0);
    const ExrFile a = readExr(folder.path("a.exr")), b = readExr(folder.path("b.exr"));
    EXPECT_EQ(bitsOf(a, {0, 0, 32, 24}), bitsOf(b, {0, 0, 32, 24}));
    EXPECT_TRUE(contains(recipeOf(a).at("command"), "-D Camera.fov=55 -D Integrator.maxdepth=9"));
    EXPECT_EQ(runProgram({"info", scene, "--json"}).code, 0);
}

TEST_F(RenderCommand, OverridesThatMeanNothingAreRefused) {
    const auto errorOf = [&](const std::string& setting) {
        const ProgramRun run = runProgram({"render", scene, "-o", folder.path("a.exr"), "-D", setting});
        EXPECT_EQ(run.code, 64) << setting;
        return run.err;
    };
    EXPECT_EQ(errorOf("Camera.fo=30"),
              "error: -D Camera.fo=30: camera 'perspective' has no parameter 'fo'; did you mean 'fov'?\n");
    EXPECT_EQ(errorOf("Film.iso=fast"), "error: -D Film.iso=fast: 'fast' is not a number\n");
    EXPECT_EQ(errorOf("Cammera.fov=30"),
              "error: -D 'Cammera.fov=30': unknown directive 'Cammera'; did you mean 'Camera'?\n");
    EXPECT_TRUE(contains(errorOf("Camera.fov"), "expected DIRECTIVE.PARAMETER=VALUE"));
    const ProgramRun range = runProgram({"render", scene, "-o", folder.path("a.exr"), "-D", "Camera.fov=190"});
    EXPECT_EQ(range.code, 65);
    EXPECT_TRUE(contains(range.err, "error: -D Camera.fov=190: fov is 190, outside the allowed range")) << range.err;
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
