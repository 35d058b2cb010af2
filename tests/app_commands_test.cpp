// The command line as a user meets it: what is said, where, and with which exit code.

#include "tests/run_program.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace penumbra {
namespace {

/// A wrong command line: nothing on standard output, one line of error with these words, and the code.
void expectRefused(const std::vector<std::string>& arguments, int code, const std::string& words) {
    const ProgramRun run = runProgram(arguments);
    std::string line = "penumbra";
    for (const std::string& a : arguments)
        line += " " + a;
    EXPECT_EQ(run.code, code) << line << "\n" << run.err;
    EXPECT_EQ(run.out, "") << line;
    EXPECT_TRUE(run.err.starts_with("error: ")) << line << "\n" << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << line << "\n" << run.err;
    EXPECT_TRUE(contains(run.err, words)) << line << "\n" << run.err;
}

TEST(CommandLine, HelpOfEveryCommandHasUsageDefaultsAndExamples) {
    for (const char* command : {"render", "info", "list", "convert"}) {
        const ProgramRun run = runProgram({command, "--help"});
        EXPECT_EQ(run.code, 0);
        EXPECT_EQ(run.err, "");
        EXPECT_TRUE(contains(run.out, std::string("Usage: penumbra ") + command + " [options]")) << run.out;
        EXPECT_TRUE(contains(run.out, "Examples:\n  penumbra " + std::string(command))) << run.out;
        EXPECT_TRUE(contains(run.out, "(default: ") || contains(run.out, "(default:\n")) << run.out;
    }
    const ProgramRun program = runProgram({"--help"});
    EXPECT_EQ(program.code, 0);
    for (const char* command : {"  render ", "  info ", "  list ", "  convert "})
        EXPECT_TRUE(contains(program.out, command));
}

TEST(CommandLine, VersionNamesTheLibraries) {
    const ProgramRun run = runProgram({"--version"});
    EXPECT_EQ(run.code, 0);
    for (const char* library :
         {"penumbra ", "Embree ", "oneTBB ", "OpenImageIO ", "OpenEXR ", "OpenColorIO ", "OpenSSL ", "zlib "})
        EXPECT_TRUE(contains(run.out, library)) << run.out;
}

TEST(CommandLine, WrongUsageNamesTheNearest) {
    expectRefused({}, 64, "penumbra --help");
    expectRefused({"rendr", "x.pbrt"}, 64, "unknown command 'rendr'; did you mean 'render'?");
    expectRefused({"render", "x.pbrt", "--ssp", "4"}, 64, "unknown option '--ssp'; did you mean '--spp'?");
    expectRefused({"render", "x.pbrt", "--outfil=a.exr"}, 64, "did you mean '--outfile'?");
    expectRefused({"render", "x.pbrt", "-q"}, 64, "unknown option '-q'");
    expectRefused({"render"}, 64, "a scene is missing");
    expectRefused({"render", "x.pbrt", "y.pbrt"}, 64, "one word too many: 'y.pbrt'");
    expectRefused({"list", "sampler", "sobl"}, 64, "did you mean 'sobol'?");
    expectRefused({"list", "bananas"}, 64, "unknown kind 'bananas'");
}

TEST(CommandLine, ValuesAreChecked) {
    expectRefused({"render", "x.pbrt", "--spp"}, 64, "--spp");
    for (const char* value : {"0", "-1", "1e9x", "", "4.5", "99999999999999999999", " 4"})
        expectRefused({"render", "x.pbrt", "--spp", value}, 64,
                      "--spp: '" + std::string(value) + "' is not a whole number from 1 to ");
    for (const char* value : {"0", "-1", "1000000"})
        expectRefused({"render", "x.pbrt", "-t", value}, 64, "--nthreads: ");
    expectRefused({"render", "x.pbrt", "--resolution", "640"}, 64, "--resolution: '640'");
    expectRefused({"render", "x.pbrt", "--resolution", "0x5"}, 64, "--resolution: '0'");
    expectRefused({"render", "x.pbrt", "--seed", "4294967296"}, 64, "--seed: ");
    expectRefused({"render", "x.pbrt", "--sampler", "sobl"}, 64, "did you mean 'sobol'?");
    expectRefused({"render", "x.pbrt", "--integrator", "pat"}, 64, "did you mean 'path'?");
    expectRefused({"render", "x.pbrt", "--stats=yaml"}, 64, "--stats: unknown form 'yaml'");
    expectRefused({"render", "x.pbrt", "--progress", "xml"}, 64, "--progress: unknown form 'xml'");
    expectRefused({"render", "x.pbrt", "--progress", "json:77"}, 64, "descriptor 77 is not open");
    expectRefused({"render", "x.pbrt", "--pixel", "1,2"}, 64, "--pixel and --sample belong together");
    expectRefused({"convert", "a.exr", "b.png", "--exposure", "nan"}, 64, "--exposure: 'nan'");
    expectRefused({"convert", "a.exr"}, 64, "two pictures are needed");
}

TEST(CommandLine, InputsThatAreMissingOrWrong) {
    const TemporaryFolder folder;
    expectRefused({"render", folder.path("no.pbrt")}, 66, "no.pbrt");
    expectRefused({"info", folder.path("no.pbrt")}, 66, "no.pbrt");
    expectRefused({"convert", folder.path("no.exr"), folder.path("a.png")}, 66, "no.exr");
    const std::string wrong = folder.file("wrong.pbrt", "WorldBegin\n  Shape \"spere\"\n");
    expectRefused({"info", wrong}, 65, wrong + ":2:3: ");
    expectRefused({"info", wrong}, 65, "did you mean 'sphere'?");
    expectRefused({"convert", wrong, folder.path("a.png")}, 65, "wrong.pbrt");
}

TEST(CommandLine, OutputsThatCannotBe) {
    const TemporaryFolder folder;
    const std::string scene = folder.file("scene.pbrt", kSmallScene);
    expectRefused({"render", scene, "-o", ""}, 73, "a picture needs the name of a file");
    expectRefused({"render", scene, "-o", "/"}, 73, "a picture needs the name of a file");
    expectRefused({"render", scene, "-o", folder.path("no/a.exr")}, 73, "there is no folder");
    expectRefused({"render", scene, "-o", folder.path(std::string(300, 'a') + ".exr")}, 73, "name too long");
    expectRefused({"render", scene, "-o", scene}, 73, "is not overwritten");
    expectRefused({"render", scene, "-o", folder.path("a.qoi")}, 64, "known extensions: exr, png");
    EXPECT_EQ(readBytes(scene), kSmallScene);
    const ProgramRun full = runProgram({"render", scene, "-o", "/dev/full", "--quiet"});
    EXPECT_EQ(full.code, 74);
    EXPECT_TRUE(contains(full.err, "No space left")) << full.err;
}

TEST(CommandLine, OutputNeverReplacesAnAssetOfTheScene) {
    const TemporaryFolder folder;
    const std::string picture = folder.path("sky.png");
    const std::string plain = folder.file("plain.pbrt", kSmallScene);
    ASSERT_EQ(runProgram({"render", plain, "-o", picture, "--quiet"}).code, 0);
    const std::string bytes = readBytes(picture);
    const std::string scene = folder.file(
        "scene.pbrt", std::string("Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n") +
                          "WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"sky.png\"\n" +
                          "Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n");
    const ProgramRun run = runProgram({"render", scene, "-o", picture});
    EXPECT_EQ(run.code, 73);
    EXPECT_TRUE(contains(run.err, "is a file of the scene")) << run.err;
    EXPECT_EQ(readBytes(picture), bytes);
}

TEST(CommandLine, ClosedStandardStreamsAreNoDisaster) {
    const TemporaryFolder folder;
    const std::string scene = folder.file("scene.pbrt", kSmallScene), picture = folder.path("a.exr");
    for (const int descriptor : {0, 1, 2}) {
        ProgramSurroundings closed;
        closed.inChild = [descriptor] { ::close(descriptor); };
        EXPECT_EQ(runProgram({"render", scene, "-o", picture}, closed).code, 0) << descriptor;
        EXPECT_TRUE(readBytes(picture).starts_with("\x76\x2f\x31\x01")) << descriptor;
    }
}

TEST(CommandLine, OutputToADeviceThatIsFullIsAnErrorAndToAReaderThatLeftIsNone) {
    ProgramSurroundings full;
    full.inChild = [] { ::dup2(::open("/dev/full", O_WRONLY), STDOUT_FILENO); };
    EXPECT_EQ(runProgram({"list"}, full).code, 74);
    ProgramSurroundings gone;
    gone.inChild = [] {
        int ends[2];
        if (::pipe(ends) != 0) ::_exit(126);
        ::dup2(ends[1], STDOUT_FILENO);
        ::close(ends[0]);
    };
    const ProgramRun run = runProgram({"list"}, gone);
    EXPECT_EQ(run.code, 0);
    EXPECT_EQ(run.err, "");
}

TEST(CommandLine, ListGivesNamesParametersAndJson) {
    const ProgramRun all = runProgram({"list"});
    EXPECT_EQ(all.code, 0);
    for (const char* name : {"samplers", "  sobol ", "materials", "  diffuse ", "lights", "  infinite ", "integrators",
                             "  path ", "filters", "  mitchell ", "textures", "  imagemap "})
        EXPECT_TRUE(contains(all.out, name)) << name << all.out;
    EXPECT_FALSE(contains(all.out, "\"integer pixelsamples\"")) << all.out;
    const ProgramRun one = runProgram({"list", "sampler", "sobol"});
    EXPECT_TRUE(contains(one.out, "\"integer pixelsamples\"")) << one.out;
    EXPECT_FALSE(contains(one.out, "  stratified ")) << one.out;
    const nlohmann::json json = nlohmann::json::parse(runProgram({"list", "--json"}).out);
    EXPECT_EQ(json.at("samplers").at(0).at("name"), "sobol");
    EXPECT_FALSE(json.at("materials").at(0).at("parameters").empty());
}

TEST(CommandLine, InfoSaysWhatIsInAScene) {
    const TemporaryFolder folder;
    const std::string scene = folder.file("scene.pbrt", kSmallScene);
    const ProgramRun text = runProgram({"info", scene});
    EXPECT_EQ(text.code, 0);
    for (const char* part : {"32x24", "sobol, 4 samples per pixel", "path, maxdepth 4", "to film.exr"})
        EXPECT_TRUE(contains(text.out, part)) << text.out;
    const nlohmann::json json = nlohmann::json::parse(runProgram({"info", scene, "--json"}).out);
    EXPECT_EQ(json.at("film").at("resolution"), (nlohmann::json{32, 24}));
    EXPECT_EQ(json.at("shapes"), 2);
    EXPECT_EQ(json.at("lights").at("diffuse"), 1);
    EXPECT_EQ(json.at("lights").at("infinite"), 1);
    EXPECT_EQ(json.at("scene_sha256").get<std::string>().size(), 64u);
    EXPECT_NEAR(json.at("bounds").at("lower").at(1).get<double>(), -1, 1e-5);
}

TEST(CommandLine, InfoSaysWhetherMeshesAreSurfaces) {
    const TemporaryFolder folder;
    // A tetrahedron with a vertex twice over, as seams have it; two triangles that face opposite ways.
    const std::string scene = folder.file("scene.pbrt", std::string(kSmallScene) + R"(
Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  0 0 1  0 0 1 ] "integer indices" [ 0 2 1  0 1 3  1 2 4  2 0 4 ]
Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  -1 0 0 ] "integer indices" [ 0 1 2 0 3 2 ]
)");
    const nlohmann::json meshes = nlohmann::json::parse(runProgram({"info", scene, "--json"}).out).at("meshes");
    const nlohmann::json solid = meshes.at(meshes.size() - 2), sheet = meshes.at(meshes.size() - 1);
    EXPECT_TRUE(solid.at("closed"));
    EXPECT_TRUE(solid.at("oriented"));
    EXPECT_EQ(solid.at("euler_characteristic"), 2);
    EXPECT_FALSE(sheet.at("closed"));
    EXPECT_TRUE(sheet.at("manifold"));
    EXPECT_EQ(sheet.at("turned_edges"), 1);
    EXPECT_EQ(sheet.at("borders"), 1);
    const std::string text = runProgram({"info", scene}).out;
    EXPECT_TRUE(contains(text, ": trianglemesh, 4 triangles, closed manifold, Euler characteristic 2\n")) << text;
    EXPECT_TRUE(contains(text, "manifold with 1 border, 1 edge between triangles that face opposite ways, Euler")) << text;
}

TEST(CommandLine, WarningsStandBeforeErrorsAndStrictMakesThemErrors) {
    const TemporaryFolder folder;
    const std::string scene =
        folder.file("scene.pbrt", std::string(kSmallScene) + "Shape \"sphere\" \"float radios\" 1\n");
    const ProgramRun run = runProgram({"info", scene});
    EXPECT_EQ(run.code, 0);
    EXPECT_TRUE(run.err.starts_with("warning: " + scene + ":")) << run.err;
    EXPECT_TRUE(contains(run.err, "did you mean 'radius'?")) << run.err;
    const ProgramRun strict = runProgram({"info", scene, "--strict"});
    EXPECT_EQ(strict.code, 65);
    EXPECT_TRUE(contains(strict.err, "error: " + scene + ":")) << strict.err;
}

}  // namespace
}  // namespace penumbra
