#include "lights/area_rectangle.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

bool same(const Vec3<float>& a, const Vec3<float>& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

struct Edge {
    double x, y, z;
    Edge(const Vec3<float>& to, const Vec3<float>& from)
        : x(double(to.x) - from.x), y(double(to.y) - from.y), z(double(to.z) - from.z) {}
    friend double dot(const Edge& a, const Edge& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
};

}  // namespace

RectangleLight RectangleLight::make(const Vec3<float>& corner, const Vec3<float>& edgeX, const Vec3<float>& edgeY,
                                    const Vec3<float>& normal, const Spectrum<float>& radiance, std::uint32_t flags) {
    RectangleLight light;
    light.corner = corner;
    light.width = length(edgeX);
    light.height = length(edgeY);
    light.axisX = normalize(edgeX);
    light.normal = spannedPlane(edgeX, edgeY, normal).normal;
    // Exactly orthogonal, where the edges are so only to a few digits.
    const Vec3<float> side = cross(light.normal, light.axisX);
    light.axisY = normalize(dot(side, edgeY) < 0.f ? -side : side);
    light.radiance = radiance;
    light.flags = flags;
    return light;
}

std::optional<RectangleShape> rectangleOfTriangles(const std::array<Vec3<float>, 3>& a,
                                                   const std::array<Vec3<float>, 3>& b) {
    constexpr double kTolerance = 1e-5;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3<float>&apex = a[i], &first = a[(i + 1) % 3], &second = a[(i + 2) % 3];
        for (std::size_t j = 0; j < 3; ++j) {
            // Wound the same way, the second triangle runs along the shared edge in the other sense.
            const Vec3<float>& opposite = b[j];
            if (!same(b[(j + 1) % 3], second) || !same(b[(j + 2) % 3], first)) continue;
            const Edge x(first, apex), y(second, apex), across(opposite, second);
            const double shortest = std::min(dot(x, x), dot(y, y));
            const double gapX = across.x - x.x, gapY = across.y - x.y, gapZ = across.z - x.z;
            if (!(shortest > 0) || !(std::abs(dot(x, y)) <= kTolerance * shortest)) continue;
            if (!(gapX * gapX + gapY * gapY + gapZ * gapZ <= kTolerance * kTolerance * shortest)) continue;
            return RectangleShape{apex, first - apex, second - apex};
        }
    }
    return std::nullopt;
}

}  // namespace penumbra
