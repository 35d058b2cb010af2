#include "scenes/builder/media.h"

#include <fmt/format.h>

namespace penumbra::builder {

MediumLibrary::MediumLibrary(const SceneDescription& scene, BuildContext& context, std::vector<MediumRecord>& table)
    : scene_(scene), context_(context), table_(table) {
    table_.assign(1, MediumRecord{});
    for (std::size_t i = 0; i < scene.media.size(); ++i)
        names_[scene.media[i].name] = i;
}

std::uint32_t MediumLibrary::row(const std::string& name, SourcePosition where) {
    if (name.empty()) return 0;
    const auto found = names_.find(name);
    if (found == names_.end()) {
        std::vector<std::string> known;
        for (const auto& entry : names_)
            known.push_back(entry.first);
        context_.fail(where, "unknown medium " + quote(name) + suggestion(name, known));
    }
    const auto [place, isNew] = rows_.try_emplace(found->second, 0);
    if (isNew) {
        table_.push_back(make(scene_.media[found->second]));
        place->second = std::uint32_t(table_.size() - 1);
    }
    return place->second;
}

MediumRecord MediumLibrary::make(const NamedMediumEntity& entity) {
    static const std::vector<std::string> known{"homogeneous", "uniformgrid", "rgbgrid", "cloud", "nanovdb"};
    if (entity.type == "homogeneous") return makeHomogeneous(entity);
    if (std::find(known.begin(), known.end(), entity.type) == known.end())
        context_.fail(entity.where, "unknown medium type " + quote(entity.type) + suggestion(entity.type, known));
    context_.warnOnce("medium " + entity.type, entity.where,
                      "the medium type " + quote(entity.type) + " is not there yet; vacuum stands in for it");
    entity.parameters.markAllUsed();
    return {};
}

MediumRecord MediumLibrary::makeHomogeneous(const NamedMediumEntity& entity) {
    const ParameterSet& p = entity.parameters;
    const std::string owner = ownerName("medium", entity.name);
    if (const Parameter* preset = p.find("string", "preset")) {
        context_.warnOnce("medium preset", preset->where,
                          "presets of media are not there yet; vacuum stands in for them");
        p.markAllUsed();
        return {};
    }
    const auto coefficient = [&](const char* name) {
        const Parameter* given = BuildContext::findSpectrum(p, name);
        return given ? readSpectrumParameter(*given, SpectrumRole::Unbounded, context_.spectra(), owner) : Rgb{1, 1, 1};
    };
    constexpr float kMost = 1e30f;
    const float scale = context_.number(p, "scale", 1, 0, kMost);
    const Rgb absorption = coefficient("sigma_a") * scale, scattering = coefficient("sigma_s") * scale;
    if (!(absorption.largest() <= kMost))
        context_.fail(entity.where, owner + ": the absorption is too large for a float");
    if (scattering.largest() > 0)
        context_.warnOnce("scattering", entity.where, owner + ": scattering media come later: light is only absorbed");
    const Parameter* emission = BuildContext::findSpectrum(p, "Le");
    if (emission && readSpectrumParameter(*emission, SpectrumRole::Illuminant, context_.spectra(), owner).largest() > 0)
        context_.warnOnce("emitting medium", emission->where, owner + ": media do not emit yet");
    p.number("Lescale", 1);
    p.number("g", 0);
    context_.warnUnused(p, owner);
    return {toSpectrum(absorption)};
}

}  // namespace penumbra::builder
