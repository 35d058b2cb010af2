// The order of the layers, and each third-party library in its one place: both are read off the #include lines of every
// source file of the project. docs/DESIGN.md says why; to move a border, change the tables below with it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// A layer: the folder whose files belong to it, and the layers that those files may include beside their own.
struct Layer {
    std::string_view folder;
    std::vector<std::string_view> mayInclude;
};

/// The longest folder that matches decides, so app/batch and app/commands are layers of their own.
const std::vector<Layer>& layers() {
    static const std::vector<Layer> table = [] {
        std::vector<Layer> result;
        std::vector<std::string_view> below;
        const auto add = [&](std::initializer_list<std::string_view> siblings) {
            for (const std::string_view folder : siblings)
                result.push_back({folder, below});
            below.insert(below.end(), siblings);
        };
        add({"core"});
        add({"samplers", "materials", "lights"});  // siblings: never each other
        add({"scenes"});
        add({"integrators"});
        add({"app/batch"});
        add({"bench/lab", "tests/proof"});
        add({"app/commands", "bench", "tests"});  // nobody includes these
        return result;
    }();
    return table;
}

/// A third-party library: the headers that are its own (as written between <> or ""), and the one file pair, given
/// without its extension, that may include them. No pair means: any .cpp file, but no header.
struct ThirdParty {
    std::string_view name;
    std::regex header;
    std::optional<std::string_view> onlyIn;
};

const std::vector<ThirdParty>& thirdParties() {
    static const std::vector<ThirdParty> table = {
        {"Embree", std::regex("embree[0-9]?/.*|rtcore.*"), "core/geometry/accelerator"},
        {"TBB", std::regex("(tbb|oneapi)/.*"), "core/base/parallel"},
        {"OpenImageIO", std::regex("OpenImageIO/.*"), "core/image/oiio_module"},
        {"OpenEXR", std::regex("OpenEXR/.*|Imath/.*|Imf.*|Imath.*|half\\.h|Iex.*"), "core/image/exr"},
        {"OpenColorIO", std::regex("OpenColorIO/.*"), "core/color/display"},
        {"OpenSSL", std::regex("openssl/.*"), "core/base/sha256"},
        {"utf8proc", std::regex("utf8proc\\.h"), "core/base/unicode"},
        {"libpng", std::regex("png\\.h"), "core/image/png"},
        {"zlib", std::regex("zlib\\.h"), "core/base/byte_reader"},
        {"nlohmann-json", std::regex("nlohmann/.*"), std::nullopt},
        {"CLI11", std::regex("CLI/.*"), std::nullopt},
        {"fmt", std::regex("fmt/.*"), std::nullopt},
    };
    return table;
}

/// Layers are tested on what they include; a test of a third-party adapter may speak to the library itself.
bool isTestProgram(const std::string& file) {
    return file.starts_with("tests/") && !file.starts_with("tests/proof/");
}

struct Include {
    std::string file;  ///< relative to the root of the project
    int line = 0;
    std::string target;
    bool quoted = false;
};

bool isUnder(std::string_view path, std::string_view folder) {
    return path.starts_with(folder) && path.size() > folder.size() && path[folder.size()] == '/';
}

const Layer* layerOf(std::string_view path) {
    const Layer* best = nullptr;
    for (const Layer& layer : layers()) {
        if (isUnder(path, layer.folder) && (!best || layer.folder.size() > best->folder.size())) best = &layer;
    }
    return best;
}

/// The includes of one text, in order; `file` is only a label.
std::vector<Include> includesOf(std::istream& text, const std::string& file) {
    static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
    std::vector<Include> result;
    std::string line;
    for (int number = 1; std::getline(text, line); ++number) {
        std::smatch match;
        if (std::regex_match(line, match, pattern)) result.push_back({file, number, match[2], match[1] == "\""});
    }
    return result;
}

std::string place(const Include& include) {
    return include.file + ":" + std::to_string(include.line) + ": includes " + include.target;
}

/// What is wrong with this include as the order of layers goes, or nothing.
std::optional<std::string> orderViolation(const Include& include) {
    const Layer* to = layerOf(include.target);
    if (!to) return std::nullopt;
    const Layer* from = layerOf(include.file);
    if (!from) return place(include) + ", but its own folder is not a layer";
    const bool allowed =
        from == to || std::find(from->mayInclude.begin(), from->mayInclude.end(), to->folder) != from->mayInclude.end();
    if (allowed) return std::nullopt;
    return place(include) + ", but " + std::string(from->folder) + " may not include " + std::string(to->folder);
}

