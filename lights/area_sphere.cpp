#include "lights/area_sphere.h"

#include <cmath>
#include <numbers>

namespace penumbra {
namespace {

Vec3<float> rounded(const Matrix4& m, int row) {
    const auto& r = m.m[std::size_t(row)];
    return {float(r[0]), float(r[1]), float(r[2])};
}

/// World area of a part of the unit sphere under the map whose inverse transpose is given: an element dA with the
/// normal n becomes |det M| |M^-T n| dA.
double mappedArea(const Matrix4& inverseTranspose, double determinant, double zMin, double zMax, double phiMax) {
    constexpr int kZ = 64, kPhi = 64;
    double sum = 0;
    for (int i = 0; i < kZ; ++i) {
        const double z = zMin + (i + 0.5) / kZ * (zMax - zMin), r = std::sqrt(std::fmax(0, 1 - z * z));
        for (int j = 0; j < kPhi; ++j) {
            const double phi = (j + 0.5) / kPhi * phiMax;
            const Vec3d n = transformVector(inverseTranspose, {r * std::cos(phi), r * std::sin(phi), z});
            sum += std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
        }
    }
    return std::abs(determinant) * sum / (kZ * kPhi) * (zMax - zMin) * phiMax;
}

}  // namespace

bool SphereLight::make(const Matrix4& worldFromObject, double radius, double zMin, double zMax, double phiMax,
                       const Spectrum<float>& radiance, std::uint32_t flags, SphereLight& light) {
    const Matrix4 world = worldFromObject * scaling(radius, radius, radius);
    Matrix4 object;
    if (!invert(world, object)) return false;
    const double determinant = determinant3(world);
    SphereLight s;
    const Matrix4 columns = transpose(world);
    s.center = {float(world.m[0][3]), float(world.m[1][3]), float(world.m[2][3])};
    s.toWorldX = rounded(columns, 0);
    s.toWorldY = rounded(columns, 1);
    s.toWorldZ = rounded(columns, 2);
    s.toObjectX = rounded(object, 0);
    s.toObjectY = rounded(object, 1);
    s.toObjectZ = rounded(object, 2);
    s.inverseScale = float(1 / std::cbrt(std::abs(determinant)));
    const double low = std::fmax(zMin / radius, -1), high = std::fmin(zMax / radius, 1);
    s.zMin = float(low);
    s.zMax = float(high);
    s.phiMax = float(std::fmin(phiMax, 2 * std::numbers::pi));
    s.area = float(mappedArea(transpose(object), determinant, low, high, s.phiMax));
    s.radiance = radiance;
    s.flags = flags;
    s.whole = low == -1 && high == 1 && s.phiMax >= kTwoPi;
    if (!std::isfinite(s.area) || !std::isfinite(s.inverseScale)) return false;
    light = s;
    return true;
}

}  // namespace penumbra
