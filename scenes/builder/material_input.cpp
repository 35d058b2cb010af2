#include "scenes/builder/material_input.h"

#include "core/base/byte_reader.h"

namespace penumbra::builder {

SpectrumInput SceneMaterialInput::albedo(std::string_view name, Rgb otherwise) {
    SpectrumInput input = color(name, otherwise, SpectrumRole::Albedo);
    for (float* x : {&input.constant.r, &input.constant.g, &input.constant.b})
        *x = std::clamp(*x, 0.f, 1.f);
    return input;
}

SpectrumInput SceneMaterialInput::coefficient(std::string_view name, Rgb otherwise) {
    return color(name, otherwise, SpectrumRole::Unbounded);
}

SpectrumInput SceneMaterialInput::color(std::string_view name, Rgb otherwise, SpectrumRole role) {
    TextureOperand operand = TextureOperand::color(otherwise);
    if (const Parameter* p = parameters().find("texture", name))
        operand = textures_.spectrum(*p, role);
    else if (const Parameter* s = BuildContext::findSpectrum(parameters(), name))
        operand = TextureOperand::color(readSpectrumParameter(*s, role, context_.spectra(), owner_));
    if (operand.isConstant()) return {operand.constant, kNoTexture};
    usesTextures_ = true;
    return {{}, operand.texture};
}

ScalarInput SceneMaterialInput::scalar(std::string_view name, float otherwise) {
    const Parameter* p = parameters().find("texture", name);
    if (!p) return {parameters().number(name, otherwise), kNoTexture};
    const TextureOperand operand = textures_.scalar(*p);
    usesTextures_ = usesTextures_ || !operand.isConstant();
    return {operand.constant.r, operand.texture};
}

ScalarInput SceneMaterialInput::scalar(std::string_view name, const ScalarInput& otherwise) {
    const bool given = parameters().find("texture", name) || parameters().find("float", name);
    return given ? scalar(name, 0.f) : otherwise;
}

float SceneMaterialInput::dielectricIndex(std::string_view name, float otherwise) {
    const Parameter* p = parameters().find("float", name);
    if (!p) p = BuildContext::findSpectrum(parameters(), name);
    return p ? readIndexOfRefraction(*p, context_.spectra(), owner_) : otherwise;
}

ConductorIndex SceneMaterialInput::conductorIndex(std::string_view eta, std::string_view k) {
    Parameter etaStorage, kStorage;
    const Parameter* etaGiven = indexParameter(eta, etaStorage);
    const Parameter* kGiven = indexParameter(k, kStorage);
    return readConductorIndex(etaGiven, kGiven, context_.spectra(), owner_);
}

std::vector<char> SceneMaterialInput::file(std::string_view name, std::uint64_t most) {
    const Parameter* p = parameters().find("string", name);
    if (!p || p->strings().empty()) fail("needs a file: the parameter \"string " + std::string(name) + "\"");
    return context_.placed(p->where, owner_, [&] {
        const std::string path = context_.path(p->strings().front());
        ByteReader reader = ByteReader::open(path);
        std::vector<char> bytes;
        while (reader.fill(1)) {
            if (bytes.size() + reader.available() > most)
                throw Error(ErrorKind::BadData, path + ": longer than " + std::to_string(most) + " bytes");
            bytes.insert(bytes.end(), reader.data(), reader.data() + reader.available());
            reader.consume(reader.available());
        }
        return bytes;
    });
}

const Parameter* SceneMaterialInput::indexParameter(std::string_view name, Parameter& storage) {
    const Parameter* p = parameters().find("texture", name);
    if (!p) return BuildContext::findSpectrum(parameters(), name);
    const TextureOperand operand = textures_.spectrum(*p, SpectrumRole::Unbounded);
    if (!operand.isConstant()) {
        context_.warnOnce("textured conductor", p->where,
                          owner_ + ": textures as the index of a conductor are not there yet; copper stands in");
        return nullptr;
    }
    storage = {.type = "rgb",
               .name = p->name,
               .where = p->where,
               .values = std::vector<float>{operand.constant.r, operand.constant.g, operand.constant.b},
               .colorSpace = context_.filmColorSpace().name};
    return &storage;
}

}  // namespace penumbra::builder
