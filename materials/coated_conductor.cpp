// What happens once, when a coated metal is made: its parameters.
#include "materials/coated_conductor.h"

#include <algorithm>

namespace penumbra {

CoatedConductorMaterial CoatedConductorMaterial::make(MaterialInput& input) {
    constexpr std::uint32_t kMostBounces = 1000;  // beyond, roulette has long ended every walk worth the name
    const float eta = readInterfaceIndex(input, "interface.eta");
    CoatedConductorMaterial m{{RoughnessInputs::make(input, "interface.")},
                              {RoughnessInputs::make(input, "conductor.")},
                              ConductorInputs::make(input, "conductor.", eta)};
    m.eta = eta;
    m.opticalThickness = readOpticalThickness(input);
    m.metalBounces = std::min(readBaseBounces(input), kMostBounces);
    const int walks = input.parameters().integer("nsamples", 1);
    if (walks < 1 || walks > 1024) input.fail("nsamples must lie between 1 and 1024");
    m.walks = std::uint32_t(walks);
    return m;
}

}  // namespace penumbra
