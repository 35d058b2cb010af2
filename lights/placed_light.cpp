#include "lights/placed_light.h"

#include "core/base/error.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

void PlacedLight::place(const Matrix4& worldFromLight, Vec3d at) {
    Matrix4 inverse;
    if (!invert(worldFromLight, inverse)) throw Error(ErrorKind::BadData, "the matrix of the light is singular");
    const Vec3d p = transformPoint(worldFromLight, at);
    position = {float(p.x), float(p.y), float(p.z)};
    // Only ratios matter: entries of about one keep floats from over- and underflow.
    double largest = 0;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c)
            largest = std::max(largest, std::abs(inverse.m[r][c]));
    const auto row = [&](std::size_t r) {
        return Vec3<float>{float(inverse.m[r][0] / largest), float(inverse.m[r][1] / largest),
                           float(inverse.m[r][2] / largest)};
    };
    toLightX = row(0);
    toLightY = row(1);
    toLightZ = row(2);
}

LightBounds PlacedLight::coneBounds(const Vec3<float>& axis, double inner, double outer, double intensity) const {
    LightBounds b = LightBounds::ofPoint(position, intensity);
    const Vec3<float> rows[3] = {toLightX, toLightY, toLightZ};
    const float size = lengthSquared(rows[0]);
    for (std::size_t i = 0; i < 3; ++i) {
        const bool isTurned = std::abs(lengthSquared(rows[i]) - size) < 1e-4f * size &&
                              std::abs(dot(rows[i], rows[(i + 1) % 3])) < 1e-4f * size;
        if (!isTurned) return b;
    }
    // Rows of a rotation times a factor: the transpose is the inverse, up to a factor.
    const Vec3<float> w = rows[0] * axis.x + rows[1] * axis.y + rows[2] * axis.z;
    b.axis = Vec3<double>{w.x, w.y, w.z} * (1 / std::sqrt(double(lengthSquared(w))));
    // Importance falls with the cosine of the angle beyond the spread, and has to last to the edge, and somewhat
    // beyond, as the matrix is a rotation to some digits only.
    constexpr double kSlack = 2e-3, kMostFalloff = 1.5;
    b.spread = std::clamp(std::max(inner, outer - kMostFalloff), 0., std::numbers::pi);
    b.falloff = outer + kSlack - b.spread;
    return b;
}

}  // namespace penumbra
