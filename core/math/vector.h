// Vectors, local frames and small helpers over lanes.
#pragma once

#include "core/math/lane_math.h"

namespace penumbra {

template <class F>
struct Vec2 {
    F x, y;
    friend Vec2 operator+(const Vec2& a, const Vec2& b) { return {a.x + b.x, a.y + b.y}; }
    friend Vec2 operator-(const Vec2& a, const Vec2& b) { return {a.x - b.x, a.y - b.y}; }
    friend Vec2 operator*(const Vec2& a, F s) { return {a.x * s, a.y * s}; }
};

template <class F>
struct Vec3 {
    F x, y, z;
    friend Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
    friend Vec3 operator*(const Vec3& a, F s) { return {a.x * s, a.y * s, a.z * s}; }
    friend Vec3 operator*(F s, const Vec3& a) { return {a.x * s, a.y * s, a.z * s}; }
    friend Vec3 operator/(const Vec3& a, F s) { return a * (F(1.f) / s); }
    Vec3& operator+=(const Vec3& b) { x += b.x; y += b.y; z += b.z; return *this; }
};

template <class F> F dot(const Vec3<F>& a, const Vec3<F>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class F> Vec3<F> cross(const Vec3<F>& a, const Vec3<F>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class F> F lengthSquared(const Vec3<F>& a) { return dot(a, a); }
template <class F> F length(const Vec3<F>& a) { return sqrt(dot(a, a)); }
/// A zero vector gives NaN.
template <class F> Vec3<F> normalize(const Vec3<F>& a) { return a * (F(1.f) / length(a)); }
template <class F> Vec3<F> abs(const Vec3<F>& a) { return {abs(a.x), abs(a.y), abs(a.z)}; }
template <class F> F maxComponent(const Vec3<F>& a) { return max(a.x, max(a.y, a.z)); }
template <class F> Vec3<F> select(const Mask<F>& m, const Vec3<F>& a, const Vec3<F>& b) {
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
template <class F> Vec3<F> flipSign(const Mask<F>& m, const Vec3<F>& a) {
    return {flipSign(m, a.x), flipSign(m, a.y), flipSign(m, a.z)};
}
template <class F> Vec3<F> broadcast(const Vec3<float>& a) { return {F(a.x), F(a.y), F(a.z)}; }
template <class F> Vec3<float> lane(const Vec3<F>& a, int i) { return {lane(a.x, i), lane(a.y, i), lane(a.z, i)}; }

/// Two unit vectors that make a right-handed frame with the unit vector n (Duff et al. 2017, JCGT 6(1)).
template <class F>
void orthonormalBasis(const Vec3<F>& n, Vec3<F>& s, Vec3<F>& t) {
    const F sign = copySign(F(1.f), n.z);
    const F a = F(-1.f) / (sign + n.z);
    const F b = n.x * n.y * a;
    s = {F(1.f) + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
}

/// Orthonormal s, t, n: local x, y, z.
template <class F>
struct Frame {
    Vec3<F> s, t, n;
    static Frame fromNormal(const Vec3<F>& n) {
        Frame f;
        f.n = n;
        orthonormalBasis(n, f.s, f.t);
        return f;
    }
    /// Turns s and t about n so that s lies towards v; not where v is along n, nor in other lanes.
    void turnTowards(const Vec3<F>& v, const Mask<F>& wanted) {
        const Vec3<F> across = v - n * dot(n, v);
        const F squared = dot(across, across);
        const Mask<F> use = wanted & (squared > F(1e-30f));
        const Vec3<F> x = across * (F(1.f) / sqrt(max(squared, F(1e-30f))));
        s = select(use, x, s);
        t = select(use, cross(n, x), t);
    }
    Vec3<F> toLocal(const Vec3<F>& v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
    Vec3<F> toWorld(const Vec3<F>& v) const { return s * v.x + t * v.y + n * v.z; }
};

}  // namespace penumbra
