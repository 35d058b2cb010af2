#include "lights/infinite_image.h"

#include "core/base/error.h"

#include <array>
#include <cmath>
#include <numbers>

namespace penumbra {
namespace {

/// The columns of the matrix, made orthonormal in order (Gram-Schmidt).
std::array<Vec3<float>, 3> orthonormalAxes(const Matrix4& m) {
    std::array<Vec3<float>, 3> axes;
    std::array<std::array<double, 3>, 3> done{};
    for (std::size_t c = 0; c < 3; ++c) {
        std::array<double, 3> v = {m.m[0][c], m.m[1][c], m.m[2][c]};
        const double before = std::hypot(v[0], v[1], v[2]);
        for (std::size_t k = 0; k < c; ++k) {
            const double along = v[0] * done[k][0] + v[1] * done[k][1] + v[2] * done[k][2];
            for (std::size_t i = 0; i < 3; ++i)
                v[i] -= along * done[k][i];
        }
        const double size = std::hypot(v[0], v[1], v[2]);
        if (!(size > 1e-9 * before)) throw Error(ErrorKind::BadData, "the matrix of an infinite light is singular");
        for (std::size_t i = 0; i < 3; ++i)
            done[c][i] = v[i] / size;
        axes[c] = {float(done[c][0]), float(done[c][1]), float(done[c][2])};
    }
    return axes;
}

}  // namespace

ImageInfiniteLight ImageInfiniteLight::make(SkyMap map, std::span<const float> rgb, std::size_t width,
                                            std::size_t height, const Spectrum<float>& scale,
                                            const Matrix4& worldFromLight, LightTables& tables) {
    const std::size_t count = width * height;
    if (count == 0 || width > kMaxResolution || height > kMaxResolution)
        throw Error(ErrorKind::BadData, "the image of the infinite light is too large");

    ImageInfiniteLight light;
    const std::array<Vec3<float>, 3> axes = orthonormalAxes(worldFromLight);
    light.axisX = axes[0];
    light.axisY = axes[1];
    light.axisZ = axes[2];
    light.map = map;
    light.width = std::uint32_t(width);
    light.height = std::uint32_t(height);
    light.strideX = searchStride(width);
    light.strideY = searchStride(height);
    light.pixels = roomForNumbers(tables, 4 * count + (height + 1) + height * (width + 1));
    light.distribution = std::uint32_t(light.pixels + 4 * count);
    tables.numbers.resize(light.distribution);
    float* const rows = tables.numbers.data() + light.pixels;
    std::vector<float> weights(count);
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        float* const row = rows + 4 * i;
        row[0] = usable(rgb[3 * i] * scale.r);
        row[1] = usable(rgb[3 * i + 1] * scale.g);
        row[2] = usable(rgb[3 * i + 2] * scale.b);
        const double flux = average(Spectrum<float>{row[0], row[1], row[2]}) * light.solidAngle(i / width);
        weights[i] = float(flux);
        sum += flux;
    }
    light.mean = float(sum / (4 * std::numbers::pi));
    appendCumulativeGrid(weights, width, height, tables.numbers);
    light.fillDensities(weights, tables);
    return light;
}

double ImageInfiniteLight::solidAngle(std::size_t row) const {
    if (map == SkyMap::EqualArea) return 4 * std::numbers::pi / (double(width) * height);
    const double perRow = std::numbers::pi / height;
    return 2 * std::numbers::pi / width * (std::cos(double(row) * perRow) - std::cos(double(row + 1) * perRow));
}

void ImageInfiniteLight::fillDensities(std::span<const float> weights, LightTables& tables) const {
    const float* const table = tables.numbers.data() + distribution;
    for (std::size_t y = 0; y < height; ++y) {
        const float* const row = table + (height + 1) + (width + 1) * y;
        const double perPixel = (double(table[y + 1]) - table[y]) / solidAngle(y);
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t i = y * width + x;
            // An all-black image has a uniform table, but nothing to sample.
            const double density = weights[i] > 0 ? perPixel * (double(row[x + 1]) - row[x]) : 0;
            tables.numbers[pixels + 4 * i + 3] = float(density);
        }
    }
}

}  // namespace penumbra
