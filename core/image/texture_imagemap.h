// imagemap: an image file laid on the surface; v = 0 is its bottom row.
//
// Value: scale times the filtered texel, then, where inverted, 1 minus that, not below 0. A spectrum is r, g, b of the
// image, taken from the image's colour space to the film's (as a reflectance or as light, by its role) and clamped to
// [0, 1] where it is an albedo. A number is the mean of r, g, b, or alpha where the image has it and is not opaque.
#pragma once

#include "core/image/texture_mapping.h"
#include "core/image/texture_plugin.h"

namespace penumbra {

struct ImageTexture {
    static constexpr auto kParameters = TextureMapping::parameters({
        {"string", "filename", "", "EXR, PNG, JPEG, HDR, TIFF, PFM or TGA file"},
        {"string", "filter", "bilinear", "point, bilinear, trilinear; ewa counts as trilinear"},
        {"string", "wrap", "repeat", "beyond the image: repeat, black, clamp, octahedralsphere"},
        {"string", "encoding", "sRGB", "of PNG files: sRGB, linear, gamma x"},
        {"float", "scale", "1", "factor of the texels"},
        {"bool", "invert", "false", "1 minus the value"},
        {"float", "maxanisotropy", "8", "of ewa; not used"},
    });
    static constexpr PluginInfo kInfo{"imagemap", "an image file laid on the surface", kParameters};

    static TextureOperand make(TextureInput& input, TextureTables& tables);

    template <class V, class F>
    V evaluate(const TextureContext<F>& at, const TextureTables& tables) const {
        const MappedPoint<F> m = mapping.map(at);
        const F width = F(2.f) * max(m.widthS, m.widthT);
        const V texel = tables.image(image).template lookup<V>(m.s, F(1.f) - m.t, width, wrap, filter);
        if constexpr (std::is_same_v<V, F>) {
            const F value = texel * F(scale);
            return invert ? max(F(1.f) - value, F(0.f)) : value;
        } else {
            return inFilmSpace(texel * F(scale));
        }
    }

    TextureMapping mapping;
    std::uint32_t image = 0;
    WrapMode wrap = WrapMode::Repeat;
    TextureFilter filter = TextureFilter::Bilinear;
    float scale = 1;
    bool invert = false;
    bool albedo = false;
    bool converts = false;  ///< the image's space is not the film's: `toFilm` takes it there
    std::array<std::array<float, 3>, 3> toFilm{};

private:
    template <class F>
    Spectrum<F> inFilmSpace(Spectrum<F> c) const {
        if (invert) c = Spectrum<F>::constant(F(1.f)) - c;
        c = {max(c.r, F(0.f)), max(c.g, F(0.f)), max(c.b, F(0.f))};
        if (converts) {
            const auto row = [&](const std::array<float, 3>& m) {
                return F(m[0]) * c.r + F(m[1]) * c.g + F(m[2]) * c.b;
            };
            c = {row(toFilm[0]), row(toFilm[1]), row(toFilm[2])};
        }
        return albedo ? clampAlbedo(c) : c;
    }
};

}  // namespace penumbra
