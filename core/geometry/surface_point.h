// SurfacePoint: the geometry of a hit, built once, for the final hit only.
//
// Conventions: world space. `ng` is the unit geometric normal on the side that the shape's orientation calls outside (it
// decides emission, media and what "outside a dielectric" means); the shading frame's normal lies in its hemisphere.
// `error` bounds, per component, how far p is off the surface by rounding (along it, points next to an edge of a triangle
// are moved inwards by about as much); rays leave from offsetOrigin(), which is beyond that bound.
#pragma once

#include "core/geometry/curves.h"
#include "core/geometry/geometry.h"
#include "core/geometry/quadrics.h"

namespace penumbra {

template <class F>
struct Hit {
    UInt<F> shape, primitive, instance;  ///< row of Geometry::shapes (see shapeOf), triangle of the mesh or piece of
                                         ///< the curves, row of instances or kNone
    F u, v, t;
};

/// The row of shapes that belongs to what Embree reports: the geometry's number in its group, and the instance met, if any.
template <class F>
UInt<F> shapeOf(const Geometry& g, const UInt<F>& geometry, const UInt<F>& instance) {
    const Mask<F> instanced = instance != UInt<F>(kNone);
    if (none(instanced)) return geometry;
    const Records<F, InstanceRecord> r(g.instances.data(), select(instanced, instance, UInt<F>(0u)));
    return select(instanced, r(&InstanceRecord::firstShape) + geometry, geometry);
}

template <class F>
struct SurfacePoint {
    Vec3<F> p, error, ng;
    Frame<F> frame;
    Vec2<F> uv;
    F uvPerLength;       ///< how far uv moves for a step of unit length, to scale footprints
    ShapeLanes<F> shape;
    UInt<F> primitive;   ///< triangle of the mesh
};

/// Where a ray that leaves p in the direction w has to start so that it neither meets the surface again nor leaks through.
template <class F>
Vec3<F> offsetOrigin(const Vec3<F>& p, const Vec3<F>& error, const Vec3<F>& ng, const Vec3<F>& w) {
    return p + flipSign(dot(w, ng) < F(0.f), ng) * dot(abs(ng), error);
}

namespace detail {

template <class F>
[[gnu::always_inline]] inline Vec3<F> loadVertex(const float* table, const UInt<F>& row) {
    F r[4];
    loadRows4(table, row * UInt<F>(3u), r);
    return {r[0], r[1], r[2]};
}

/// The vertices of a triangle, and what stands in the tables for each.
template <class F>
struct TriangleCorners {
    UInt<F> vertex[3];

