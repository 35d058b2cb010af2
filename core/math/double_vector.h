// Arithmetic of vectors in double, for cold code, and for tests that compute what hot code must give by other means.
#pragma once

#include "core/math/matrix.h"
#include "core/math/vector.h"

#include <cmath>

namespace penumbra {

inline Vec3d operator+(Vec3d a, Vec3d b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3d operator-(Vec3d a, Vec3d b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3d operator*(Vec3d a, double s) {
    return {a.x * s, a.y * s, a.z * s};
}
inline double dot(Vec3d a, Vec3d b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline double length(Vec3d a) {
    return std::sqrt(dot(a, a));
}
inline Vec3d normalized(Vec3d a) {
    return a * (1 / length(a));
}
inline Vec3d cross(Vec3d a, Vec3d b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec3<float> rounded(Vec3d a) {
    return {float(a.x), float(a.y), float(a.z)};
}
inline Vec3d widened(const Vec3<float>& a) {
    return {a.x, a.y, a.z};
}

}  // namespace penumbra
