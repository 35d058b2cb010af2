// PathBatch: the state of the paths that one thread has in flight, in arrays.
//
// Two kinds of arrays. *Slots* stand still for the life of a path: what it has gathered and who it is. *Rays* are what changes
// at every step; they live in two buffers, because shading reads one in the order of materials and packs the survivors into
// the other. A ray names its slot.
// Memory: about 260 bytes a path with both buffers; 1024 paths stay inside a second-level cache of half a megabyte.
// Thread safety: one batch belongs to one thread.
#pragma once

#include "core/geometry/ray_packet.h"
#include "core/math/spectrum.h"
#include "core/math/vector.h"
#include "integrators/integrator.h"

namespace penumbra {

/// Room behind the last path: groups read and pack eight at a time.
inline constexpr int kBatchCapacity = kMaxBatch + 2 * kPacketWidth;

/// Records in rows, so that a group gathers them by row loads and a transpose (lanes.h), which beats a gather for each field.
struct RayBuffer {
    static constexpr std::uint32_t kStride = 16;
    /// origin, cone width, direction, slot | throughput, bsdf pdf, eta scale, depth, medium, first light
    alignas(64) float rows[kBatchCapacity][kStride];
};
struct HitBuffer {
    static constexpr std::uint32_t kStride = 8;
    /// shape, primitive, instance, u, v, t
    alignas(64) float rows[kBatchCapacity][kStride];
};
struct ShadowBuffer {
    static constexpr std::uint32_t kStride = 8;
    /// origin, far, direction, slot
    alignas(64) float rows[kBatchCapacity][kStride];
    alignas(64) float r[kBatchCapacity], g[kBatchCapacity], b[kBatchCapacity];   ///< what arrives if nothing is in the way
};

struct SlotBuffer {
    static constexpr std::uint32_t kStride = 8;
    /// radiance gathered (3), -, SampleAddress (2), time, -
    alignas(64) float rows[kBatchCapacity][kStride];
    alignas(64) float rasterX[kBatchCapacity], rasterY[kBatchCapacity];          ///< the pixel's corner
    alignas(64) float sign[kBatchCapacity];                                      ///< of the filter
    alignas(64) std::uint32_t pixel[kBatchCapacity], sample[kBatchCapacity];     ///< of the film
    alignas(64) std::uint32_t covered[kBatchCapacity];                           ///< 1: the camera ray met something
    alignas(64) std::uint32_t normal[kBatchCapacity];                            ///< packed, of the last scattering; where lights are picked by place
};

/// When the slots' camera rays left, as CameraRay has it.
template <class F>
F timeOf(const SlotBuffer& s, const UInt<F>& slot) {
    return gather(s.rows[0] + 6, slot * UInt<F>(SlotBuffer::kStride));
}

struct PathBatch {
    RayBuffer rays[2];
    HitBuffer hits;
    ShadowBuffer shadows;
    SlotBuffer slots;
    alignas(64) std::uint32_t key[kBatchCapacity];      ///< per ray: material of the hit, or "missed"
    alignas(64) std::uint16_t order[kBatchCapacity];    ///< rays sorted by key
    int live = 0;                                       ///< rays in the current buffer
    int current = 0;                                    ///< which buffer
    int shadowCount = 0;

    RayBuffer& now() { return rays[current]; }
    RayBuffer& next() { return rays[1 - current]; }
};

/// The batch of the calling thread.
PathBatch& threadBatch();

/// What changes from step to step along a path.
template <class F>
struct PathRay {
    Vec3<F> origin, direction;
    Spectrum<F> throughput;
    F bsdfPdf;                  ///< density with which the direction was chosen; 0: emission met counts whole
    F etaScale;                 ///< for roulette: product of squared relative indices crossed, over the weight of the camera ray
    F coneWidth;                ///< of the ray's cone at its origin
    UInt<F> slot, depth;        ///< depth: scattering events so far
    UInt<F> medium;
    F firstLight;               ///< brightness of what the first hit sent to the camera, for roulette

    void load(const RayBuffer& buffer, const UInt<F>& at) {
        F a[8], b[8];
        loadRows8(buffer.rows[0], at * UInt<F>(RayBuffer::kStride), a);
        loadRows8(buffer.rows[0], at * UInt<F>(RayBuffer::kStride) + UInt<F>(8u), b);
        origin = {a[0], a[1], a[2]};
        coneWidth = a[3];
        direction = {a[4], a[5], a[6]};
        slot = floatBits(a[7]);
        throughput = {b[0], b[1], b[2]};
        bsdfPdf = b[3];
        etaScale = b[4];
        depth = floatBits(b[5]);
        medium = floatBits(b[6]);
        firstLight = b[7];
    }
    /// The lanes of `keep`, packed from row `at` on.
    void store(RayBuffer& buffer, int at, unsigned keep) const {
        const F a[8] = {origin.x, origin.y, origin.z, coneWidth, direction.x, direction.y, direction.z, floatFromBits(slot)};
        const F b[8] = {throughput.r, throughput.g, throughput.b, bsdfPdf, etaScale, floatFromBits(depth), floatFromBits(medium), firstLight};
        storeRows8(buffer.rows[at], RayBuffer::kStride, a, keep);
        storeRows8(buffer.rows[at] + 8, RayBuffer::kStride, b, keep);
    }
};

/// What a step knows of eight rays (or one) that met materials of one kind.
template <class F>
struct RayGroup : PathRay<F> {
    Spectrum<F> gathered;       ///< by the paths so far, as their slots have it
    F time;
    SampleAddress<F> address;
    Mask<F> live;               ///< the other lanes are copies of a live one

    /// REQUIRES: `slot` is known.
    void loadSlots(const SlotBuffer& s) {
        F row[8];
        loadRows8(s.rows[0], this->slot * UInt<F>(SlotBuffer::kStride), row);
        gathered = {row[0], row[1], row[2]};
        address = {floatBits(row[4]), floatBits(row[5])};
        time = row[6];
    }
    /// Here and in the slots. Spare lanes copy a live lane's value and so write what it writes.
    void addToSlots(SlotBuffer& s, const Spectrum<F>& value) {
        gathered += value;
        const F row[4] = {gathered.r, gathered.g, gathered.b, F(0.f)};
        scatterRows4(s.rows[0], this->slot * UInt<F>(SlotBuffer::kStride), row);
    }
};

}  // namespace penumbra
