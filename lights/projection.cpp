#include "lights/projection.h"

#include <algorithm>
#include <numbers>

namespace penumbra {

ProjectionScreen::ProjectionScreen(std::size_t width, std::size_t height, double fov) {
    const double shorter = std::tan(fov * (std::numbers::pi / 360)) / double(std::min(width, height));
    halfWidth = shorter * double(width);
    halfHeight = shorter * double(height);
}

double ProjectionScreen::cosineCubed(double u, double v) const {
    const double x = (2 * u - 1) * halfWidth, y = (2 * v - 1) * halfHeight, perCosine2 = 1 + x * x + y * y;
    return 1 / (perCosine2 * std::sqrt(perCosine2));
}

ProjectionLight ProjectionLight::make(const Matrix4& worldFromLight, std::span<const float> rgb, std::size_t width,
                                      std::size_t height, double fov, float scale, LightTables& tables) {
    const ProjectionScreen screen(width, height, fov);
    ProjectionLight light;
    light.place(worldFromLight, {0, 0, 0});
    light.perTangentX = float(0.5 / screen.halfWidth);
    light.perTangentY = float(0.5 / screen.halfHeight);
    light.width = std::uint32_t(width);
    light.height = std::uint32_t(height);
    light.pixels = roomForNumbers(tables, 4 * width * height);
    double sum = 0;
    for (std::size_t i = 0; i < width * height; ++i) {
        const Spectrum<float> pixel = {usable(rgb[3 * i] * scale), usable(rgb[3 * i + 1] * scale),
                                       usable(rgb[3 * i + 2] * scale)};
        tables.numbers.insert(tables.numbers.end(), {pixel.r, pixel.g, pixel.b, 0.f});
        sum += average(pixel) * screen.cosineCubed((double(i % width) + 0.5) / double(width),
                                                   (double(i / width) + 0.5) / double(height));
    }
    light.flux = float(sum / double(width * height) * screen.area());
    return light;
}

std::optional<LightBounds> ProjectionLight::bounds(const LightTables&) const {
    const double x = 0.5 / perTangentX, y = 0.5 / perTangentY;
    return coneBounds({0, 0, 1}, 0, std::atan(std::hypot(x, y)), flux / (4 * x * y));
}

}  // namespace penumbra
