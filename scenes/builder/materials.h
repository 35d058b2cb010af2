// MaterialLibrary: the materials of a scene file, by name or number, made when a shape or a mix first uses them.
//
// Hostile input: mixes that refer to themselves, and chains deeper than kDeepest, are errors.
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
    bool passThrough = false;   ///< no surface, or a mix with some: what is put on it does not shine
    bool needsUv = false;       ///< it looks at uv, or some texture does
    bool needsTangent = false;  ///< the x axis of its frame matters
};

class MaterialLibrary {
public:
    static constexpr std::size_t kDeepest = 64;

    /// All must outlive this object. Fails where a material is of a type that nobody knows.
    MaterialLibrary(const SceneDescription& scene, BuildContext& context, TextureLibrary& textures,
                    MaterialTable& table);

    SceneMaterial get(const MaterialReference& reference);

private:
    using Made = std::optional<SceneMaterial>;
    SceneMaterial getNamed(const std::string& name, SourcePosition where);
    SceneMaterial make(const Entity& entity, const std::string& owner);
    SceneMaterial makeOurs(const Entity& entity, const std::string& owner);
    /// The bumps and the normal map of the material that was made of the entity.
    void addRelief(const Entity& entity, const std::string& owner, SceneMaterial& made);
    SceneMaterial makeMix(const Entity& entity, const std::string& owner);
    [[noreturn]] void failCycle(std::size_t material, SourcePosition where) const;

    const SceneDescription& scene_;
    BuildContext& context_;
    TextureLibrary& textures_;
    MaterialTable& table_;
    std::map<std::string, std::size_t, std::less<>> names_;
    std::map<std::size_t, Made> named_;  ///< nothing: being made
    std::vector<std::size_t> making_;    ///< the named ones being made, each a member of the one before
    std::map<int, SceneMaterial> unnamed_;
};

}  // namespace penumbra::builder
