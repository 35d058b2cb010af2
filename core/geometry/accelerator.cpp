#include "core/geometry/accelerator.h"

#include "core/base/error.h"
#include "core/geometry/alpha_mask.h"
#include "core/geometry/face_list.h"
#include "core/geometry/quadrics.h"

#if PENUMBRA_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <bit>
#include <cstddef>

namespace penumbra {

static_assert(sizeof(RayPacket) == sizeof(RTCRay8) && offsetof(RayPacket, far) == offsetof(RTCRay8, tfar));
static_assert(sizeof(HitPacket) >= sizeof(RTCHit8) && offsetof(HitPacket, instance) == offsetof(RTCHit8, instID));
static_assert(offsetof(RayHitPacket, hit) == offsetof(RTCRayHit8, hit));

namespace {

constexpr std::uint32_t kVisibleToAll = 0xFFFFFFFFu;

/// Embree's "valid" array of a bit mask.
struct LiveLanes {
    alignas(32) int valid[8];
    explicit LiveLanes(unsigned live) {
        const detail::V8i bit = {1, 2, 4, 8, 16, 32, 64, 128};
        const detail::V8i set = ((detail::V8i{} + int(live)) & bit) == bit;
        _mm256_store_si256(reinterpret_cast<__m256i*>(valid), __m256i(set));
    }
};

Mask8 loadValid(const int* valid) { return Mask8(detail::V8i(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(valid)))); }

/// Rays in the space of a group, as callbacks see them.
template <class F>
struct TracedRays {
    GroupRay<F> ray;
    F near, far;
};

TracedRays<Lanes8f> raysOf(const RayPacket& r) {
    return {{{load<Lanes8f>(r.originX), load<Lanes8f>(r.originY), load<Lanes8f>(r.originZ)},
             {load<Lanes8f>(r.directionX), load<Lanes8f>(r.directionY), load<Lanes8f>(r.directionZ)},
             load<Lanes8f>(r.time)},
            load<Lanes8f>(r.near),
            load<Lanes8f>(r.far)};
}
TracedRays<float> rayOf(RTCRayN* r, unsigned n, unsigned i) {
    return {{{RTCRayN_org_x(r, n, i), RTCRayN_org_y(r, n, i), RTCRayN_org_z(r, n, i)},
             {RTCRayN_dir_x(r, n, i), RTCRayN_dir_y(r, n, i), RTCRayN_dir_z(r, n, i)},
             RTCRayN_time(r, n, i)},
            RTCRayN_tnear(r, n, i),
            RTCRayN_tfar(r, n, i)};
}

template <class F, class IsThere = NoHoles>
QuadricHit<F> meetQuadric(const QuadricRecord& q, const TracedRays<F>& r, const IsThere& isThere = {}) {
    const Affine<F> m = loadAffine<F>(&q.objectFromWorld, UInt<F>(0u));
    return intersectQuadric(q, m.point(r.ray.origin), m.vector(r.ray.direction), r.near, r.far, isThere);
}

/// What the user pointer of a shape with holes leads to.
struct MaskedShape {
    AlphaMask mask;
    std::uint32_t firstInstance;

