// The parameters that layered materials have in common.
#include "materials/coat_interface.h"

#include <algorithm>

namespace penumbra {

float readOpticalThickness(MaterialInput& input) {
    ScalarInput thickness = input.scalar("thickness", 0.01f);
    if (thickness.texture != kNoTexture) {
        input.warn("the thickness of a coat cannot come from a texture; 0.01 is used");
        thickness.constant = 0.01f;
    }
    if (!(thickness.constant >= 0.f)) input.fail("thickness must not be negative");

    const SpectrumInput albedo = input.albedo("albedo", {0.f, 0.f, 0.f});
    input.scalar("g", 0.f);  // known, and without meaning where nothing scatters
    const bool scatters = albedo.texture != kNoTexture || maxComponent(albedo.constant) > 0.f;
    if (scatters) input.warn("scattering in the gap of a coat is not simulated; it only lessens the gap's absorption");
    const float scattered = albedo.texture == kNoTexture ? std::min(average(albedo.constant), 1.f) : 0.f;
    return std::min(thickness.constant * (1.f - scattered), 1e6f);
}

std::uint32_t readBaseBounces(MaterialInput& input) {
    const int maxDepth = input.parameters().integer("maxdepth", 10);
    if (maxDepth < 0) input.fail("maxdepth must not be negative");
    return std::uint32_t(maxDepth / 2 + maxDepth % 2);
}

}  // namespace penumbra
