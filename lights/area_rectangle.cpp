#include "lights/area_rectangle.h"

namespace penumbra {

RectangleLight RectangleLight::make(const Vec3<float>& corner, const Vec3<float>& edgeX, const Vec3<float>& edgeY,
                                    const Vec3<float>& normal, const Spectrum<float>& radiance, std::uint32_t flags) {
    RectangleLight light;
    light.corner = corner;
    light.width = length(edgeX);
    light.height = length(edgeY);
    light.axisX = normalize(edgeX);
    const Vec3<float> up = normalize(cross(light.axisX, edgeY));
    light.axisY = cross(up, light.axisX);   // exactly orthogonal, where the edges are so only to a few digits
    light.normal = dot(up, normal) < 0.f ? -up : up;
    light.radiance = radiance;
    light.flags = flags;
    return light;
}

}  // namespace penumbra
