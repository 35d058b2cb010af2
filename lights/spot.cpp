#include "lights/spot.h"

#include <cmath>
#include <numbers>

namespace penumbra {
namespace {

float versineOf(double degrees) {
    const double s = std::sin(degrees * (std::numbers::pi / 360));
    return float(2 * s * s);
}

}  // namespace

SpotLight SpotLight::make(const Matrix4& worldFromLight, Vec3d from, Vec3d axis, double innerAngle, double outerAngle,
                          const Spectrum<float>& intensity) {
    SpotLight light;
    light.place(worldFromLight, from);
    const double size = std::hypot(axis.x, axis.y, axis.z);
    light.axis = {float(axis.x / size), float(axis.y / size), float(axis.z / size)};
    light.versineInner = versineOf(innerAngle);
    light.versineOuter = versineOf(outerAngle);
    light.intensity = intensity;
    return light;
}

std::optional<LightBounds> SpotLight::bounds(const LightTables&) const {
    const auto angleOf = [](double versine) { return 2 * std::asin(std::sqrt(std::min(versine / 2, 1.))); };
    return coneBounds(axis, angleOf(versineInner), angleOf(versineOuter), average(intensity));
}

}  // namespace penumbra