/// What is wrong with this include as third-party libraries go, or nothing.
std::optional<std::string> thirdPartyViolation(const Include& include) {
    const fs::path file(include.file);
    const std::string stem = (file.parent_path() / file.stem()).string();
    for (const ThirdParty& library : thirdParties()) {
        if (!std::regex_match(include.target, library.header)) continue;
        if (library.onlyIn) {
            if (stem == *library.onlyIn || isTestProgram(include.file)) return std::nullopt;
            return place(include) + ", but " + std::string(library.name) + " belongs in " +
                   std::string(*library.onlyIn) + ".{h,cpp} alone";
        }
        if (file.extension() == ".cpp") return std::nullopt;
        return place(include) + ", but " + std::string(library.name) + " belongs in .cpp files";
    }
    return std::nullopt;
}

std::vector<Include> includesOfProject() {
    constexpr std::array kFolders = {"core",        "samplers", "materials", "lights", "scenes",
                                     "integrators", "app",      "bench",     "tests"};
    const fs::path root(PENUMBRA_SOURCE_DIR);
    std::vector<Include> result;
    for (const char* folder : kFolders) {
        if (!fs::exists(root / folder)) continue;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
            if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
            std::ifstream text(entry.path());
            const std::string name = fs::relative(entry.path(), root).string();
            const std::vector<Include> includes = includesOf(text, name);
            result.insert(result.end(), includes.begin(), includes.end());
        }
    }
    return result;
}

TEST(IncludeOrder, GoesOnlyTowardsTheCore) {
    const std::vector<Include> includes = includesOfProject();
    ASSERT_FALSE(includes.empty()) << "no source files under " << PENUMBRA_SOURCE_DIR;
    for (const Include& include : includes) {
        if (const auto violation = orderViolation(include)) ADD_FAILURE() << *violation;
    }
}

TEST(IncludeOrder, KeepsThirdPartyLibrariesInTheirPlace) {
    for (const Include& include : includesOfProject()) {
        if (const auto violation = thirdPartyViolation(include)) ADD_FAILURE() << *violation;
    }
}

/// A quoted include is one of ours, and starts at the root of the project.
TEST(IncludeOrder, QuotesOnlyPathsFromTheRoot) {
    const std::set<std::string> generated = {"core/base/version.h"};
    for (const Include& include : includesOfProject()) {
        if (!include.quoted || generated.contains(include.target)) continue;
        EXPECT_TRUE(fs::exists(fs::path(PENUMBRA_SOURCE_DIR) / include.target)) << place(include);
    }
}

// The checks themselves: what they must catch, and what they must let pass.
TEST(IncludeOrder, CatchesWhatItShould) {
    const auto orderOf = [](const char* file, const char* target) {
        return orderViolation({file, 1, target, true}).has_value();
    };
    EXPECT_TRUE(orderOf("core/base/error.h", "samplers/registry.h"));
    EXPECT_TRUE(orderOf("materials/diffuse.h", "lights/point.h"));
    EXPECT_TRUE(orderOf("integrators/path.cpp", "app/batch/job.h"));
    EXPECT_TRUE(orderOf("app/batch/job.cpp", "app/commands/main.h"));
    EXPECT_TRUE(orderOf("bench/lab/roof.cpp", "tests/proof/suite.h"));
    EXPECT_TRUE(orderOf("app/other/thing.cpp", "core/base/error.h"));
    EXPECT_FALSE(orderOf("core/film/film.h", "core/base/error.h"));
    EXPECT_FALSE(orderOf("app/commands/render.cpp", "tests/proof/suite.h"));
    EXPECT_FALSE(orderOf("tests/scenes_pbrt_test.cpp", "tests/helpers.h"));
    EXPECT_FALSE(orderOf("lights/point.h", "vector"));

    const auto thirdPartyOf = [](const char* file, const char* target) {
        return thirdPartyViolation({file, 1, target, false}).has_value();
    };
    EXPECT_TRUE(thirdPartyOf("integrators/path.cpp", "embree4/rtcore.h"));
    EXPECT_TRUE(thirdPartyOf("scenes/scene.cpp", "oneapi/tbb/parallel_for.h"));
    EXPECT_TRUE(thirdPartyOf("app/batch/job.h", "nlohmann/json.hpp"));
    EXPECT_TRUE(thirdPartyOf("core/film/film.cpp", "ImfOutputFile.h"));
    EXPECT_FALSE(thirdPartyOf("core/geometry/accelerator.cpp", "embree3/rtcore.h"));
    EXPECT_FALSE(thirdPartyOf("app/commands/render.cpp", "CLI/CLI.hpp"));
}

}  // namespace
