// The batch driver: the only place that gathers, sorts, packs and scatters paths. It runs the paths of a tile through the
// steps of an integrator, about a thousand at a time.
//
// One step: trace the live rays in packets of eight; where a mix of materials was met, choose one of them; sort the rays by
// the material they met (a miss is a kind of its own); hand each group of eight of one kind to the integrator, which adds
// emission, asks for a shadow ray and packs the ray that goes on; trace the shadow rays and add what arrives. Paths end in
// lockstep: there is no refill, so every number of a path depends on its own address alone, and lanes, batch size and tile
// order change no bit.
//
// A Shader is the integrator's part, generic over lanes:
//   template <class F, class M> void shade(Step<F>&, RayGroup<F>&, const Hit<F>&, const UInt<F>& material) const noexcept;
//   template <class F> void miss(Step<F>&, RayGroup<F>&) const noexcept;
#pragma once

#include "core/geometry/surface_point.h"
#include "integrators/first_surface.h"
#include "integrators/path_batch.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <xmmintrin.h>

namespace penumbra {

/// Flush-to-zero and denormals-are-zero while in scope; set inside the task, because oneTBB restores the flags for each.
class FlushDenormals {
public:
    FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
    ~FlushDenormals() { _mm_setcsr(saved_); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
    unsigned saved_;
};

/// Embree aborts on rays that are not finite or start beyond 1.8e18.
template <class F>
Mask<F> isSound(const Vec3<F>& origin, const Vec3<F>& direction) {
    const Vec3<F> o = abs(origin), d = abs(direction);
    return (maxComponent(o) < F(1e18f)) & (o.x + o.y + o.z < F(1e19f)) & (d.x + d.y + d.z < F(2.f));
}

/// Throughput is nowhere negative, so its sum is a finite number where all of it is.
template <class F>
Mask<F> isFinite(const Spectrum<F>& throughput) {
    return throughput.r + throughput.g + throughput.b < F(kInfinity);
}

/// Makes invalid samples of the paths of the chosen lanes.
template <class F>
void breakPaths(SlotBuffer& slots, const UInt<F>& slot, unsigned lanes) {
    for (; lanes; lanes &= lanes - 1) slots.rows[lane(slot, std::countr_zero(lanes))][0] = std::numeric_limits<float>::quiet_NaN();
}

/// What a shader works with: the scene, the batch and where its results go. Rays that are not sound never reach Embree:
/// their paths become invalid samples, and so do those whose throughput is not finite.
template <class F>
struct Step {
    const Scene& scene;
    PathBatch& batch;
    std::uint32_t vertex;       ///< of the hit; the camera is vertex 0
    int nextCount;              ///< rays packed so far

