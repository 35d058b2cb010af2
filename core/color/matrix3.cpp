#include "core/color/matrix3.h"

namespace penumbra {

Matrix3 inverse(const Matrix3& a) {
    const auto& m = a.m;
    const auto cofactor = [&](int row, int column) {  // cyclic indices carry the sign
        const int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
        return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
    };
    const double determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
    Matrix3 out;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            out.m[row][column] = cofactor(column, row) / determinant;
    return out;
}

}  // namespace penumbra
