// The machine code of the transport: it must give the same bits on every AVX2 machine. So its objects call no
// single-precision function of the C library (glibc picks a variant by the processor, and its results change with the
// variant), and hold no fused multiply-add (the compiler would choose where, and one lane would differ from eight).
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/version.h"

namespace {

namespace fs = std::filesystem;

const fs::path kObjectFolders(PENUMBRA_BINARY_DIR "/CMakeFiles");

std::vector<fs::path> objectsUnder(const fs::path& folder) {
    std::vector<fs::path> result;
    if (!fs::exists(folder)) return result;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".o") result.push_back(entry.path());
    }
    return result;
}

/// Everything that may run below Integrator::render.
std::vector<fs::path> hotObjects() {
    std::vector<fs::path> result;
    for (const char* folder :
         {"penumbra_samplers.dir", "penumbra_materials.dir", "penumbra_lights.dir", "penumbra_integrators.dir",
          "penumbra_core.dir/core/math", "penumbra_core.dir/core/camera", "penumbra_core.dir/core/film",
          "penumbra_core.dir/core/geometry"}) {
        const std::vector<fs::path> objects = objectsUnder(kObjectFolders / folder);
        result.insert(result.end(), objects.begin(), objects.end());
    }
    return result;
}

/// What the command prints; a command that fails fails the test.
std::string outputOf(const std::string& command) {
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), [](FILE*) { return 0; });
    if (!pipe) {
        ADD_FAILURE() << "cannot run " << command;
        return {};
    }
    std::string output;
    std::array<char, 65536> buffer;
    while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe.get())) {
        output.append(buffer.data(), count);
    }
    EXPECT_EQ(pclose(pipe.get()), 0) << command;
    return output;
}

std::set<std::string> undefinedSymbols(const fs::path& object) {
    std::istringstream text(outputOf(PENUMBRA_NM " --undefined-only --format=just-symbols '" + object.string() + "'"));
    std::set<std::string> result;
    for (std::string symbol; std::getline(text, symbol);)
        result.insert(symbol);
    return result;
}

/// The mnemonics among the object's instructions that start with one of the prefixes.
std::set<std::string> mnemonics(const fs::path& object, std::initializer_list<std::string_view> prefixes) {
    std::istringstream text(outputOf(PENUMBRA_OBJDUMP " --disassemble --no-show-raw-insn '" + object.string() + "'"));
    std::set<std::string> result;
    for (std::string line; std::getline(text, line);) {
        const std::size_t tab = line.find('\t');  // "   12:\tvaddps %ymm0,..."
        if (tab == std::string::npos) continue;
        const std::string_view mnemonic =
            std::string_view(line).substr(tab + 1).substr(0, line.find(' ', tab) - tab - 1);
        for (const std::string_view prefix : prefixes) {
            if (mnemonic.starts_with(prefix)) result.emplace(mnemonic);
        }
    }
    return result;
}

std::string joined(const std::set<std::string>& names) {
    std::string result;
    for (const std::string& name : names)
        result += (result.empty() ? "" : " ") + name;
    return result;
}

class HotObjects : public testing::Test {
protected:
    void SetUp() override {
        if (penumbra::kNativeBuild) GTEST_SKIP() << "a build for this machine only promises nothing to others";
    }
};

TEST_F(HotObjects, CallNoSinglePrecisionLibraryFunction) {
    const std::set<std::string> forbidden = {"sinf",   "cosf",  "sincosf", "tanf",    "asinf",   "acosf", "atanf",
                                             "atan2f", "sinhf", "coshf",   "tanhf",   "expf",    "exp2f", "expm1f",
                                             "logf",   "log2f", "log10f",  "log1pf",  "powf",    "cbrtf", "hypotf",
                                             "fmaf",   "erff",  "erfcf",   "tgammaf", "lgammaf", "fma"};
    const std::vector<fs::path> objects = hotObjects();
    ASSERT_FALSE(objects.empty()) << "no objects under " << kObjectFolders;
    for (const fs::path& object : objects) {
        std::set<std::string> found;
        for (const std::string& symbol : undefinedSymbols(object)) {
            if (forbidden.contains(symbol)) found.insert(symbol);
        }
        EXPECT_TRUE(found.empty()) << object << " calls " << joined(found);
    }
}

TEST_F(HotObjects, HoldNoFusedMultiplyAdd) {
    for (const fs::path& object : hotObjects()) {
        const std::set<std::string> found = mnemonics(object, {"vfmadd", "vfmsub", "vfnmadd", "vfnmsub"});
        EXPECT_TRUE(found.empty()) << object << " holds " << joined(found);
    }
}

/// The check of the processor must itself run on any x86-64, and before the C library is up.
TEST(CpuCheck, IsCompiledForAnyProcessorAndCallsOnlyTheSystem) {
    const std::vector<fs::path> objects = objectsUnder(kObjectFolders / "penumbra_cpu_check.dir");
    ASSERT_EQ(objects.size(), 1u);
    const std::set<std::string> vexCoded = mnemonics(objects[0], {"v"});
    EXPECT_TRUE(vexCoded.empty()) << joined(vexCoded);
    for (const std::string& symbol : undefinedSymbols(objects[0])) {
        EXPECT_TRUE(symbol == "write" || symbol == "_exit" || symbol == "_GLOBAL_OFFSET_TABLE_") << symbol;
    }
}

}  // namespace
