#include "lights/area_triangle.h"

namespace penumbra {

TriangleLight TriangleLight::make(const Vec3<float>& a, const Vec3<float>& b, const Vec3<float>& c,
                                  const Vec3<float>& normal, const Spectrum<float>& radiance, std::uint32_t flags) {
    TriangleLight light;
    light.corner = a;
    light.edgeB = b - a;
    light.edgeC = c - a;
    const SpannedPlane plane = spannedPlane(light.edgeB, light.edgeC, normal);
    light.normal = plane.normal;
    light.area = 0.5f * plane.area;
    light.radiance = radiance;
    light.flags = flags;
    return light;
}

}  // namespace penumbra
