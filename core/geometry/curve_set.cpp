#include "core/geometry/curve_set.h"

#include "core/base/error.h"
#include "core/geometry/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra {
namespace {

/// What is interpolated along a curve: position and radius.
struct Control {
    double x = 0, y = 0, z = 0, r = 0;
    friend Control operator+(const Control& a, const Control& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z, a.r + b.r};
    }
    friend Control operator*(const Control& a, double s) { return {a.x * s, a.y * s, a.z * s, a.r * s}; }
};
using Cubic = std::array<Control, 4>;

Control mix(const Control& a, const Control& b, double t) {
    return a * (1 - t) + b * t;
}

std::vector<Control> pointsOf(const CurveArrays& arrays) {
    std::vector<Control> points(arrays.P.size() / 3);
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = {arrays.P[3 * i], arrays.P[3 * i + 1], arrays.P[3 * i + 2], 0};
    return points;
}

std::size_t countSegments(const CurveArrays& arrays, const std::string& where) {
    const std::size_t points = arrays.P.size() / 3, degree = std::size_t(arrays.degree);
    const auto fail = [&](const std::string& needed) {
        throw Error(ErrorKind::BadData, where + ": " + std::to_string(points) + " points make no curve of degree " +
                                            std::to_string(degree) + "; needed are " + needed);
    };
    if (arrays.spline) {
        if (points <= degree) fail("at least " + std::to_string(degree + 1));
        return points - degree;
    }
    if (points <= degree || (points - 1) % degree != 0)
        fail(std::to_string(degree + 1) + ", and " + std::to_string(degree) + " for each further segment");
    return (points - 1) / degree;
}

/// One segment as a cubic Bezier curve, without its radius.
Cubic segmentOf(const CurveArrays& arrays, const std::vector<Control>& p, std::size_t segment) {
    if (arrays.degree == 3) {
        if (!arrays.spline) return {p[3 * segment], p[3 * segment + 1], p[3 * segment + 2], p[3 * segment + 3]};
        const Control *a = &p[segment], b = mix(a[1], a[2], 1. / 3), c = mix(a[1], a[2], 2. / 3);
        return {mix(mix(a[0], a[1], 2. / 3), b, 0.5), b, c, mix(c, mix(a[2], a[3], 1. / 3), 0.5)};
    }
    std::array<Control, 3> q;
    if (arrays.spline)
        q = {mix(p[segment], p[segment + 1], 0.5), p[segment + 1], mix(p[segment + 1], p[segment + 2], 0.5)};
    else
        q = {p[2 * segment], p[2 * segment + 1], p[2 * segment + 2]};
    return {q[0], mix(q[0], q[1], 2. / 3), mix(q[1], q[2], 1. / 3), q[2]};
}

bool hasLength(const Cubic& c) {
    return std::any_of(c.begin() + 1, c.end(),
                       [&](const Control& p) { return p.x != c[0].x || p.y != c[0].y || p.z != c[0].z; });
}

/// log2 of the pieces that keep the polygon of Embree within a twentieth of the width, as PBRT-v4's own recursion does:
/// n chords stray from a cubic by at most 6 |second difference of its control points| / (8 n^2).
unsigned levelOf(const std::vector<Cubic>& segments, double width) {
    double bend = 0;
    for (const Cubic& c : segments)
        for (std::size_t i = 0; i < 2; ++i) {
            const Control d = c[i] + c[i + 1] * -2 + c[i + 2];
            bend = std::max(bend, std::hypot(d.x, d.y, d.z));
        }
    unsigned level = 0;
    for (double chords = kCurveQuads; level < kMostCurveLevel && 6 * bend > 8 * chords * chords * 0.05 * width;
         chords *= 2)
        ++level;
    return level;
}

void put(std::vector<float>& table, const Control& c) {
    table.insert(table.end(), {float(c.x), float(c.y), float(c.z), float(c.r)});
}

/// One level of a uniform cubic B-spline's subdivision (Lane and Riesenfeld 1980): twice the segments.
std::vector<Control> subdivided(const std::vector<Control>& p) {
    std::vector<Control> finer;
    finer.reserve(2 * p.size() - 3);
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
        if (i > 0) finer.push_back(p[i - 1] * 0.125 + p[i] * 0.75 + p[i + 1] * 0.125);
        finer.push_back(mix(p[i], p[i + 1], 0.5));
    }
    return finer;
}

