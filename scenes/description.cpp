#include "scenes/description.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace penumbra {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostOfPath = 1000;  // bytes of a path that a message shows

std::string findFile(const SceneDescription& scene, const std::string& name) {
    const fs::path path(name);
    if (path.is_absolute()) return name;
    const fs::path beside = fs::path(scene.topFile).parent_path() / path;
    std::error_code ignored;
    if (!fs::exists(beside, ignored) && fs::exists(path, ignored)) return name;
    return beside.string();
}

}  // namespace

std::string resolvePath(const SceneDescription& scene, const std::string& name) {
    std::string path = findFile(scene, name);
    checkInsideRoot(scene.root, path);
    return path;
}

std::string canonicalRoot(const std::string& folder) {
    std::error_code failure;
    const fs::path root = fs::canonical(folder, failure);
    if (failure) throw Error(ErrorKind::MissingInput, quote(folder, kMostOfPath) + ": " + failure.message());
    if (!fs::is_directory(root, failure))
        throw Error(ErrorKind::MissingInput, quote(folder, kMostOfPath) + ": is no folder");
    return root.string();
}

void checkInsideRoot(const std::string& root, const std::string& path) {
    if (root.empty()) return;
    std::error_code failure;
    const fs::path inside(root), actual = fs::weakly_canonical(fs::absolute(path, failure), failure);
    // What cannot be followed to its end might lead anywhere.
    const bool isInside =
        !failure && std::mismatch(inside.begin(), inside.end(), actual.begin(), actual.end()).first == inside.end();
    if (!isInside)
        throw Error(ErrorKind::NotPermitted, "the file " + quote(path, kMostOfPath) + " lies outside the root " +
                                                 quote(root, kMostOfPath) + " that --root sets");
}

}  // namespace penumbra
