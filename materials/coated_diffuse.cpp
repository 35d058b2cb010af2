// What happens once, when a coated material is made: its parameters, and its table.
#include "materials/coated_diffuse.h"

#include <algorithm>

namespace penumbra {
namespace {

float readOpticalThickness(MaterialInput& input) {
    ScalarInput thickness = input.scalar("thickness", 0.01f);
    if (thickness.texture != kNoTexture) {
        input.warn("the thickness of a coat cannot come from a texture; 0.01 is used");
        thickness.constant = 0.01f;
    }
    if (!(thickness.constant >= 0.f)) input.fail("thickness must not be negative");

    const SpectrumInput albedo = input.albedo("albedo", {0.f, 0.f, 0.f});
    input.scalar("g", 0.f);                     // known, and without meaning where nothing scatters
    input.parameters().integer("nsamples", 1);  // known: there is nothing to average
    const bool scatters = albedo.texture != kNoTexture || maxComponent(albedo.constant) > 0.f;
    if (scatters) input.warn("scattering in the gap of a coat is not simulated; it only lessens the gap's absorption");
    const float scattered = albedo.texture == kNoTexture ? std::min(average(albedo.constant), 1.f) : 0.f;
    return std::min(thickness.constant * (1.f - scattered), 1e6f);
}

}  // namespace

CoatedDiffuseMaterial CoatedDiffuseMaterial::make(MaterialInput& input) {
    CoatedDiffuseMaterial m{RoughnessInputs::make(input), {}};
    m.reflectance = input.albedo("reflectance", {0.5f, 0.5f, 0.5f});
    m.eta = readInterfaceIndex(input);
    m.opticalThickness = readOpticalThickness(input);
    const int maxDepth = input.parameters().integer("maxdepth", 10);
    if (maxDepth < 0) input.fail("maxdepth must not be negative");
    m.baseBounces = std::uint32_t(maxDepth / 2 + maxDepth % 2);

    const Coat coat{m.eta, m.opticalThickness};
    const SurfaceRoughness<float> rough = surface(m.uAlpha.constant, m.vAlpha.constant);
    MaterialTables& tables = input.tables();
    enum Kind { Smooth, Constant, Textured };
    if (m.isTextured()) {
        const std::uint32_t block =
            tables.block({Textured, coat.eta, coat.opticalThickness},
                         [&](std::vector<float>& numbers) { appendTexturedCoat(coat, numbers); });
        m.setBlock(block, kTexturedRows, tables.data());
    } else if (rough.smooth) {
        const std::uint32_t block = tables.block({Smooth, coat.eta, coat.opticalThickness},
                                                 [&](std::vector<float>& numbers) { appendSmoothCoat(coat, numbers); });
        m.setBlock(block, TableRows{}, tables.data());
    } else {
        const std::uint32_t block =
            tables.block({Constant, coat.eta, coat.opticalThickness, rough.ggx.ax, rough.ggx.ay},
                         [&](std::vector<float>& numbers) { appendConstantCoat(coat, rough.ggx, numbers); });
        m.setBlock(block, constantRows(rough.ggx), tables.data());
    }
    return m;
}

void CoatedDiffuseMaterial::setBlock(std::uint32_t offset, const TableRows& rows, const float* tables) {
    RoughnessTableInputs::setBlock(offset, rows);
    rho = tables[offset];
    tau = tables[offset + 2];
}

}  // namespace penumbra
