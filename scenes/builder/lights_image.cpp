// Images of lights, as the film sees them.
#include "scenes/builder/lights.h"

#include "core/image/image_io.h"

#include <fmt/format.h>

#include <algorithm>

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

Rgb LightImage::sky(SkyMap map, Vec3d direction) const {
    const Vec3<float> d = {float(direction.x), float(direction.y), float(direction.z)};
    const Vec2<float> st = map == SkyMap::LatLong ? ImageInfiniteLight::latLongPlace(d) : equalAreaSquare(d);
    const double x = double(st.x) * double(width) - 0.5, y = double(st.y) * double(height) - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const auto pixel = [&](double column, double row) {
        const double w = double(width), h = double(height);
        if (map == SkyMap::LatLong) {
            column = column < 0 ? column + w : column >= w ? column - w : column;
        } else {
            // Beyond an edge lies the same edge, run through the other way (Clarberg 2008).
            if (column < 0 || column >= w) row = h - 1 - row, column = column < 0 ? -1 - column : 2 * w - 1 - column;
            if (row < 0 || row >= h) column = w - 1 - column, row = row < 0 ? -1 - row : 2 * h - 1 - row;
        }
        const std::size_t i =
            std::size_t(std::clamp(row, 0., h - 1)) * width + std::size_t(std::clamp(column, 0., w - 1));
        return Rgb{rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]};
    };
    const float fx = float(x - left), fy = float(y - top);
    const Rgb above = pixel(left, top) * (1 - fx) + pixel(left + 1, top) * fx;
    const Rgb below = pixel(left, top + 1) * (1 - fx) + pixel(left + 1, top + 1) * fx;
    return above * (1 - fy) + below * fy;
}

}  // namespace penumbra::builder
