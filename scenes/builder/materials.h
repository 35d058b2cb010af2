// MaterialLibrary: the materials of a scene file, by name or number, made when a shape first uses them.
//
// Thread safety: none; one instance belongs to one build.
#pragma once

#include "scenes/builder/textures.h"

#include "materials/registry.h"

#include <map>
#include <optional>

namespace penumbra::builder {

/// A material as shapes need to know it.
struct SceneMaterial {
    MaterialHandle handle;
    bool passThrough = false;   ///< no surface: what is put on it does not shine
    bool needsUv = false;       ///< some texture looks at uv
    bool needsTangent = false;  ///< it is anisotropic
};

class MaterialLibrary {
public:
    /// All must outlive this object. Fails where a material is of a type that nobody knows.
    MaterialLibrary(const SceneDescription& scene, BuildContext& context, TextureLibrary& textures,
                    MaterialTable& table);

    SceneMaterial get(const MaterialReference& reference);

private:
    using Made = std::optional<SceneMaterial>;
    SceneMaterial getNamed(const std::string& name, SourcePosition where);
    SceneMaterial make(const Entity& entity, const std::string& owner);
    SceneMaterial makeOurs(const Entity& entity, const std::string& owner);
    SceneMaterial makeMix(const Entity& entity, const std::string& owner);

    const SceneDescription& scene_;
    BuildContext& context_;
    TextureLibrary& textures_;
    MaterialTable& table_;
    std::map<std::string, std::size_t, std::less<>> names_;
    std::map<std::size_t, Made> named_;  ///< nothing: being made
    std::map<int, SceneMaterial> unnamed_;
    int depth_ = 0;
};

}  // namespace penumbra::builder
