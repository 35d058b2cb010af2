// AlphaMask: the holes of a shape, where the scene gives it an alpha (a number or a float texture).
//
// A point of alpha a stops a ray with probability a, else the ray goes on as if nothing were there: every ray, shadow
// rays included, so the expectation is a blend of the shape with what is behind it. The choice is no random draw but a
// hash of the ray (origin, direction) and of what it meets (shape, triangle or piece, instance, near or far side):
// Embree may offer a hit in any order, more than once, and hits that are not the nearest, and must hear the same each
// time. Rays of different samples and of different vertices of a path differ, so their choices are independent, and so
// are those of stacked sheets. The choice is free of work where alpha is 0 or less (nothing there, NaN included) or 1
// and more.
//
// Textures are looked up as points, without a footprint.
// Thread safety: immutable. A mask refers to tables of the Geometry and of the Textures, which keep their place in
// memory when their owners move; they must outlive it. Its functions give the same bits over lanes and one by one.
#pragma once

#include "core/geometry/surface_point.h"
#include "core/image/texture.h"

namespace penumbra {

/// A ray on its way through a group of shapes: in the space of the group.
template <class F>
struct GroupRay {
    Vec3<F> origin, direction;
    F time;
};

class AlphaMask {
public:
    /// `row`: of geometry.shapes. `textures` may be null where the shape's alpha is a number.
    AlphaMask(const Geometry& geometry, std::uint32_t row, const Textures* textures);

    /// Whether the ray meets the triangle (of the mesh) at distance t, where its barycentric coordinates are u, v.
    /// `instance`: row of Geometry::instances, or kNone.
    template <class F>
    Mask<F> meetsTriangle(const GroupRay<F>& ray, F t, std::uint32_t instance, const UInt<F>& triangle, const Vec2<F>& barycentric) const;
    /// Whether the ray meets the piece (of the curves) at distance t, where Embree's parameters are `uv`.
    template <class F>
    Mask<F> meetsCurve(const GroupRay<F>& ray, F t, std::uint32_t instance, const UInt<F>& piece,
                       const Vec2<F>& uv) const;
    /// Whether the ray meets the quadric at distance t. `farSide`: it is the second root.
    template <class F>
    Mask<F> meetsQuadric(const GroupRay<F>& ray, F t, std::uint32_t instance, bool farSide) const;

    /// Alpha at a world-space point of a shape that stands in the world, which shines: clamped to [0, 1]. Of a mesh, in that
    /// triangle; in either of two that are one light.
    template <class F>
    F alphaAt(const UInt<F>& triangle, const Vec3<F>& p) const;

    const QuadricRecord& quadric() const { return *quadric_; }

private:
    /// What textures look at, in the space of the group.
    template <class F>
    struct Point {
        Vec2<F> uv;
        Vec3<F> p, n;
    };
    template <class F>
    struct Triangle {
        detail::TriangleCorners<F> corners;
        Vec3<F> origin, e1, e2, normal;
        Triangle(const AlphaMask& mask, const UInt<F>& triangle);
        Vec2<F> barycentricOf(const Vec3<F>& p) const;
    };
    template <class F>
    Vec2<F> uvAt(const Triangle<F>& t, const Vec2<F>& barycentric) const;
    template <class F>
    Point<F> quadricPointAt(const Vec3<F>& p) const;
    /// Of the texture.
    template <class F>
    F alpha(Point<F> at, std::uint32_t instance, F time) const;
    template <class F>
    Mask<F> isThere(F alpha, const GroupRay<F>& ray, std::uint32_t instance, const UInt<F>& part) const;

    float constant_;
    std::uint32_t texture_, row_, uvShift_, first_, flags_;
    bool isOneLight_;
    const TextureTables* textures_;
    const std::uint32_t* triangles_ = nullptr;   ///< of the mesh: three vertex numbers each
    const QuadricRecord* quadric_ = nullptr;
    CurveTables curves_;
    const float *positions_, *uvs_;
    const InstanceRecord* instances_;
    const AffineRecord* matrices_;
};

}  // namespace penumbra
