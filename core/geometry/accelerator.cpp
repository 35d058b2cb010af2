#include "core/geometry/accelerator.h"

#include "core/base/error.h"
#include "core/geometry/quadrics.h"

#if PENUMBRA_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

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

/// Eight rays in a quadric's object space.
struct LocalRays {
    Vec3<Lanes8f> origin, direction;
    Lanes8f near, far;
    LocalRays(const RayPacket& r, const QuadricRecord& q)
        : near(load<Lanes8f>(r.near)), far(load<Lanes8f>(r.far)) {
        const Affine<Lanes8f> m = loadAffine<Lanes8f>(&q.objectFromWorld, Lanes8u(0u));
        origin = m.point({load<Lanes8f>(r.originX), load<Lanes8f>(r.originY), load<Lanes8f>(r.originZ)});
        direction = m.vector({load<Lanes8f>(r.directionX), load<Lanes8f>(r.directionY), load<Lanes8f>(r.directionZ)});
    }
};

Mask8 loadValid(const int* valid) { return Mask8(detail::V8i(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(valid)))); }

// The callbacks see the packets of the calls below, so N is 8; single rays (N = 1) are moved into lane 0 of a packet.

void intersectPacket(const QuadricRecord& q, Mask8 valid, RayHitPacket& rays, unsigned primitive, unsigned geometry, unsigned instance) {
    const LocalRays local(rays.ray, q);
    const QuadricHit<Lanes8f> hit = intersectQuadric(q, local.origin, local.direction, local.near, local.far);
    const Mask8 met = hit.hit & valid;
    if (none(met)) return;
    const auto put = [&](std::uint32_t* to, std::uint32_t value) {
        store(to, select(met, Lanes8u(value), load<Lanes8f>(to)));
    };
    store(rays.ray.far, select(met, hit.t, local.far));
    store(rays.hit.u, select(met, Lanes8f(0.f), load<Lanes8f>(rays.hit.u)));
    store(rays.hit.v, select(met, Lanes8f(0.f), load<Lanes8f>(rays.hit.v)));
    put(rays.hit.primitive, primitive);
    put(rays.hit.geometry, geometry);
    put(rays.hit.instance, instance);
}

void onIntersect(const RTCIntersectFunctionNArguments* a) {
    const auto& q = *static_cast<const QuadricRecord*>(a->geometryUserPtr);
    const unsigned instance = a->context->instID[0];
    if (a->N == 8) {
        intersectPacket(q, loadValid(a->valid), *reinterpret_cast<RayHitPacket*>(a->rayhit), a->primID, a->geomID, instance);
        return;
    }
    RTCRayN* ray = RTCRayHitN_RayN(a->rayhit, a->N);
    RTCHitN* out = RTCRayHitN_HitN(a->rayhit, a->N);
    for (unsigned i = 0; i < a->N; ++i) {
        if (!a->valid[i]) continue;
        const Affine<float> m = loadAffine<float>(&q.objectFromWorld, 0u);
        const auto hit = intersectQuadric<float>(
            q, m.point({RTCRayN_org_x(ray, a->N, i), RTCRayN_org_y(ray, a->N, i), RTCRayN_org_z(ray, a->N, i)}),
            m.vector({RTCRayN_dir_x(ray, a->N, i), RTCRayN_dir_y(ray, a->N, i), RTCRayN_dir_z(ray, a->N, i)}),
            RTCRayN_tnear(ray, a->N, i), RTCRayN_tfar(ray, a->N, i));
        if (!hit.hit) continue;
        RTCRayN_tfar(ray, a->N, i) = hit.t;
        RTCHitN_u(out, a->N, i) = RTCHitN_v(out, a->N, i) = 0.f;
        RTCHitN_primID(out, a->N, i) = a->primID;
        RTCHitN_geomID(out, a->N, i) = a->geomID;
        RTCHitN_instID(out, a->N, i, 0) = instance;
    }
}

