#include "scenes/builder/context.h"

#include <fmt/format.h>

#include <cmath>

namespace penumbra::builder {

BuildContext::BuildContext(const SceneDescription& scene, const ColorSpace& film, Warnings& warnings)
    : spectra_{film, scene.files, [&scene](const std::string& name) { return resolvePath(scene, name); }, warnings} {}

void BuildContext::fail(SourcePosition where, const std::string& text, ErrorKind kind) const {
    throw Error(kind, position(where) + ": " + text);
}

void BuildContext::warn(SourcePosition where, const std::string& text) {
    warnings().add(position(where) + ": " + text);
}

void BuildContext::warnOnce(const std::string& kind, SourcePosition where, const std::string& text) {
    if (said_.insert(kind).second) warn(where, text);
}

void BuildContext::warnUnused(const ParameterSet& parameters, const std::string& owner) {
    parameters.warnUnused(files(), owner, warnings());
}

const Parameter* BuildContext::findSpectrum(const ParameterSet& parameters, std::string_view name) {
    for (const char* type : {"rgb", "blackbody", "spectrum"})
        if (const Parameter* p = parameters.find(type, name)) return p;
    return nullptr;
}

Rgb BuildContext::illuminant(const ParameterSet& parameters, std::string_view name, const std::string& owner) const {
    const Parameter* p = findSpectrum(parameters, name);
    return p ? readSpectrumParameter(*p, SpectrumRole::Illuminant, spectra_, owner) : Rgb{1, 1, 1};
}

float BuildContext::number(const ParameterSet& parameters, std::string_view name, float otherwise, float least,
                           float most) const {
    const float value = parameters.number(name, otherwise);
    if (value >= least && value <= most) return value;  // not NaN
    const Parameter* p = parameters.findAny(name);
    fail(p ? p->where : SourcePosition{},
         fmt::format("{} is {}, outside the allowed range, {} to {}", name, value, least, most));
}

int BuildContext::integer(const ParameterSet& parameters, std::string_view name, int otherwise, int least,
                          int most) const {
    const int value = parameters.integer(name, otherwise);
    if (value >= least && value <= most) return value;
    const Parameter* p = parameters.findAny(name);
    fail(p ? p->where : SourcePosition{},
         fmt::format("{} is {}, outside the allowed range, {} to {}", name, value, least, most));
}

}  // namespace penumbra::builder
