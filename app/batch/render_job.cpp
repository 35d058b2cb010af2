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
    const int size = options_.tileSize;
    columns_ = std::size_t((film_.crop().width() + size - 1) / size);
    tiles_ = columns_ * std::size_t((film_.crop().height() + size - 1) / size);
    if (options_.isWatched) tileLocks_ = std::make_unique<std::mutex[]>(tiles_);
    progress_.samples = film_.pixelCount() * std::uint64_t(scene_.samplesPerPixel);
    warningCount_ = warnings.all().size();
    times_.build = secondsSince(start);
}

bool RenderJob::run(const std::atomic<bool>* stop) {
    const auto start = std::chrono::steady_clock::now();
    const auto samples = std::uint32_t(scene_.samplesPerPixel);
    progress_.samplesDone = 0;
    constexpr std::uint32_t kGrowth = 4;  // of the samples with each pass
    std::uint32_t first = 0, end = options_.isWatched ? 1 : samples;
    while (first < samples) {
        renderPass({first, end}, stop);
        first = end;
        end = end < samples / kGrowth ? end * kGrowth : samples;
    }
    times_.render += secondsSince(start);
    return isWhole();
}

void RenderJob::renderPass(SampleRange samples, const std::atomic<bool>* stop) {
    const SpreadOrder order(tiles_);
    parallelFor(tiles_, [&](std::size_t i) {
        const RenderCounts counts = renderTile(order[i], samples, stop);
        const std::lock_guard lock(countsLock_);
        counts_.add(counts);
    });
}

RenderCounts RenderJob::renderTile(std::size_t number, SampleRange samples, const std::atomic<bool>* stop) {
    const Tile t = tile(number);
    const std::uint64_t pixels = std::uint64_t(t.x1 - t.x0) * std::uint64_t(t.y1 - t.y0);
    RenderCounts counts;
    for (std::uint32_t first = samples.begin;
         first < samples.end && !(stop && stop->load(std::memory_order_relaxed));) {
        const std::uint32_t end = first + std::min(kSamplesPerCall, samples.end - first);
        {
            const auto lock = lockTile(number);
            integrator_->render(scene_, t, {first, end}, options_.controls, film_, counts);
        }
        progress_.samplesDone.fetch_add(pixels * (end - first), std::memory_order_relaxed);
        first = end;
    }
    return counts;
}

Tile RenderJob::tile(std::size_t number) const {
    const int size = options_.tileSize, x = int(number % columns_) * size, y = int(number / columns_) * size;
    return {x, y, std::min(x + size, film_.crop().width()), std::min(y + size, film_.crop().height())};
}

std::unique_lock<std::mutex> RenderJob::lockTile(std::size_t number) const {
    return tileLocks_ ? std::unique_lock(tileLocks_[number]) : std::unique_lock<std::mutex>();
}

void RenderJob::visitTiles(const Tile& window, const std::function<void(const Tile&)>& visit) const {
    const int size = options_.tileSize;
    for (int row = window.y0 / size; row * size < window.y1; ++row)
        for (int column = window.x0 / size; column * size < window.x1; ++column) {
            const std::size_t number = std::size_t(row) * columns_ + std::size_t(column);
            const Tile t = tile(number);
            const auto lock = lockTile(number);
            visit({std::max(t.x0, window.x0), std::max(t.y0, window.y0), std::min(t.x1, window.x1),
                   std::min(t.y1, window.y1)});
        }
}

RenderCounts RenderJob::countsSoFar() const {
    const std::lock_guard lock(countsLock_);
    return counts_;
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
