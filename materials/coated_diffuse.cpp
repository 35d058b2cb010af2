// What happens once, when a coated material is made: its parameters, and its table.
#include "materials/coated_diffuse.h"

namespace penumbra {

CoatedDiffuseMaterial CoatedDiffuseMaterial::make(MaterialInput& input) {
    CoatedDiffuseMaterial m{RoughnessInputs::make(input), {}};
    m.reflectance = input.albedo("reflectance", {0.5f, 0.5f, 0.5f});
    m.eta = readInterfaceIndex(input);
    m.opticalThickness = readOpticalThickness(input);
    input.parameters().integer("nsamples", 1);  // known: there is nothing to average
    m.baseBounces = readBaseBounces(input);

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
