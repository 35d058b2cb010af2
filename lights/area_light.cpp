#include "lights/area_light.h"

#include <cmath>

namespace penumbra {

SpannedPlane spannedPlane(const Vec3<float>& edgeX, const Vec3<float>& edgeY, const Vec3<float>& facing) {
    const double x = double(edgeX.y) * edgeY.z - double(edgeX.z) * edgeY.y;
    const double y = double(edgeX.z) * edgeY.x - double(edgeX.x) * edgeY.z;
    const double z = double(edgeX.x) * edgeY.y - double(edgeX.y) * edgeY.x;
    const double area = std::sqrt(x * x + y * y + z * z);
    const double scale = (x * facing.x + y * facing.y + z * facing.z < 0 ? -1 : 1) / area;
    return {{float(x * scale), float(y * scale), float(z * scale)}, float(area)};
}

}  // namespace penumbra