    /// What the paths gather. Before shadow() and go() of the same group, which may make their samples invalid.
    void add(RayGroup<F>& g, const Spectrum<F>& value) { g.addToSlots(batch.slots, value); }
    void shadow(const RayGroup<F>& g, const Vec3<F>& origin, const Vec3<F>& direction, F far, const Spectrum<F>& value,
                const Mask<F>& wanted) {
        const Mask<F> asked = wanted & g.live, sound = isSound(origin, direction);
        breakPaths<F>(batch.slots, g.slot, bits(Mask<F>(asked & !sound)));
        const unsigned keep = bits(Mask<F>(asked & sound));
        if (!keep) return;
        ShadowBuffer& s = batch.shadows;
        const int n = batch.shadowCount;
        const F row[8] = {origin.x, origin.y, origin.z, far, direction.x, direction.y, direction.z, floatFromBits(g.slot)};
        storeRows8(s.rows[n], ShadowBuffer::kStride, row, keep);
        storePacked(s.r + n, value.r, keep);
        storePacked(s.g + n, value.g, keep);
        storePacked(s.b + n, value.b, keep);
        batch.shadowCount = n + std::popcount(keep);
    }
    void go(const RayGroup<F>& g, const PathRay<F>& ray, const Mask<F>& wanted) {
        const Mask<F> going = wanted & g.live, sound = isSound(ray.origin, ray.direction) & isFinite(ray.throughput);
        breakPaths<F>(batch.slots, g.slot, bits(Mask<F>(going & !sound)));
        const unsigned keep = bits(Mask<F>(going & sound));
        if (!keep) return;
        ray.store(batch.next(), nextCount, keep);
        nextCount += std::popcount(keep);
    }
};

/// What materials see of the surface where the ray met it, given the width of the ray's cone there.
template <class F>
ShadingContext<F> shadingContext(const Scene& scene, const SurfacePoint<F>& at, F coneWidth) {
    return {scene.textures, scene.materials.tableData(), {at.uv, coneWidth * at.uvPerLength, at.p, at.ng, coneWidth}};
}

/// Where a path begins on the film, on the lens and in time.
template <class F>
struct CameraNumbers {
    Vec2<F> raster, lens;
    F shutter;
    F sign;  ///< of the filter
};

/// `x`, `y`: the pixel's corner.
template <class F>
CameraNumbers<F> cameraNumbers(const Scene& scene, F x, F y, const SampleAddress<F>& address) {
    const auto numbers = scene.sampler.at<F>(address, 0);
    const FilterSample<F> f = scene.filter.sample(numbers.get2(Dim::Filter));
    CameraNumbers<F> c{{x + F(0.5f) + f.offset.x, y + F(0.5f) + f.offset.y}, {F(0.5f), F(0.5f)}, F(0.5f), f.sign};
    if (scene.camera.usesLens()) c.lens = numbers.get2(Dim::Lens);
    if (scene.hasMotion) c.shutter = numbers.get1(Dim::Time);
    return c;
}

/// Of the ray's cone at the hit.
template <class F>
F coneWidthAt(const Scene& scene, const RayGroup<F>& g, const Hit<F>& hit) {
    return g.coneWidth + F(scene.camera.coneSpread()) * hit.t;
}

/// Tilts the shading frame by the reliefs of the materials that were met (materials/relief.h). Never inlined: few
/// materials have one, and the code of all is not to grow by it.
template <class F>
[[gnu::noinline]] void applyRelief(const Scene& scene, const RayGroup<F>& g, const Hit<F>& hit, const UInt<F>& material,
                                   SurfacePoint<F>& at) noexcept {
    const SurfaceDerivatives<F> derivatives = surfaceDerivatives(scene.geometry, hit, at, g.time);
    const ShadingContext<F> context = shadingContext(scene, at, coneWidthAt(scene, g, hit));
    at.frame = reliefFrame(scene.materials.reliefs<F>(material), scene.textures, context.at, derivatives, at.frame);
}

/// The surface where the ray met the material, as it is shaded.
template <class F, class M>
SurfacePoint<F> shadedPoint(const Scene& scene, const RayGroup<F>& g, const Hit<F>& hit,
                            const UInt<F>& material) noexcept {
    SurfacePoint<F> at = surfacePoint(scene.geometry, hit, g.origin, g.direction, g.time);
    if (scene.materials.template hasRelief<M>()) applyRelief(scene, g, hit, material, at);
    return at;
}

namespace detail {

/// Groups are filled in place and passed by reference: at 700 bytes a copy costs more than some of the steps.
template <class F>
void gatherGroup(RayGroup<F>& g, const PathBatch& batch, const RayBuffer& r, const UInt<F>& at, int liveCount, bool hasMotion) {
    g.load(r, at);
    g.loadSlots(batch.slots);
    if (!hasMotion) g.time = F(0.f);
    g.live = firstLanes<F>(liveCount);
}

template <class F>
Hit<F> gatherHit(const HitBuffer& h, const UInt<F>& at) {
    F row[8];
    loadRows8(h.rows[0], at * UInt<F>(HitBuffer::kStride), row);
    return {floatBits(row[0]), floatBits(row[1]), floatBits(row[2]), row[3], row[4], row[5]};
}

/// Lane k of a group of `count` live rays, or of the last live one.
template <class F>
UInt<F> groupIndices(const std::uint16_t* order, int count) {
    UInt<F> at = loadIndices<F>(order);
    if (count < kLanes<F>) at = select(firstLanes<F>(count), at, UInt<F>(order[count - 1]));
    return at;
}

}  // namespace detail

template <class F, class Shader>
class BatchDriver {
public:
    BatchDriver(const Scene& scene, const Shader& shader, const RenderControls& controls, Film& film, RenderCounts& counts)
        : scene_(scene), shader_(shader), controls_(controls), film_(film), counts_(counts), batch_(threadBatch()) {}

