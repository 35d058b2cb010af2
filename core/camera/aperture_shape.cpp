#include "core/camera/aperture_shape.h"

#include "core/base/error.h"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace penumbra {
namespace {

struct Corner {
    double x, y;
};
using Polygon = std::vector<Corner>;

/// Corners at equal angles on circles of radius `even` and `odd` in turn; the first lies in the direction `start`.
Polygon starPolygon(int corners, double even, double odd, double start) {
    Polygon p;
    for (int i = 0; i < corners; ++i) {
        const double r = i % 2 ? odd : even, angle = start + 2 * std::numbers::pi * i / corners;
        p.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    return p;
}

/// By the parity of the edges that a ray to the right crosses.
bool isInside(const Polygon& polygon, double x, double y) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Corner a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        if ((a.y > y) != (b.y > y) && x < a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
    return inside;
}

using Transmission = std::function<double(double x, double y)>;

Transmission insideOf(Polygon polygon) {
    return [polygon = std::move(polygon)](double x, double y) { return isInside(polygon, x, y) ? 1.0 : 0.0; };
}

Transmission shapeOf(const std::string& name) {
    constexpr double kUp = std::numbers::pi / 2, kFifth = std::numbers::pi / 5;
    if (name == "gaussian")
        return [](double x, double y) { return std::fmax(0.0, std::exp(-(x * x + y * y)) - std::exp(-1.0)); };
    if (name == "square") return insideOf({{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}});
    if (name == "pentagon") return insideOf(starPolygon(5, 0.8, 0.8, kUp));
    // The pentagram: the corners between its points lie where lines between points cross.
    return insideOf(starPolygon(10, std::cos(2 * kFifth) / std::cos(kFifth), 1, 0));
}

}  // namespace

std::span<const std::string> ApertureShape::names() {
    static const std::vector<std::string> names{"gaussian", "square", "pentagon", "star"};
    return names;
}

ApertureShape ApertureShape::named(const std::string& name) {
    constexpr int kSize = 256, kPerSide = 4;  // points per side of a cell
    const Transmission shape = shapeOf(name);
    std::vector<double> values;
    for (int row = 0; row < kSize; ++row)
        for (int column = 0; column < kSize; ++column) {
            double sum = 0;
            for (int i = 0; i < kPerSide * kPerSide; ++i) {
                const double x = column + (i % kPerSide + 0.5) / kPerSide, y = row + (i / kPerSide + 0.5) / kPerSide;
                sum += shape(2 * x / kSize - 1, 1 - 2 * y / kSize);
            }
            values.push_back(sum / (kPerSide * kPerSide));
        }
    return ApertureShape(kSize, kSize, values);
}

ApertureShape ApertureShape::fromImage(const Image& image) {
    std::vector<double> values;
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Rgb c = image.rgb(x, y);
            values.push_back(std::fmax(0.0, (double(c.r) + c.g + c.b) / 3));
            sum += values.back();
        }
    if (!(sum > 0) || !std::isfinite(sum))
        throw Error(ErrorKind::BadData, "an aperture of that image lets no light through");
    return ApertureShape(image.width(), image.height(), values);
}

ApertureShape::ApertureShape(int width, int height, const std::vector<double>& values)
    : width_(width + 2), height_(height + 2), grid_(std::size_t(width_) * std::size_t(height_)) {
    double sum = 0;
    for (const double v : values)
        sum += v;
    const double scale = std::numbers::pi / 4 * double(values.size()) / sum;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            grid_[std::size_t(y + 1) * std::size_t(width_) + std::size_t(x + 1)] =
                float(values[std::size_t(y) * std::size_t(width) + std::size_t(x)] * scale);
}

}  // namespace penumbra