    /// The row of the instance that a callback's context names.
    std::uint32_t instanceRow(std::uint32_t embreeId) const { return embreeId == kNoHit ? kNone : embreeId - firstInstance; }
};

// The two kinds of quadrics, made of the user pointer and of the instance that a callback comes from.

struct WholeQuadric {
    const QuadricRecord& record;
    WholeQuadric(const void* user, std::uint32_t) : record(*static_cast<const QuadricRecord*>(user)) {}
    template <class F>
    QuadricHit<F> meet(const TracedRays<F>& r) const { return meetQuadric(record, r); }
};

struct MaskedQuadric {
    const AlphaMask& mask;
    const QuadricRecord& record;
    std::uint32_t instance;
    MaskedQuadric(const void* user, std::uint32_t embreeId)
        : mask(static_cast<const MaskedShape*>(user)->mask),
          record(mask.quadric()),
          instance(static_cast<const MaskedShape*>(user)->instanceRow(embreeId)) {}
    template <class F>
    QuadricHit<F> meet(const TracedRays<F>& r) const {
        return meetQuadric(record, r, [&](const F& t, bool farSide) { return mask.meetsQuadric(r.ray, t, instance, farSide); });
    }
};

// The callbacks see the packets of the calls below, so N is 8; single rays (N = 1) come one by one.

void store(RayHitPacket& rays, const Mask8& met, const Lanes8f& t, unsigned primitive, unsigned geometry, unsigned instance) {
    const auto put = [&](std::uint32_t* to, std::uint32_t value) {
        store(to, select(met, Lanes8u(value), load<Lanes8f>(to)));
    };
    store(rays.ray.far, select(met, t, load<Lanes8f>(rays.ray.far)));
    store(rays.hit.u, select(met, Lanes8f(0.f), load<Lanes8f>(rays.hit.u)));
    store(rays.hit.v, select(met, Lanes8f(0.f), load<Lanes8f>(rays.hit.v)));
    put(rays.hit.primitive, primitive);
    put(rays.hit.geometry, geometry);
    put(rays.hit.instance, instance);
}

template <class Quadric>
void onIntersect(const RTCIntersectFunctionNArguments* a) {
    const unsigned instance = a->context->instID[0];
    const Quadric quadric(a->geometryUserPtr, instance);
    if (a->N == 8) {
        auto& rays = *reinterpret_cast<RayHitPacket*>(a->rayhit);
        const auto hit = quadric.meet(raysOf(rays.ray));
        const Mask8 met = hit.hit & loadValid(a->valid);
        if (any(met)) store(rays, met, hit.t, a->primID, a->geomID, instance);
        return;
    }
    RTCRayN* ray = RTCRayHitN_RayN(a->rayhit, a->N);
    RTCHitN* out = RTCRayHitN_HitN(a->rayhit, a->N);
    for (unsigned i = 0; i < a->N; ++i) {
        if (!a->valid[i]) continue;
        const auto hit = quadric.meet(rayOf(ray, a->N, i));
        if (!hit.hit) continue;
        RTCRayN_tfar(ray, a->N, i) = hit.t;
        RTCHitN_u(out, a->N, i) = RTCHitN_v(out, a->N, i) = 0.f;
        RTCHitN_primID(out, a->N, i) = a->primID;
        RTCHitN_geomID(out, a->N, i) = a->geomID;
        RTCHitN_instID(out, a->N, i, 0) = instance;
    }
}

template <class Quadric>
void onOccluded(const RTCOccludedFunctionNArguments* a) {
    const Quadric quadric(a->geometryUserPtr, a->context->instID[0]);
    if (a->N == 8) {
        auto& ray = *reinterpret_cast<RayPacket*>(a->ray);
        const TracedRays<Lanes8f> rays = raysOf(ray);
        store(ray.far, select(quadric.meet(rays).hit & loadValid(a->valid), Lanes8f(-kInfinity), rays.far));
        return;
    }
    for (unsigned i = 0; i < a->N; ++i)
        if (a->valid[i] && quadric.meet(rayOf(a->ray, a->N, i)).hit) RTCRayN_tfar(a->ray, a->N, i) = -kInfinity;
}

/// Bounds of the whole sphere, disk or cylinder, a little widened for rounding.
template <class Quadric>
void onBounds(const RTCBoundsFunctionArguments* a) {
    const QuadricRecord& q = Quadric(a->geometryUserPtr, kNoHit).record;
    // A disk or cylinder is a circle that is shifted along its axis, a sphere a circle that turns.
    const bool sphere = q.kind == ShapeKind::Sphere;
    const float middle = sphere ? 0.f : 0.5f * (q.zMin + q.zMax), half = sphere ? 0.f : 0.5f * (q.zMax - q.zMin);
    float lower[3], upper[3];
    for (int i = 0; i < 3; ++i) {
        const float* row = q.worldFromObject.m + 4 * i;
        const float rx = row[0] * q.radius, ry = row[1] * q.radius;
        const float rz = sphere ? row[2] * q.radius : 0.f;
        const float centre = row[3] + row[2] * middle;
        const float reach = sqrt(rx * rx + ry * ry + rz * rz) + abs(row[2]) * half;
        const float slack = (abs(centre) + reach + abs(row[3])) * 1e-6f;
        lower[i] = centre - reach - slack;
        upper[i] = centre + reach + slack;
    }
    RTCBounds& b = *a->bounds_o;
    b.lower_x = lower[0], b.lower_y = lower[1], b.lower_z = lower[2];
    b.upper_x = upper[0], b.upper_y = upper[1], b.upper_z = upper[2];
}

/// Called where a ray may meet a triangle or a piece of a curve with holes; Embree has put the distance into the ray.
/// More often than not one lane alone is valid.
template <bool kCurve>
void onMasked(const RTCFilterFunctionNArguments* a) {
    const auto& shape = *static_cast<const MaskedShape*>(a->geometryUserPtr);
    const std::uint32_t instance = shape.instanceRow(a->context->instID[0]);
    const auto meets = [&](const auto& ray, const auto& t, const auto& primitive, const auto& uv) {
        if constexpr (kCurve)
            return shape.mask.meetsCurve(ray, t, instance, primitive, uv);
        else
            return shape.mask.meetsTriangle(ray, t, instance, primitive, uv);
    };
    if (a->N == 8) {
        const Mask8 valid = loadValid(a->valid);
        if (std::popcount(bits(valid)) > 1) {
            const TracedRays<Lanes8f> rays = raysOf(*reinterpret_cast<const RayPacket*>(a->ray));
            const auto& hit = *reinterpret_cast<const HitPacket*>(a->hit);
            const Lanes8f zero(0.f);
            const Vec2<Lanes8f> at = {select(valid, load<Lanes8f>(hit.u), zero), select(valid, load<Lanes8f>(hit.v), zero)};
            const Lanes8u primitive = select(valid, load<Lanes8f>(hit.primitive), Lanes8u(0u));
            const Mask8 met = valid & meets(rays.ray, rays.far, primitive, at);
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(a->valid), __m256i(met.v));
            return;
        }
    }
    for (unsigned i = 0; i < a->N; ++i) {
        if (!a->valid[i]) continue;
        const TracedRays<float> r = rayOf(a->ray, a->N, i);
        const Vec2<float> at = {RTCHitN_u(a->hit, a->N, i), RTCHitN_v(a->hit, a->N, i)};
        const std::uint32_t primitive = RTCHitN_primID(a->hit, a->N, i);
        a->valid[i] = meets(r.ray, r.far, primitive, at) ? -1 : 0;
    }
}

}  // namespace

