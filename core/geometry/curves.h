// Curves over lanes: the surface at a hit that Embree reports. (What is met is Embree's affair: see accelerator.cpp.)
//
// Conventions (PBRT-v4): u runs along a segment, v across it from 0 to 1, towards d x T for a ray in the direction d
// and the tangent T; T is the surface's tangent. A curve without normals of its own is a ribbon that faces the ray,
// with its normal on the ray's far side; that of a cylinder turns with v, from side to side, as a tube's would, and
// there the shading is a tube's. Ribbons have v turned round where they are seen from their back.
//
// Precision: a ribbon that faces the ray is another one for every ray, so a ray that leaves a point may meet the same
// curve again, unless it starts outside of the tube that all these ribbons fill. `error` says so: offsetOrigin() then
// starts beyond it. (Embree ignores hits of ribbons nearer than a width in addition.)
#pragma once

#include "core/geometry/geometry.h"

namespace penumbra {

/// The surface at a hit, in the space of the curve.
template <class F>
struct CurvePoint {
    Vec3<F> p, error, normal, tangent;  ///< normal and tangent unit
    Vec2<F> uv;
    F uvPerLength;
};

/// The tables of Geometry that curves are in.
struct CurveTables {
    const float *vertices, *normals;
    const std::uint32_t* indices;
};

/// `piece` is the row of Geometry::curveIndices, `flags` those of the shape, `primitive` the piece's number in its
/// shape. u, v are Embree's; `met` the point met and `direction` the ray's, not necessarily of unit length.
template <class F>
CurvePoint<F> curvePoint(const CurveTables& tables, const UInt<F>& piece, const UInt<F>& primitive,
                         const UInt<F>& flags, F u, F v, const Vec3<F>& met, const Vec3<F>& direction) {
    const auto has = [&](std::uint32_t flag) { return Mask<F>((flags & UInt<F>(flag)) != UInt<F>(0u)); };
    const Mask<F> spline = has(kShapeCurveSpline), ribbon = has(kShapeCurveRibbon), cylinder = has(kShapeCurveCylinder);
    const UInt<F> first = gather(tables.indices, piece);

    // Weights of the four control points for the point and for the derivative by u.
    const F w = F(1.f) - u, u2 = u * u, w2 = w * w, sixth = F(1.f / 6.f);
    const F bezier[4] = {w2 * w, F(3.f) * w2 * u, F(3.f) * w * u2, u2 * u};
    const F cubic[4] = {bezier[0] * sixth, (F(4.f) + u2 * (F(3.f) * u - F(6.f))) * sixth,
                        (F(4.f) + w2 * (F(3.f) * w - F(6.f))) * sixth, bezier[3] * sixth};
    const F bezierSlope[4] = {F(-3.f) * w2, F(3.f) * w * (w - F(2.f) * u), F(3.f) * u * (F(2.f) * w - u), F(3.f) * u2};
    const F cubicSlope[4] = {F(-0.5f) * w2, u * (F(1.5f) * u - F(2.f)), w * (F(2.f) - F(1.5f) * w), F(0.5f) * u2};

    Vec3<F> center = {F(0.f), F(0.f), F(0.f)}, slope = center, turned = center, ends = center;
    F radius = F(0.f), largest = F(0.f);
    for (int i = 0; i < 4; ++i) {
        F row[4];
        loadRows4(tables.vertices, (first + UInt<F>(std::uint32_t(i))) * UInt<F>(4u), row);
        const Vec3<F> control = {row[0], row[1], row[2]};
        const F weight = select(spline, cubic[i], bezier[i]);
        center += control * weight;
        slope += control * select(spline, cubicSlope[i], bezierSlope[i]);
        radius = radius + row[3] * weight;
        largest = max(largest, maxComponent(abs(control)));
        if (i == 0) ends = control * F(-1.f);
        if (i == 3) ends += control;
    }
    if (any(ribbon))
        for (int i = 0; i < 4; ++i) {
            const UInt<F> row = select(ribbon, first + UInt<F>(std::uint32_t(i)), UInt<F>(0u)) * UInt<F>(3u);
            F n[4];
            loadRows4(tables.normals, row, n);
            turned += Vec3<F>{n[0], n[1], n[2]} * bezier[i];
        }

    CurvePoint<F> out;
    const Mask<F> cusp = dot(slope, slope) <= F(1e-12f) * dot(ends, ends);
    const Vec3<F> straight = select(cusp, ends, slope);
    const Vec3<F> tangent = normalize(straight);
    // Across the curve; of a ray along it, in any direction.
    const Vec3<F> facing = select(ribbon, turned, direction);
    const Vec3<F> sideways = cross(facing, tangent);
    const Mask<F> along = dot(sideways, sideways) <= F(1e-12f) * dot(facing, facing);
    const Vec3<F> side = select(along, Frame<F>::fromNormal(tangent).s, normalize(sideways));
    const Vec3<F> front = cross(tangent, side);

    // Embree's v is in [-1, 1] of ribbons that face the ray, and in [0, 1] of those with normals.
    const F across = clamp(select(ribbon, v, F(0.5f) + F(0.5f) * v), F(0.f), F(1.f));
    F s, c;
    sinCos(F(kPi) * (across - F(0.5f)), s, c);
    out.normal = select(cylinder, side * s + front * c, front);
    out.tangent = tangent;
    out.p = select(ribbon, met, center + side * ((F(2.f) * across - F(1.f)) * radius));
    const F rounding = largest * F(32 * 0x1p-24f);
    const F clear = select(ribbon, F(2e-3f), select(cylinder, F(2.1f), F(1.1f))) * max(radius, F(0.f)) + rounding;
    out.error = {clear, clear, clear};

    const Mask<F> turnedRound = (ribbon & (dot(direction, out.normal) < F(0.f))) ^ has(kShapeCurveMirrored);
    const UInt<F> level = (flags >> kShapeCurveLevelShift) & UInt<F>(kMostCurveLevel);
    const F pieces = floatFromBits((level + UInt<F>(127u)) << 23);  // 2^level
    const UInt<F> number = primitive & (toUInt(pieces) - UInt<F>(1u));
    out.uv = {(toFloat<F>(number) + u) / pieces, select(turnedRound, F(1.f) - across, across)};
    out.uvPerLength = F(1.f) / sqrt(max(length(straight) * pieces * F(2.f) * radius, F(1e-30f)));
    return out;
}

}  // namespace penumbra
