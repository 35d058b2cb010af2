#include "scenes/builder/textures.h"

#include "core/image/texture_registry.h"

#include <fmt/format.h>

namespace penumbra::builder {
namespace {

class SceneTextureInput final : public TextureInput {
public:
    SceneTextureInput(const Entity& entity, const Matrix4& textureToWorld, std::string owner,
                      std::optional<SpectrumRole> role, TextureLibrary& library, BuildContext& context)
        : entity_(entity),
          textureToWorld_(textureToWorld),
          role_(role),
          library_(library),
          context_(context),
          owner_(std::move(owner)) {}

    TextureKind kind() const override { return role_ ? TextureKind::Spectrum : TextureKind::Float; }
    SpectrumRole role() const override { return role_.value_or(SpectrumRole::Unbounded); }
    const ColorSpace& filmColorSpace() const override { return context_.filmColorSpace(); }
    const Matrix4& textureToWorld() const override { return textureToWorld_; }
    TextureOperand spectrum(std::string_view name, Rgb otherwise) override {
        if (const Parameter* p = parameters().find("texture", name)) return library_.spectrum(*p, role());
        if (const Parameter* p = BuildContext::findSpectrum(parameters(), name))
            return TextureOperand::color(readSpectrumParameter(*p, role(), context_.spectra(), owner_));
        return TextureOperand::color(otherwise);
    }
    TextureOperand scalar(std::string_view name, float otherwise) override {
        if (const Parameter* p = parameters().find("texture", name)) return library_.scalar(*p);
        return TextureOperand::number(parameters().number(name, otherwise));
    }
    std::string path(std::string_view name) override {
        const std::string file = parameters().text(name, "");
        if (file.empty()) fail(fmt::format("\"string {}\" is missing", name));
        return context_.placed(entity_.where, owner_, [&] { return context_.path(file); });
    }
    const ParameterSet& parameters() const override { return entity_.parameters; }
    std::string where() const override { return context_.position(entity_.where) + ": " + owner_; }
    void warn(const std::string& text) override { context_.warn(entity_.where, owner_ + ": " + text); }
    [[noreturn]] void fail(const std::string& text) override { context_.fail(entity_.where, owner_ + ": " + text); }

private:
    const Entity& entity_;
    const Matrix4& textureToWorld_;
    std::optional<SpectrumRole> role_;
    TextureLibrary& library_;
    BuildContext& context_;
    std::string owner_;
};

}  // namespace

TextureLibrary::TextureLibrary(const SceneDescription& scene, BuildContext& context, Textures& table)
    : scene_(scene), context_(context), table_(table) {
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        const TextureEntity& t = scene.textures[i];
        (t.isFloat ? floats_ : spectra_)[t.name] = i;
        if (!Textures::knows(t.type))
            context.fail(t.where,
                         "unknown texture class " + quote(t.type) + suggestion(t.type, pluginNames(TextureTypes{})));
    }
}

TextureOperand TextureLibrary::spectrum(const Parameter& reference, SpectrumRole role) {
    return get({find(reference, false), role}, reference.where);
}

TextureOperand TextureLibrary::scalar(const Parameter& reference) {
    return get({find(reference, true), std::nullopt}, reference.where);
}

std::size_t TextureLibrary::find(const Parameter& reference, bool isFloat) const {
    const auto& names = isFloat ? floats_ : spectra_;
    const std::string& name = reference.strings().front();
    if (const auto found = names.find(name); found != names.end()) return found->second;
    const std::string kind = isFloat ? "float" : "spectrum";
    if ((isFloat ? spectra_ : floats_).contains(name))
        context_.fail(reference.where, fmt::format("{} needs a {} texture, and {} is one of the other kind",
                                                   quote(reference.name), kind, quote(name)));
    std::vector<std::string> known;
    for (const auto& entry : names)
        known.push_back(entry.first);
    context_.fail(reference.where, fmt::format("unknown {} texture {}{}", kind, quote(name), suggestion(name, known)));
}

TextureOperand TextureLibrary::get(Use use, SourcePosition where) {
    const auto [place, isNew] = made_.try_emplace(use);
    const TextureEntity& texture = scene_.textures[use.texture];
    if (!isNew) {
        if (!place->second) context_.fail(where, "the texture " + quote(texture.name) + " refers to itself");
        return *place->second;
    }
    if (++depth_ > kDeepest)
        context_.fail(where, fmt::format("textures within textures are more than {} deep", kDeepest));
    const TextureOperand operand = make(texture, use.role);
    --depth_;
    place->second = operand;
    return operand;
}

TextureOperand TextureLibrary::make(const TextureEntity& texture, std::optional<SpectrumRole> role) {
    const std::string owner = ownerName("texture", texture.name);
    SceneTextureInput input(texture, texture.textureToWorld, owner, role, *this, context_);
    const TextureOperand operand = table_.add(texture.type, input);
    context_.warnUnused(texture.parameters, owner);
    return operand;
}

std::uint32_t TextureLibrary::normalMap(const Entity& material, const std::string& owner) {
    const Matrix4 nowhere;
    SceneTextureInput input(material, nowhere, owner, SpectrumRole::Unbounded, *this, context_);
    return table_.addNormalMap("normalmap", input);
}

}  // namespace penumbra::builder
