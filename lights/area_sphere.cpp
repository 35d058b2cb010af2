#include "lights/area_sphere.h"

#include <cmath>
#include <numbers>

namespace penumbra {
namespace {

/// World area of a part of the unit sphere.
double mappedArea(const AreaStretch& stretch, double zMin, double zMax, double phiMax) {
    constexpr int kZ = 64, kPhi = 64;
    double sum = 0;
    for (int i = 0; i < kZ; ++i) {
        const double z = zMin + (i + 0.5) / kZ * (zMax - zMin), r = std::sqrt(std::fmax(0, 1 - z * z));
        for (int j = 0; j < kPhi; ++j) {
            const double phi = (j + 0.5) / kPhi * phiMax;
            sum += stretch({r * std::cos(phi), r * std::sin(phi), z});
        }
    }
    return sum / (kZ * kPhi) * (zMax - zMin) * phiMax;
}

}  // namespace

bool SphereLight::make(const Matrix4& worldFromObject, double radius, double zMin, double zMax, double phiMax,
                       const Spectrum<float>& radiance, std::uint32_t flags, SphereLight& light) {
    const Matrix4 world = worldFromObject * scaling(radius, radius, radius);
    SphereLight s;
    if (!s.set(world)) return false;
    const double low = std::fmax(zMin / radius, -1), high = std::fmin(zMax / radius, 1);
    s.zMin = float(low);
    s.zMax = float(high);
    s.phiMax = float(std::fmin(phiMax, 2 * std::numbers::pi));
    s.area = float(mappedArea(AreaStretch(world), low, high, s.phiMax));
    s.radiance = radiance;
    s.flags = flags;
    const bool shinesThroughHoles = flags & kLightPierced && flags & (kLightTwoSided | kLightReversed);
    s.whole = low == -1 && high == 1 && s.phiMax >= kTwoPi && !shinesThroughHoles;
    if (!std::isfinite(s.area)) return false;
    light = s;
    return true;
}

std::optional<LightBounds> SphereLight::bounds(const LightTables& tables) const {
    const auto reach = [](double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); };
    const Vec3<double> middle = {center.x, center.y, center.z};
    const Vec3<double> half = {reach(toWorldX.x, toWorldY.x, toWorldZ.x), reach(toWorldX.y, toWorldY.y, toWorldZ.y),
                               reach(toWorldX.z, toWorldY.z, toWorldZ.z)};
    return LightBounds::ofRound(middle - half, middle + half, 0.25 * double(meanRadiance(*this, tables)) * area);
}

}  // namespace penumbra
