// 4x4 matrices in double, for cold code: transforms are composed in double and rounded to float once, when the scene is built.
//
// Conventions: column vectors, p' = M p; m[row][column].
#pragma once

#include <array>

namespace penumbra {

struct Vec3d {
    double x = 0, y = 0, z = 0;
};

struct Matrix4 {
    std::array<std::array<double, 4>, 4> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    friend bool operator==(const Matrix4&, const Matrix4&) = default;
};

Matrix4 operator*(const Matrix4& a, const Matrix4& b);
Matrix4 transpose(const Matrix4& a);
/// Inverse by Gauss-Jordan with full pivoting; false where the matrix is singular or not finite (out is then untouched).
bool invert(const Matrix4& a, Matrix4& out);
/// Determinant of the upper left 3x3.
double determinant3(const Matrix4& a);

Matrix4 translation(double x, double y, double z);
Matrix4 scaling(double x, double y, double z);
/// Rotation by `degrees` about the axis (x, y, z), which need not be normalised (Rodrigues).
Matrix4 rotation(double degrees, double x, double y, double z);
/// pbrt's LookAt: camera-from-world, left-handed (+z forward, +x right, +y up). False where degenerate.
bool lookAt(Vec3d eye, Vec3d look, Vec3d up, Matrix4& out);

Vec3d transformPoint(const Matrix4& a, Vec3d p);
Vec3d transformVector(const Matrix4& a, Vec3d v);

/// M = T R S with R a rotation as a unit quaternion (x, y, z, w) and S what is left (scale and shear), by polar
/// decomposition (Higham's iteration), as the pbrt format defines motion: T and S lerp, R slerps the short way round.
struct Decomposition {
    Vec3d translation;
    std::array<double, 4> rotation{0, 0, 0, 1};
    Matrix4 stretch;
};
Decomposition decompose(const Matrix4& a);
Matrix4 compose(const Decomposition& d);

}  // namespace penumbra
