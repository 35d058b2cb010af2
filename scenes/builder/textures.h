// TextureLibrary: the textures of a scene file by name. A texture is made when something first uses it, once for every
// role under which it is used.
//
// Hostile input: textures that refer to themselves, and chains deeper than kDeepest, are errors.
// Thread safety: none; one instance belongs to one build.
#pragma once

#include "scenes/builder/context.h"

#include "core/image/texture.h"

#include <map>
#include <optional>

namespace penumbra::builder {

class TextureLibrary {
public:
    static constexpr int kDeepest = 64;

    /// All three must outlive this object. Fails where a texture is of a class that nobody knows.
    TextureLibrary(const SceneDescription& scene, BuildContext& context, Textures& table);

    /// The texture that a "texture" parameter names.
    TextureOperand spectrum(const Parameter& reference, SpectrumRole role);
    TextureOperand scalar(const Parameter& reference);
    /// The file that the "string normalmap" of a material names; see Textures::addNormalMap.
    std::uint32_t normalMap(const Entity& material, const std::string& owner);

private:
    struct Use {
        std::size_t texture = 0;           ///< index into the scene's textures
        std::optional<SpectrumRole> role;  ///< none: a float texture
        auto operator<=>(const Use&) const = default;
    };
    std::size_t find(const Parameter& reference, bool isFloat) const;
    TextureOperand get(Use use, SourcePosition where);
    TextureOperand make(const TextureEntity& texture, std::optional<SpectrumRole> role);

    const SceneDescription& scene_;
    BuildContext& context_;
    Textures& table_;
    std::map<std::string, std::size_t, std::less<>> floats_, spectra_;
    std::map<Use, std::optional<TextureOperand>> made_;  ///< nothing: being made
    int depth_ = 0;
};

}  // namespace penumbra::builder