struct Accelerator::State {
    RTCDevice device = nullptr;
    std::vector<RTCScene> scenes;   // one a group; 0 is the world
    std::vector<MaskedShape> masks;   // of shapes with holes; Embree holds pointers to them
    std::uint32_t firstInstance = 0;
    bool hasInstances = false;
    std::unique_ptr<FaceList> faces;   // in place of Embree for the packets of a small scene

    ~State() {
        for (RTCScene s : scenes) rtcReleaseScene(s);
        if (device) rtcReleaseDevice(device);
    }

    void check(const char* what) const {
        const RTCError error = rtcGetDeviceError(device);
        if (error == RTC_ERROR_NONE) return;
        if (error == RTC_ERROR_OUT_OF_MEMORY)
            throw Error(ErrorKind::OutOfMemory, "not enough memory for the acceleration structure of the scene");
        throw Error(ErrorKind::Internal, std::string("Embree failed while ") + what + " (error " + std::to_string(int(error)) + ")");
    }

    /// REQUIRES: masks has room, for Embree keeps the pointer. `row`: of the shapes.
    MaskedShape* addMask(const Geometry& g, std::uint32_t row, const Textures* textures) {
        masks.push_back({AlphaMask(g, row, textures), firstInstance});
        return &masks.back();
    }
    /// `mask`: null where the shape has no holes, here and below.
    void attachMesh(RTCScene scene, const Geometry& g, const ShapeRecord& shape, MaskedShape* mask, unsigned id) {
        RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, g.positions.data(), 0, 12, g.positions.size() / 3);
        rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, g.indices.data(), std::size_t(shape.first) * 12, 12,
                                   shape.count);
        if (mask) setFilter<false>(mesh, mask);
        attach(scene, mesh, id);
    }
    void attachCurves(RTCScene scene, const Geometry& g, const ShapeRecord& shape, MaskedShape* mask, unsigned id) {
        const bool ribbon = shape.flags & kShapeCurveRibbon, spline = shape.flags & kShapeCurveSpline;
        RTCGeometry curves = rtcNewGeometry(device, ribbon   ? RTC_GEOMETRY_TYPE_NORMAL_ORIENTED_BEZIER_CURVE
                                                    : spline ? RTC_GEOMETRY_TYPE_FLAT_BSPLINE_CURVE
                                                             : RTC_GEOMETRY_TYPE_FLAT_BEZIER_CURVE);
        rtcSetSharedGeometryBuffer(curves, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, g.curveVertices.data(), 0, 16,
                                   g.curveVertices.size() / 4);
        rtcSetSharedGeometryBuffer(curves, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, g.curveIndices.data(),
                                   std::size_t(shape.first) * 4, 4, shape.count);
        // Control points behind the last ribbon have no normals; nor does a ribbon's index lead there.
        if (ribbon)
            rtcSetSharedGeometryBuffer(curves, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3, g.curveNormals.data(), 0,
                                       12, g.curveNormals.size() / 3);
        rtcSetGeometryTessellationRate(curves, kCurveQuads);
        if (mask) setFilter<true>(curves, mask);
        attach(scene, curves, id);
    }
    void attachQuadric(RTCScene scene, const Geometry& g, const ShapeRecord& shape, MaskedShape* mask, unsigned id) {
        RTCGeometry user = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(user, 1);
        if (mask) setQuadric<MaskedQuadric>(user, mask);
        else setQuadric<WholeQuadric>(user, const_cast<QuadricRecord*>(&g.quadrics[shape.first]));
        attach(scene, user, id);
    }
    void attachInstance(RTCScene scene, const Geometry& g, const InstanceRecord& record, unsigned id) {
        RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, scenes[record.group]);
        rtcSetGeometryTimeStepCount(instance, record.segments + 1);
        for (unsigned i = 0; i <= record.segments; ++i)
            rtcSetGeometryTransform(instance, i, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, g.matrices[record.firstMatrix + i].m);
        attach(scene, instance, id);
    }

    void buildGroup(const Geometry& g, std::size_t group, IntersectionMode mode, const Textures* textures) {
        RTCScene scene = rtcNewScene(device);
        scenes[group] = scene;
        rtcSetSceneFlags(scene, mode == IntersectionMode::Fast ? RTC_SCENE_FLAG_NONE : RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
        const ShapeGroup& range = g.groups[group];
        for (unsigned i = 0; i < range.shapeCount; ++i) {
            const ShapeRecord& shape = g.shapes[range.firstShape + i];
            if (shape.count == 0 || shape.flags & kShapeInvisible) continue;
            MaskedShape* mask = shape.isMasked() ? addMask(g, range.firstShape + i, textures) : nullptr;
            if (shape.kind == ShapeKind::Mesh) attachMesh(scene, g, shape, mask, i);
            else if (shape.kind == ShapeKind::Curves) attachCurves(scene, g, shape, mask, i);
            else attachQuadric(scene, g, shape, mask, i);
        }
        if (group == 0)
            for (unsigned i = 0; i < g.instances.size(); ++i) attachInstance(scene, g, g.instances[i], range.shapeCount + i);
        check("reading the shapes");
        rtcCommitScene(scene);
        check("building");
    }

private:
    template <bool kCurve>
    static void setFilter(RTCGeometry geometry, MaskedShape* mask) {
        rtcSetGeometryUserData(geometry, mask);
        rtcSetGeometryIntersectFilterFunction(geometry, onMasked<kCurve>);
        rtcSetGeometryOccludedFilterFunction(geometry, onMasked<kCurve>);
    }
    template <class Quadric>
    static void setQuadric(RTCGeometry user, void* data) {
        rtcSetGeometryUserData(user, data);
        rtcSetGeometryBoundsFunction(user, onBounds<Quadric>, nullptr);
        rtcSetGeometryIntersectFunction(user, onIntersect<Quadric>);
        rtcSetGeometryOccludedFunction(user, onOccluded<Quadric>);
    }
    void attach(RTCScene scene, RTCGeometry geometry, unsigned id) {
        rtcSetGeometryMask(geometry, kVisibleToAll);
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, id);
        rtcReleaseGeometry(geometry);
    }
};

