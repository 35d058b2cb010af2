#include "core/math/matrix.h"

#include "core/math/double_vector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace penumbra {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// False, and `out` untouched, where `v` has no direction.
bool normalized(Vec3d v, Vec3d& out) {
    const double length = std::hypot(v.x, v.y, v.z);
    if (!(length > 0) || !std::isfinite(length)) return false;
    out = {v.x / length, v.y / length, v.z / length};
    return true;
}

bool isFinite(const Matrix4& a) {
    return std::all_of(a.m.begin(), a.m.end(), [](const auto& row) {
        return std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); });
    });
}

struct SineCosine {
    double sine, cosine;
};

/// Exact at multiples of 90 degrees, so that axis-aligned scenes stay axis-aligned.
SineCosine sineCosineDegrees(double degrees) {
    int quarter = 0;
    const double rest = std::remquo(degrees, 90.0, &quarter) * (std::numbers::pi / 180);
    const double s = std::sin(rest), c = std::cos(rest);
    switch (quarter & 3) {
        case 0:
            return {s, c};
        case 1:
            return {c, -s};
        case 2:
            return {-s, -c};
        default:
            return {-c, s};
    }
}

/// Gauss-Jordan elimination of one matrix beside the identity. `size` holds, for every entry, the largest term that
/// went into it: an entry that is nothing but the rounding error of such terms is a zero. (A bound on the entries alone
/// would refuse Scale 1 1 1e-20, which has an inverse, or accept rows 1 2 3 / 4 5 6 / 7 8 9, which have none.)
class Elimination {
public:
    explicit Elimination(const Matrix4& a) : left_(a) {
        for (int r = 0; r < 4; ++r)
            for (int c = 0; c < 4; ++c)
                size_.m[r][c] = std::abs(a.m[r][c]);
    }

    /// False where no pivot is left.
    bool eliminateNext() {
        int pivotRow = -1, pivotColumn = -1;
        double largest = 0;
        for (int r = 0; r < 4; ++r)
            for (int c = 0; c < 4; ++c)
                if (columnOfRow_[r] < 0 && !columnDone_[c] && std::abs(left_.m[r][c]) > largest) {
                    largest = std::abs(left_.m[r][c]);
                    pivotRow = r;
                    pivotColumn = c;
                }
        if (pivotRow < 0) return false;
        columnOfRow_[pivotRow] = pivotColumn;
        columnDone_[pivotColumn] = true;
        const double pivot = left_.m[pivotRow][pivotColumn];
        for (int c = 0; c < 4; ++c) {
            left_.m[pivotRow][c] /= pivot;
            size_.m[pivotRow][c] /= std::abs(pivot);
            right_.m[pivotRow][c] /= pivot;
        }
        for (int r = 0; r < 4; ++r)
            if (r != pivotRow) subtractRow(r, pivotRow, left_.m[r][pivotColumn]);
        return true;
    }

    /// Row r of the right side belongs to the column that r was the pivot row of.
    Matrix4 result() const {
        Matrix4 inverse;
        for (int r = 0; r < 4; ++r)
            inverse.m[columnOfRow_[r]] = right_.m[r];
        return inverse;
    }

private:
    void subtractRow(int from, int row, double factor) {
        for (int c = 0; c < 4; ++c) {
            left_.m[from][c] -= factor * left_.m[row][c];
            right_.m[from][c] -= factor * right_.m[row][c];
            size_.m[from][c] = std::max(size_.m[from][c], std::abs(factor) * size_.m[row][c]);
            if (std::abs(left_.m[from][c]) <= 4 * kEpsilon * size_.m[from][c]) left_.m[from][c] = 0;
        }
    }

    Matrix4 left_, right_, size_;
    std::array<int, 4> columnOfRow_{-1, -1, -1, -1};
    std::array<bool, 4> columnDone_{};
};

/// The upper left 3x3, the rest as in the identity.
Matrix4 linearPart(const Matrix4& a) {
    Matrix4 linear;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            linear.m[r][c] = a.m[r][c];
    return linear;
}

double frobeniusNorm3(const Matrix4& a) {
    double sum = 0;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            sum += a.m[r][c] * a.m[r][c];
    return std::sqrt(sum);
}

/// The orthogonal factor of a linear map by Higham's scaled Newton iteration (Computing the polar decomposition, SIAM
/// J. Sci. Stat. Comput. 7, 1986, section 3); its determinant has the sign of the map's. False where the map is
/// singular.
bool orthogonalFactor(const Matrix4& linear, Matrix4& out) {
    Matrix4 q = linear;
    constexpr int kMostSteps = 64;  // 10 suffice for a condition of 1e16; the bound is only against a stall
    for (int step = 0; step < kMostSteps; ++step) {
        Matrix4 inverse;
        if (!invert(q, inverse)) return false;
        const double gamma = std::sqrt(frobeniusNorm3(inverse) / frobeniusNorm3(q));
        if (!(gamma > 0) || !std::isfinite(gamma)) return false;
        double change = 0;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) {
                const double next = 0.5 * (gamma * q.m[r][c] + inverse.m[c][r] / gamma);
                out.m[r][c] = next;
                change = std::max(change, std::abs(next - q.m[r][c]));
            }
        q = out;
        if (change < 8 * kEpsilon) break;
    }
    return true;
}