    void render(const Tile& tile, SampleRange samples) noexcept {
        const FlushDenormals flush;
        const std::uint32_t perPixel = samples.end - samples.begin;
        const std::uint64_t total = std::uint64_t(tile.x1 - tile.x0) * std::uint64_t(tile.y1 - tile.y0) * perPixel;
        for (std::uint64_t first = 0; first < total; first += std::uint64_t(controls_.batchSize)) {
            const std::uint64_t left = total - first;
            begin(tile, samples, first, left < std::uint64_t(controls_.batchSize) ? int(left) : controls_.batchSize);
            for (std::uint32_t vertex = 1; batch_.live > 0; ++vertex) step(vertex);
            end();
        }
    }

private:
    static constexpr int W = kLanes<F>;
    /// A mesh with no more indices stays in the caches by itself.
    static constexpr std::size_t kNearIndices = std::size_t(1) << 17;
    /// Live lanes of the group that begins at i of a run that ends at `end`.
    static int groupSize(int i, int end) { return end - i < W ? end - i : W; }

    /// Makes the camera rays of paths first .. first + count of the tile. Samples of a pixel are neighbours, so packets start coherent.
    void begin(const Tile& tile, SampleRange samples, std::uint64_t first, int count) {
        SlotBuffer& s = batch_.slots;
        const std::uint32_t perPixel = samples.end - samples.begin, tileWidth = std::uint32_t(tile.x1 - tile.x0);
        const std::uint32_t filmWidth = std::uint32_t(film_.crop().width());
        const std::uint64_t firstPixel = first / perPixel;
        std::uint32_t sample = std::uint32_t(first % perPixel);
        int x = tile.x0 + int(firstPixel % tileWidth), y = tile.y0 + int(firstPixel / tileWidth);
        for (int i = 0; i < count;) {
            const int ofPixel = std::min(int(perPixel - sample), count - i);
            std::fill_n(s.pixel + i, ofPixel, std::uint32_t(y) * filmWidth + std::uint32_t(x));
            std::iota(s.sample + i, s.sample + i + ofPixel, samples.begin + sample);
            std::fill_n(s.rasterX + i, ofPixel, float(x + film_.crop().x0));
            std::fill_n(s.rasterY + i, ofPixel, float(y + film_.crop().y0));
            i += ofPixel;
            sample = 0;
            if (++x == tile.x1) x = tile.x0, ++y;
        }
        batch_.live = 0;
        for (int i = 0; i < count; i += W) cameraRays(i, groupSize(i, count));
        batch_.current = 0;
        pathCount_ = count;
        counts_.paths += std::uint64_t(count);
    }