Accelerator::Accelerator(const Geometry& geometry, IntersectionMode mode, const Textures* textures)
    : state_(std::make_unique<State>()) {
    // The same code on every machine, so that every machine gives the same bits. No "threads=": that would cap TBB.
    state_->device = rtcNewDevice("isa=avx2");
    if (!state_->device) throw Error(ErrorKind::Internal, "Embree gives no device");
    state_->firstInstance = geometry.groups[0].shapeCount;
    state_->hasInstances = !geometry.instances.empty();
    state_->scenes.resize(geometry.groups.size());
    const auto masked = std::count_if(geometry.shapes.begin(), geometry.shapes.end(), [](const ShapeRecord& s) { return s.isMasked(); });
    state_->masks.reserve(std::size_t(masked));
    if (mode == IntersectionMode::Robust) state_->faces = FaceList::make(geometry);
    for (std::size_t i = geometry.groups.size(); i-- > 0;) state_->buildGroup(geometry, i, mode, textures);   // the world last: it refers to the others
}
Accelerator::Accelerator() = default;
Accelerator::~Accelerator() = default;
Accelerator::Accelerator(Accelerator&&) noexcept = default;
Accelerator& Accelerator::operator=(Accelerator&&) noexcept = default;

namespace {

#if PENUMBRA_EMBREE_MAJOR >= 4
void trace(RTCScene scene, const int* valid, RayHitPacket& rays, Coherence coherence) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    if (coherence == Coherence::Coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect8(valid, scene, reinterpret_cast<RTCRayHit8*>(&rays), &arguments);
}
void trace(RTCScene scene, const int* valid, RayPacket& rays) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    rtcOccluded8(valid, scene, reinterpret_cast<RTCRay8*>(&rays), &arguments);
}
void traceOne(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, nullptr); }
void traceOne(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, nullptr); }
#else
void trace(RTCScene scene, const int* valid, RayHitPacket& rays, Coherence coherence) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (coherence == Coherence::Coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &context, reinterpret_cast<RTCRayHit8*>(&rays));
}
void trace(RTCScene scene, const int* valid, RayPacket& rays) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded8(valid, scene, &context, reinterpret_cast<RTCRay8*>(&rays));
}
void traceOne(RTCScene scene, RTCRayHit& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &ray);
}
void traceOne(RTCScene scene, RTCRay& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
}
#endif

