// RayPacket: eight rays and their hits, in the layout that Embree's packet calls use.
//
// All traversal goes through packets of eight, replay included (one live lane there): Embree's packet results for a ray do
// not depend on its neighbours, its lane or which lanes are live, but its single-ray calls may differ in the last bits.
// A ray's direction is a unit vector, time is normalised to [0, 1] over the scene's transform times.
#pragma once

#include <cstdint>

namespace penumbra {

inline constexpr int kPacketWidth = 8;
inline constexpr std::uint32_t kNoHit = 0xFFFFFFFFu;

struct alignas(32) RayPacket {
    float originX[8], originY[8], originZ[8], near[8];
    float directionX[8], directionY[8], directionZ[8], time[8];
    float far[8];                       ///< in: the ray's end; out: distance of the hit, or -infinity where occluded
    std::uint32_t mask[8], id[8], flags[8];
};

struct alignas(32) HitPacket {
    float normalX[8], normalY[8], normalZ[8], u[8], v[8];
    std::uint32_t primitive[8], geometry[8], instance[8];   ///< kNoHit where nothing was met; instance kNoHit: none
    std::uint32_t reserved[8];                              ///< Embree 4 may have an instance-array index here
};

struct alignas(32) RayHitPacket {
    RayPacket ray;
    HitPacket hit;
};

}  // namespace penumbra
