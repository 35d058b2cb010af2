// What happens once, when a material of hair is made: its parameters.
#include "materials/hair.h"

namespace penumbra {
namespace {

/// A constant outside its range is an error; a texture is clamped where it is looked up.
ScalarInput within(MaterialInput& input, const char* name, float otherwise, float least, float most) {
    const ScalarInput x = input.scalar(name, otherwise);
    if (x.texture == kNoTexture && !(x.constant >= least && x.constant <= most))
        input.fail(std::string(name) + " must lie between " + std::to_string(least) + " and " + std::to_string(most));
    return x;
}

}  // namespace

HairMaterial HairMaterial::make(MaterialInput& input) {
    HairMaterial m;
    const ParameterSet& given = input.parameters();
    const char* color = given.findAny("reflectance") ? "reflectance" : "color";
    const bool hasPigment = given.findAny("eumelanin") || given.findAny("pheomelanin");
    const bool hasColor = given.findAny(color), hasAbsorption = given.findAny("sigma_a");
    if (int(hasAbsorption) + int(hasColor) + int(hasPigment) > 1)
        input.warn("one of sigma_a, reflectance and pigments colours hair; the first of them counts, in this order");
    if (hasAbsorption) {
        m.by = Color::Absorption;
        m.color = input.coefficient("sigma_a", {0.f, 0.f, 0.f});
    } else if (hasColor) {
        m.by = Color::Reflectance;
        m.color = input.albedo(color, {0.5f, 0.5f, 0.5f});
    } else {
        constexpr float kMost = 1e4f;
        m.eumelanin = within(input, "eumelanin", hasPigment ? 0.f : 1.3f, 0.f, kMost);
        m.pheomelanin = within(input, "pheomelanin", 0.f, 0.f, kMost);
    }
    m.eta = within(input, "eta", 1.55f, 0.01f, 100.f);
    m.betaM = input.scalar("beta_m", 0.3f);
    m.betaN = input.scalar("beta_n", 0.3f);
    m.alpha = within(input, "alpha", 2.f, -90.f, 90.f);
    return m;
}

}  // namespace penumbra
