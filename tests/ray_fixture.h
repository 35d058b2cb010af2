// What the tests of tracing share: rays in packets and what is answered of them.
#pragma once

#include "core/geometry/accelerator.h"
#include "tests/geometry_fixture.h"

#include <array>
#include <vector>

namespace penumbra::test {

struct Ray {
    Vec3<float> origin, direction;
    float far, time;
};

inline void put(RayPacket& p, int i, const Ray& r) {
    p.originX[i] = r.origin.x, p.originY[i] = r.origin.y, p.originZ[i] = r.origin.z;
    p.directionX[i] = r.direction.x, p.directionY[i] = r.direction.y, p.directionZ[i] = r.direction.z;
    p.near[i] = 0;
    p.far[i] = r.far;
    p.time[i] = r.time;
    p.mask[i] = 0xFFFFFFFFu;
    p.id[i] = p.flags[i] = 0;
}

/// What the accelerator says of a ray, as bits: t, u, v and the three numbers. (The normal is Embree's own affair.)
using Answer = std::array<std::uint32_t, 6>;

inline Answer answerOf(const RayHitPacket& p, int i) {
    const bool met = p.hit.geometry[i] != kNoHit;
    return {floatBits(p.ray.far[i]),
            met ? floatBits(p.hit.u[i]) : 0,
            met ? floatBits(p.hit.v[i]) : 0,
            met ? p.hit.primitive[i] : 0,
            p.hit.geometry[i],
            p.hit.instance[i]};
}

inline RayHitPacket emptyPacket() {
    RayHitPacket p{};
    for (int i = 0; i < 8; ++i)
        p.hit.geometry[i] = p.hit.instance[i] = kNoHit;
    return p;
}

inline Answer alone(const Accelerator& accelerator, const Ray& r, Coherence coherence = Coherence::Incoherent) {
    RayHitPacket p = emptyPacket();
    put(p.ray, 0, r);
    accelerator.intersect(p, 1, coherence);
    return answerOf(p, 0);
}

inline bool occludedAlone(const Accelerator& accelerator, const Ray& r) {
    RayPacket p{};
    put(p, 0, r);
    accelerator.occluded(p, 1);
    return p.far[0] < 0;
}

inline std::vector<Ray> randomRays(Random& random, std::size_t count) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3d from = random.inCube(4), to = random.inCube(1.5);
        const Vec3<float> o = rounded(from);
        rays.push_back({o, normalize(rounded(to) - o), i % 3 ? kInfinity : float(6 * random()), float(random())});
    }
    return rays;
}

}  // namespace penumbra::test
