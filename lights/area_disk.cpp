#include "lights/area_disk.h"

namespace penumbra {

DiskLight DiskLight::make(const Vec3<float>& center, const Vec3<float>& radiusX, const Vec3<float>& radiusY,
                          float inner, float phiMax, const Vec3<float>& normal, const Spectrum<float>& radiance,
                          std::uint32_t flags) {
    const SpannedPlane plane = spannedPlane(radiusX, radiusY, normal);
    DiskLight light;
    light.center = center;
    light.radiusX = radiusX;
    light.radiusY = radiusY;
    light.normal = plane.normal;
    light.inner = inner;
    light.phiMax = phiMax;
    light.area = float(0.5 * phiMax * (1.0 - double(inner) * inner) * plane.area);
    light.radiance = radiance;
    light.flags = flags;
    return light;
}

}  // namespace penumbra
