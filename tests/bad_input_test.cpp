// Puts the corpus of bad inputs (tests/bad_input/) to the program, as a user would, and holds it to the rules that
// tests/bad_input/bad_input.h states.

#include "tests/bad_input/command_line.h"
#include "tests/bad_input/images.h"
#include "tests/bad_input/ply.h"
#include "tests/bad_input/scene_text.h"
#include "tests/run_program.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <map>
#include <regex>

namespace penumbra::bad_input {
namespace {

namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;  // more memory and time, and an address space that has no limit
#else
constexpr bool kIsSanitized = false;
#endif

/// Makes the files in the folder; returns their bytes.
std::uint64_t make(const Files& files, const TemporaryFolder& folder) {
    std::uint64_t bytes = 0;
    for (const auto& [name, content] : files) {
        const std::size_t arrow = name.find(" -> ");
        const auto* text = std::get_if<std::string>(&content);
        if (arrow != std::string::npos)
            fs::create_symlink(name.substr(arrow + 4), folder.path(name.substr(0, arrow)));
        else if (name.ends_with('/'))
            fs::create_directories(folder.path(name));
        else
            bytes += fs::file_size(folder.file(name, text ? *text : std::get<1>(content)()));
    }
    return bytes;
}

/// What is in a folder: names, sizes and times of change, but for the picture.
std::map<std::string, std::string> stateOf(const TemporaryFolder& folder) {
    std::map<std::string, std::string> state;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path(""))) {
        if (entry.path().filename().string().starts_with("out.")) continue;
        std::string& text = state[entry.path().string()];
        if (entry.is_symlink()) text = "-> " + fs::read_symlink(entry.path()).string();
        if (entry.is_symlink() || !entry.is_regular_file()) continue;
        text += std::to_string(entry.file_size()) + " bytes, " +
                std::to_string(entry.last_write_time().time_since_epoch().count());
    }
    return state;
}

/// The program with a locale that has decimal commas, without a home, and with limits beyond which it is a failure.
ProgramSurroundings surroundingsOf(const Case& c, const TemporaryFolder& folder) {
    ProgramSurroundings s;
    s.folder = folder.path("");
    s.environment = c.environment;
    s.environment.insert(s.environment.end(), {{"LC_ALL", "de_DE.UTF-8"}, {"HOME", ""}});
    s.inChild = [] {
        constexpr rlim_t kAddressSpace = rlim_t{2} << 30, kSeconds = 60;
        const rlimit memory{kAddressSpace, kAddressSpace}, seconds{kSeconds, kSeconds};
        if (!kIsSanitized) ::setrlimit(RLIMIT_AS, &memory);
        ::setrlimit(RLIMIT_CPU, &seconds);
        ::alarm(240);  // for what waits rather than works; the machine may be slow
    };
    return s;
}

void expectLines(const std::string& text, bool withPlace) {
    static const std::regex place(R"(^(error|warning): ([^:]+\.pbrt(:[0-9]+:[0-9]+)?|--[a-z]+|[^:]+\.[a-z]+): .*)");
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        EXPECT_TRUE(withPlace ? std::regex_match(line.substr(0, 200), place)
                              : line.starts_with("error: ") || line.starts_with("warning: "))
            << line;
        EXPECT_LE(line.size(), 5000u);
        EXPECT_TRUE(std::none_of(line.begin(), line.end(), [](char c) { return c >= 0 && c < ' '; })) << line;
    }
}

/// Any line that begins so.
bool says(const std::string& text, const std::string& start) {
    return text.starts_with(start) || contains(text, "\n" + start);
}

void expectBehaves(const Case& c) {
    SCOPED_TRACE("bad input: " + c.name);
    const TemporaryFolder folder;
    const double megabytes = 1e-6 * double(make(c.files, folder));
    const auto before = stateOf(folder);
    std::vector<std::string> arguments = c.command;
    arguments.insert(arguments.end(), {"--progress", "none"});
    if (!c.threads.empty()) arguments.insert(arguments.end(), {"-t", c.threads});
    arguments.insert(arguments.end(), c.options.begin(), c.options.end());
    const ProgramRun run = runProgram(arguments, surroundingsOf(c, folder));

    EXPECT_EQ(run.code, c.code) << run.err.substr(0, 2000);
    if (!kIsSanitized) {
        EXPECT_LE(run.cpuSeconds, 2 + megabytes / 100);
        EXPECT_LE(double(run.peakBytes) * 1e-6, 256 + 4 * megabytes);
    }
    EXPECT_EQ(stateOf(folder), before);
    EXPECT_EQ(fs::exists(folder.path("out.exr")), run.code == 0);
    EXPECT_EQ(run.out, "");
    const std::string told = std::regex_replace(run.err, std::regex("wrote out.exr: .*\n"), "");
    expectLines(told, c.hasPlace);
    EXPECT_EQ(std::count(told.begin(), told.end(), '\n') > 0, !c.says.empty()) << told.substr(0, 2000);
    EXPECT_TRUE(says(told, c.says)) << "expected: " << c.says << "\nfound:    " << told.substr(0, 2000);
    EXPECT_EQ(says(told, "error: "), run.code != 0) << told.substr(0, 2000);
}

void expectAllBehave(const std::vector<Case>& cases) {
    for (const Case& c : cases)
        expectBehaves(c);
}

TEST(BadSceneText, Encoding) {
    expectAllBehave(encodingCases());
}
TEST(BadSceneText, Syntax) {
    expectAllBehave(syntaxCases());
}
TEST(BadSceneText, Settings) {
    expectAllBehave(settingsCases());
}
TEST(BadSceneText, Files) {
    expectAllBehave(fileCases());
}
TEST(BadSceneText, Meaning) {
    expectAllBehave(meaningCases());
}
TEST(BadCommandLine, Options) {
    expectAllBehave(optionCases());
}
TEST(BadCommandLine, Outputs) {
    expectAllBehave(outputCases());
}
TEST(BadCommandLine, Environment) {
    expectAllBehave(environmentCases());
}
TEST(BadPly, Header) {
    expectAllBehave(plyHeaderCases());
}
TEST(BadPly, Data) {
    expectAllBehave(plyDataCases());
}
TEST(BadImage, Textures) {
    expectAllBehave(textureCases());
}

}  // namespace
}  // namespace penumbra::bad_input