    /// Of `n` slots from `at` on.
    void cameraRays(int at, int n) {
        SlotBuffer& s = batch_.slots;
        const UInt<F> slot = UInt<F>(std::uint32_t(at)) + laneIndices<F>();
        // The number of a pixel is that of the whole picture, so a crop renders the same samples.
        const F x = load<F>(s.rasterX + at), y = load<F>(s.rasterY + at);
        const UInt<F> pixel = toUInt(y) * UInt<F>(std::uint32_t(scene_.film.width)) + toUInt(x);
        const SampleAddress<F> a = addressOf<F>(pixel, load<F>(s.sample + at), std::uint32_t(film_.replicates()), scene_.seed);
        const CameraNumbers<F> numbers = cameraNumbers(scene_, x, y, a);
        const CameraRay<F> ray = scene_.camera.ray(numbers.raster, numbers.lens, numbers.shutter);
        const F zero(0.f), row[8] = {zero, zero, zero, zero, floatFromBits(a.seed), floatFromBits(a.index), ray.time, zero};
        storeRows8(s.rows[at], SlotBuffer::kStride, row, (1u << W) - 1u);
        store(s.sign + at, numbers.sign);
        // What the camera keeps out is black, and not empty.
        const Mask<F> dark = !(ray.weight > F(0.f));
        store(s.covered + at, select(dark, UInt<F>(1u), UInt<F>(0u)));
        const PathRay<F> first{ray.origin, ray.direction, Spectrum<F>::constant(ray.weight), F(0.f), F(1.f) / ray.weight, ray.coneWidth,
                               slot, UInt<F>(0u), UInt<F>(scene_.cameraMedium), F(0.f)};
        const unsigned asked = ((1u << n) - 1u) & ~bits(dark), keep = bits(isSound(ray.origin, ray.direction)) & asked;
        breakPaths<F>(s, slot, asked & ~keep);
        first.store(batch_.rays[0], batch_.live, keep);
        batch_.live += std::popcount(keep);
    }

    void step(std::uint32_t vertex) {
        traceNearest(vertex == 1);
        if (!scene_.materials.mixes().empty()) chooseFromMixes(vertex);
        sortByMaterial();
        Step<F> step{scene_, batch_, vertex, 0};
        batch_.shadowCount = 0;
        const RayBuffer& r = batch_.now();
        int begin = 0;
        for (unsigned tag = 0; tag < MaterialTable::kTags; ++tag) {
            const int end = runEnd_[tag];
            if (end > begin)
                dispatch(MaterialTypes{}, tag, [&]<class M>() { shadeRun<M>(step, r, begin, end, vertex == 1); });
            begin = end;
        }
        missed(step, r, begin);
        traceShadows();
        batch_.live = step.nextCount;
        batch_.current = 1 - batch_.current;
    }

    template <class M>
    void shadeRun(Step<F>& step, const RayBuffer& r, int begin, int end, bool first) {
        for (int i = begin; i < end; i += W) {
            const int n = groupSize(i, end);
            const UInt<F> at = detail::groupIndices<F>(batch_.order + i, n);
            RayGroup<F> g;
            detail::gatherGroup<F>(g, batch_, r, at, n, scene_.hasMotion);
            if (first) scatter(batch_.slots.covered, g.slot, UInt<F>(1u));
            counts_.groups += 1;
            counts_.liveLanes += std::uint64_t(n);
            const Hit<F> hit = detail::gatherHit<F>(batch_.hits, at);
            const UInt<F> material = gather(batch_.key, at);
            if constexpr (!M::kPassThrough)
                if (!film_.aovs().empty()) [[unlikely]]
                    recordFirstSurface<F>(scene_, batch_.slots, g, hit, material, kTagOf<M, MaterialTypes>, film_);
            shader_.template shade<F, M>(step, g, hit, material);
        }
    }

    void missed(Step<F>& step, const RayBuffer& r, int begin) {
        for (int i = begin; i < batch_.live; i += W) {
            const int n = groupSize(i, batch_.live);
            const UInt<F> at = detail::groupIndices<F>(batch_.order + i, n);
            RayGroup<F> g;
            detail::gatherGroup<F>(g, batch_, r, at, n, false);
            shader_.template miss<F>(step, g);
        }
    }

