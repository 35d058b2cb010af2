// Matrices: algebra on random matrices, and the conventions of the pbrt format (columns, signs, handedness).

#include "core/math/matrix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace penumbra {
namespace {

double largestDifference(const Matrix4& a, const Matrix4& b) {
    double largest = 0;
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c)
            largest = std::max(largest, std::abs(a.m[r][c] - b.m[r][c]));
    return largest;
}

void expectNear(const Matrix4& a, const Matrix4& b, double tolerance) {
    EXPECT_LE(largestDifference(a, b), tolerance);
}

void expectNear(Vec3d a, Vec3d b, double tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

class Random {
public:
    double uniform(double low = -1, double high = 1) { return low + (high - low) * (engine_() / 4294967296.0); }
    Matrix4 matrix() {
        Matrix4 a;
        for (auto& row : a.m)
            for (double& value : row)
                value = uniform();
        return a;
    }
    Matrix4 affine() {
        Matrix4 a = matrix();
        a.m[3] = {0, 0, 0, 1};
        return a;
    }

private:
    std::mt19937 engine_{7};
};

Matrix4 rows(std::array<double, 4> a, std::array<double, 4> b, std::array<double, 4> c,
             std::array<double, 4> d = {0, 0, 0, 1}) {
    Matrix4 matrix;
    matrix.m = {a, b, c, d};
    return matrix;
}

TEST(Matrix, ProductAppliesTheRightFactorFirst) {
    const Matrix4 both = translation(1, 2, 3) * scaling(2, 3, 4);
    expectNear(transformPoint(both, {1, 1, 1}), {3, 5, 7}, 0);
    expectNear(transformVector(both, {1, 1, 1}), {2, 3, 4}, 0);
    EXPECT_EQ(both, rows({2, 0, 0, 1}, {0, 3, 0, 2}, {0, 0, 4, 3}));
    EXPECT_EQ(transpose(both).m[3][0], 1);
}

TEST(Matrix, PointsAreDividedByTheirWeight) {
    Matrix4 perspective;
    perspective.m[3] = {0, 0, 1, 0};
    expectNear(transformPoint(perspective, {2, 4, 2}), {1, 2, 1}, 0);
}

TEST(Matrix, InverseOfRandomMatrices) {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        const Matrix4 a = random.matrix();
        Matrix4 inverse, back;
        ASSERT_TRUE(invert(a, inverse));
        ASSERT_TRUE(invert(inverse, back));
        double size = 1;  // the error grows with the condition of a
        for (const auto& row : inverse.m)
            for (const double value : row)
                size = std::max(size, std::abs(value));
        expectNear(a * inverse, {}, 1e-14 * size);
        expectNear(inverse * a, {}, 1e-14 * size);
        expectNear(back, a, 1e-13 * size);
    }
}

TEST(Matrix, InverseNeedsPivotsAnywhere) {
    Matrix4 inverse;
    const Matrix4 permuted = rows({0, 0, 0, 2}, {0, 4, 0, 0}, {8, 0, 0, 0}, {0, 0, 16, 0});
    ASSERT_TRUE(invert(permuted, inverse));
    EXPECT_EQ(permuted * inverse, Matrix4{});
    const Matrix4 uneven = translation(1e6, 0, 0) * scaling(1e-20, 1, 1e20);
    ASSERT_TRUE(invert(uneven, inverse));
    EXPECT_DOUBLE_EQ(inverse.m[0][0], 1e20);
    EXPECT_DOUBLE_EQ(inverse.m[0][3], -1e26);
    EXPECT_DOUBLE_EQ(inverse.m[2][2], 1e-20);
}

TEST(Matrix, SingularMatricesHaveNoInverse) {
    const Matrix4 untouched = translation(1, 2, 3);
    Matrix4 out = untouched;
    EXPECT_FALSE(invert(scaling(1, 0, 1), out));
    EXPECT_FALSE(invert(rows({1, 2, 3, 0}, {4, 5, 6, 0}, {7, 8, 9, 0}), out));
    EXPECT_FALSE(invert(rows({.1, .2, .3, 0}, {.4, .5, .6, 0}, {.7, .8, .9, 0}), out));
    EXPECT_FALSE(invert(scaling(1e-320, 1, 1), out));
    EXPECT_FALSE(invert(scaling(std::numeric_limits<double>::infinity(), 1, 1), out));
    EXPECT_FALSE(invert(translation(0, std::nan(""), 0), out));
    EXPECT_EQ(out, untouched);
}

