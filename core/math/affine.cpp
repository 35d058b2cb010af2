#include "core/math/affine.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

AffineRecord toRecord(const Matrix4& a) {
    AffineRecord r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j)
            // No negative zeros: interpolation between equal matrices would make positive ones of them, and whether lanes
            // that stand still are interpolated depends on their neighbours.
            r.m[4 * i + j] = float(a.m[std::size_t(i)][std::size_t(j)]) + 0.f;
    return r;
}

namespace {

std::array<double, 4> slerp(const std::array<double, 4>& a, std::array<double, 4> b, double t) {
    double d = 0;
    for (int i = 0; i < 4; ++i) d += a[std::size_t(i)] * b[std::size_t(i)];
    if (d < 0) {
        for (double& x : b) x = -x;
        d = -d;
    }
    const double angle = std::acos(std::min(d, 1.0));
    const double s = std::sin(angle);
    const double wa = s > 1e-9 ? std::sin((1 - t) * angle) / s : 1 - t, wb = s > 1e-9 ? std::sin(t * angle) / s : t;
    std::array<double, 4> q;
    double length = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        q[i] = wa * a[i] + wb * b[i];
        length += q[i] * q[i];
    }
    for (double& x : q) x /= std::sqrt(length);
    return q;
}

double rotationAngle(const std::array<double, 4>& a, const std::array<double, 4>& b) {
    double d = 0;
    for (std::size_t i = 0; i < 4; ++i) d += a[i] * b[i];
    return 2 * std::acos(std::min(std::fabs(d), 1.0));
}

/// The largest change of an entry, in terms of the largest entry.
double stretchChange(const Matrix4& a, const Matrix4& b) {
    double change = 0, largest = 0;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) {
            change = std::fmax(change, std::fabs(b.m[r][c] - a.m[r][c]));
            largest = std::fmax(largest, std::fmax(std::fabs(a.m[r][c]), std::fabs(b.m[r][c])));
        }
    return largest > 0 ? change / largest : 0;
}

}  // namespace

std::vector<Matrix4> motionMatrices(const Matrix4& start, const Matrix4& end) {
    if (start == end) return {start};
    const Decomposition a = decompose(start), b = decompose(end);
    // A segment of angle x strays by x^2 / 8 from its turn, and by x y / 4 where the stretch changes by y meanwhile.
    constexpr double kHalfDegree = 0.5 * 3.14159265358979323846 / 180, kStray = 1e-5;
    const double angle = rotationAngle(a.rotation, b.rotation);
    const double forStretch = std::sqrt(angle * stretchChange(a.stretch, b.stretch) / (4 * kStray));
    const int segments = int(std::clamp(std::ceil(std::fmax(angle / kHalfDegree, forStretch)), 1.0, 128.0));
    std::vector<Matrix4> out;
    for (int i = 0; i <= segments; ++i) {
        const double t = double(i) / segments;
        Decomposition d;
        d.translation = {(1 - t) * a.translation.x + t * b.translation.x, (1 - t) * a.translation.y + t * b.translation.y,
                         (1 - t) * a.translation.z + t * b.translation.z};
        d.rotation = slerp(a.rotation, b.rotation, t);
        for (std::size_t r = 0; r < 4; ++r)
            for (std::size_t c = 0; c < 4; ++c) d.stretch.m[r][c] = (1 - t) * a.stretch.m[r][c] + t * b.stretch.m[r][c];
        out.push_back(i == 0 ? start : i == segments ? end : compose(d));
    }
    return out;
}

}  // namespace penumbra
