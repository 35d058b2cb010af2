#include "lights/quadric_place.h"

#include <cmath>

namespace penumbra {
namespace {

Vec3<float> row(const Matrix4& m, std::size_t i) {
    const auto& r = m.m[i];
    return {float(r[0]), float(r[1]), float(r[2])};
}

}  // namespace

bool QuadricPlace::set(const Matrix4& worldFromObject) {
    Matrix4 object;
    if (!invert(worldFromObject, object)) return false;
    const float scale = float(1 / std::cbrt(std::abs(determinant3(worldFromObject))));
    if (!std::isfinite(scale)) return false;
    const Matrix4 columns = transpose(worldFromObject);
    const auto& m = worldFromObject.m;
    center = {float(m[0][3]), float(m[1][3]), float(m[2][3])};
    toWorldX = row(columns, 0);
    toWorldY = row(columns, 1);
    toWorldZ = row(columns, 2);
    toObjectX = row(object, 0);
    toObjectY = row(object, 1);
    toObjectZ = row(object, 2);
    inverseScale = scale;
    return true;
}

AreaStretch::AreaStretch(const Matrix4& worldFromObject) : determinant_(std::abs(determinant3(worldFromObject))) {
    Matrix4 inverse;
    invert(worldFromObject, inverse);
    inverseTranspose_ = transpose(inverse);
}

double AreaStretch::operator()(Vec3d normal) const {
    const Vec3d n = transformVector(inverseTranspose_, normal);
    return determinant_ * std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
}

}  // namespace penumbra
