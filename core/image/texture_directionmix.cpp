#include "core/image/texture_directionmix.h"

#include "core/image/texture_registry.h"

namespace penumbra {

TextureOperand DirectionMixTexture::make(TextureInput& input, TextureTables& tables) {
    DirectionMixTexture t;
    t.along = input.value("tex1", 0.f);
    t.across = input.value("tex2", 1.f);
    const Vec3<float> given = readVector(input.parameters(), "dir", {0, 1, 0});
    const auto& m = input.textureToWorld().m;
    double world[3], squared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        world[i] = m[i][0] * double(given.x) + m[i][1] * double(given.y) + m[i][2] * double(given.z);
        squared += world[i] * world[i];
    }
    if (!(squared > 0) || !std::isfinite(squared)) input.fail("dir has no direction");
    const double scale = 1 / std::sqrt(squared);
    t.direction = {float(world[0] * scale), float(world[1] * scale), float(world[2] * scale)};
    return tables.append(t, {t.along, t.across}, input);
}

}  // namespace penumbra