    TriangleCorners(const std::uint32_t* indices, const UInt<F>& triangle) {
        F row[4];
        loadRows4(reinterpret_cast<const float*>(indices), triangle * UInt<F>(3u), row);
        for (int i = 0; i < 3; ++i) vertex[i] = floatBits(row[i]);
    }
    void positions(const float* table, Vec3<F> out[3]) const {
        for (int i = 0; i < 3; ++i) out[i] = loadVertex<F>(table, vertex[i]);
    }
    /// Of normals or tangents; of lanes that are not given any, those of row 0.
    void vectors(const float* table, const UInt<F>& shift, const Mask<F>& given, Vec3<F> out[3]) const {
        for (int i = 0; i < 3; ++i) out[i] = loadVertex<F>(table, select(given, vertex[i] + shift, UInt<F>(0u)));
    }
    /// The corners of a mesh without uv are (0,0), (1,0), (1,1), and so are those of lanes not wanted.
    void uvs(const float* table, const UInt<F>& shift, const Mask<F>& wanted, Vec2<F> out[3]) const {
        out[0] = {F(0.f), F(0.f)}, out[1] = {F(1.f), F(0.f)}, out[2] = {F(1.f), F(1.f)};
        const Mask<F> mapped = wanted & (shift != UInt<F>(kNone));
        if (none(mapped)) return;
        for (int i = 0; i < 3; ++i) {
            F row[4];
            loadRows4(table, select(mapped, vertex[i] + shift, UInt<F>(0u)) * UInt<F>(2u), row);
            out[i] = {select(mapped, row[0], out[i].x), select(mapped, row[1], out[i].y)};
        }
    }
};

/// The matrix that instanced lanes stand in the world by.
template <class F>
Affine<F> instanceMatrix(const Geometry& g, const Hit<F>& hit, const Mask<F>& instanced, F time) {
    const Records<F, InstanceRecord> instance(g.instances.data(), select(instanced, hit.instance, UInt<F>(0u)));
    return affineAt<F>(g.matrices.data(), instance(&InstanceRecord::firstMatrix), instance(&InstanceRecord::segments),
                       time);
}

/// The unit vector along v, whose square may be beyond the range of floats (normals grow and shrink with the square of a
/// scale). Of usual vectors it is normalize().
template <class F>
[[gnu::always_inline]] inline Vec3<F> unitNormal(const Vec3<F>& v) {
    const F squared = dot(v, v);
    const Mask<F> usual = (squared > F(1e-30f)) & (squared < F(1e30f));
    if (all(usual)) [[likely]] return v * (F(1.f) / sqrt(squared));
    const F largest = max(maxComponent(abs(v)), F(1e-37f));   // 1 / largest is a normal number, too
    return normalize(select(usual, v, v * (F(1.f) / largest)));
}

/// What a shape gives in its own space.
template <class F>
struct LocalSurface {
    Vec3<F> p, error, ng, ns, tangent;   ///< ng, ns not normalised
    Vec2<F> uv;
    F uvPerLength;
    bool isFlat;                         ///< ns is ng in every lane
};

/// What the rounding of place.point(p) amounts to in the space of p, where no coordinate of p is beyond `coordinate`.
template <class F>
F roundingInside(const Affine<F>& place, F coordinate) {
    const Vec3<F> rounding = place.pointError({coordinate, coordinate, coordinate}, {F(0.f), F(0.f), F(0.f)});
    // Times the norm of the inverse matrix.
    const Cofactors<F> c = place.cofactors();
    const auto size = [](const Vec3<F>& row) { return abs(row.x) + abs(row.y) + abs(row.z); };
    const F norm = max(size(c.x), max(size(c.y), size(c.z))) / abs(c.determinant);
    return maxComponent(rounding) * norm;
}

/// `place`: of instanced lanes the matrix from here to the world.
template <class F>
[[gnu::always_inline]] inline void meshSurface(LocalSurface<F>& s, const Geometry& g, const ShapeLanes<F>& shape,
                                               const Hit<F>& hit, const Mask<F>& isMesh, const Affine<F>& place,
                                               const Mask<F>& instanced) {
    // Lanes that are no mesh read triangle 0 of the table and are thrown away by the caller.
    const TriangleCorners<F> corners(g.indices.data(), select(isMesh, shape.first + hit.primitive, UInt<F>(0u)));
    Vec3<F> at[3];
    corners.positions(g.positions.data(), at);
    const Vec3<F> &p0 = at[0], &p1 = at[1], &p2 = at[2];
    const F b1 = hit.u, b2 = hit.v, b0 = (F(1.f) - b1) - b2;
    s.p = p0 * b0 + p1 * b1 + p2 * b2;
    // The plane that Embree intersected is known to a few roundings of the corners' coordinates. One bound for all axes: a
    // plane through the origin has coordinates of exactly 0 across it, and still a ray must not start in it.
    const F largest = max(maxComponent(abs(p0)), max(maxComponent(abs(p1)), maxComponent(abs(p2))));
    const F error = largest * F(12 * 0x1p-24f);
    s.error = {error, error, error};
    const Vec3<F> e1 = p1 - p0, e2 = p2 - p0;
    const Mask<F> flip = shape.has(kShapeFlipNormal);
    const Vec3<F> faceNormal = cross(e1, e2);
    // Nor may a ray start beyond an edge, where the next face of a closed room is behind it: points keep off the edges by
    // their error. With n the face normal (twice the area long), barycentric b is b |n| / |edge| away from its edge.
    F margin = error;
    if (any(instanced)) margin = margin + select(instanced, roundingInside(place, largest), F(0.f));
    const Vec3<F> e3 = e2 - e1;
    const F longestSquared = max(dot(e1, e1), max(dot(e2, e2), dot(e3, e3)));
    const F normalSquared = dot(faceNormal, faceNormal);
    const F nearest = max(min(b0, min(b1, b2)), F(0.f));
    const Mask<F> onEdge = nearest * nearest * normalSquared < margin * margin * longestSquared;
    if (any(onEdge)) {
        // Towards the centroid, which is a third of the height away from each edge.
        const F part = min(F(3.f) * margin * sqrt(longestSquared / normalSquared), F(1.f));
        const Vec3<F> centroid = (p0 + p1 + p2) * F(1.f / 3.f);
        s.p = select(onEdge, s.p + (centroid - s.p) * part, s.p);
    }
    s.ng = flipSign(flip, faceNormal);
    s.ns = s.ng;
    const Mask<F> smooth = isMesh & (shape.normalShift != UInt<F>(kNone));
    s.isFlat = none(smooth);
    if (!s.isFlat) {
        Vec3<F> normals[3];
        corners.vectors(g.normals.data(), shape.normalShift, smooth, normals);
        const Vec3<F> n = normals[0] * b0 + normals[1] * b1 + normals[2] * b2;
        const Mask<F> usable = smooth & (dot(n, n) > F(0.f));
        s.ns = select(usable, n, s.ns);
        // The interpolated normal says which side is outside (PBRT-v4).
        s.ng = flipSign(usable & (dot(n, s.ng) < F(0.f)), s.ng);
    }
    s.uv = {b1 + b2, b2};   // the corners of a mesh without uv are (0,0), (1,0), (1,1)
    s.tangent = e1;
    s.uvPerLength = F(0.f);
    const Mask<F> needs = isMesh & shape.has(kShapeNeedsUv | kShapeNeedsTangent);
    if (any(needs)) {
        Vec2<F> uvs[3];
        corners.uvs(g.uvs.data(), shape.uvShift, needs, uvs);
        const Vec2<F> &t0 = uvs[0], &t1 = uvs[1], &t2 = uvs[2];
        s.uv = {t0.x * b0 + t1.x * b1 + t2.x * b2, t0.y * b0 + t1.y * b1 + t2.y * b2};
        const Vec2<F> d1 = t1 - t0, d2 = t2 - t0;
        const F determinant = d1.x * d2.y - d1.y * d2.x;
        const Vec3<F> dpdu = flipSign(determinant < F(0.f), e1 * d2.y - e2 * d1.y);
        s.tangent = select(abs(determinant) > F(1e-30f), dpdu, s.tangent);
        s.uvPerLength = sqrt(abs(determinant) / max(length(faceNormal), F(1e-30f)));
        const Mask<F> given = needs & (shape.tangentShift != UInt<F>(kNone));
        if (any(given)) {
            Vec3<F> tangents[3];
            corners.vectors(g.tangents.data(), shape.tangentShift, given, tangents);
            s.tangent = select(given, tangents[0] * b0 + tangents[1] * b1 + tangents[2] * b2, s.tangent);
        }
    }
}

/// The quadric of a lane, and the matrices between its object space and the space of the shape's group. Lanes that are none
/// read quadric 0.
template <class F>
struct PlacedQuadric {
    Records<F, QuadricRecord> record;
    Affine<F> fromObject, toObject;

