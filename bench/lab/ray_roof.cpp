#include "bench/lab/ray_roof.h"

#include "app/batch/statistics.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/hash.h"
#include "integrators/batch_driver.h"
#include "integrators/registry.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>

namespace penumbra {
namespace {

struct RecordedTile {
    Tile tile;
    RayRecord rays;
    RenderCounts counts = {};  ///< of rendering it
    bool isWhole = false;      ///< rendered, and every ray recorded
};

/// The tiles of the picture in a scattered order, so that those that fit into the memory come from all over it.
std::vector<Tile> scatteredTiles(const CropWindow& crop, int size) {
    std::vector<Tile> tiles;
    for (int y = 0; y < crop.height(); y += size)
        for (int x = 0; x < crop.width(); x += size)
            tiles.push_back({x, y, std::min(x + size, crop.width()), std::min(y + size, crop.height())});
    const auto place = [](const Tile& t) { return mixBits(std::uint32_t(t.y0) << 16 ^ mixBits(std::uint32_t(t.x0))); };
    std::stable_sort(tiles.begin(), tiles.end(), [&](const Tile& a, const Tile& b) { return place(a) < place(b); });
    return tiles;
}

/// The three that are compared.
enum Contestant { kRender, kPackets, kSingly, kContestants };
using Rates = std::array<double, kContestants>;  ///< samples per second

class Contest {
public:
    Contest(const RenderJob& job, std::size_t memoryBytes);

    std::size_t tilesOfPicture() const { return tilesOfPicture_; }
    std::size_t tiles() const { return tiles_.size(); }
    std::uint32_t samplesPerPixel() const { return samplesPerPixel_; }
    std::uint64_t samples() const;
    /// Through the accelerator that rendering used.
    ReplayCounts replayAsRendered() const { return replay(scene_.accelerator, ReplayMode::Packets); }
    void checkReplay(const ReplayCounts& found) const;
    Rates round(int number);

private:
    void record();
    void renderTile(RecordedTile& t, RayRecorder* recorder, RenderCounts& counts);
    void render();
    void run(Contestant contestant);
    ReplayCounts replay(const Accelerator& accelerator, ReplayMode mode) const;
    const Accelerator& embree() const { return embree_ ? *embree_ : scene_.accelerator; }

