// Geometry: everything rays can meet, in tables that both Embree and the lanes read.
//
// One array of positions and one of indices serve all meshes (Embree shares them, nothing is copied), and likewise for
// curves. A shape is a mesh, a quadric or a set of curves with a material, lights and media; geometry number s of the
// top scene is shape s. Shapes that move, and objects that are instanced, stand in groups of shapes of their own and
// are met through an instance: hit.instance names it. Shapes outside instances are in world space (meshes baked,
// quadrics by matrix).
//
// Invariants after finish(): positions and all per-vertex arrays have 16 readable bytes behind them; indices are global
// numbers of vertices or control points; immutable. Thread safety: immutable after finish().
#pragma once

#include "core/geometry/curve_set.h"
#include "core/geometry/mesh.h"
#include "core/math/affine.h"
#include "core/math/records.h"

#include <cstdint>
#include <vector>

namespace penumbra {

inline constexpr std::uint32_t kNone = 0xFFFFFFFFu;

enum class ShapeKind : std::uint32_t { Mesh, Sphere, Disk, Cylinder, Curves };

/// Bits of ShapeRecord::flags.
inline constexpr std::uint32_t kShapeFlipNormal = 1;    ///< the geometric normal is the negative of what the shape itself gives
inline constexpr std::uint32_t kShapeNeedsUv = 2;       ///< some texture of the material looks at uv
inline constexpr std::uint32_t kShapeNeedsTangent = 4;  ///< the material is anisotropic (or will be bumped): the frame's x matters
inline constexpr std::uint32_t kShapeInvisible = 8;     ///< in no acceleration structure (a light with alpha 0)
inline constexpr std::uint32_t kShapeMediumBoundary = 16;
// Of curves alone: their basis, type and CurveSet::level.
inline constexpr std::uint32_t kShapeCurveSpline = 1u << 16;    ///< uniform B-spline, else Bezier
inline constexpr std::uint32_t kShapeCurveCylinder = 1u << 17;  ///< shaded as a cylinder
inline constexpr std::uint32_t kShapeCurveRibbon = 1u << 18;    ///< with normals of its own, else facing the ray
inline constexpr std::uint32_t kShapeCurveMirrored = 1u
                                                     << 19;  ///< v runs the other way: a mirroring matrix is baked in
inline constexpr int kShapeCurveLevelShift = 20;             ///< three bits

struct alignas(64) ShapeRecord {
    ShapeKind kind = ShapeKind::Mesh;
    std::uint32_t flags = 0;
    std::uint32_t material = 0;
    std::uint32_t first = 0;               ///< mesh: first triangle; quadric: row of quadrics; curves: first piece
    std::uint32_t light = kNone;           ///< light of primitive 0
    std::uint32_t lightStride = 0;         ///< 1: every triangle its own light; 0: one light for the shape
    std::uint32_t mediumInside = kNone, mediumOutside = kNone;   ///< medium rows where kShapeMediumBoundary
    // What to add to a vertex number to get its row in normals, uvs, tangents; kNone: the mesh has none.
    std::uint32_t normalShift = kNone, uvShift = kNone, tangentShift = kNone;
    std::uint32_t count = 0;               ///< triangles, pieces of curves, or 1
    float alpha = 1;                       ///< what of a ray the shape stops (alpha_mask.h), unless a texture says it
    std::uint32_t alphaTexture = kNone;

    bool isMasked() const { return alphaTexture != kNone || !(alpha >= 1.f); }
};

/// A row of shapes for every lane, with the fields that shading reads.
template <class F>
struct ShapeLanes {
    UInt<F> kind, flags, first, light, lightStride, mediumInside, mediumOutside, normalShift, uvShift, tangentShift;

    static ShapeLanes load(const ShapeRecord* shapes, const UInt<F>& row) {
        static_assert(sizeof(ShapeRecord) == 64);
        const Records<F, ShapeRecord> r(shapes, row);
        if (r.shared()) {
            const ShapeRecord& s = r.first();
            return {UInt<F>(std::uint32_t(s.kind)), UInt<F>(s.flags), UInt<F>(s.first), UInt<F>(s.light), UInt<F>(s.lightStride),
                    UInt<F>(s.mediumInside), UInt<F>(s.mediumOutside), UInt<F>(s.normalShift), UInt<F>(s.uvShift),
                    UInt<F>(s.tangentShift)};
        }
        const float* base = reinterpret_cast<const float*>(shapes);
        F w[8], v[4];
        loadRows8(base, row * UInt<F>(16u), w);
        loadRows4(base, row * UInt<F>(16u) + UInt<F>(8u), v);
        return {floatBits(w[0]), floatBits(w[1]), floatBits(w[3]), floatBits(w[4]), floatBits(w[5]),
                floatBits(w[6]), floatBits(w[7]), floatBits(v[0]), floatBits(v[1]), floatBits(v[2])};
    }
    Mask<F> has(std::uint32_t flag) const { return (flags & UInt<F>(flag)) != UInt<F>(0u); }
};

/// A (part of a) sphere, an annulus or an open cylinder, in object space: see PBRT-v4's sphere, disk and cylinder.
struct QuadricRecord {
    AffineRecord worldFromObject, objectFromWorld;
    float radius = 1, innerRadius = 0;
    float zMin = -1, zMax = 1;             ///< disk: zMin = height
    float phiMax = kTwoPi;
    float thetaMin = 0, thetaMax = kPi;    ///< sphere: polar angles (from +z) of zMax and zMin
    ShapeKind kind = ShapeKind::Sphere;
};

/// One placed group of shapes, at top level.
struct InstanceRecord {
    std::uint32_t firstShape = 0;          ///< of its group; hit.geometry counts from here
    std::uint32_t firstMatrix = 0, segments = 0;   ///< into `matrices`: affineAt
    std::uint32_t group = 0;
};

/// A run of shapes with an acceleration structure of its own. Group 0 is the world.
struct ShapeGroup {
    std::uint32_t firstShape = 0, shapeCount = 0;
};

class Geometry {
public:
    std::vector<float> positions, normals, uvs, tangents;
    std::vector<std::uint32_t> indices;
    std::vector<float> curveVertices;         ///< 4 a control point: x, y, z, radius
    std::vector<float> curveNormals;          ///< 3 a control point, up to those of the last ribbon
    std::vector<std::uint32_t> curveIndices;  ///< 1 a piece: its first control point
    std::vector<ShapeRecord> shapes;
    std::vector<QuadricRecord> quadrics;
    std::vector<ShapeGroup> groups = std::vector<ShapeGroup>(1);   ///< never empty
    std::vector<InstanceRecord> instances;
    std::vector<AffineRecord> matrices;

    /// Appends the mesh's arrays and returns a record with kind, first, count and the shifts filled in. Takes the mesh apart.
    ShapeRecord addMesh(TriangleMesh&& mesh);
    ShapeRecord addQuadric(const QuadricRecord& q);
    /// The record with kind, first, count and the flags of basis and level. Takes the set apart.
    ShapeRecord addCurves(CurveSet&& curves);
    /// Pads the arrays. Call once, last.
    void finish();

    /// Bytes held in all tables.
    std::size_t memoryBytes() const;
};

}  // namespace penumbra