    PlacedQuadric(const Geometry& g, const ShapeLanes<F>& shape, const Mask<F>& isQuadric)
        : record(g.quadrics.data(), select(isQuadric, shape.first, UInt<F>(0u))) {
        const UInt<F> offset = record.index() * UInt<F>(std::uint32_t(sizeof(QuadricRecord) / 4));
        fromObject = loadAffineAt<F>(g.quadrics[0].worldFromObject.m, offset);
        toObject = loadAffineAt<F>(g.quadrics[0].objectFromWorld.m, offset);
    }
};

template <class F>
void quadricSurface(LocalSurface<F>& s, const Geometry& g, const ShapeLanes<F>& shape, const Mask<F>& isQuadric, const Vec3<F>& met) {
    // `met` is the hit in the space of the shape's group.
    const PlacedQuadric<F> q(g, shape, isQuadric);
    const QuadricPoint<F> point = quadricPoint(q.record, q.toObject.point(met));
    const Mask<F> flip = shape.has(kShapeFlipNormal);
    s.p = q.fromObject.point(point.p);
    s.error = q.fromObject.pointError(point.p, point.error);
    s.ng = flipSign(flip, q.fromObject.normal(point.normal));
    s.ns = s.ng;
    s.isFlat = true;
    s.tangent = q.fromObject.vector(point.tangent);
    s.uv = point.uv;
    s.uvPerLength = F(0.f);
    // A normal here is as long as an area grows.
    if (any(isQuadric & shape.has(kShapeNeedsUv)))
        s.uvPerLength = F(1.f) / sqrt(max(areaPerUv(q.record, point.p) * length(s.ng), F(1e-30f)));
}

template <class F>
LocalSurface<F> blend(const Mask<F>& m, const LocalSurface<F>& a, const LocalSurface<F>& b) {
    return {select(m, a.p, b.p),
            select(m, a.error, b.error),
            select(m, a.ng, b.ng),
            select(m, a.ns, b.ns),
            select(m, a.tangent, b.tangent),
            {select(m, a.uv.x, b.uv.x), select(m, a.uv.y, b.uv.y)},
            select(m, a.uvPerLength, b.uvPerLength),
            a.isFlat && b.isFlat};
}

template <class F>
void curveSurface(LocalSurface<F>& s, const Geometry& g, const ShapeLanes<F>& shape, const Hit<F>& hit,
                  const Mask<F>& isCurve, const Vec3<F>& met, const Vec3<F>& direction) {
    const UInt<F> piece = select(isCurve, shape.first + hit.primitive, UInt<F>(0u));
    const UInt<F> flags = select(isCurve, shape.flags, UInt<F>(0u));
    const CurveTables tables{g.curveVertices.data(), g.curveNormals.data(), g.curveIndices.data()};
    const CurvePoint<F> point = curvePoint(tables, piece, hit.primitive, flags, hit.u, hit.v, met, direction);
    s.p = point.p;
    s.error = point.error;
    s.ng = flipSign(shape.has(kShapeFlipNormal), point.normal);
    s.ns = s.ng;
    s.isFlat = true;
    s.tangent = point.tangent;
    s.uv = point.uv;
    s.uvPerLength = point.uvPerLength;
}

/// Of lanes that hold no mesh. Where both kinds are there, lanes are computed twice.
template <class F>
void otherSurface(LocalSurface<F>& s, const Geometry& g, const ShapeLanes<F>& shape, const Hit<F>& hit,
                  const Mask<F>& isMesh, const Vec3<F>& met, const Vec3<F>& direction) {
    const Mask<F> isCurve = shape.kind == UInt<F>(std::uint32_t(ShapeKind::Curves));
    const Mask<F> isQuadric = !(isMesh | isCurve);
    if (none(isCurve)) return quadricSurface(s, g, shape, isQuadric, met);
    curveSurface(s, g, shape, hit, isCurve, met, direction);
    if (none(isQuadric)) return;
    LocalSurface<F> q;
    quadricSurface(q, g, shape, isQuadric, met);
    s = blend(isCurve, s, q);
}

}  // namespace detail

/// `origin`, `direction`, `time` are those of the ray (world space). Every lane must hold a hit.
template <class F>
SurfacePoint<F> surfacePoint(const Geometry& g, const Hit<F>& hit, const Vec3<F>& origin, const Vec3<F>& direction, F time) {
    using namespace detail;
    SurfacePoint<F> out;
    out.shape = ShapeLanes<F>::load(g.shapes.data(), hit.shape);
    out.primitive = hit.primitive;
    const ShapeLanes<F>& shape = out.shape;
    const Mask<F> instanced = hit.instance != UInt<F>(kNone);
    Affine<F> place;
    if (any(instanced)) place = instanceMatrix(g, hit, instanced, time);

    const Mask<F> isMesh = shape.kind == UInt<F>(std::uint32_t(ShapeKind::Mesh));
    LocalSurface<F> s;
    if (any(isMesh)) meshSurface(s, g, shape, hit, isMesh, place, instanced);
    if (!all(isMesh)) {
        Vec3<F> met = origin + direction * hit.t, along = direction;
        if (any(instanced)) {  // into the space of the group
            met = select(instanced, place.preimage(met), met);
            along = select(instanced, place.vectorPreimage(direction), direction);
        }
        if (none(isMesh)) {
            otherSurface(s, g, shape, hit, isMesh, met, along);
        } else {
            LocalSurface<F> other;
            otherSurface(other, g, shape, hit, isMesh, met, along);
            s = blend(isMesh, s, other);
        }
    }
    if (any(instanced)) {
        s.error = select(instanced, place.pointError(s.p, s.error), s.error);
        s.p = select(instanced, place.point(s.p), s.p);
        const Vec3<F> ng = place.normal(s.ng);   // as much longer as areas are larger
        if (any(instanced & shape.has(kShapeNeedsUv))) {
            const F shrinks = sqrt(length(s.ng) / max(length(ng), F(1e-30f)));
            s.uvPerLength = select(instanced, s.uvPerLength * shrinks, s.uvPerLength);
        }
        s.ng = select(instanced, ng, s.ng);
        s.ns = select(instanced, place.normal(s.ns), s.ns);
        s.tangent = select(instanced, place.vector(s.tangent), s.tangent);
    }
    out.p = s.p;
    out.error = s.error;
    out.ng = unitNormal(s.ng);
    Vec3<F> n = out.ng;
    if (!s.isFlat) {
        n = unitNormal(s.ns);
        // A shading normal on the wrong side of the face would turn the surface inside out.
        n = flipSign(dot(n, out.ng) < F(0.f), n);
    }
    out.uv = s.uv;
    out.uvPerLength = s.uvPerLength;

    const Mask<F> needsTangent = shape.has(kShapeNeedsTangent);
    out.frame = Frame<F>::fromNormal(n);
    if (any(needsTangent)) out.frame.turnTowards(s.tangent, needsTangent);
    return out;
}

}  // namespace penumbra
