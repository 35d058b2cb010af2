#include "lights/area_cylinder.h"

#include <cmath>
#include <numbers>

namespace penumbra {

bool CylinderLight::make(const Matrix4& worldFromObject, double radius, double zMin, double zMax, double phiMax,
                         const Spectrum<float>& radiance, std::uint32_t flags, CylinderLight& light) {
    const Matrix4 world = worldFromObject * translation(0, 0, zMin) * scaling(radius, radius, zMax - zMin);
    CylinderLight l;
    if (!l.set(world)) return false;
    l.phiMax = float(std::fmin(phiMax, 2 * std::numbers::pi));
    const AreaStretch stretch(world);
    constexpr int kPhi = 4096;
    double sum = 0;
    for (int i = 0; i < kPhi; ++i) {
        const double phi = (i + 0.5) / kPhi * l.phiMax;
        sum += stretch({std::cos(phi), std::sin(phi), 0});
    }
    l.area = float(sum / kPhi * l.phiMax);
    l.radiance = radiance;
    l.flags = flags;
    if (!std::isfinite(l.area)) return false;
    light = l;
    return true;
}

std::optional<LightBounds> CylinderLight::bounds(const LightTables& tables) const {
    // Each coordinate: a circle about the middle of the axis, moved along the axis to both sides.
    const auto reach = [](double x, double y, double z) { return std::sqrt(x * x + y * y) + 0.5 * std::abs(z); };
    const Vec3<double> middle = {center.x + 0.5 * toWorldZ.x, center.y + 0.5 * toWorldZ.y, center.z + 0.5 * toWorldZ.z};
    const Vec3<double> half = {reach(toWorldX.x, toWorldY.x, toWorldZ.x), reach(toWorldX.y, toWorldY.y, toWorldZ.y),
                               reach(toWorldX.z, toWorldY.z, toWorldZ.z)};
    return LightBounds::ofRound(middle - half, middle + half, 0.25 * double(meanRadiance(*this, tables)) * area);
}

}  // namespace penumbra
