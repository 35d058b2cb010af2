#include "app/batch/render_job.h"

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "integrators/registry.h"
#include "scenes/overrides.h"
#include "scenes/readers.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <mutex>
#include <numeric>

namespace penumbra {
namespace {

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A tile is rendered this many samples of each pixel at a time, which bounds how long a stop takes.
constexpr std::uint32_t kSamplesPerCall = 64;

/// Visits 0 .. count-1 in an order whose every stretch is spread over the whole, so that the first per cent of the
/// tiles costs about what the others cost, and the time left can be told.
class SpreadOrder {
public:
    explicit SpreadOrder(std::uint64_t count) : count_(count), stride_(std::uint64_t(double(count) * kGoldenSection)) {
        while (std::gcd(stride_, count_) != 1)
            ++stride_;
    }
    std::uint64_t operator[](std::uint64_t i) const { return i * stride_ % count_; }

private:
    static constexpr double kGoldenSection = 0.6180339887498949;
    std::uint64_t count_, stride_;
};

void checkOptions(const RenderOptions& o) {
    constexpr int kMost = std::numeric_limits<int>::max();
    struct Range {
        const char* name;
        int value, least, most;
    };
    for (const Range& r : {Range{"replicates", o.replicates, 1, kMost}, Range{"tileSize", o.tileSize, 1, 1 << 14},
                           Range{"batchSize", o.controls.batchSize, 1, kMaxBatch},
                           Range{"samplesOverride", o.build.samplesOverride, 0, kMost},
                           Range{"width", o.build.width, 0, kMost}, Range{"height", o.build.height, 0, kMost}})
        if (r.value < r.least || r.value > r.most)
            throw Error(ErrorKind::Usage, std::string(r.name) + " is " + std::to_string(r.value) +
                                              ", outside the allowed range, " + std::to_string(r.least) + " to " +
                                              std::to_string(r.most));
    if (o.controls.lanes != 1 && o.controls.lanes != 8)
        throw Error(ErrorKind::Usage, "lanes are " + std::to_string(o.controls.lanes) + "; there may be 1 or 8");
}

}  // namespace

RenderJob::RenderJob(const RenderOptions& options, Warnings& warnings) : options_(options) {
    const auto start = std::chrono::steady_clock::now();
    SceneDescription description = readScene(options.scene, warnings, options.root);
    times_.parse = secondsSince(start);
    prepare(std::move(description), warnings);
}

RenderJob::RenderJob(SceneDescription description, const RenderOptions& options, Warnings& warnings)
    : options_(options) {
    prepare(std::move(description), warnings);
}

void RenderJob::prepare(SceneDescription description, Warnings& warnings) {
    checkOptions(options_);
    const auto start = std::chrono::steady_clock::now();
    applyOverrides(description, options_.overrides);
    inputs_ = findSceneInputs(description);
    scene_ = buildScene(std::move(description), options_.build, warnings);
    if (options_.replicates > scene_.samplesPerPixel)
        throw Error(ErrorKind::Usage, std::to_string(options_.replicates) +
                                          " replicates need at least as many samples per pixel, not " +
                                          std::to_string(scene_.samplesPerPixel));
    integrator_ = makeIntegrator(scene_);
    film_ = Film(scene_.film.crop, options_.replicates, scene_.filter.normalization(), scene_.film.aovs);
    progress_.samples = film_.pixelCount() * std::uint64_t(scene_.samplesPerPixel);
    warningCount_ = warnings.all().size();
    times_.build = secondsSince(start);
}

bool RenderJob::run(const std::atomic<bool>* stop) {
    const auto start = std::chrono::steady_clock::now();
    const CropWindow& crop = film_.crop();
    const int size = options_.tileSize, columns = (crop.width() + size - 1) / size,
              rows = (crop.height() + size - 1) / size;
    const std::uint64_t tiles = std::uint64_t(columns) * std::uint64_t(rows);
    const SpreadOrder order(tiles);
    progress_.samplesDone = 0;
    std::mutex mutex;  // counts are merged once a tile
    parallelFor(tiles, [&](std::size_t i) {
        const int x = int(order[i] % std::uint64_t(columns)) * size, y = int(order[i] / std::uint64_t(columns)) * size;
        const RenderCounts counts =
            renderTile({x, y, std::min(x + size, crop.width()), std::min(y + size, crop.height())}, stop);
        const std::lock_guard lock(mutex);
        counts_.add(counts);
    });
    times_.render += secondsSince(start);
    return progress_.samplesDone == progress_.samples;
}

RenderCounts RenderJob::renderTile(const Tile& tile, const std::atomic<bool>* stop) {
    const std::uint64_t pixels = std::uint64_t(tile.x1 - tile.x0) * std::uint64_t(tile.y1 - tile.y0);
    const auto samples = std::uint32_t(scene_.samplesPerPixel);
    RenderCounts counts;
    for (std::uint32_t first = 0; first < samples && !(stop && stop->load(std::memory_order_relaxed));) {
        const std::uint32_t end = first + std::min(kSamplesPerCall, samples - first);
        integrator_->render(scene_, tile, {first, end}, options_.controls, film_, counts);
        progress_.samplesDone.fetch_add(pixels * (end - first), std::memory_order_relaxed);
        first = end;
    }
    return counts;
}

ReplayedSample RenderJob::replay(int x, int y, std::uint32_t sample, int lanes) const {
    const CropWindow& crop = film_.crop();
    if (x < crop.x0 || x >= crop.x1 || y < crop.y0 || y >= crop.y1)
        throw Error(ErrorKind::Usage, "pixel " + std::to_string(x) + "," + std::to_string(y) +
                                          " is outside the picture (" + std::to_string(crop.x0) + "," +
                                          std::to_string(crop.y0) + " to " + std::to_string(crop.x1 - 1) + "," +
                                          std::to_string(crop.y1 - 1) + ")");
    if (sample >= std::uint32_t(scene_.samplesPerPixel))
        throw Error(ErrorKind::Usage, "sample " + std::to_string(sample) +
                                          " is not rendered: a pixel has the samples 0 to " +
                                          std::to_string(scene_.samplesPerPixel - 1));
    RenderControls alone = options_.controls;
    alone.lanes = lanes;
    Film film(CropWindow{x, y, x + 1, y + 1}, options_.replicates, 1.0);
    RenderCounts counts;
    integrator_->render(scene_, {0, 0, 1, 1}, {sample, sample + 1}, alone, film, counts);
    if (counts.invalid) return {Spectrum<float>::constant(std::numeric_limits<float>::quiet_NaN()), std::nullopt};
    const PixelEstimate e = film.estimate(0);
    ReplayedSample result{{float(e.mean[0]), float(e.mean[1]), float(e.mean[2])}, std::nullopt};
    const ClampedLight& lost = counts.clamped;
    if (lost.samples)
        result.unlimited = result.value + Spectrum<float>{float(lost.sum(0)), float(lost.sum(1)), float(lost.sum(2))};
    return result;
}

}  // namespace penumbra
