#include "scenes/pbrt/reader.h"

#include "scenes/pbrt/parser.h"

#include <filesystem>

namespace penumbra {

namespace {

/// `open` opens the top file. The only place where places become text.
template <class Open>
SceneDescription readPbrt(const std::string& topFile, const std::string& root, Warnings& warnings, Open&& open) {
    SceneDescription scene;
    scene.topFile = topFile;
    scene.root = root;
    pbrt::Sources sources(scene);
    try {
        open(sources);
        pbrt::Parser(sources, scene, warnings).run();
    } catch (const ErrorAt& e) {
        throw Error(e.kind(), e.placed(scene.files).what() + sources.includeChain());
    }
    return scene;
}

}  // namespace

SceneDescription readPbrtFile(const std::string& path, Warnings& warnings, const std::string& root) {
    return readPbrt(path, root, warnings, [&](pbrt::Sources& sources) {
        if (path == "-")
            sources.openStandardInput();
        else
            sources.openTopFile(path);
    });
}

SceneDescription readPbrtText(std::string_view text, const std::string& name, const std::string& folder,
                              Warnings& warnings, const std::string& root) {
    const std::string topFile = (std::filesystem::path(folder) / name).string();
    return readPbrt(topFile, root, warnings, [&](pbrt::Sources& sources) { sources.openText(text, name); });
}

}  // namespace penumbra
