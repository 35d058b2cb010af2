// PathBatch: the state of the paths that one thread has in flight, in arrays.
//
// Two kinds of arrays. *Slots* stand still for the life of a path: what it has gathered and who it is. *Rays* are what changes
// at every step; they live in two buffers, because shading reads one in the order of materials and packs the survivors into
// the other. A ray names its slot.
// Memory: about 160 bytes a path with both buffers; 1024 paths stay inside a second-level cache.
// Thread safety: one batch belongs to one thread.
#pragma once

#include "core/geometry/ray_packet.h"
#include "core/math/spectrum.h"
#include "core/math/vector.h"
#include "integrators/integrator.h"

namespace penumbra {

/// Room behind the last path: groups read and pack eight at a time.
inline constexpr int kBatchCapacity = kMaxBatch + 2 * kPacketWidth;

struct RayBuffer {
    using Floats = float[kBatchCapacity];
    using Words = std::uint32_t[kBatchCapacity];
    alignas(64) Floats originX, originY, originZ, directionX, directionY, directionZ;
    alignas(64) Floats throughputR, throughputG, throughputB;
    alignas(64) Floats bsdfPdf;         ///< density with which the direction was chosen; 0: emission met counts whole
    alignas(64) Floats etaScale;        ///< product of squared relative indices crossed, for roulette
    alignas(64) Floats coneWidth;       ///< of the ray's cone at its origin
    alignas(64) Words slot, depth, medium;
};

struct HitBuffer {
    alignas(64) std::uint32_t geometry[kBatchCapacity], primitive[kBatchCapacity], instance[kBatchCapacity];
    alignas(64) float u[kBatchCapacity], v[kBatchCapacity], t[kBatchCapacity];
};

struct ShadowBuffer {
    alignas(64) float originX[kBatchCapacity], originY[kBatchCapacity], originZ[kBatchCapacity];
    alignas(64) float directionX[kBatchCapacity], directionY[kBatchCapacity], directionZ[kBatchCapacity];
    alignas(64) float far[kBatchCapacity];
    alignas(64) float r[kBatchCapacity], g[kBatchCapacity], b[kBatchCapacity];   ///< what arrives if nothing is in the way
    alignas(64) std::uint32_t slot[kBatchCapacity];
};

struct SlotBuffer {
    alignas(64) float r[kBatchCapacity], g[kBatchCapacity], b[kBatchCapacity];   ///< radiance gathered
    alignas(64) float time[kBatchCapacity];
    alignas(64) float rasterX[kBatchCapacity], rasterY[kBatchCapacity];          ///< the pixel's corner
    alignas(64) float sign[kBatchCapacity];                                      ///< of the filter
    alignas(64) std::uint32_t seed[kBatchCapacity], index[kBatchCapacity];       ///< SampleAddress
    alignas(64) std::uint32_t pixel[kBatchCapacity], sample[kBatchCapacity];     ///< of the film
    alignas(64) std::uint32_t covered[kBatchCapacity];                           ///< 1: the camera ray met something
};

struct PathBatch {
    RayBuffer rays[2];
    HitBuffer hits;
    ShadowBuffer shadows;
    SlotBuffer slots;
    alignas(64) std::uint32_t key[kBatchCapacity];      ///< material of the hit, or "missed", per ray
    alignas(64) std::uint16_t order[kBatchCapacity];    ///< rays sorted by key
    int live = 0;                                       ///< rays in the current buffer
    int current = 0;                                    ///< which buffer
    int shadowCount = 0;

    RayBuffer& now() { return rays[current]; }
    RayBuffer& next() { return rays[1 - current]; }
};

/// The batch of the calling thread.
PathBatch& threadBatch();

/// What a step knows of eight rays (or one) that met materials of one kind.
template <class F>
struct RayGroup {
    Vec3<F> origin, direction;
    Spectrum<F> throughput;
    F bsdfPdf, etaScale, coneWidth, time;
    UInt<F> slot, depth, medium;
    SampleAddress<F> address;
    Mask<F> live;               ///< the other lanes are copies of a live one
    unsigned liveBits;
};

/// A ray that goes on.
template <class F>
struct NextRay {
    Vec3<F> origin, direction;
    Spectrum<F> throughput;
    F bsdfPdf, etaScale, coneWidth;
    UInt<F> slot, depth, medium;
};

/// L of the slots += value. Spare lanes copy a live lane's value and so write what it writes.
template <class F>
void addToSlot(SlotBuffer& s, const UInt<F>& slot, const Spectrum<F>& value) {
    scatter(s.r, slot, gather(s.r, slot) + value.r);
    scatter(s.g, slot, gather(s.g, slot) + value.g);
    scatter(s.b, slot, gather(s.b, slot) + value.b);
}

template <class F>
void pushRay(PathBatch& batch, int& count, const NextRay<F>& ray, unsigned keep) {
    RayBuffer& b = batch.next();
    storePacked(b.originX + count, ray.origin.x, keep);
    storePacked(b.originY + count, ray.origin.y, keep);
    storePacked(b.originZ + count, ray.origin.z, keep);
    storePacked(b.directionX + count, ray.direction.x, keep);
    storePacked(b.directionY + count, ray.direction.y, keep);
    storePacked(b.directionZ + count, ray.direction.z, keep);
    storePacked(b.throughputR + count, ray.throughput.r, keep);
    storePacked(b.throughputG + count, ray.throughput.g, keep);
    storePacked(b.throughputB + count, ray.throughput.b, keep);
    storePacked(b.bsdfPdf + count, ray.bsdfPdf, keep);
    storePacked(b.etaScale + count, ray.etaScale, keep);
    storePacked(b.coneWidth + count, ray.coneWidth, keep);
    storePacked(b.slot + count, ray.slot, keep);
    storePacked(b.depth + count, ray.depth, keep);
    storePacked(b.medium + count, ray.medium, keep);
    count += std::popcount(keep);
}

template <class F>
void pushShadow(PathBatch& batch, const Vec3<F>& origin, const Vec3<F>& direction, F far, const Spectrum<F>& value,
                const UInt<F>& slot, unsigned keep) {
    ShadowBuffer& s = batch.shadows;
    const int n = batch.shadowCount;
    storePacked(s.originX + n, origin.x, keep);
    storePacked(s.originY + n, origin.y, keep);
    storePacked(s.originZ + n, origin.z, keep);
    storePacked(s.directionX + n, direction.x, keep);
    storePacked(s.directionY + n, direction.y, keep);
    storePacked(s.directionZ + n, direction.z, keep);
    storePacked(s.far + n, far, keep);
    storePacked(s.r + n, value.r, keep);
    storePacked(s.g + n, value.g, keep);
    storePacked(s.b + n, value.b, keep);
    storePacked(s.slot + n, slot, keep);
    batch.shadowCount = n + std::popcount(keep);
}

}  // namespace penumbra
