#include "core/image/texture_marble.h"

#include "core/image/texture_registry.h"

namespace penumbra {

TextureOperand MarbleTexture::make(TextureInput& input, TextureTables& tables) {
    requireKind(input, TextureKind::Spectrum, kInfo.name);
    MarbleTexture t{TextureSpace::make(input), readOctaves(input)};
    t.scale = input.parameters().number("scale", 1.f);
    t.variation = input.parameters().number("variation", 0.2f);
    constexpr Rgb kStone{0.87f, 0.87f, 0.9f}, kGrey{0.75f, 0.75f, 0.75f}, kWarm{0.9f, 0.885f, 0.87f},
        kVein{0.3f, 0.3f, 0.495f};
    constexpr Rgb kControlPoints[kSegments + 3] = {kStone, kStone, kStone, kGrey, kWarm, kStone, kStone, kVein, kStone};
    const Matrix3 toFilm = reflectanceConversion(srgbColorSpace(), input.filmColorSpace());
    for (std::size_t i = 0; i < t.colors.size(); ++i) {
        const Rgb c = apply(toFilm, kControlPoints[i]);
        t.colors[i] = {c.r, c.g, c.b};
    }
    return tables.append(t, {}, input);
}

}  // namespace penumbra
