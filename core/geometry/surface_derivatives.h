// How the point of a hit and its shading normal change with uv; for the few materials that ask, and therefore apart
// from surfacePoint().
//
// Where a shape has no usable uv (a triangle whose uv are on a line, the pole of a sphere), dp/du and dp/dv are the
// axes of the shading frame or zero, and the normal does not change. So it is on curves, whose surface depends on the
// ray.
#pragma once

#include "core/geometry/surface_point.h"

namespace penumbra {

template <class F>
struct SurfaceDerivatives {
    Vec3<F> dpdu, dpdv;  ///< world space
    Vec3<F> dndu, dndv;  ///< of the unit shading normal, and at right angles to it
};

namespace detail {

/// The normal here is not normalised, and of either side.
template <class F>
struct LocalDerivatives {
    Vec3<F> dpdu, dpdv, n, dndu, dndv;
    Mask<F> usable;
};

/// Lanes that are no mesh read triangle 0.
template <class F>
LocalDerivatives<F> meshInGroup(const Geometry& g, const ShapeLanes<F>& shape, const Hit<F>& hit,
                                const Mask<F>& isMesh) {
    const TriangleCorners<F> corners(g.indices.data(), select(isMesh, shape.first + hit.primitive, UInt<F>(0u)));
    Vec3<F> p[3], n[3];
    Vec2<F> t[3];
    corners.positions(g.positions.data(), p);
    corners.uvs(g.uvs.data(), shape.uvShift, isMesh, t);
    const Vec2<F> d1 = t[1] - t[0], d2 = t[2] - t[0];
    const F determinant = d1.x * d2.y - d1.y * d2.x;
    const Mask<F> usable = abs(determinant) > F(1e-30f);
    const F inverse = F(1.f) / select(usable, determinant, F(1.f));
    // By uv, of what is linear between the corners.
    const auto alongU = [&](const Vec3<F>& e1, const Vec3<F>& e2) { return (e1 * d2.y - e2 * d1.y) * inverse; };
    const auto alongV = [&](const Vec3<F>& e1, const Vec3<F>& e2) { return (e2 * d1.x - e1 * d2.x) * inverse; };
    LocalDerivatives<F> out;
    out.usable = usable;
    const Vec3<F> e1 = p[1] - p[0], e2 = p[2] - p[0], zero{F(0.f), F(0.f), F(0.f)};
    out.dpdu = alongU(e1, e2);
    out.dpdv = alongV(e1, e2);
    out.n = cross(e1, e2);
    out.dndu = out.dndv = zero;
    const Mask<F> smooth = isMesh & (shape.normalShift != UInt<F>(kNone));
    if (any(smooth)) {
        corners.vectors(g.normals.data(), shape.normalShift, smooth, n);
        const Vec3<F> sum = n[0] * ((F(1.f) - hit.u) - hit.v) + n[1] * hit.u + n[2] * hit.v;
        const Mask<F> given = smooth & (dot(sum, sum) > F(0.f));
        out.n = select(given, sum, out.n);
        out.dndu = select(given, alongU(n[1] - n[0], n[2] - n[0]), zero);
        out.dndv = select(given, alongV(n[1] - n[0], n[2] - n[0]), zero);
    }
    return out;
}

/// `p`: the point in the space of the shape's group.
template <class F>
LocalDerivatives<F> quadricInGroup(const Geometry& g, const ShapeLanes<F>& shape, const Mask<F>& isQuadric,
                                   const Vec3<F>& p) {
    const PlacedQuadric<F> q(g, shape, isQuadric);
    const QuadricDerivatives<F> d = quadricDerivatives(q.record, q.toObject.point(p));
    return {q.fromObject.vector(d.dpdu),  q.fromObject.vector(d.dpdv), q.fromObject.normal(d.normal),
            q.fromObject.normal(d.dndu), q.fromObject.normal(d.dndv), Mask<F>(true)};
}

}  // namespace detail

/// `hit` is what surfacePoint() made `at` of, at the same time. Every lane must hold a hit.
template <class F>
SurfaceDerivatives<F> surfaceDerivatives(const Geometry& g, const Hit<F>& hit, const SurfacePoint<F>& at, F time) {
    using namespace detail;
    const Mask<F> instanced = hit.instance != UInt<F>(kNone);
    Affine<F> place;
    Vec3<F> inGroup = at.p;
    if (any(instanced)) {
        place = instanceMatrix(g, hit, instanced, time);
        inGroup = select(instanced, place.preimage(at.p), at.p);
    }
    const Mask<F> isMesh = at.shape.kind == UInt<F>(std::uint32_t(ShapeKind::Mesh));
    const Mask<F> isCurve = at.shape.kind == UInt<F>(std::uint32_t(ShapeKind::Curves));
    const Mask<F> isQuadric = !(isMesh | isCurve);
    LocalDerivatives<F> d;
    d.usable = Mask<F>(false);
    d.dpdu = d.dpdv = d.dndu = d.dndv = {F(0.f), F(0.f), F(0.f)};
    d.n = at.frame.n;
    const auto add = [&](const Mask<F>& m, const LocalDerivatives<F>& of) {
        d = {select(m, of.dpdu, d.dpdu), select(m, of.dpdv, d.dpdv), select(m, of.n, d.n),
             select(m, of.dndu, d.dndu), select(m, of.dndv, d.dndv), select(m, of.usable, d.usable)};
    };
    if (any(isMesh)) add(isMesh, meshInGroup(g, at.shape, hit, isMesh));
    if (any(isQuadric)) add(isQuadric, quadricInGroup(g, at.shape, isQuadric, inGroup));
    if (any(instanced)) {
        d.dpdu = select(instanced, place.vector(d.dpdu), d.dpdu);
        d.dpdv = select(instanced, place.vector(d.dpdv), d.dpdv);
        d.n = select(instanced, place.normal(d.n), d.n);
        d.dndu = select(instanced, place.normal(d.dndu), d.dndu);
        d.dndv = select(instanced, place.normal(d.dndv), d.dndv);
    }
    // Of the unit normal: less the part that only changes the length.
    const Vec3<F>& n = at.frame.n;
    const F signedLength = copySign(length(d.n), dot(d.n, n));
    const auto ofUnit = [&](const Vec3<F>& dn) {
        const Vec3<F> scaled = dn / signedLength;
        const Vec3<F> across = scaled - n * dot(n, scaled);
        const Mask<F> sound = d.usable & (dot(across, across) < F(1e30f));
        return select(sound, across, Vec3<F>{F(0.f), F(0.f), F(0.f)});
    };
    return {select(d.usable, d.dpdu, at.frame.s), select(d.usable, d.dpdv, at.frame.t), ofUnit(d.dndu), ofUnit(d.dndv)};
}

}  // namespace penumbra