    /// `fromCamera`: neighbours are samples of one pixel, so their packets are coherent.
    void traceNearest(bool fromCamera) {
        const RayBuffer& r = batch_.now();
        counts_.rays += std::uint64_t(batch_.live);
        RayHitPacket p;
        preparePacket(p.ray);
        for (int i = 0; i < batch_.live; i += W) {
            const int n = groupSize(i, batch_.live);
            const unsigned live = (1u << n) - 1u;
            F row[8];
            loadRows8(r.rows[i], laneIndices<F>() * UInt<F>(RayBuffer::kStride), row);
            fillPacket(p.ray, row, F(kInfinity), n);
            store(p.hit.geometry, UInt<F>(kNoHit));
            store(p.hit.instance, UInt<F>(kNoHit));
            const Coherence coherence = fromCamera ? Coherence::Coherent : Coherence::Incoherent;
            if (controls_.recorder) controls_.recorder->nearest(p, live, coherence);
            scene_.accelerator.intersect(p, live, coherence);

            const UInt<F> geometry = load<F>(p.hit.geometry), instance = load<F>(p.hit.instance);
            const Mask<F> met = geometry != UInt<F>(kNoHit);
            UInt<F> key(missKey());
            if (any(met)) {
                const UInt<F> shape = shapeOf<F>(scene_.geometry, select(met, geometry, UInt<F>(0u)),
                                                 select(met, instance, UInt<F>(kNone)));
                const Records<F, ShapeRecord> shapes(scene_.geometry.shapes.data(), shape);
                key = select(met, shapes(&ShapeRecord::material), key);
                const UInt<F> primitive = load<F>(p.hit.primitive);
                if (readsAhead_) prefetchTriangles(shapes(&ShapeRecord::first) + primitive, bits(met) & live);
                const F hit[8] = {floatFromBits(shape), floatFromBits(primitive), floatFromBits(instance),
                                  load<F>(p.hit.u), load<F>(p.hit.v), load<F>(p.ray.far), F(0.f), F(0.f)};
                storeRows8(batch_.hits.rows[i], HitBuffer::kStride, hit, live);
            }
            store(batch_.key + i, key);   // decides the order of shading
        }
    }

    /// Asks for the indices of the triangles that were met: shading comes to them when the batch is traced. In vain where
    /// it was no mesh.
    void prefetchTriangles(const UInt<F>& triangle, unsigned lanes) const {
        const UInt<F> row = triangle * UInt<F>(3u);
        for (; lanes; lanes &= lanes - 1) prefetch(scene_.geometry.indices.data(), lane(row, std::countr_zero(lanes)));
    }

    /// Replaces the keys of mixes by those of what is met there; `order` is free until the sort.
    void chooseFromMixes(std::uint32_t vertex) {
        int count = 0;
        for (int i = 0; i < batch_.live; ++i)
            if (batch_.key[i] & kMixFlag) batch_.order[count++] = std::uint16_t(i);
        for (int i = 0; i < count; i += W) {
            const int n = groupSize(i, count);
            const UInt<F> at = detail::groupIndices<F>(batch_.order + i, n);
            RayGroup<F> g;
            detail::gatherGroup<F>(g, batch_, batch_.now(), at, n, scene_.hasMotion);
            const F u = scene_.sampler.at<F>(g.address, vertex).get1(Dim::Mix);
            SurfacePoint<F> surface{};
            F coneWidth(0.f);
            if (scene_.materials.mixesAreTextured()) {
                const Hit<F> hit = detail::gatherHit<F>(batch_.hits, at);
                surface = surfacePoint(scene_.geometry, hit, g.origin, g.direction, g.time);
                coneWidth = coneWidthAt(scene_, g, hit);
            }
            const UInt<F> met = penumbra::chooseFromMixes(scene_.materials.mixes().data(), gather(batch_.key, at), u,
                                                          shadingContext(scene_, surface, coneWidth));
            scatter(batch_.key, at, met);
        }
    }