/// Shepperd's method: divide by the largest of the four components, so that nothing cancels. w >= 0.
std::array<double, 4> quaternionFromRotation(const Matrix4& rotation) {
    const auto& m = rotation.m;
    const double trace = m[0][0] + m[1][1] + m[2][2];
    std::array<double, 4> q;
    if (trace > std::max({m[0][0], m[1][1], m[2][2]})) {
        q = {m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], 1 + trace};
    } else {
        const int i = m[0][0] >= m[1][1] ? (m[0][0] >= m[2][2] ? 0 : 2) : (m[1][1] >= m[2][2] ? 1 : 2);
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        q[i] = 1 + m[i][i] - m[j][j] - m[k][k];
        q[j] = m[i][j] + m[j][i];
        q[k] = m[i][k] + m[k][i];
        q[3] = m[k][j] - m[j][k];
    }
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (double& component : q)
        component /= q[3] < 0 ? -norm : norm;
    return q;
}

Matrix4 rotationFromQuaternion(const std::array<double, 4>& q) {
    const auto [x, y, z, w] = q;
    Matrix4 r;
    r.m[0] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 0};
    r.m[1] = {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 0};
    r.m[2] = {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), 0};
    return r;
}

}  // namespace

Matrix4 operator*(const Matrix4& a, const Matrix4& b) {
    Matrix4 product;
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) {
            double sum = 0;
            for (int k = 0; k < 4; ++k)
                sum += a.m[r][k] * b.m[k][c];
            product.m[r][c] = sum;
        }
    return product;
}

Matrix4 transpose(const Matrix4& a) {
    Matrix4 t;
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c)
            t.m[r][c] = a.m[c][r];
    return t;
}

bool invert(const Matrix4& a, Matrix4& out) {
    if (!isFinite(a)) return false;
    Elimination elimination(a);
    for (int step = 0; step < 4; ++step)
        if (!elimination.eliminateNext()) return false;
    const Matrix4 inverse = elimination.result();
    if (!isFinite(inverse)) return false;  // 1 / 1e-320
    out = inverse;
    return true;
}

double determinant3(const Matrix4& a) {
    const auto& m = a.m;
    return dot({m[0][0], m[0][1], m[0][2]}, cross({m[1][0], m[1][1], m[1][2]}, {m[2][0], m[2][1], m[2][2]}));
}

Matrix4 translation(double x, double y, double z) {
    Matrix4 t;
    t.m[0][3] = x;
    t.m[1][3] = y;
    t.m[2][3] = z;
    return t;
}

Matrix4 scaling(double x, double y, double z) {
    Matrix4 s;
    s.m[0][0] = x;
    s.m[1][1] = y;
    s.m[2][2] = z;
    return s;
}

Matrix4 rotation(double degrees, double x, double y, double z) {
    Vec3d n;
    if (!normalized({x, y, z}, n)) return {};  // no axis: no rotation
    const auto [s, c] = sineCosineDegrees(degrees);
    const double t = 1 - c;
    Matrix4 r;
    r.m[0] = {t * n.x * n.x + c, t * n.x * n.y - s * n.z, t * n.x * n.z + s * n.y, 0};
    r.m[1] = {t * n.y * n.x + s * n.z, t * n.y * n.y + c, t * n.y * n.z - s * n.x, 0};
    r.m[2] = {t * n.z * n.x - s * n.y, t * n.z * n.y + s * n.x, t * n.z * n.z + c, 0};
    return r;
}

bool lookAt(Vec3d eye, Vec3d look, Vec3d up, Matrix4& out) {
    Vec3d forward, upwards, right;
    if (!normalized({look.x - eye.x, look.y - eye.y, look.z - eye.z}, forward) || !normalized(up, upwards))
        return false;
    const Vec3d side = cross(upwards, forward);
    constexpr double kLeastSine = 1e-12;  // below it the side is rounding noise of two parallel vectors
    if (!(std::hypot(side.x, side.y, side.z) > kLeastSine) || !normalized(side, right)) return false;
    const Vec3d top = cross(forward, right);
    // The inverse of a rigid motion with columns (right, top, forward, eye): its rows, and the eye turned back.
    Matrix4 camera;
    camera.m[0] = {right.x, right.y, right.z, -dot(right, eye)};
    camera.m[1] = {top.x, top.y, top.z, -dot(top, eye)};
    camera.m[2] = {forward.x, forward.y, forward.z, -dot(forward, eye)};
    if (!isFinite(camera)) return false;
    out = camera;
    return true;
}

Vec3d transformPoint(const Matrix4& a, Vec3d p) {
    std::array<double, 4> h;
    for (int r = 0; r < 4; ++r)
        h[r] = a.m[r][0] * p.x + a.m[r][1] * p.y + a.m[r][2] * p.z + a.m[r][3];
    if (h[3] == 1) return {h[0], h[1], h[2]};
    return {h[0] / h[3], h[1] / h[3], h[2] / h[3]};
}

Vec3d transformVector(const Matrix4& a, Vec3d v) {
    const auto row = [&](int r) { return a.m[r][0] * v.x + a.m[r][1] * v.y + a.m[r][2] * v.z; };
    return {row(0), row(1), row(2)};
}

Decomposition decompose(const Matrix4& a) {
    Decomposition d;
    d.translation = {a.m[0][3], a.m[1][3], a.m[2][3]};
    const Matrix4 linear = linearPart(a);
    d.stretch = linear;
    Matrix4 q;
    if (!orthogonalFactor(linear, q)) return d;  // singular: all of it is stretch
    // With a reflection q = -R, R a rotation; S = -P then carries the reflection. Unlike a mirrored axis of P, which
    // has to be chosen, this follows the matrix continuously, so two mirrored key frames interpolate like their mirror
    // images.
    if (determinant3(q) < 0)
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                q.m[r][c] = -q.m[r][c];
    d.rotation = quaternionFromRotation(q);
    d.stretch = transpose(rotationFromQuaternion(d.rotation)) * linear;
    return d;
}

Matrix4 compose(const Decomposition& d) {
    return translation(d.translation.x, d.translation.y, d.translation.z) * rotationFromQuaternion(d.rotation) *
           d.stretch;
}

}  // namespace penumbra