TEST(Matrix, DeterminantOfTheLinearPart) {
    EXPECT_EQ(determinant3(translation(5, 6, 7) * scaling(2, 3, -4)), -24);
    EXPECT_NEAR(determinant3(rotation(33, 1, 2, 3)), 1, 1e-15);
    EXPECT_EQ(determinant3(rows({0, 1, 0, 0}, {0, 0, 1, 0}, {1, 0, 0, 0})), 1);
}

TEST(Matrix, RotateTurnsXToYAboutZ) {
    EXPECT_EQ(rotation(90, 0, 0, 5), rows({0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}));
    EXPECT_EQ(rotation(-90, 0, 0, 5), rows({0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}));
    expectNear(transformVector(rotation(90, 1, 0, 0), {0, 1, 0}), {0, 0, 1}, 0);
    expectNear(transformVector(rotation(90, 0, 1, 0), {0, 0, 1}), {1, 0, 0}, 0);
    expectNear(transformVector(rotation(120, 1, 1, 1), {1, 0, 0}), {0, 1, 0}, 1e-15);
    expectNear(transformVector(rotation(30, 0, 0, 1), {1, 0, 0}), {std::sqrt(.75), .5, 0}, 1e-15);
}

TEST(Matrix, RotateIsExactAtRightAnglesAndPeriodic) {
    EXPECT_EQ(rotation(180, 1, 0, 0), scaling(1, -1, -1));
    EXPECT_EQ(rotation(360, 3, 1, 2), Matrix4{});
    EXPECT_EQ(rotation(270, 0, 1, 0), rotation(-90, 0, 1, 0));
    for (double angle = -720; angle <= 720; angle += 7.5) {
        expectNear(rotation(angle, 1, -2, .5) * rotation(-angle, 1, -2, .5), {}, 1e-15);
        EXPECT_NEAR(rotation(angle, 0, 0, 1).m[0][0], std::cos(angle * std::acos(-1.0) / 180), 1e-14) << angle;
        EXPECT_NEAR(rotation(angle, 0, 0, 1).m[1][0], std::sin(angle * std::acos(-1.0) / 180), 1e-14) << angle;
    }
}

TEST(Matrix, RotateAboutNothingDoesNothing) {
    EXPECT_EQ(rotation(50, 0, 0, 0), Matrix4{});
}

TEST(Matrix, LookAtIsTheInverseOfRightUpForwardEye) {
    const Vec3d eye{1, 2, 3};
    Matrix4 camera, world;
    ASSERT_TRUE(lookAt(eye, {4, 3, 7}, {.2, 1, .1}, camera));
    ASSERT_TRUE(invert(camera, world));
    // The columns as the format states them: d = ^(look - eye), r = ^(^up x d), v = d x r.
    const double length = std::sqrt(26.0);
    const Vec3d d{3 / length, 1 / length, 4 / length};
    expectNear({world.m[0][2], world.m[1][2], world.m[2][2]}, d, 1e-15);
    const Vec3d r{1 * d.z - .1 * d.y, .1 * d.x - .2 * d.z, .2 * d.y - 1 * d.x};
    const double rLength = std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z);
    expectNear(Vec3d{world.m[0][0], world.m[1][0], world.m[2][0]}, {r.x / rLength, r.y / rLength, r.z / rLength},
               1e-15);
    EXPECT_GT(world.m[1][1], .5);  // up stays up
    expectNear({world.m[0][3], world.m[1][3], world.m[2][3]}, eye, 1e-14);
    EXPECT_NEAR(determinant3(camera), 1, 1e-14);
}