    void traceShadows() {
        const ShadowBuffer& s = batch_.shadows;
        SlotBuffer& slots = batch_.slots;
        counts_.shadowRays += std::uint64_t(batch_.shadowCount);
        RayPacket p;
        preparePacket(p);
        for (int i = 0; i < batch_.shadowCount; i += W) {
            const int n = groupSize(i, batch_.shadowCount);
            const unsigned live = (1u << n) - 1u;
            F row[8];
            loadRows8(s.rows[i], laneIndices<F>() * UInt<F>(ShadowBuffer::kStride), row);
            fillPacket(p, row, row[3], n);
            if (controls_.recorder) controls_.recorder->shadow(p, live);
            scene_.accelerator.occluded(p, live);
            for (unsigned open = bits(Mask<F>(load<F>(p.far) >= F(0.f))) & live; open; open &= open - 1) {
                const int k = i + std::countr_zero(open);
                const std::uint32_t to = floatBits(s.rows[k][7]);
                slots.rows[to][0] += s.r[k];
                slots.rows[to][1] += s.g[k];
                slots.rows[to][2] += s.b[k];
            }
        }
    }

    /// What all packets have alike; tracing leaves it as it is.
    static void preparePacket(RayPacket& p) {
        store(p.near, F(0.f));
        store(p.time, F(0.f));
        store(p.mask, UInt<F>(0xFFFFFFFFu));
        store(p.id, UInt<F>(0u));
        store(p.flags, UInt<F>(0u));
    }
    /// `row`: the first eight words of a ray or shadow record: origin, -, direction, slot.
    void fillPacket(RayPacket& p, const F row[8], F far, int n) {
        store(p.originX, row[0]);
        store(p.originY, row[1]);
        store(p.originZ, row[2]);
        store(p.directionX, row[4]);
        store(p.directionY, row[5]);
        store(p.directionZ, row[6]);
        if (scene_.hasMotion)
            store(p.time, timeOf<F>(batch_.slots, select(firstLanes<F>(n), floatBits(row[7]), UInt<F>(0u))));
        store(p.far, far);
    }

    std::uint32_t missKey() const { return scene_.materials.size(); }

    /// Orders the rays by the material they met, misses last. Stable, so the order is a function of the batch alone. Where a
    /// scene has very many materials, by kind only.
    void sortByMaterial() {
        constexpr std::uint32_t kFewBuckets = 8, kMostBuckets = 1024;
        const std::uint32_t materials = missKey();
        const bool fine = materials < kMostBuckets;
        const std::uint32_t buckets = (fine ? materials : MaterialTable::kTags) + 1;
        int place[kMostBuckets + 1];
        if (buckets <= kFewBuckets)
            pickBuckets(place, buckets);
        else if (fine)
            countingSort(place, buckets, [&](int i) { return batch_.key[i]; });
        else
            countingSort(place, buckets, [&](int i) {
                const std::uint32_t key = batch_.key[i];
                return key == materials ? buckets - 1 : scene_.materials.tag(key);
            });
        // Each place is now the end of its bucket.
        for (unsigned tag = 0; tag < MaterialTable::kTags; ++tag) {
            const std::uint32_t last = fine ? scene_.materials.firstId(tag + 1) : tag + 1;
            runEnd_[tag] = last ? place[last - 1] : 0;
        }
    }

    /// Fills `order`; `place` becomes the end of each bucket there. Each key has its bucket, which picks its rays, eight at
    /// a time: no look-up and no store waits for the one before, so few buckets are faster filled than by counting.
    void pickBuckets(int place[], std::uint32_t buckets) {
        int n = 0;
        for (std::uint32_t b = 0; b < buckets; ++b) {
            for (int i = 0; i < batch_.live; i += W) {
                const unsigned mine = bits(load<F>(batch_.key + i) == UInt<F>(b)) & ((1u << groupSize(i, batch_.live)) - 1u);
                storePackedIndices(batch_.order + n, UInt<F>(std::uint32_t(i)) + laneIndices<F>(), mine);
                n += std::popcount(mine);
            }
            place[b] = n;
        }
    }