void putSpline(CurveSet& set, std::vector<Control> p, const CurveArrays& arrays, const std::vector<Cubic>& segments) {
    const double count = double(segments.size());
    for (std::size_t i = 0; i < p.size(); ++i)  // the spline of values in a line is the line
        p[i].r = 0.5 * (arrays.width0 + (double(arrays.width1) - arrays.width0) * (double(i) - 1) / count);
    for (unsigned i = 0; i < set.level; ++i)
        p = subdivided(p);
    set.vertices.reserve(4 * p.size());
    for (const Control& c : p)
        put(set.vertices, c);
    for (std::size_t i = 0; i + 3 < p.size(); ++i)
        if (hasLength(segments[i >> set.level])) set.indices.push_back(std::uint32_t(i));
}

/// The half of a Bezier curve: its control points by de Casteljau's construction.
Cubic half(const Cubic& c, bool second) {
    const Control a = mix(c[0], c[1], 0.5), b = mix(c[1], c[2], 0.5), d = mix(c[2], c[3], 0.5);
    const Control ab = mix(a, b, 0.5), bd = mix(b, d, 0.5), middle = mix(ab, bd, 0.5);
    return second ? Cubic{middle, bd, d, c[3]} : Cubic{c[0], a, ab, middle};
}

void putPieces(CurveSet& set, const Cubic& c, unsigned level, bool seen) {
    if (level > 0) {
        putPieces(set, half(c, false), level - 1, seen);
        putPieces(set, half(c, true), level - 1, seen);
        return;
    }
    if (seen) set.indices.push_back(std::uint32_t(set.vertices.size() / 4));
    for (std::size_t i = 0; i < 3; ++i)
        put(set.vertices, c[i]);
}

void putBezier(CurveSet& set, const CurveArrays& arrays, std::vector<Cubic> segments) {
    const double count = double(segments.size());
    for (std::size_t i = 0; i < segments.size(); ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
            const double along = (double(i) + double(k) / 3) / count;
            segments[i][k].r = 0.5 * (arrays.width0 + (double(arrays.width1) - arrays.width0) * along);
        }
        putPieces(set, segments[i], set.level, hasLength(segments[i]));
    }
    put(set.vertices, segments.back()[3]);
}

Vec3d normalOf(const CurveArrays& arrays, std::size_t i, const std::string& where) {
    const Vec3d n = {arrays.N[3 * i], arrays.N[3 * i + 1], arrays.N[3 * i + 2]};
    const double size = std::hypot(n.x, n.y, n.z);
    if (!(size > 0))
        throw Error(ErrorKind::BadData, where + ": the normal number " + std::to_string(i) + " has no length");
    return {n.x / size, n.y / size, n.z / size};
}

/// By the angle between unit vectors. Opposite ones have no way between them: the first then holds.
Vec3d slerp(const Vec3d& a, const Vec3d& b, double t) {
    const double angle = std::acos(std::clamp(a.x * b.x + a.y * b.y + a.z * b.z, -1.0, 1.0)), sine = std::sin(angle);
    if (sine < 1e-6) return a;
    const double s = std::sin((1 - t) * angle) / sine, r = std::sin(t * angle) / sine;
    return {a.x * s + b.x * r, a.y * s + b.y * r, a.z * s + b.z * r};
}

/// The control points of the cubics that meet the slerped normals at the ends and thirds of every piece.
void putNormals(CurveSet& set, const CurveArrays& arrays, std::size_t segments, const std::string& where) {
    const auto put3 = [&](const Vec3d& n) {
        set.normals.insert(set.normals.end(), {float(n.x), float(n.y), float(n.z)});
    };
    const std::size_t pieces = std::size_t(1) << set.level;
    for (std::size_t i = 0; i < segments; ++i) {
        const Vec3d from = normalOf(arrays, i, where), to = normalOf(arrays, i + 1, where);
        for (std::size_t j = 0; j < pieces; ++j) {
            std::array<Vec3d, 4> n;
            for (std::size_t k = 0; k < 4; ++k)
                n[k] = slerp(from, to, (double(j) + double(k) / 3) / double(pieces));
            const auto combined = [&](double a, double b, double c, double d) {
                return Vec3d{(a * n[0].x + b * n[1].x + c * n[2].x + d * n[3].x) / 6,
                             (a * n[0].y + b * n[1].y + c * n[2].y + d * n[3].y) / 6,
                             (a * n[0].z + b * n[1].z + c * n[2].z + d * n[3].z) / 6};
            };
            put3(n[0]);
            put3(combined(-5, 18, -9, 2));
            put3(combined(2, -9, 18, -5));
        }
    }
    put3(normalOf(arrays, segments, where));
}

