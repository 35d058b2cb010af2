// Images of lights, as the film sees them.
#include "scenes/builder/lights.h"

#include "core/image/image_io.h"

#include <fmt/format.h>

namespace penumbra::builder {

LightImage::LightImage(const std::string& file, SourcePosition where, const std::string& owner, BuildContext& context,
                       Space space) {
    const Image image = context.placed(where, owner, [&] { return readImage(context.path(file)); });
    width = std::size_t(image.width());
    height = std::size_t(image.height());
    rgb.reserve(3 * width * height);
    const Matrix3 toFilm = lightConversion(image.colorSpace(), context.filmColorSpace());
    std::size_t broken = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Rgb c = image.rgb(x, y);
            broken += !c.isFinite();
            const Rgb own = {std::fmax(c.r, 0.f), std::fmax(c.g, 0.f), std::fmax(c.b, 0.f)};
            const Rgb stored = space == Space::Own ? own : apply(toFilm, own);
            rgb.insert(rgb.end(), {stored.r, stored.g, stored.b});
        }
    if (broken)
        context.warn(where, fmt::format("{}: {} pixels of the image are not finite and count as black", owner, broken));
}

}  // namespace penumbra::builder