    /// The same by a counting sort, for any number of buckets.
    template <class BucketOf>
    void countingSort(int place[], std::uint32_t buckets, const BucketOf& bucketOf) {
        const int live = batch_.live;
        std::fill_n(place, buckets, 0);
        for (int i = 0; i < live; ++i) ++place[bucketOf(i)];
        int sum = 0;
        for (std::uint32_t b = 0; b < buckets; ++b) {
            const int n = place[b];
            place[b] = sum;
            sum += n;
        }
        for (int i = 0; i < live; ++i) batch_.order[place[bucketOf(i)]++] = std::uint16_t(i);
    }

    /// Hands the finished paths to the film.
    void end() {
        const SlotBuffer& s = batch_.slots;
        const bool plain = scene_.film.isIdentity(), inRuns = film_.replicates() == 1;
        static_assert(kMaxBatch <= PixelRun::kMost);
        PixelRun run;
        for (int i = 0; i < pathCount_;) {
            if (plain && inRuns && addGroup(run, i)) {
                i += W;
            } else {
                addOne(run, i, plain, inRuns);
                ++i;
            }
            // Samples of a pixel are neighbours.
            if (inRuns && (i == pathCount_ || s.pixel[i] != s.pixel[i - 1])) {
                film_.add(s.pixel[i - 1], run);
                run = {};
            }
        }
    }
    /// The paths i .. i + W, where they are of one pixel and of everyday size; else false, and nothing is done.
    bool addGroup(PixelRun& run, int i) const {
        const SlotBuffer& s = batch_.slots;
        if (W == 1 || i + W > pathCount_ || s.pixel[i + W - 1] != s.pixel[i]) return false;
        const F sign = load<F>(s.sign + i);
        F row[4];
        loadRows4(s.rows[i], laneIndices<F>() * UInt<F>(SlotBuffer::kStride), row);
        const Spectrum<F> value{row[0] * sign, row[1] * sign, row[2] * sign};
        return run.add(value, sign, load<F>(s.covered + i) != UInt<F>(0u));
    }
    void addOne(PixelRun& run, int i, bool plain, bool inRuns) {
        const SlotBuffer& s = batch_.slots;
        Spectrum<float> value{s.rows[i][0], s.rows[i][1], s.rows[i][2]}, lost = Spectrum<float>::constant(0.f);
        if (!plain) {
            value = toSensor(scene_.film, value);
            lost = limitSample(value, scene_.film.maxComponent);
        }
        if (s.sign[i] < 0.f) {
            value = value * -1.f;
            lost = lost * -1.f;
        }
        const bool covered = s.covered[i] != 0;
        if (!(inRuns && run.add(value, s.sign[i], covered)) && !film_.add(s.pixel[i], s.sample[i], value, s.sign[i], covered))
            counts_.addInvalid({s.pixel[i], s.sample[i]});
        else if (!isBlack(lost))
            counts_.clamped.add(lost);
    }
    static Spectrum<float> toSensor(const FilmSettings& f, const Spectrum<float>& c) {
        const auto& m = f.sensorFromFilm;
        return {m[0] * c.r + m[1] * c.g + m[2] * c.b, m[3] * c.r + m[4] * c.g + m[5] * c.b, m[6] * c.r + m[7] * c.g + m[8] * c.b};
    }

    const Scene& scene_;
    const Shader& shader_;
    const RenderControls& controls_;
    Film& film_;
    RenderCounts& counts_;
    PathBatch& batch_;
    const bool readsAhead_ = scene_.geometry.indices.size() > kNearIndices;
    int pathCount_ = 0;
    int runEnd_[MaterialTable::kTags];   ///< in `order`: end of the rays that met each kind of material
};

}  // namespace penumbra
