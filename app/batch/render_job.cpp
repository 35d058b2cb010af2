#include "app/batch/render_job.h"

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "integrators/registry.h"
#include "scenes/readers.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <mutex>

namespace penumbra {
namespace {

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

RenderJob::RenderJob(const RenderOptions& options, Warnings& warnings) : options_(options) {
    const auto start = std::chrono::steady_clock::now();
    SceneDescription description = readScene(options.scene, warnings);
    times_.parse = secondsSince(start);
    prepare(std::move(description), warnings);
}

RenderJob::RenderJob(SceneDescription description, const RenderOptions& options, Warnings& warnings) : options_(options) {
    prepare(std::move(description), warnings);
}

void RenderJob::prepare(SceneDescription description, Warnings& warnings) {
    const auto start = std::chrono::steady_clock::now();
    scene_ = buildScene(std::move(description), options_.build, warnings);
    integrator_ = makeIntegrator(scene_.integrator);
    film_ = Film(scene_.film.crop, options_.replicates, scene_.filter.normalization());
    times_.build = secondsSince(start);
}

void RenderJob::run() {
    const auto start = std::chrono::steady_clock::now();
    const CropWindow& crop = film_.crop();
    const int size = options_.tileSize, columns = (crop.width() + size - 1) / size, rows = (crop.height() + size - 1) / size;
    progress_.tiles = std::uint64_t(columns) * std::uint64_t(rows);
    progress_.tilesDone = 0;
    std::mutex mutex;   // counts are merged once a tile
    parallelFor(progress_.tiles, [&](std::size_t i) {
        const int x = int(i % std::size_t(columns)) * size, y = int(i / std::size_t(columns)) * size;
        const Tile tile{x, y, std::min(x + size, crop.width()), std::min(y + size, crop.height())};
        RenderCounts counts;
        integrator_->render(scene_, tile, {0, std::uint32_t(scene_.samplesPerPixel)}, options_.controls, film_, counts);
        const std::lock_guard lock(mutex);
        counts_.add(counts);
        ++progress_.tilesDone;
    });
    times_.render += secondsSince(start);
}

Spectrum<float> RenderJob::replay(int x, int y, std::uint32_t sample) const {
    const CropWindow& crop = film_.crop();
    if (x < crop.x0 || x >= crop.x1 || y < crop.y0 || y >= crop.y1)
        throw Error(ErrorKind::Usage, "pixel " + std::to_string(x) + "," + std::to_string(y) + " is outside the picture (" +
                                          std::to_string(crop.x0) + "," + std::to_string(crop.y0) + " to " + std::to_string(crop.x1 - 1) +
                                          "," + std::to_string(crop.y1 - 1) + ")");
    RenderControls alone = options_.controls;
    alone.lanes = 1;
    Film film(CropWindow{x, y, x + 1, y + 1}, options_.replicates, 1.0);
    RenderCounts counts;
    integrator_->render(scene_, {0, 0, 1, 1}, {sample, sample + 1}, alone, film, counts);
    if (counts.invalid) return Spectrum<float>::constant(std::numeric_limits<float>::quiet_NaN());
    const PixelEstimate e = film.estimate(0);
    return {float(e.mean[0]), float(e.mean[1]), float(e.mean[2])};
}

}  // namespace penumbra
