#include "core/geometry/face_list.h"

#include "core/math/double_vector.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace penumbra {

// ---------------------------------------------------------------------------------------------------- making

class FaceList::Maker {
public:
    explicit Maker(FaceList& list) : list_(list) {}

    /// False where there are too many faces.
    bool addMesh(const Geometry& g, const ShapeRecord& shape, std::uint32_t geometry) {
        if (shape.count > 2 * kMostFaces) return false;
        std::vector<std::array<std::uint32_t, 3>> left(shape.count);
        for (std::uint32_t i = 0; i < shape.count; ++i)
            for (int k = 0; k < 3; ++k) {
                const float* p = &g.positions[3 * std::size_t(g.indices[3 * (std::size_t(shape.first) + i) + k])];
                left[i][k] = corner({p[0], p[1], p[2]});
            }
        std::vector<bool> taken(shape.count);
        for (std::uint32_t i = 0; i < shape.count; ++i) {
            if (taken[i]) continue;
            std::uint32_t other = i + 1;
            std::optional<std::array<std::uint32_t, 4>> ring;
            for (; other < shape.count; ++other)
                if (!taken[other] && (ring = joined(left[i], left[other]))) break;
            const auto& [a, b, c] = left[i];
            addFace(ring ? *ring : std::array{a, b, c, a}, ring.has_value());
            addTriangle(left[i], i, geometry);
            if (ring) {
                addTriangle(left[other], other, geometry);
                taken[other] = true;
            }
        }
        return list_.faces_.size() <= kMostFaces && list_.corners_.size() <= kMostCorners;
    }

private:
    /// Meshes that touch share their corners, too.
    std::uint32_t corner(const Vec3<float>& p) {
        const auto same = [&](const Vec3<float>& q) { return q.x == p.x && q.y == p.y && q.z == p.z; };
        const auto at = std::find_if(list_.corners_.begin(), list_.corners_.end(), same);
        if (at == list_.corners_.end()) {
            list_.corners_.push_back(p);
            return std::uint32_t(list_.corners_.size() - 1);
        }
        return std::uint32_t(at - list_.corners_.begin());
    }
    Vec3d place(std::uint32_t corner) const { return widened(list_.corners_[corner]); }

    /// The corners around the quadrilateral of two triangles, if they make one that is flat and convex.
    std::optional<std::array<std::uint32_t, 4>> joined(const std::array<std::uint32_t, 3>& first,
                                                       const std::array<std::uint32_t, 3>& second) const {
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) {
                // From the common edge on, the two run in opposite directions.
                const std::uint32_t a = first[i], b = first[(i + 1) % 3], c = first[(i + 2) % 3], d = second[(k + 2) % 3];
                if (second[k] != a || second[(k + 1) % 3] != c) continue;
                const std::array ring{a, b, c, d};
                if (isFlatAndConvex(ring)) return ring;
            }
        return std::nullopt;
    }
    bool isFlatAndConvex(const std::array<std::uint32_t, 4>& ring) const {
        Vec3d p[4];
        double largest = 0;
        for (int i = 0; i < 4; ++i) {
            p[i] = place(ring[i]);
            largest = std::max({largest, std::abs(p[i].x), std::abs(p[i].y), std::abs(p[i].z)});
        }
        const Vec3d n = cross(p[1] - p[0], p[2] - p[0]);
        const double length = std::sqrt(dot(n, n));
        // The last corner may be off the plane of the others by its rounding, and no more.
        if (!(std::abs(dot(n, p[3] - p[0])) <= length * largest * 0x1p-23)) return false;
        for (int i = 0; i < 4; ++i)
            if (!(dot(n, cross(p[(i + 1) % 4] - p[i], p[(i + 2) % 4] - p[(i + 1) % 4])) > 1e-9 * length * length)) return false;
        return true;
    }

    /// `isPair`: its second triangle begins at corner 2 of the ring.
    void addFace(const std::array<std::uint32_t, 4>& ring, bool isPair) {
        const Vec3d from = place(ring[0]), diagonal = place(ring[2]) - from;
        const Vec3d n = cross(place(ring[1]) - from, diagonal), across = normalized(cross(diagonal, n)) * (isPair ? 1. : 0.);
        list_.faces_.push_back({ring, rounded(normalized(n)), list_.corners_[ring[0]], std::uint32_t(list_.triangles_.size()),
                                rounded(across), float(isPair ? dot(across, from) : -1), 0});
    }
    void addTriangle(const std::array<std::uint32_t, 3>& corners, std::uint32_t primitive, std::uint32_t geometry) {
        const Vec3d from = place(corners[0]), e1 = place(corners[1]) - from, e2 = place(corners[2]) - from;
        const Vec3d n = cross(e1, e2);
        const double inverse = 1 / dot(n, n);
        list_.triangles_.push_back({rounded(cross(e2, n) * inverse), primitive, rounded(cross(n, e1) * inverse), geometry,
                                    list_.corners_[corners[0]], {}});
    }

    FaceList& list_;
};

