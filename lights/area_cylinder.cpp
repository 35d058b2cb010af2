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

}  // namespace penumbra
