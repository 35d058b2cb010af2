#include "core/geometry/alpha_mask.h"

#include "core/image/texture_plugin.h"
#include "core/math/hash.h"

namespace penumbra {

static_assert(kNoTexture == kNone);

AlphaMask::AlphaMask(const Geometry& g, std::uint32_t row, const Textures* textures)
    : row_(row),
      textures_(textures ? &textures->tables() : nullptr),
      curves_{g.curveVertices.data(), g.curveNormals.data(), g.curveIndices.data()},
      positions_(g.positions.data()),
      uvs_(g.uvs.data()),
      instances_(g.instances.data()),
      matrices_(g.matrices.data()) {
    const ShapeRecord& shape = g.shapes[row];
    constant_ = shape.alpha;
    texture_ = shape.alphaTexture;
    uvShift_ = shape.uvShift;
    first_ = shape.first;
    flags_ = shape.flags;
    isOneLight_ = shape.lightStride == 0;
    if (shape.kind == ShapeKind::Mesh) triangles_ = g.indices.data() + 3 * std::size_t(shape.first);
    else if (shape.kind != ShapeKind::Curves)
        quadric_ = &g.quadrics[shape.first];
}

template <class F>
Mask<F> AlphaMask::isThere(F alpha, const GroupRay<F>& ray, std::uint32_t instance, const UInt<F>& part) const {
    const Mask<F> whole = alpha >= F(1.f), partly = (alpha > F(0.f)) & !whole;
    if (none(partly)) return whole;
    UInt<F> h = combineBits(part, UInt<F>(combineBits(row_, instance)));
    for (const F x : {ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z})
        h = combineBits(h, floatBits(x));
    return whole | (partly & (unitFloat<F>(h) < alpha));
}

template <class F>
F AlphaMask::alpha(Point<F> at, std::uint32_t instance, F time) const {
    if (instance != kNone) {
        const InstanceRecord& placed = instances_[instance];
        const Affine<F> place = affineAt<F>(matrices_, UInt<F>(placed.firstMatrix), UInt<F>(placed.segments), time);
        at.p = place.point(at.p);
        at.n = place.normal(at.n);
    }
    return textures_->evaluate<F>(texture_, TextureContext<F>{at.uv, F(0.f), at.p, detail::unitNormal(at.n), F(0.f)});
}

template <class F>
AlphaMask::Triangle<F>::Triangle(const AlphaMask& mask, const UInt<F>& triangle) : corners(mask.triangles_, triangle) {
    Vec3<F> p[3];
    corners.positions(mask.positions_, p);
    origin = p[0];
    e1 = p[1] - p[0];
    e2 = p[2] - p[0];
    normal = cross(e1, e2);
}

/// Of p, or where p is not in the plane of the point of it that is nearest.
template <class F>
Vec2<F> AlphaMask::Triangle<F>::barycentricOf(const Vec3<F>& p) const {
    const Vec3<F> d = p - origin;
    const F scale = F(1.f) / dot(normal, normal);
    return {dot(cross(d, e2), normal) * scale, dot(cross(e1, d), normal) * scale};
}

template <class F>
Vec2<F> AlphaMask::uvAt(const Triangle<F>& t, const Vec2<F>& barycentric) const {
    Vec2<F> uv[3];
    t.corners.uvs(uvs_, UInt<F>(uvShift_), Mask<F>(true), uv);
    const F b1 = barycentric.x, b2 = barycentric.y, b0 = (F(1.f) - b1) - b2;
    return {uv[0].x * b0 + uv[1].x * b1 + uv[2].x * b2, uv[0].y * b0 + uv[1].y * b1 + uv[2].y * b2};
}

template <class F>
AlphaMask::Point<F> AlphaMask::quadricPointAt(const Vec3<F>& p) const {
    const Affine<F> objectFromGroup = loadAffine<F>(&quadric_->objectFromWorld, UInt<F>(0u));
    const Affine<F> groupFromObject = loadAffine<F>(&quadric_->worldFromObject, UInt<F>(0u));
    const QuadricPoint<F> q = quadricPoint(Records<F, QuadricRecord>(quadric_, UInt<F>(0u)), objectFromGroup.point(p));
    return {q.uv, p, groupFromObject.normal(q.normal)};
}

template <class F>
Mask<F> AlphaMask::meetsTriangle(const GroupRay<F>& ray, F t, std::uint32_t instance, const UInt<F>& triangle,
                                 const Vec2<F>& barycentric) const {
    if (texture_ == kNone) return isThere(F(constant_), ray, instance, triangle);
    const Triangle<F> met(*this, triangle);
    const Point<F> at{uvAt(met, barycentric), ray.origin + ray.direction * t, met.normal};
    return isThere(alpha(at, instance, ray.time), ray, instance, triangle);
}

template <class F>
Mask<F> AlphaMask::meetsCurve(const GroupRay<F>& ray, F t, std::uint32_t instance, const UInt<F>& piece,
                              const Vec2<F>& uv) const {
    if (texture_ == kNone) return isThere(F(constant_), ray, instance, piece);
    const CurvePoint<F> at = curvePoint<F>(curves_, UInt<F>(first_) + piece, piece, UInt<F>(flags_), uv.x, uv.y,
                                           ray.origin + ray.direction * t, ray.direction);
    return isThere(alpha(Point<F>{at.uv, at.p, at.normal}, instance, ray.time), ray, instance, piece);
}

template <class F>
Mask<F> AlphaMask::meetsQuadric(const GroupRay<F>& ray, F t, std::uint32_t instance, bool farSide) const {
    const UInt<F> part(farSide ? 1u : 0u);
    if (texture_ == kNone) return isThere(F(constant_), ray, instance, part);
    return isThere(alpha(quadricPointAt(ray.origin + ray.direction * t), instance, ray.time), ray, instance, part);
}

template <class F>
F AlphaMask::alphaAt(const UInt<F>& triangle, const Vec3<F>& p) const {
    if (texture_ == kNone) return F(clamp(constant_, 0.f, 1.f));
    Point<F> at;
    if (quadric_) {
        at = quadricPointAt(p);
    } else {
        const Triangle<F> met(*this, triangle);
        const Vec2<F> b = met.barycentricOf(p);
        at = {uvAt(met, b), p, met.normal};
        if (isOneLight_) {
            // A rectangle: p may lie in its other triangle, whose uv need not go on as those of this one do.
            const Mask<F> outside = min(min(b.x, b.y), F(1.f) - b.x - b.y) < F(0.f);
            const Triangle<F> other(*this, UInt<F>(1u));
            const Vec2<F> there = uvAt(other, other.barycentricOf(p));
            at.uv = {select(outside, there.x, at.uv.x), select(outside, there.y, at.uv.y)};
        }
    }
    return clamp(alpha(at, kNone, F(0.f)), F(0.f), F(1.f));
}

template bool AlphaMask::meetsTriangle<float>(const GroupRay<float>&, float, std::uint32_t, const std::uint32_t&,
                                              const Vec2<float>&) const;
template Mask8 AlphaMask::meetsTriangle<Lanes8f>(const GroupRay<Lanes8f>&, Lanes8f, std::uint32_t, const Lanes8u&,
                                                 const Vec2<Lanes8f>&) const;
template bool AlphaMask::meetsCurve<float>(const GroupRay<float>&, float, std::uint32_t, const std::uint32_t&,
                                           const Vec2<float>&) const;
template Mask8 AlphaMask::meetsCurve<Lanes8f>(const GroupRay<Lanes8f>&, Lanes8f, std::uint32_t, const Lanes8u&,
                                              const Vec2<Lanes8f>&) const;
template bool AlphaMask::meetsQuadric<float>(const GroupRay<float>&, float, std::uint32_t, bool) const;
template Mask8 AlphaMask::meetsQuadric<Lanes8f>(const GroupRay<Lanes8f>&, Lanes8f, std::uint32_t, bool) const;
template float AlphaMask::alphaAt<float>(const std::uint32_t&, const Vec3<float>&) const;
template Lanes8f AlphaMask::alphaAt<Lanes8f>(const Lanes8u&, const Vec3<Lanes8f>&) const;

}  // namespace penumbra
