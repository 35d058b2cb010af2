#include "lights/emission_picture.h"

#include <cmath>

namespace penumbra {

EmissionPicture makePicture(std::span<const float> rgb, std::size_t width, std::size_t height, LightTables& tables) {
    EmissionPicture picture;
    picture.firstPixel = roomForNumbers(tables, 4 * width * height);
    picture.width = std::uint32_t(width);
    picture.height = std::uint32_t(height);
    double sum = 0;
    for (std::size_t i = 0; i < width * height; ++i) {
        const Spectrum<float> pixel = {usable(rgb[3 * i]), usable(rgb[3 * i + 1]), usable(rgb[3 * i + 2])};
        tables.numbers.insert(tables.numbers.end(), {pixel.r, pixel.g, pixel.b, 0.f});
        sum += average(pixel);
    }
    picture.mean = float(sum / double(width * height));
    return picture;
}

EmissionPicture onTriangle(EmissionPicture picture, const std::array<Vec3<float>, 3>& corners,
                           const std::array<Vec2<float>, 3>& uv) {
    const auto edge = [&](std::size_t i) {
        return Vec3<double>{double(corners[i].x) - corners[0].x, double(corners[i].y) - corners[0].y,
                            double(corners[i].z) - corners[0].z};
    };
    // The gradients of the weights of the second and the third corner.
    const Vec3<double> a = edge(1), b = edge(2), n = cross(a, b);
    const double perArea = 1 / dot(n, n);
    const Vec3<double> toA = cross(b, n) * perArea, toB = cross(n, a) * perArea;
    const auto row = [&](double first, double second) {
        const Vec3<double> g = toA * first + toB * second;
        return Vec3<float>{float(g.x), float(g.y), float(g.z)};
    };
    picture.map = EmissionPicture::Flat;
    picture.origin = corners[0];
    picture.toX = row(double(uv[1].x) - uv[0].x, double(uv[2].x) - uv[0].x);
    picture.toY = row(double(uv[1].y) - uv[0].y, double(uv[2].y) - uv[0].y);
    picture.uStart = uv[0].x;
    picture.vStart = uv[0].y;
    return picture;
}

EmissionPicture onRound(EmissionPicture picture, EmissionPicture::Map map, const Matrix4& worldFromUnit, double phiMax,
                        double vStart, double vEnd) {
    Matrix4 inverse;
    if (!invert(worldFromUnit, inverse)) return picture;
    const auto row = [&](std::size_t r) {
        return Vec3<float>{float(inverse.m[r][0]), float(inverse.m[r][1]), float(inverse.m[r][2])};
    };
    const Vec3d center = transformPoint(worldFromUnit, {0, 0, 0});
    picture.map = map;
    picture.origin = {float(center.x), float(center.y), float(center.z)};
    picture.toX = row(0);
    picture.toY = row(1);
    picture.toZ = row(2);
    picture.phiMax = float(phiMax);
    picture.vStart = float(vStart);
    picture.vPerUnit = float(1 / (vStart - vEnd));
    return picture;
}

}  // namespace penumbra
