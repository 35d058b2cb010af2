#include "lights/infinite_portal.h"

#include "core/base/error.h"

#include <bit>
#include <numbers>

namespace penumbra {
namespace {

constexpr std::size_t kMostResolution = 8192;

Vec3<double> from(const Vec3d& a, const Vec3d& b) {
    return {b.x - a.x, b.y - a.y, b.z - a.z};
}

double size(const Vec3<double>& v) {
    return std::sqrt(dot(v, v));
}

Vec3<float> rounded(const Vec3<double>& v) {
    return {float(v.x), float(v.y), float(v.z)};
}

/// The unit direction of a pixel's middle, in the portal's frame.
Vec3<double> pixelDirection(std::size_t x, std::size_t y, std::size_t n) {
    const auto tangent = [&](std::size_t i) {
        return std::tan(std::numbers::pi * ((double(i) + 0.5) / double(n) - 0.5));
    };
    const Vec3<double> w = {tangent(x), tangent(y), 1};
    return w * (1 / size(w));
}

}  // namespace

PortalInfiniteLight PortalInfiniteLight::make(const std::array<Vec3d, 4>& corners, std::size_t n,
                                              const std::function<Spectrum<float>(Vec3d)>& sky, LightTables& tables) {
    const Vec3<double> x = from(corners[0], corners[3]), y = from(corners[0], corners[1]);
    const Vec3<double> across = from(corners[0], corners[2]);
    const double sizeX = size(x), sizeY = size(y), slack = 1e-3 * std::fmin(sizeX, sizeY);
    if (!(slack > 0) || !(std::abs(dot(x, y)) <= 1e-3 * sizeX * sizeY) || !(size(across - x - y) <= slack))
        throw Error(ErrorKind::BadData, "the corners of the portal are not those of a rectangle, in order round it");
    if (n == 0 || n > kMostResolution) throw Error(ErrorKind::BadData, "the image of the portal is too large");

    PortalInfiniteLight light;
    const Vec3<double> axisX = x * (1 / sizeX), out = cross(axisX, y), axisZ = out * (1 / size(out));
    const Vec3<double> axisY = cross(axisZ, axisX);
    light.corner = rounded({corners[0].x, corners[0].y, corners[0].z});
    light.axisX = rounded(axisX);
    light.axisY = rounded(axisY);
    light.axisZ = rounded(axisZ);
    light.width = float(sizeX);
    light.height = float(sizeY);
    light.resolution = std::uint32_t(n);
    light.pixels = roomForNumbers(tables, 4 * n * n + (n + 1) * (n + 1));
    light.sums = std::uint32_t(light.pixels + 4 * n * n);

    std::vector<double> weights(n * n);
    const double perPixel = std::pow(std::numbers::pi / double(n), 2);
    double total = 0, flux = 0;
    for (std::size_t i = 0; i < n * n; ++i) {
        const Vec3<double> w = pixelDirection(i % n, i / n, n);
        const Vec3<double> d = axisX * w.x + axisY * w.y + axisZ * w.z;
        const Spectrum<float> L = sky({d.x, d.y, d.z});
        const Spectrum<float> pixel = {usable(L.r), usable(L.g), usable(L.b)};
        tables.numbers.insert(tables.numbers.end(), {pixel.r, pixel.g, pixel.b, 0.f});
        weights[i] = double(average(pixel)) * detail::portalJacobian(w) * perPixel;
        total += weights[i];
        flux += weights[i] * w.z;
    }
    light.normalRadiance = float(flux / std::numbers::pi);

    // All pixels together have less than 2^31 units, so that differences fit.
    const double units = total > 0 ? (0x1p31 - 2 * double(n * n) - 2) / total : 0;
    std::vector<std::uint32_t> before(n + 1, 0u), row(n + 1);
    for (std::size_t y0 = 0; y0 <= n; ++y0) {
        for (const std::uint32_t sum : before)
            tables.numbers.push_back(std::bit_cast<float>(sum));
        if (y0 == n) break;
        row[0] = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const double w = weights[y0 * n + i];
            row[i + 1] = row[i] + (w > 0 ? 1u + std::uint32_t(w * units) : 0u);
        }
        for (std::size_t i = 0; i <= n; ++i)
            before[i] += row[i];
    }
    return light;
}

}  // namespace penumbra
