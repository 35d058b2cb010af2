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

}  // namespace penumbra
