#include "core/image/texture_mapping.h"

#include <algorithm>
#include <string>

namespace penumbra {

TextureMapping TextureMapping::make(TextureInput& input) {
    const ParameterSet& parameters = input.parameters();
    static const std::vector<std::string> kKnown{"uv", "planar", "spherical", "cylindrical"};
    const std::string mapping = parameters.text("mapping", "uv");
    if (std::find(kKnown.begin(), kKnown.end(), mapping) == kKnown.end())
        input.fail("unknown mapping " + quote(mapping) + suggestion(mapping, kKnown));
    if (mapping != "uv") {
        input.warn("the mapping " + quote(mapping) + " is not there yet; 'uv' is used");
        parameters.find("vector3", "v1");  // the planar mapping's own: not to be reported as unknown besides
        parameters.find("vector3", "v2");
    }
    TextureMapping m;
    m.uScale = parameters.number("uscale", 1.f);
    m.vScale = parameters.number("vscale", 1.f);
    m.uDelta = parameters.number("udelta", 0.f);
    m.vDelta = parameters.number("vdelta", 0.f);
    return m;
}

}  // namespace penumbra