TEST(Matrix, LookAtAlongZIsATranslation) {
    Matrix4 camera;
    ASSERT_TRUE(lookAt({0, 0, -5}, {0, 0, 0}, {0, 1, 0}, camera));
    EXPECT_EQ(camera, translation(0, 0, 5));
    ASSERT_TRUE(lookAt({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, camera));
    expectNear(transformPoint(camera, {0, 0, -1}), {1, 0, 0}, 0);  // looking to +x with y up, -z is to the right
}

TEST(Matrix, LookAtNeedsADirectionAndAnUp) {
    const Matrix4 untouched = translation(1, 2, 3);
    Matrix4 out = untouched;
    EXPECT_FALSE(lookAt({1, 1, 1}, {1, 1, 1}, {0, 1, 0}, out));
    EXPECT_FALSE(lookAt({0, 0, 0}, {0, 3, 0}, {0, 1, 0}, out));
    EXPECT_FALSE(lookAt({0, 0, 0}, {.3, .1, .7}, {-.9, -.3, -2.1}, out));  // parallel but for rounding
    EXPECT_FALSE(lookAt({0, 0, 0}, {0, 0, 1}, {0, 0, 0}, out));
    EXPECT_FALSE(lookAt({0, 0, 0}, {std::nan(""), 0, 1}, {0, 1, 0}, out));
    EXPECT_EQ(out, untouched);
}

TEST(Matrix, DecompositionSeparatesWhatWasComposed) {
    const Matrix4 stretch = rows({2, .3, .1, 0}, {.3, 1, .2, 0}, {.1, .2, .5, 0});  // symmetric, positive
    for (const double angle : {0.0, 1e-7, 30.0, 90.0, 120.0, 179.0, 180.0})
        for (const Vec3d axis : {Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 2, -3}, {-1, -1, -1}}) {
            const Decomposition d = decompose(translation(4, 5, 6) * rotation(angle, axis.x, axis.y, axis.z) * stretch);
            expectNear(d.translation, {4, 5, 6}, 0);
            expectNear(d.stretch, stretch, 1e-14);
            const double half = angle * std::acos(-1.0) / 360;
            const double norm = std::sqrt(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z);
            // q and -q are the same rotation.
            const double along = (d.rotation[0] * axis.x + d.rotation[1] * axis.y + d.rotation[2] * axis.z) / norm;
            EXPECT_NEAR(std::abs(d.rotation[3] * std::cos(half) + along * std::sin(half)), 1, 1e-14) << angle;
        }
}

TEST(Matrix, RandomDecompositionsComposeBack) {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        // Of any size and shape, a half of them with a reflection.
        const Matrix4 a =
            random.affine() * scaling(std::exp(random.uniform(-20, 20)), std::exp(random.uniform(-9, 9)), 1);
        const Decomposition d = decompose(a);
        const auto [x, y, z, w] = d.rotation;
        EXPECT_NEAR(x * x + y * y + z * z + w * w, 1, 1e-14);
        EXPECT_GE(w, 0);
        double size = 1;
        for (const auto& row : a.m)
            for (const double value : row)
                size = std::max(size, std::abs(value));
        expectNear(compose(d), a, 1e-14 * size);
        expectNear(d.stretch, transpose(d.stretch), 1e-13 * size);
        EXPECT_EQ(determinant3(d.stretch) < 0, determinant3(a) < 0);
    }
}

TEST(Matrix, ReflectionsGoIntoTheStretch) {
    const Matrix4 mirrored = scaling(-1, 1, 1) * rotation(40, 0, 1, 0);
    const Decomposition d = decompose(mirrored);
    expectNear(compose(d), mirrored, 1e-15);
    expectNear(d.stretch, scaling(-1, -1, -1), 1e-14);
    // Half-way between two mirrored key frames lies the mirror image of what lies half-way between the plain ones.
    const Decomposition start = decompose(scaling(-1, 1, 1)),
                        end = decompose(scaling(-1, 1, 1) * rotation(80, 0, 1, 0));
    Decomposition middle = start;
    double norm = 0, sign = 0;
    for (int i = 0; i < 4; ++i)
        sign += start.rotation[i] * end.rotation[i];
    for (int i = 0; i < 4; ++i) {
        middle.rotation[i] = start.rotation[i] + std::copysign(1.0, sign) * end.rotation[i];
        norm += middle.rotation[i] * middle.rotation[i];
    }
    for (double& component : middle.rotation)
        component /= std::sqrt(norm);
    expectNear(compose(middle), mirrored, 1e-14);
}

TEST(Matrix, SingularMatricesAreAllStretch) {
    const Matrix4 flat = translation(1, 2, 3) * rotation(30, 0, 0, 1) * scaling(1, 1, 0);
    const Decomposition d = decompose(flat);
    EXPECT_EQ(d.rotation, (std::array<double, 4>{0, 0, 0, 1}));
    expectNear(compose(d), flat, 0);
}

}  // namespace
}  // namespace penumbra
