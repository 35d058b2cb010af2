#include "core/image/texture_mapping.h"

#include <algorithm>
#include <string>

namespace penumbra {

Vec3<float> readVector(const ParameterSet& parameters, std::string_view name, const Vec3<float>& otherwise) {
    const std::vector<float>& v = parameters.numbers("vector3", name);
    return v.size() < 3 ? otherwise : Vec3<float>{v[0], v[1], v[2]};
}

TextureSpace TextureSpace::make(TextureInput& input) {
    Matrix4 fromWorld;
    if (!invert(input.textureToWorld(), fromWorld)) input.fail("the transformation in force here has no inverse");
    return {toRecord(fromWorld)};
}

TextureMapping TextureMapping::make(TextureInput& input) {
    const ParameterSet& parameters = input.parameters();
    static const std::vector<std::string> kKnown{"uv", "planar", "spherical", "cylindrical"};  // as MappingKind
    const std::string mapping = parameters.text("mapping", "uv");
    const auto found = std::find(kKnown.begin(), kKnown.end(), mapping);
    if (found == kKnown.end()) input.fail("unknown mapping " + quote(mapping) + suggestion(mapping, kKnown));
    TextureMapping m;
    m.kind = MappingKind(found - kKnown.begin());
    if (m.kind != MappingKind::Uv) m.space = TextureSpace::make(input);
    if (m.kind == MappingKind::Uv) {
        m.uScale = parameters.number("uscale", 1.f);
        m.vScale = parameters.number("vscale", 1.f);
    }
    if (m.kind == MappingKind::Planar) {
        m.v1 = readVector(parameters, "v1", m.v1);
        m.v2 = readVector(parameters, "v2", m.v2);
    }
    if (m.kind == MappingKind::Uv || m.kind == MappingKind::Planar) {
        m.uDelta = parameters.number("udelta", 0.f);
        m.vDelta = parameters.number("vdelta", 0.f);
    }
    return m;
}

}  // namespace penumbra
