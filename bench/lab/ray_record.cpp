#include "bench/lab/ray_record.h"

#include "core/math/lanes.h"

#include <bit>

namespace penumbra {
namespace {

/// The rows of a packet that a record keeps.
constexpr float (RayPacket::*kStoredRows[StoredPacket::kRows])[kPacketWidth] = {
    &RayPacket::originX,    &RayPacket::originY,    &RayPacket::originZ, &RayPacket::near, &RayPacket::directionX,
    &RayPacket::directionY, &RayPacket::directionZ, &RayPacket::time,    &RayPacket::far};

constexpr std::uint32_t kVisibleToAll = 0xFFFFFFFFu;

// Row by row: of a copy in one piece the compiler makes a string instruction, which costs more.
void restore(const StoredPacket& stored, RayPacket& rays) {
    for (int i = 0; i < StoredPacket::kRows; ++i)
        store(rays.*kStoredRows[i], load<Lanes8f>(stored.rows[i]));
    store(rays.mask, Lanes8u(kVisibleToAll));
    store(rays.id, Lanes8u(0u));
    store(rays.flags, Lanes8u(0u));
}

template <ReplayMode kMode>
void replayNearest(const StoredPacket& stored, const Accelerator& accelerator, ReplayCounts& counts) {
    RayHitPacket p;
    restore(stored, p.ray);
    store(p.hit.geometry, Lanes8u(kNoHit));
    store(p.hit.instance, Lanes8u(kNoHit));
    if constexpr (kMode == ReplayMode::Packets)
        accelerator.intersect(p, stored.live, stored.coherence);
    else
        accelerator.intersectSingly(p, stored.live);
    counts.rays += std::uint64_t(std::popcount(stored.live));
    counts.hits += std::uint64_t(std::popcount(bits(load<Lanes8f>(p.hit.geometry) != Lanes8u(kNoHit)) & stored.live));
}

template <ReplayMode kMode>
void replayShadow(const StoredPacket& stored, const Accelerator& accelerator, ReplayCounts& counts) {
    RayPacket p;
    restore(stored, p);
    if constexpr (kMode == ReplayMode::Packets)
        accelerator.occluded(p, stored.live);
    else
        accelerator.occludedSingly(p, stored.live);
    counts.shadowRays += std::uint64_t(std::popcount(stored.live));
    counts.occluded += std::uint64_t(std::popcount(bits(load<Lanes8f>(p.far) < Lanes8f(0.f)) & stored.live));
}

}  // namespace

RayStore::RayStore(std::size_t bytes)
    : count_(bytes / sizeof(Block)), blocks_(std::make_unique_for_overwrite<Block[]>(count_)) {
    static_assert(sizeof(Block) <= kBlockBytes);
}

RayStore::Block* RayStore::take() noexcept {
    const std::size_t i = taken_.fetch_add(1, std::memory_order_relaxed);
    if (i >= count_) return nullptr;
    blocks_[i].count = 0;
    blocks_[i].next = nullptr;
    return &blocks_[i];
}

void ReplayCounts::add(const ReplayCounts& other) {
    packets += other.packets;
    rays += other.rays;
    hits += other.hits;
    shadowRays += other.shadowRays;
    occluded += other.occluded;
}

StoredPacket* RayRecord::nextPacket() noexcept {
    if (!isComplete_) return nullptr;
    if (!last_ || last_->count == RayStore::Block::kPackets) {
        RayStore::Block* block = store_->take();
        if (!block) {
            isComplete_ = false;
            return nullptr;
        }
        (last_ ? last_->next : first_) = block;
        last_ = block;
    }
    return &last_->packets[last_->count++];
}

void RayRecord::keep(const RayPacket& rays, unsigned live, bool isShadow, Coherence coherence) noexcept {
    StoredPacket* stored = nextPacket();
    if (!stored) return;
    for (int i = 0; i < StoredPacket::kRows; ++i)
        store(stored->rows[i], load<Lanes8f>(rays.*kStoredRows[i]));
    stored->live = std::uint8_t(live);
    stored->isShadow = isShadow;
    stored->coherence = coherence;
}

template <ReplayMode kMode>
ReplayCounts RayRecord::replayAll(const Accelerator& accelerator) const noexcept {
    ReplayCounts counts;
    for (const RayStore::Block* block = first_; block; block = block->next) {
        counts.packets += block->count;
        for (std::uint32_t i = 0; i < block->count; ++i) {
            const StoredPacket& stored = block->packets[i];
            if (stored.isShadow)
                replayShadow<kMode>(stored, accelerator, counts);
            else
                replayNearest<kMode>(stored, accelerator, counts);
        }
    }
    return counts;
}

ReplayCounts RayRecord::replay(const Accelerator& accelerator, ReplayMode mode) const noexcept {
    return mode == ReplayMode::Packets ? replayAll<ReplayMode::Packets>(accelerator)
                                       : replayAll<ReplayMode::Singly>(accelerator);
}

}  // namespace penumbra