    const Scene& scene_;
    std::optional<Accelerator> embree_;   ///< where rendering does without
    RenderControls controls_;
    std::uint32_t samplesPerPixel_;
    std::unique_ptr<Integrator> integrator_;
    Film film_;
    RayStore store_;
    std::vector<RecordedTile> tiles_;
    std::size_t tilesOfPicture_ = 0;
};

Contest::Contest(const RenderJob& job, std::size_t memoryBytes)
    : scene_(job.scene()),
      controls_(job.options().controls),
      samplesPerPixel_(std::min(std::uint32_t(scene_.samplesPerPixel), RayRoof::kMostSamplesPerPixel)),
      integrator_(makeIntegrator(scene_)),
      film_(scene_.film.crop, job.options().replicates, scene_.filter.normalization()),
      store_(memoryBytes) {
    for (const Tile& tile : scatteredTiles(film_.crop(), job.options().tileSize))
        tiles_.push_back({tile, RayRecord(store_)});
    tilesOfPicture_ = tiles_.size();
    if (scene_.accelerator.hasFaceList()) embree_.emplace(scene_.geometry, IntersectionMode::Embree, &scene_.textures);
    record();
    if (tiles_.empty())
        throw Error(ErrorKind::Usage,
                    bytesText(double(memoryBytes)) +
                        " do not hold the rays of one tile: give more memory, fewer samples per pixel "
                        "or smaller tiles");
}

void Contest::record() {
    parallelFor(tiles_.size(), [&](std::size_t i) {
        RecordedTile& t = tiles_[i];
        if (store_.isExhausted()) return;
        renderTile(t, &t.rays, t.counts);
        t.isWhole = t.rays.isComplete();
    });
    std::erase_if(tiles_, [](const RecordedTile& t) { return !t.isWhole; });
}

void Contest::renderTile(RecordedTile& t, RayRecorder* recorder, RenderCounts& counts) {
    RenderControls controls = controls_;
    controls.recorder = recorder;
    integrator_->render(scene_, t.tile, {0, samplesPerPixel_}, controls, film_, counts);
}

void Contest::render() {
    parallelFor(tiles_.size(), [&](std::size_t i) {
        RenderCounts counts;
        renderTile(tiles_[i], nullptr, counts);
    });
}

ReplayCounts Contest::replay(const Accelerator& accelerator, ReplayMode mode) const {
    ReplayCounts total;
    std::mutex mutex;  // counts are merged once a tile
    parallelFor(tiles_.size(), [&](std::size_t i) {
        const FlushDenormals flush;  // as rendering does
        const ReplayCounts counts = tiles_[i].rays.replay(accelerator, mode);
        const std::lock_guard lock(mutex);
        total.add(counts);
    });
    return total;
}

std::uint64_t Contest::samples() const {
    std::uint64_t paths = 0;
    for (const RecordedTile& t : tiles_)
        paths += t.counts.paths;
    return paths;
}

/// A roof of other rays than rendering's would mean nothing. Every hit of rendering is a live lane of one shading call.
void Contest::checkReplay(const ReplayCounts& found) const {
    RenderCounts rendered;
    for (const RecordedTile& t : tiles_)
        rendered.add(t.counts);
    if (found.rays != rendered.rays || found.shadowRays != rendered.shadowRays || found.hits != rendered.liveLanes)
        throw Error(ErrorKind::Internal,
                    "the replay of the rays differs from the render: " + std::to_string(found.rays) + " rays with " +
                        std::to_string(found.hits) + " hits and " + std::to_string(found.shadowRays) +
                        " shadow rays, not " + std::to_string(rendered.rays) + ", " +
                        std::to_string(rendered.liveLanes) + " and " + std::to_string(rendered.shadowRays));
}

void Contest::run(Contestant contestant) {
    switch (contestant) {
        case kPackets:
            replay(embree(), ReplayMode::Packets);
            break;
        case kSingly:
            replay(embree(), ReplayMode::Singly);
            break;
        default:
            render();
    }
}

Rates Contest::round(int number) {
    Rates rates;
    for (int i = 0; i < kContestants; ++i) {
        const auto contestant = Contestant((number + i) % kContestants);
        rates[contestant] = double(samples()) / secondsOf([&] { run(contestant); });
    }
    return rates;
}

Spread spreadOver(const std::vector<Rates>& rounds, auto&& value) {
    std::vector<double> values;
    for (const Rates& r : rounds)
        values.push_back(value(r));
    return spreadOf(values);
}

}  // namespace

RayRoof measureRayRoof(const RenderJob& job, const RayRoofOptions& options) {
    Contest contest(job, options.memoryBytes);
    RayRoof result;
    result.options = options;
    result.threads = ThreadLimit::current();
    result.tiles = contest.tiles();
    result.tilesOfPicture = contest.tilesOfPicture();
    result.samplesPerPixel = contest.samplesPerPixel();
    result.samples = contest.samples();
    result.rays = contest.replayAsRendered();
    contest.checkReplay(result.rays);
    contest.round(0);  // not counted: the first of each brings its code and data into the caches

    std::vector<Rates> rounds;
    for (int i = 0; i < options.rounds; ++i)
        rounds.push_back(contest.round(i));
    const auto rateOf = [&](Contestant c) { return spreadOver(rounds, [c](const Rates& r) { return r[c]; }); };
    result.render = rateOf(kRender);
    result.packets = rateOf(kPackets);
    result.singly = rateOf(kSingly);
    result.packetsAreRoof = result.packets.median >= result.singly.median;
    const Contestant roof = result.packetsAreRoof ? kPackets : kSingly;
    result.fraction = spreadOver(rounds, [roof](const Rates& r) { return r[kRender] / r[roof]; });
    return result;
}

}  // namespace penumbra
