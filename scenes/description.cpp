#include "scenes/description.h"

#include <filesystem>
#include <system_error>

namespace penumbra {

std::string resolvePath(const SceneDescription& scene, const std::string& name) {
    namespace fs = std::filesystem;
    const fs::path path(name);
    if (path.is_absolute()) return name;
    const fs::path beside = fs::path(scene.topFile).parent_path() / path;
    std::error_code ignored;
    if (!fs::exists(beside, ignored) && fs::exists(path, ignored)) return name;
    return beside.string();
}

}  // namespace penumbra