void onOccluded(const RTCOccludedFunctionNArguments* a) {
    const auto& q = *static_cast<const QuadricRecord*>(a->geometryUserPtr);
    if (a->N == 8) {
        auto& ray = *reinterpret_cast<RayPacket*>(a->ray);
        const LocalRays local(ray, q);
        const auto hit = intersectQuadric(q, local.origin, local.direction, local.near, local.far);
        store(ray.far, select(hit.hit & loadValid(a->valid), Lanes8f(-kInfinity), local.far));
        return;
    }
    for (unsigned i = 0; i < a->N; ++i) {
        if (!a->valid[i]) continue;
        const Affine<float> m = loadAffine<float>(&q.objectFromWorld, 0u);
        const auto hit = intersectQuadric<float>(
            q, m.point({RTCRayN_org_x(a->ray, a->N, i), RTCRayN_org_y(a->ray, a->N, i), RTCRayN_org_z(a->ray, a->N, i)}),
            m.vector({RTCRayN_dir_x(a->ray, a->N, i), RTCRayN_dir_y(a->ray, a->N, i), RTCRayN_dir_z(a->ray, a->N, i)}),
            RTCRayN_tnear(a->ray, a->N, i), RTCRayN_tfar(a->ray, a->N, i));
        if (hit.hit) RTCRayN_tfar(a->ray, a->N, i) = -kInfinity;
    }
}

/// Bounds of the whole sphere, disk or cylinder, a little widened for rounding.
void onBounds(const RTCBoundsFunctionArguments* a) {
    const auto& q = *static_cast<const QuadricRecord*>(a->geometryUserPtr);
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

}  // namespace

struct Accelerator::State {
    RTCDevice device = nullptr;
    std::vector<RTCScene> scenes;   // one a group; 0 is the world
    std::uint32_t firstInstance = 0;
    bool hasInstances = false;

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

    void attachMesh(RTCScene scene, const Geometry& g, const ShapeRecord& shape, unsigned id) {
        RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, g.positions.data(), 0, 12, g.positions.size() / 3);
        rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, g.indices.data(), std::size_t(shape.first) * 12, 12,
                                   shape.count);
        attach(scene, mesh, id);
    }
    void attachQuadric(RTCScene scene, const Geometry& g, const ShapeRecord& shape, unsigned id) {
        RTCGeometry user = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(user, 1);
        rtcSetGeometryUserData(user, const_cast<QuadricRecord*>(&g.quadrics[shape.first]));
        rtcSetGeometryBoundsFunction(user, onBounds, nullptr);
        rtcSetGeometryIntersectFunction(user, onIntersect);
        rtcSetGeometryOccludedFunction(user, onOccluded);
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

    void buildGroup(const Geometry& g, std::size_t group, IntersectionMode mode) {
        RTCScene scene = rtcNewScene(device);
        scenes[group] = scene;
        rtcSetSceneFlags(scene, mode == IntersectionMode::Robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
        const ShapeGroup& range = g.groups[group];
        for (unsigned i = 0; i < range.shapeCount; ++i) {
            const ShapeRecord& shape = g.shapes[range.firstShape + i];
            if (shape.count == 0 || shape.flags & kShapeInvisible) continue;
            if (shape.kind == ShapeKind::Mesh) attachMesh(scene, g, shape, i);
            else attachQuadric(scene, g, shape, i);
        }
        if (group == 0)
            for (unsigned i = 0; i < g.instances.size(); ++i) attachInstance(scene, g, g.instances[i], range.shapeCount + i);
        check("reading the shapes");
        rtcCommitScene(scene);
        check("building");
    }

private:
    void attach(RTCScene scene, RTCGeometry geometry, unsigned id) {
        rtcSetGeometryMask(geometry, kVisibleToAll);
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, id);
        rtcReleaseGeometry(geometry);
    }
};

Accelerator::Accelerator(const Geometry& geometry, IntersectionMode mode) : state_(std::make_unique<State>()) {
    // The same code on every machine, so that every machine gives the same bits. No "threads=": that would cap TBB.
    state_->device = rtcNewDevice("isa=avx2");
    if (!state_->device) throw Error(ErrorKind::Internal, "Embree gives no device");
    state_->firstInstance = geometry.groups[0].shapeCount;
    state_->hasInstances = !geometry.instances.empty();
    state_->scenes.resize(geometry.groups.size());
    for (std::size_t i = geometry.groups.size(); i-- > 0;) state_->buildGroup(geometry, i, mode);   // the world last: it refers to the others
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
    const LiveLanes lanes(live);
    trace(state_->scenes[0], lanes.valid, rays, coherence);
    if (!state_->hasInstances) return;
    // Embree names the instance by its geometry number in the world; ours count from the first instance.
    const Lanes8u id = load<Lanes8f>(rays.hit.instance);
    store(rays.hit.instance, select(id == Lanes8u(kNoHit), id, id - Lanes8u(state_->firstInstance)));
}

void Accelerator::occluded(RayPacket& rays, unsigned live) const noexcept {
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