std::unique_ptr<FaceList> FaceList::make(const Geometry& g) {
    if (!g.instances.empty()) return nullptr;
    auto list = std::make_unique<FaceList>();
    Maker maker(*list);
    for (std::uint32_t i = 0; i < g.groups[0].shapeCount; ++i) {
        const ShapeRecord& shape = g.shapes[g.groups[0].firstShape + i];
        if (shape.count == 0 || shape.flags & kShapeInvisible) continue;
        if (shape.isMasked() || shape.kind == ShapeKind::Curves) return nullptr;
        if (shape.kind != ShapeKind::Mesh) list->quadrics_.push_back({&g.quadrics[shape.first], i});
        else if (!maker.addMesh(g, shape, i)) return nullptr;
        if (list->faces_.size() + 3 * list->quadrics_.size() > kMostFaces) return nullptr;
    }
    return list;
}

// ---------------------------------------------------------------------------------------------------- meeting

struct FaceList::Rays {
    Vec3<F> origin, direction;
    F near;
    Mask<F> live;

    Rays(const RayPacket& r, unsigned lanes)
        : origin{load<F>(r.originX), load<F>(r.originY), load<F>(r.originZ)},
          direction{load<F>(r.directionX), load<F>(r.directionY), load<F>(r.directionZ)},
          near(load<F>(r.near)),
          live((Lanes8u(lanes) & Lanes8u(detail::V8u{1, 2, 4, 8, 16, 32, 64, 128})) != Lanes8u(0u)) {}

    Vec3<F> from(const Vec3<float>& p) const { return broadcast<F>(p) - origin; }
};

/// Calls met(t, inside) for all faces, in order; t may be anything where not inside.
template <class Met>
void FaceList::forFaces(const Rays& rays, Met&& met) const {
    // Corners as the rays see them: across, and relative to where they are.
    F x[kMostCorners], y[kMostCorners];
    Vec3<F> right, up;
    orthonormalBasis(rays.direction, right, up);
    const std::size_t cornerCount = corners_.size();
    for (std::size_t i = 0; i < cornerCount; ++i) {
        const Vec3<F> to = rays.from(corners_[i]);
        x[i] = dot(right, to);
        y[i] = dot(up, to);
    }
    for (const Face& face : faces_) {
        const auto [a, b, c, d] = face.corners;
        // Twice the area that the ray and an edge span; the same bits from the other side, negated.
        const auto side = [&](std::uint32_t i, std::uint32_t k) { return x[i] * y[k] - x[k] * y[i]; };
        const F ab = side(a, b), bc = side(b, c), cd = side(c, d), da = side(d, a);
        const Mask<F> inside = (min(min(ab, bc), min(cd, da)) >= F(0.f)) | (max(max(ab, bc), max(cd, da)) <= F(0.f));
        const Vec3<F> normal = broadcast<F>(face.normal);
        // A ray along the plane gives inf or NaN, which no comparison passes.
        const F t = dot(normal, rays.from(face.from)) / dot(normal, rays.direction);
        met(t, inside);
    }
}

