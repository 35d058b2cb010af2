// Affine transforms over lanes, and motion as a row of matrices.
//
// Conventions: rows of three-by-four, p' = M p. A motion is `segments + 1` matrices equally spaced over normalised time
// [0, 1], between which entries are interpolated linearly: exactly what Embree does with instance transforms, so that the
// point we shade is the point it hit. The pbrt format's rotation by slerp is sampled finely enough (motionMatrices).
#pragma once

#include "core/math/matrix.h"
#include "core/math/vector.h"

#include <vector>

namespace penumbra {

/// What the inverse of a linear map is made of: the rows of the inverse times the determinant (cross products of the columns).
template <class F>
struct Cofactors {
    Vec3<F> x, y, z;
    F determinant;
};

template <class F>
struct Affine {
    Vec3<F> x, y, z, origin;   ///< the columns

    Cofactors<F> cofactors() const {
        const Vec3<F> row = cross(y, z);
        return {row, cross(z, x), cross(x, y), dot(x, row)};
    }

    Vec3<F> point(const Vec3<F>& p) const { return x * p.x + y * p.y + z * p.z + origin; }
    Vec3<F> vector(const Vec3<F>& v) const { return x * v.x + y * v.y + z * v.z; }
    /// By the cofactor matrix (the inverse transpose times the determinant): exact for singular matrices too; not normalised,
    /// and for reflections negated, so that a normal stays on the side of the object that it was on.
    Vec3<F> normal(const Vec3<F>& n) const {
        const Cofactors<F> c = cofactors();
        return flipSign(c.determinant < F(0.f), c.x * n.x + c.y * n.y + c.z * n.z);
    }
    /// The point that point() takes to q (Cramer's rule). REQUIRES: not singular.
    Vec3<F> preimage(const Vec3<F>& q) const { return vectorPreimage(q - origin); }
    /// The vector that vector() takes to r. REQUIRES: not singular.
    Vec3<F> vectorPreimage(const Vec3<F>& r) const {
        const Cofactors<F> c = cofactors();
        const F inverse = F(1.f) / c.determinant;
        return {dot(r, c.x) * inverse, dot(r, c.y) * inverse, dot(r, c.z) * inverse};
    }
    /// Bound of the rounding error of point(p) when p itself is known to within `error`, per component.
    Vec3<F> pointError(const Vec3<F>& p, const Vec3<F>& error) const {
        const Vec3<F> ax = abs(x), ay = abs(y), az = abs(z), ap = abs(p);
        const Vec3<F> magnitude = ax * ap.x + ay * ap.y + az * ap.z + abs(origin);
        return magnitude * F(8 * 0x1p-24f) + ax * error.x + ay * error.y + az * error.z;
    }
};

/// Twelve floats, row by row, as Affine is kept in tables.
struct AffineRecord {
    float m[12];
};

AffineRecord toRecord(const Matrix4& m);

/// The record whose twelve floats begin `offset` floats behind `base`.
template <class F>
Affine<F> loadAffineAt(const float* base, const UInt<F>& offset) {
    F r0[4], r1[4], r2[4];
    loadRows4(base, offset, r0);
    loadRows4(base, offset + UInt<F>(4u), r1);
    loadRows4(base, offset + UInt<F>(8u), r2);
    return {{r0[0], r1[0], r2[0]}, {r0[1], r1[1], r2[1]}, {r0[2], r1[2], r2[2]}, {r0[3], r1[3], r2[3]}};
}
template <class F>
Affine<F> loadAffine(const AffineRecord* table, const UInt<F>& index) {
    return loadAffineAt<F>(table->m, index * UInt<F>(12u));
}

/// The matrix of a motion at a normalised time. `segments` 0: the matrix at `first` alone.
template <class F>
Affine<F> affineAt(const AffineRecord* table, const UInt<F>& first, const UInt<F>& segments, F time) {
    if (none(segments != UInt<F>(0u))) return loadAffine<F>(table, first);
    const F count = toFloat<F>(segments);
    const F scaled = time * count;
    const F whole = max(min(floor(scaled), count - F(1.f)), F(0.f));
    const F f = select(segments == UInt<F>(0u), F(0.f), scaled - whole);
    const UInt<F> i = first + toUInt(whole);
    const Affine<F> a = loadAffine<F>(table, i);
    const Affine<F> b = loadAffine<F>(table, select(segments == UInt<F>(0u), i, i + UInt<F>(1u)));
    const auto mix = [&](const Vec3<F>& u, const Vec3<F>& v) { return u * (F(1.f) - f) + v * f; };
    return {mix(a.x, b.x), mix(a.y, b.y), mix(a.z, b.z), mix(a.origin, b.origin)};
}

/// Samples the motion between two matrices (translation and stretch lerped, rotation slerped) so finely that linear
/// interpolation strays from it by at most about 1e-5 of the object's size (half a degree a segment, less where the object is
/// stretched meanwhile; at most 128 segments, Embree's limit). One matrix where both are equal.
std::vector<Matrix4> motionMatrices(const Matrix4& start, const Matrix4& end);

}  // namespace penumbra
