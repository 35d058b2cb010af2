// FaceList: the faces and quadrics of a small scene, met one after the other by eight rays at a time.
//
// A room of a few dozen faces is no place for a hierarchy: eight rays that go their own ways test all of its faces in
// less time than a tree takes to tell them apart (docs/BENCHMARKS.md has figures). Two triangles that make a flat convex
// quadrilateral are one face. Accelerator uses this where make() gives it and Embree elsewhere.
//
// Watertight: corners are projected along each ray, once for all faces that share them, and a ray is inside a face where
// no edge has it on the wrong side. Both faces at an edge compute the very same number for it, but for the sign, and zero
// is inside of both, so no ray passes between them (Woop, Benthin, Wald 2013, JCGT 2(1), have the argument). The plane of
// a face, which gives the distance, is measured from one of its corners, so rays that leave it next to rounding do not
// meet it again.
//
// Hits are reported as Embree does: number of the shape, triangle of the mesh, barycentrics of the triangle's second and
// third corner. Of faces met at the same distance, the first in the list counts. Thread safety: immutable once made.
#pragma once

#include "core/geometry/geometry.h"
#include "core/geometry/quadrics.h"
#include "core/geometry/ray_packet.h"

#include <array>
#include <memory>
#include <vector>

namespace penumbra {

class FaceList {
public:
    /// Null where the scene is not small, or holds more than whole meshes and quadrics that stand still. `g`'s table of
    /// quadrics must outlive the list; `g` may be moved.
    static std::unique_ptr<FaceList> make(const Geometry& g);

    void intersect(RayHitPacket& rays, unsigned live) const noexcept;
    /// Sets far to -infinity where something lies between near and far.
    void occluded(RayPacket& rays, unsigned live) const noexcept;

private:
    using F = Lanes8f;
    static constexpr std::uint32_t kMostCorners = 128, kMostFaces = 64;

    /// A triangle repeats its first corner. Sixteen words.
    struct Face {
        std::array<std::uint32_t, 4> corners;
        Vec3<float> normal, from;   ///< of the plane; `from` is the first corner
        std::uint32_t triangle;     ///< its first row of triangles_
        Vec3<float> acrossDiagonal;
        float diagonal;             ///< acrossDiagonal * p below it: p is in the second triangle
        float spare;
    };
    /// What is said of a hit. Sixteen words, which are read as rows.
    struct Triangle {
        Vec3<float> u;              ///< times the vector from corner 0 to the hit: barycentrics of corners 1 ...
        std::uint32_t primitive;
        Vec3<float> v;              ///< ... and 2
        std::uint32_t geometry;
        Vec3<float> from;           ///< corner 0
        float spare[5];
    };
    struct Quadric {
        const QuadricRecord* record;
        std::uint32_t geometry;
    };
    struct Rays;
    struct Nearest;
    class Maker;

    template <class Met>
    void forFaces(const Rays& rays, Met&& met) const;
    void tell(RayHitPacket& packet, const Rays& rays, const Nearest& nearest) const;
    static void tell(RayHitPacket& packet, const Mask<F>& met, const F& t, const F& u, const F& v, const UInt<F>& primitive,
                     const UInt<F>& geometry);
    static QuadricHit<F> meet(const Quadric& q, const Rays& rays, const F& far);

    std::vector<Vec3<float>> corners_;
    std::vector<Face> faces_;
    std::vector<Triangle> triangles_;
    std::vector<Quadric> quadrics_;
};

}  // namespace penumbra
