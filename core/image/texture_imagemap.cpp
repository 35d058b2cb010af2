#include "core/image/texture_imagemap.h"

#include "core/image/texture_registry.h"

#include <algorithm>
#include <string>

namespace penumbra {
namespace {

/// The place in `known` of the word that the "string" parameter gives; 'otherwise' where it is absent.
std::size_t choose(TextureInput& input, const std::string& name, const std::vector<std::string>& known,
                   const std::string& otherwise) {
    const std::string text = input.parameters().text(name, otherwise);
    const auto found = std::find(known.begin(), known.end(), text);
    if (found == known.end()) input.fail("unknown " + name + " " + quote(text) + suggestion(text, known));
    return std::size_t(found - known.begin());
}

WrapMode readWrap(TextureInput& input) {
    constexpr WrapMode kModes[] = {WrapMode::Repeat, WrapMode::Black, WrapMode::Clamp, WrapMode::OctahedralSphere};
    return kModes[choose(input, "wrap", {"repeat", "black", "clamp", "octahedralsphere"}, "repeat")];
}

TextureFilter readFilter(TextureInput& input) {
    constexpr TextureFilter kFilters[] = {TextureFilter::Point, TextureFilter::Bilinear, TextureFilter::Trilinear};
    const std::size_t i = choose(input, "filter", {"point", "bilinear", "trilinear", "ewa"}, "bilinear");
    input.parameters().number("maxanisotropy", 8.f);  // of ewa: known, though not used
    if (i < std::size(kFilters)) return kFilters[i];
    input.warn("the filter 'ewa' is not there yet; it counts as 'trilinear'");
    return TextureFilter::Trilinear;
}

TransferFunction readEncoding(TextureInput& input) {
    const std::string text = input.parameters().text("encoding", "sRGB");
    const std::optional<TransferFunction> encoding = TransferFunction::parse(text);
    if (!encoding) input.fail("encoding " + quote(text) + " is none of \"sRGB\", \"linear\", \"gamma <number>\"");
    return *encoding;
}

Matrix3 conversion(const TextureInput& input, const ColorSpace& image) {
    const ColorSpace& film = input.filmColorSpace();
    return input.role() == SpectrumRole::Illuminant ? lightConversion(image, film) : reflectanceConversion(image, film);
}

}  // namespace

TextureOperand ImageTexture::make(TextureInput& input, TextureTables& tables) {
    const ParameterSet& parameters = input.parameters();
    ImageTexture t;
    t.mapping = TextureMapping::make(input);
    t.wrap = readWrap(input);
    t.filter = readFilter(input);
    t.scale = parameters.number("scale", 1.f);
    t.invert = parameters.boolean("invert", false);
    t.image = tables.addImage(input.path("filename"), readEncoding(input), input);
    if (input.kind() == TextureKind::Spectrum) {
        t.albedo = input.role() == SpectrumRole::Albedo;
        const Matrix3 m = conversion(input, tables.image(t.image).colorSpace());
        t.converts = m != Matrix3{};
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t column = 0; column < 3; ++column)
                t.toFilm[row][column] = float(m.m[row][column]);
    }
    return tables.append(t, {}, input);
}

std::uint32_t Textures::addNormalMap(std::string_view parameter, TextureInput& input) {
    ImageTexture t;
    const std::string path = input.path(parameter);
    t.image = tables_->addImage(path, TransferFunction::linear(), input);
    if (tables_->image(t.image).isGrey()) input.fail("the normal map " + quote(path) + " has no colours");
    return tables_->append(t, {}, input).texture;
}

}  // namespace penumbra