struct FaceList::Nearest {
    F t;
    UInt<F> face;
    Mask<F> met;
};

void FaceList::intersect(RayHitPacket& packet, unsigned live) const noexcept {
    const Rays rays(packet.ray, live);
    Nearest nearest{load<F>(packet.ray.far), UInt<F>(0u), Mask<F>(false)};
    UInt<F> number(0u);
    forFaces(rays, [&](F t, Mask<F> inside) {
        const Mask<F> hit = inside & (t > rays.near) & (t < nearest.t);
        nearest.t = select(hit, t, nearest.t);
        nearest.face = select(hit, number, nearest.face);
        nearest.met |= hit;
        number += UInt<F>(1u);
    });
    nearest.met &= rays.live;
    if (any(nearest.met)) tell(packet, rays, nearest);
    for (const Quadric& q : quadrics_) {
        const F far = load<F>(packet.ray.far);
        const QuadricHit<F> hit = meet(q, rays, far);
        const Mask<F> met = hit.hit & rays.live;
        if (any(met)) tell(packet, met, hit.t, F(0.f), F(0.f), UInt<F>(0u), UInt<F>(q.geometry));
    }
}

QuadricHit<Lanes8f> FaceList::meet(const Quadric& q, const Rays& rays, const F& far) {
    const Affine<F> m = loadAffine<F>(&q.record->objectFromWorld, UInt<F>(0u));
    return intersectQuadric(*q.record, m.point(rays.origin), m.vector(rays.direction), rays.near, far);
}

/// The triangle that was met, and where.
void FaceList::tell(RayHitPacket& packet, const Rays& rays, const Nearest& nearest) const {
    static_assert(sizeof(Face) == 64 && sizeof(Triangle) == 64);
    const UInt<F> face = select(nearest.met, nearest.face, UInt<F>(0u)) * UInt<F>(16u);
    const Vec3<F> along = rays.direction * nearest.t, p = rays.origin + along;
    F d[4], w[8], from[4];
    loadRows4(&faces_[0].acrossDiagonal.x, face, d);
    const UInt<F> first = gather(&faces_[0].triangle, face);
    const UInt<F> row = first + select(dot(p, Vec3<F>{d[0], d[1], d[2]}) < d[3], UInt<F>(1u), UInt<F>(0u));
    loadRows8(&triangles_[0].u.x, row * UInt<F>(16u), w);
    loadRows4(&triangles_[0].from.x, row * UInt<F>(16u), from);
    const Vec3<F> q = along - (Vec3<F>{from[0], from[1], from[2]} - rays.origin);
    // Rounding may have put the point beyond an edge.
    const F u = min(max(dot(q, Vec3<F>{w[0], w[1], w[2]}), F(0.f)), F(1.f));
    const F v = min(max(dot(q, Vec3<F>{w[4], w[5], w[6]}), F(0.f)), F(1.f) - u);
    tell(packet, nearest.met, nearest.t, u, v, floatBits(w[3]), floatBits(w[7]));
}

void FaceList::tell(RayHitPacket& packet, const Mask<F>& met, const F& t, const F& u, const F& v, const UInt<F>& primitive,
                    const UInt<F>& geometry) {
    const auto put = [&](auto* to, const auto& value) { store(to, select(met, value, load<F>(to))); };
    put(packet.ray.far, t);
    put(packet.hit.u, u);
    put(packet.hit.v, v);
    put(packet.hit.primitive, primitive);
    put(packet.hit.geometry, geometry);
    put(packet.hit.instance, UInt<F>(kNoHit));
}

void FaceList::occluded(RayPacket& packet, unsigned live) const noexcept {
    const Rays rays(packet, live);
    const F far = load<F>(packet.far);
    Mask<F> met(false);
    forFaces(rays, [&](F t, Mask<F> inside) { met |= inside & (t > rays.near) & (t < far); });
    for (const Quadric& q : quadrics_)
        met |= meet(q, rays, far).hit;
    store(packet.far, select(met & rays.live, F(-kInfinity), far));
}

}  // namespace penumbra
