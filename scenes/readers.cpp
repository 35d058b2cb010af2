#include "scenes/readers.h"

#include "core/base/text.h"
#include "scenes/pbrt/reader.h"

#include <filesystem>

namespace penumbra {

namespace {

struct SceneFormat {
    std::string extension;
    SceneDescription (*read)(const std::string& path, Warnings& warnings, const std::string& root);
};

const std::vector<SceneFormat>& sceneFormats() {
    static const std::vector<SceneFormat> formats{{".pbrt", readPbrtFile}};
    return formats;
}

std::string extensionOf(const std::string& path) {
    std::filesystem::path name(path);
    if (name.extension() == ".gz") name.replace_extension();
    return name.extension().string();
}

}  // namespace

SceneDescription readScene(const std::string& path, Warnings& warnings, const std::string& root) {
    const std::string extension = extensionOf(path);
    if (extension.empty()) return readPbrtFile(path, warnings, root);
    std::vector<std::string> known;
    for (const SceneFormat& format : sceneFormats()) {
        if (format.extension == extension) return format.read(path, warnings, root);
        known.push_back(format.extension);
    }
    throw Error(ErrorKind::BadData,
                pathText(path) + ": no reader for scenes of the extension " + quote(extension) + suggestion(extension, known));
}

SceneDescription readSceneText(std::string_view text, const std::string& nameForMessages, const std::string& folder,
                               Warnings& warnings, const std::string& root) {
    return readPbrtText(text, nameForMessages, folder, warnings, root);
}

}  // namespace penumbra
