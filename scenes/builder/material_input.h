// SceneMaterialInput: the parameters of one material of a scene file, as materials ask for them.
#pragma once

#include "scenes/builder/textures.h"

#include "materials/material.h"

namespace penumbra::builder {

class SceneMaterialInput final : public MaterialInput {
public:
    /// All must outlive this object.
    SceneMaterialInput(const Entity& entity, const std::string& owner, BuildContext& context, TextureLibrary& textures,
                       MaterialTables& tables)
        : entity_(entity), owner_(owner), context_(context), textures_(textures), tables_(tables) {}

    SpectrumInput albedo(std::string_view name, Rgb otherwise) override;
    SpectrumInput coefficient(std::string_view name, Rgb otherwise) override;
    ScalarInput scalar(std::string_view name, float otherwise) override;
    ScalarInput scalar(std::string_view name, const ScalarInput& otherwise) override;
    float dielectricIndex(std::string_view name, float otherwise) override;
    ConductorIndex conductorIndex(std::string_view eta, std::string_view k) override;
    std::vector<char> file(std::string_view name, std::uint64_t most) override;
    const ChannelWeights& channelWeights() const override { return penumbra::channelWeights(context_.filmColorSpace()); }
    const ParameterSet& parameters() const override { return entity_.parameters; }
    void warn(const std::string& text) override { context_.warn(entity_.where, owner_ + ": " + text); }
    [[noreturn]] void fail(const std::string& text) override { context_.fail(entity_.where, owner_ + ": " + text); }
    MaterialTables& tables() override { return tables_; }

    /// Whether some answer was a texture.
    bool usesTextures() const { return usesTextures_; }

private:
    SpectrumInput color(std::string_view name, Rgb otherwise, SpectrumRole role);
    /// The parameter of half of a conductor's index; a constant texture becomes an rgb, held in `storage`.
    const Parameter* indexParameter(std::string_view name, Parameter& storage);

    const Entity& entity_;
    const std::string& owner_;
    BuildContext& context_;
    TextureLibrary& textures_;
    MaterialTables& tables_;
    bool usesTextures_ = false;
};

}  // namespace penumbra::builder
