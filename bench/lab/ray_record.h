// RayRecord: the rays of a piece of a render, kept as they were traced, to be traced again and nothing else done.
//
// A record keeps every packet as Embree got it, in order, nearest and shadow rays as they took turns: which lanes were
// live, what stood in the others, whether it was said to be coherent. So a replay asks Embree for exactly the work that
// rendering asked for. A packet is copied to the stack before it is traced, because tracing changes it; rendering fills
// one there as well.
//
// Memory: the blocks of a RayStore, of which there is a fixed number, all asked for beforehand, so that recording
// allocates nothing. A record that gets no further block keeps no more rays and says so.
//
// Thread safety: a store serves any number of records at once. A record is written by one thread and may be replayed
// by many.
#pragma once

#include "core/geometry/accelerator.h"
#include "integrators/integrator.h"

#include <atomic>
#include <memory>

namespace penumbra {

/// A packet without the rows that all packets share (mask, id and flags).
struct alignas(32) StoredPacket {
    static constexpr int kRows = 9;
    float rows[kRows][kPacketWidth];
    std::uint8_t live;
    bool isShadow;
    Coherence coherence;  ///< of nearest rays
};

class RayStore {
public:
    static constexpr std::size_t kBlockBytes = 64 * 1024;
    struct Block {
        static constexpr std::uint32_t kPackets = (kBlockBytes - 32) / sizeof(StoredPacket);
        StoredPacket packets[kPackets];
        std::uint32_t count;
        Block* next;
    };

    /// As many whole blocks as fit into `bytes`. The system gives the memory as it is used.
    explicit RayStore(std::size_t bytes);

    /// An empty block; null where there is none left.
    Block* take() noexcept;
    bool isExhausted() const noexcept { return taken_.load(std::memory_order_relaxed) >= count_; }

private:
    std::size_t count_;
    std::unique_ptr<Block[]> blocks_;
    std::atomic<std::size_t> taken_{0};
};

enum class ReplayMode {
    Packets,  ///< eight at a time, as they were traced
    Singly    ///< one by one through Embree's single-ray calls
};

/// What a replay traced and found.
struct ReplayCounts {
    std::uint64_t packets = 0;
    std::uint64_t rays = 0, hits = 0;  ///< to the nearest surface
    std::uint64_t shadowRays = 0, occluded = 0;
    void add(const ReplayCounts& other);
};

class RayRecord final : public RayRecorder {
public:
    explicit RayRecord(RayStore& store) : store_(&store) {}

    void nearest(const RayHitPacket& rays, unsigned live, Coherence coherence) noexcept override {
        keep(rays.ray, live, false, coherence);
    }
    void shadow(const RayPacket& rays, unsigned live) noexcept override {
        keep(rays, live, true, Coherence::Incoherent);
    }
    /// No ray is missing.
    bool isComplete() const { return isComplete_; }

    ReplayCounts replay(const Accelerator& accelerator, ReplayMode mode) const noexcept;

private:
    void keep(const RayPacket& rays, unsigned live, bool isShadow, Coherence coherence) noexcept;
    StoredPacket* nextPacket() noexcept;
    template <ReplayMode kMode>
    ReplayCounts replayAll(const Accelerator& accelerator) const noexcept;

    RayStore* store_;
    RayStore::Block* first_ = nullptr;
    RayStore::Block* last_ = nullptr;
    bool isComplete_ = true;
};

}  // namespace penumbra