RTCRay singleRay(const RayPacket& r, int i) {
    RTCRay ray;
    ray.org_x = r.originX[i], ray.org_y = r.originY[i], ray.org_z = r.originZ[i], ray.tnear = r.near[i];
    ray.dir_x = r.directionX[i], ray.dir_y = r.directionY[i], ray.dir_z = r.directionZ[i], ray.time = r.time[i];
    ray.tfar = r.far[i], ray.mask = r.mask[i], ray.id = r.id[i], ray.flags = r.flags[i];
    return ray;
}

}  // namespace

void Accelerator::intersect(RayHitPacket& rays, unsigned live, Coherence coherence) const noexcept {
    if (state_->faces) return state_->faces->intersect(rays, live);
    const LiveLanes lanes(live);
    trace(state_->scenes[0], lanes.valid, rays, coherence);
    if (!state_->hasInstances) return;
    // Embree names the instance by its geometry number in the world; ours count from the first instance.
    const Lanes8u id = load<Lanes8f>(rays.hit.instance);
    store(rays.hit.instance, select(id == Lanes8u(kNoHit), id, id - Lanes8u(state_->firstInstance)));
}

void Accelerator::occluded(RayPacket& rays, unsigned live) const noexcept {
    if (state_->faces) return state_->faces->occluded(rays, live);
    const LiveLanes lanes(live);
    trace(state_->scenes[0], lanes.valid, rays);
}

void Accelerator::intersectSingly(RayHitPacket& rays, unsigned live) const noexcept {
    for (int i = 0; i < 8; ++i) {
        if (!(live >> i & 1u)) continue;
        RTCRayHit r;
        r.ray = singleRay(rays.ray, i);
        r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        traceOne(state_->scenes[0], r);
        rays.ray.far[i] = r.ray.tfar;
        rays.hit.geometry[i] = r.hit.geomID;
        rays.hit.primitive[i] = r.hit.primID;
    }
}

void Accelerator::occludedSingly(RayPacket& rays, unsigned live) const noexcept {
    for (int i = 0; i < 8; ++i) {
        if (!(live >> i & 1u)) continue;
        RTCRay r = singleRay(rays, i);
        traceOne(state_->scenes[0], r);
        rays.far[i] = r.tfar;
    }
}

bool Accelerator::hasFaceList() const { return state_->faces != nullptr; }

SceneBounds Accelerator::bounds() const {
    RTCBounds b;
    rtcGetSceneBounds(state_->scenes[0], &b);
    return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

std::string Accelerator::libraryVersion() {
    RTCDevice device = rtcNewDevice("isa=avx2");
    const auto version = [&](RTCDeviceProperty p) { return std::to_string(rtcGetDeviceProperty(device, p)); };
    const std::string text = "Embree " + version(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." + version(RTC_DEVICE_PROPERTY_VERSION_MINOR) +
                             "." + version(RTC_DEVICE_PROPERTY_VERSION_PATCH);
    rtcReleaseDevice(device);
    return text;
}

}  // namespace penumbra
