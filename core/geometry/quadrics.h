// Spheres, cylinders and disks over lanes: intersection (called back by Embree with eight rays) and the surface at a
// hit.
//
// Precision: the near root is c / q with c = (|o| - r)(|o| + r), so a ray that starts just outside the surface never
// meets it again by rounding; points of spheres and cylinders are projected back onto them. A cylinder is a circle's
// affair: all but its ends happens in the plane z = 0.
#pragma once

#include "core/geometry/geometry.h"

namespace penumbra {

template <class F>
struct QuadricHit {
    F t;
    Mask<F> hit;
};

/// Whether the object-space point lies in the part of the quadric that exists.
template <class F>
Mask<F> insideQuadricPart(const QuadricRecord& q, const Vec3<F>& p) {
    Mask<F> in = Mask<F>(true);
    if (q.kind == ShapeKind::Sphere) {
        if (q.zMin > -q.radius) in = in & (p.z >= F(q.zMin));
        if (q.zMax < q.radius) in = in & (p.z <= F(q.zMax));
    } else if (q.kind == ShapeKind::Cylinder) {
        in = (p.z >= F(q.zMin)) & (p.z <= F(q.zMax));
    } else {
        const F d2 = p.x * p.x + p.y * p.y;
        in = (d2 <= F(q.radius * q.radius)) & (d2 >= F(q.innerRadius * q.innerRadius));
    }
    if (q.phiMax < kTwoPi) {
        F phi = atan2(p.y, p.x);
        phi = select(phi < F(0.f), phi + F(kTwoPi), phi);
        in = in & (phi <= F(q.phiMax));
    }
    return in;
}

/// Of a quadric that stops every ray: see intersectQuadric.
struct NoHoles {
    template <class F>
    Mask<F> operator()(F, bool) const { return Mask<F>(true); }
};

/// Nearest hit with near < t < far. `o`, `d` in object space; d need not be a unit vector. `isThere(t, farSide)` says whether
/// the surface is there where the ray would meet it; `farSide`: at the second of two roots.
template <class F, class IsThere = NoHoles>
QuadricHit<F> intersectQuadric(const QuadricRecord& q, const Vec3<F>& o, const Vec3<F>& d, F near, F far, const IsThere& isThere = {}) {
    const auto accept = [&](Mask<F>& meets, F t, bool farSide) {
        if (any(meets)) meets = meets & isThere(t, farSide);
    };
    if (q.kind == ShapeKind::Disk) {
        const F t = (F(q.zMin) - o.z) / d.z;   // a parallel ray gives inf or NaN, which no comparison passes
        const Vec3<F> p = {o.x + t * d.x, o.y + t * d.y, F(q.zMin)};
        Mask<F> meets = (t > near) & (t < far) & insideQuadricPart(q, p);
        accept(meets, t, false);
        return {t, meets};
    }
    const F r = F(q.radius);
    // Along the axis a cylinder has no extent to be met; a ray parallel to it gives 0 / 0, and no comparison passes.
    const F across = F(q.kind == ShapeKind::Cylinder ? 0.f : 1.f);
    const Vec3<F> from = {o.x, o.y, o.z * across}, along = {d.x, d.y, d.z * across};
    const F a = dot(along, along), b = dot(from, along);
    // Distance of the line from the centre, by the point of closest approach: no cancellation for small or far spheres
    // (Haines et al. 2019, Ray Tracing Gems, chapter 7).
    const Vec3<F> closest = from - along * (b / a);
    const F discriminant = (r * r - dot(closest, closest)) * a;
    const F root = safeSqrt(discriminant);
    const F distance = length(from);
    const F c = (distance - r) * (distance + r);
    const F s = -(b + copySign(root, b));
    const F t0 = s / a, t1 = c / s;
    const F first = min(t0, t1), second = max(t0, t1);
    const Mask<F> meets = discriminant >= F(0.f);
    Mask<F> firstOk = meets & (first > near) & (first < far) & insideQuadricPart(q, o + d * first);
    accept(firstOk, first, false);
    Mask<F> secondOk = meets & !firstOk & (second > near) & (second < far) & insideQuadricPart(q, o + d * second);
    accept(secondOk, second, true);
    return {select(firstOk, first, second), Mask<F>(firstOk | secondOk)};
}

/// The surface at a hit, in object space.
template <class F>
struct QuadricPoint {
    Vec3<F> p, error, normal, tangent;   ///< the normal points outwards (+z for disks); unit
    Vec2<F> uv;
};

template <class F>
QuadricPoint<F> quadricPoint(const Records<F, QuadricRecord>& q, const Vec3<F>& met) {
    const UInt<F> kind = q(&QuadricRecord::kind);
    const Mask<F> disk = kind == UInt<F>(std::uint32_t(ShapeKind::Disk));
    const Mask<F> cylinder = kind == UInt<F>(std::uint32_t(ShapeKind::Cylinder));
    const F r = q(&QuadricRecord::radius);
    QuadricPoint<F> out;
    // What a sphere is in space, a cylinder is in the plane.
    const Vec3<F> fromAxis = {met.x, met.y, select(cylinder, F(0.f), met.z)};
    const Vec3<F> onSphere = fromAxis * (r / length(fromAxis));
    const Vec3<F> onDisk = {met.x, met.y, q(&QuadricRecord::zMin)};
    out.p = select(disk, onDisk, Vec3<F>{onSphere.x, onSphere.y, select(cylinder, met.z, onSphere.z)});
    const F size = F(16 * 0x1p-24f) * r;
    out.error = {size, size, size};
    out.normal = select(disk, Vec3<F>{F(0.f), F(0.f), F(1.f)}, onSphere * (F(1.f) / r));
    F phi = atan2(out.p.y, out.p.x);
    phi = select(phi < F(0.f), phi + F(kTwoPi), phi);
    const F u = phi / q(&QuadricRecord::phiMax);
    const F rho = sqrt(out.p.x * out.p.x + out.p.y * out.p.y);
    const F inner = q(&QuadricRecord::innerRadius);
    const F theta = acos(out.p.z / r);
    const F thetaTop = q(&QuadricRecord::thetaMin), thetaBottom = q(&QuadricRecord::thetaMax);
    const F bottom = q(&QuadricRecord::zMin), top = q(&QuadricRecord::zMax);
    const F round =
        select(cylinder, (out.p.z - bottom) / (top - bottom), (theta - thetaBottom) / (thetaTop - thetaBottom));
    out.uv = {u, select(disk, (r - rho) / (r - inner), round)};
    // dp/du is along phi; at the poles any direction will do.
    const Mask<F> pole = rho < F(1e-20f);
    out.tangent = select(pole, Vec3<F>{F(1.f), F(0.f), F(0.f)}, Vec3<F>{-out.p.y, out.p.x, F(0.f)});
    return out;
}

/// How the point and the unit normal change with uv, in object space. `p` is on the surface.
template <class F>
struct QuadricDerivatives {
    Vec3<F> normal, dpdu, dpdv, dndu, dndv;
};

template <class F>
QuadricDerivatives<F> quadricDerivatives(const Records<F, QuadricRecord>& q, const Vec3<F>& p) {
    const UInt<F> kind = q(&QuadricRecord::kind);
    const Mask<F> disk = kind == UInt<F>(std::uint32_t(ShapeKind::Disk));
    const Mask<F> cylinder = kind == UInt<F>(std::uint32_t(ShapeKind::Cylinder));
    const F r = q(&QuadricRecord::radius), zero(0.f), perRadius = F(1.f) / r;
    const F rho = sqrt(p.x * p.x + p.y * p.y), perRho = F(1.f) / max(rho, F(1e-20f));
    const Vec3<F> outward = {p.x * perRho, p.y * perRho, zero};
    const Vec3<F> flat = outward * (q(&QuadricRecord::innerRadius) - r);   // v is 1 at the centre
    const Vec3<F> up = {zero, zero, q(&QuadricRecord::zMax) - q(&QuadricRecord::zMin)};
    const Vec3<F> round = Vec3<F>{p.z * outward.x, p.z * outward.y, -rho} *
                          (q(&QuadricRecord::thetaMin) - q(&QuadricRecord::thetaMax));
    const Vec3<F> none{zero, zero, zero};
    QuadricDerivatives<F> d;
    d.dpdu = Vec3<F>{-p.y, p.x, zero} * q(&QuadricRecord::phiMax);
    d.dpdv = select(disk, flat, select(cylinder, up, round));
    d.normal = select(disk, Vec3<F>{zero, zero, F(1.f)}, Vec3<F>{p.x, p.y, select(cylinder, zero, p.z)} * perRadius);
    d.dndu = select(disk, none, d.dpdu * perRadius);
    d.dndv = select(disk | cylinder, none, d.dpdv * perRadius);
    return d;
}

/// The area, in object space, of a piece of the surface around p over that of its uv.
template <class F>
F areaPerUv(const Records<F, QuadricRecord>& q, const Vec3<F>& p) {
    const QuadricDerivatives<F> d = quadricDerivatives(q, p);
    return length(cross(d.dpdu, d.dpdv));
}

}  // namespace penumbra