bool fits(const std::vector<float>& points) {
    return std::all_of(points.begin(), points.end(), [](float x) { return std::abs(x) < kLargestCoordinate; });
}

}  // namespace

void CurveSet::append(const CurveSet& other) {
    const std::uint32_t first = std::uint32_t(vertices.size() / 4);
    vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
    normals.insert(normals.end(), other.normals.begin(), other.normals.end());
    for (const std::uint32_t i : other.indices)
        indices.push_back(first + i);
}

CurveSet curvesFromArrays(const CurveArrays& arrays, const std::string& where, Warnings& warnings) {
    const std::size_t count = countSegments(arrays, where);
    const bool ribbon = arrays.type == CurveType::Ribbon;
    if (ribbon && arrays.N.size() != 3 * (count + 1))
        throw Error(ErrorKind::BadData, where + ": a ribbon of " + std::to_string(count) + " segments needs " +
                                            std::to_string(count + 1) + " normals \"N\", but has " +
                                            std::to_string(arrays.N.size() / 3));
    if (!ribbon && !arrays.N.empty()) warnings.add(where + ": \"N\" is of use for ribbons only; ignored");
    CurveSet set;
    const double width = std::max(arrays.width0, arrays.width1);
    if (!(width > 0) || !fits(arrays.P)) return set;

    const std::vector<Control> points = pointsOf(arrays);
    std::vector<Cubic> segments(count);
    for (std::size_t i = 0; i < count; ++i)
        segments[i] = segmentOf(arrays, points, i);
    set.level = levelOf(segments, width);
    set.spline = arrays.spline && arrays.degree == 3 && !ribbon;
    if (set.spline)
        putSpline(set, points, arrays, segments);
    else
        putBezier(set, arrays, std::move(segments));
    if (ribbon) putNormals(set, arrays, count, where);
    return set;
}

bool isSimilarity(const Matrix4& matrix) {
    const auto dot = [&](std::size_t a, std::size_t b) {
        return matrix.m[0][a] * matrix.m[0][b] + matrix.m[1][a] * matrix.m[1][b] + matrix.m[2][a] * matrix.m[2][b];
    };
    const double scale = (dot(0, 0) + dot(1, 1) + dot(2, 2)) / 3, slack = 1e-5 * scale;
    return std::abs(dot(0, 0) - scale) <= slack && std::abs(dot(1, 1) - scale) <= slack &&
           std::abs(dot(2, 2) - scale) <= slack && std::abs(dot(0, 1)) <= slack && std::abs(dot(1, 2)) <= slack &&
           std::abs(dot(2, 0)) <= slack;
}

void transform(CurveSet& curves, const Matrix4& matrix) {
    const double scale = std::cbrt(std::abs(determinant3(matrix)));
    for (std::size_t i = 0; i < curves.vertices.size(); i += 4) {
        float* v = &curves.vertices[i];
        const Vec3d p = transformPoint(matrix, {v[0], v[1], v[2]});
        v[0] = float(p.x), v[1] = float(p.y), v[2] = float(p.z), v[3] = float(scale * v[3]);
    }
    for (std::size_t i = 0; i < curves.normals.size(); i += 3) {
        float* n = &curves.normals[i];
        const Vec3d turned =
            transformVector(matrix, {n[0], n[1], n[2]});  // of a similarity the inverse transpose is a multiple
        n[0] = float(turned.x / scale), n[1] = float(turned.y / scale), n[2] = float(turned.z / scale);
    }
    if (!fits(curves.vertices)) curves = {};
}

}  // namespace penumbra
