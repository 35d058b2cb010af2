// Fuzz target: a text through the whole reader and builder, down to the acceleration structure. Files are confined to a
// folder of three, so that nothing of the machine is read and a finding repeats everywhere.

#include "scenes/builder.h"
#include "scenes/readers.h"
#include "tests/fuzz/property.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace penumbra {
namespace {

/// Made once a process, and left behind: it is a few bytes.
const std::string& sandbox() {
    static const std::string folder = [] {
        std::string pattern = (std::filesystem::temp_directory_path() / "penumbra-fuzz-XXXXXX").string();
        fuzz::require(::mkdtemp(pattern.data()) != nullptr, "a folder for the files");
        const auto file = [&](const char* name, const char* text) { std::ofstream(pattern + "/" + name) << text; };
        file("a.pbrt", "Shape \"sphere\" Material \"conductor\" Translate 1 0 0 MakeNamedMaterial \"imported\" "
                       "\"string type\" \"diffuse\"\n");
        file("m.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0 3 0 1 2\n");
        file("t.pfm", "Pf\n1 1\n-1\n\n\n\n?");
        return canonicalRoot(pattern);
    }();
    return folder;
}

void readAndBuild(std::string_view text, Warnings& warnings) {
    SceneDescription description = readSceneText(text, "fuzz.pbrt", sandbox(), warnings, sandbox());
    buildScene(std::move(description), {}, warnings);
}

}  // namespace
}  // namespace penumbra

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    using namespace penumbra;
    return fuzz::execute([&](Warnings& warnings) { readAndBuild({reinterpret_cast<const char*>(data), size}, warnings); });
}
