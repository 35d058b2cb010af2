// 3x3 matrices and triples in double: the arithmetic of colour conversions.
//
// Conventions: column vectors, v' = M v; m[row][column].
#pragma once

#include <array>

namespace penumbra {

using Triple = std::array<double, 3>;

struct Matrix3 {
    std::array<Triple, 3> m{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    friend bool operator==(const Matrix3&, const Matrix3&) = default;
};

inline Triple operator*(const Matrix3& a, const Triple& v) {
    Triple out{};
    for (int row = 0; row < 3; ++row)
        out[row] = a.m[row][0] * v[0] + a.m[row][1] * v[1] + a.m[row][2] * v[2];
    return out;
}

inline Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
    Matrix3 out;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            out.m[row][column] =
                a.m[row][0] * b.m[0][column] + a.m[row][1] * b.m[1][column] + a.m[row][2] * b.m[2][column];
    return out;
}

inline Matrix3 diagonal(const Triple& d) {
    return {{{{d[0], 0, 0}, {0, d[1], 0}, {0, 0, d[2]}}}};
}

/// Inverse by cofactors. Colour matrices are never near singular, so there is no check.
Matrix3 inverse(const Matrix3& a);

}  // namespace penumbra
