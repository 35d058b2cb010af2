// RenderJob: one scene rendered into one film. The library's front door: a scene file in, an estimate of every pixel
// with its error out.
//
//     Warnings warnings;
//     RenderJob job(RenderOptions{.scene = "scene.pbrt"}, warnings);
//     job.run();
//     job.writePicture("picture.exr");
//
// The picture is a function of the scene and the options that change it (BuildOptions, replicates): threads, tiles,
// lanes and batches change no bit. Errors: Error, as the parts throw it. Thread safety: one job belongs to one thread;
// but progress() may be read from any, and where options say isWatched, so may be whatever is marked "while it runs".
#pragma once

#include "app/batch/scene_inputs.h"
#include "core/base/warnings.h"
#include "core/film/film.h"
#include "integrators/integrator.h"
#include "scenes/builder.h"

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace penumbra {

struct RenderOptions {
    std::string scene;  ///< path; "-": standard input
    std::vector<std::string> overrides;  ///< as scenes/overrides.h takes them
    std::string root;   ///< the only folder that files are read from (canonicalRoot()); empty: any
    BuildOptions build;
    int replicates = 1;  ///< planes of the film
    int tileSize = 16;   ///< pixels; changes no bit
    /// Somebody looks on while the job runs: it goes over the whole picture again and again with ever more samples, so
    /// that there is soon something to see everywhere. Changes no bit.
    bool isWatched = false;
    RenderControls controls;
};

struct RenderProgress {
    std::atomic<std::uint64_t> samplesDone{0};
    std::uint64_t samples = 0;  ///< of all pixels
};

struct RenderTimes {
    double parse = 0, build = 0, render = 0;  ///< seconds
};

/// As the film holds it: with the sign of the filter.
struct ReplayedSample {
    Spectrum<float> value;                     ///< NaN where the sample is invalid
    std::optional<Spectrum<float>> unlimited;  ///< what it was before the limit on samples, where that made it smaller
};

class RenderJob {
public:
    /// Error(Usage) where a number of the options is outside its range.
    RenderJob(const RenderOptions& options, Warnings& warnings);
    /// A description made elsewhere (tests, tools) in the place of a file.
    RenderJob(SceneDescription description, const RenderOptions& options, Warnings& warnings);

    /// Renders all samples of all pixels. Where `stop` becomes true it returns false within a fraction of a second, and
    /// the film then holds some of the samples only.
    bool run(const std::atomic<bool>* stop = nullptr);
    /// One sample of one pixel of the whole picture, alone; `lanes` as in RenderControls. Error(Usage) outside the crop
    /// window or beyond the samples per pixel.
    ReplayedSample replay(int x, int y, std::uint32_t sample, int lanes = 1) const;

    const Scene& scene() const { return scene_; }
    const SceneInputs& inputs() const { return inputs_; }
    const Film& film() const { return film_; }
    const RenderCounts& counts() const { return counts_; }
    RenderCounts countsSoFar() const;                                            ///< while it runs
    bool isWhole() const { return progress_.samplesDone == progress_.samples; }  ///< while it runs
    /// While it runs: visits what lies in the window (of film coordinates) of each tile, one after the other, while
    /// nothing is rendered there. A thread that has work in that tile waits, so make it quick.
    void visitTiles(const Tile& window, const std::function<void(const Tile&)>& visit) const;
    const RenderTimes& times() const { return times_; }
    const RenderProgress& progress() const { return progress_; }
    const RenderOptions& options() const { return options_; }
    std::size_t warningCount() const { return warningCount_; }  ///< of reading and building the scene

    /// By extension: .exr with the error and the header that repeats the picture; .png .jpg .tif ... through the
    /// default display transform; .hdr .pfm linear. What is there and is no regular file (a device, a pipe) gets an
    /// EXR. While it runs, what there is so far, and the EXR's header says so. Returns which display transform it went
    /// through; empty where through none.
    std::string writePicture(const std::string& path) const;

private:
    void prepare(SceneDescription description, Warnings& warnings);
    void renderPass(SampleRange samples, const std::atomic<bool>* stop);
    RenderCounts renderTile(std::size_t number, SampleRange samples, const std::atomic<bool>* stop);
    Tile tile(std::size_t number) const;
    std::unique_lock<std::mutex> lockTile(std::size_t number) const;

    RenderOptions options_;
    Scene scene_;
    SceneInputs inputs_;
    Film film_;
    std::unique_ptr<Integrator> integrator_;
    std::size_t columns_ = 0, tiles_ = 0;      ///< tiles in a row; all
    std::unique_ptr<std::mutex[]> tileLocks_;  ///< isWatched only: held by who renders or reads a tile
    mutable std::mutex countsLock_;
    RenderCounts counts_;
    RenderTimes times_;
    RenderProgress progress_;
    std::size_t warningCount_ = 0;
};

/// writePicture() writes an EXR there.
bool isExrPath(const std::string& path);

/// Throws what writing a picture there would: asked before a long render. Usage: unknown extension; CannotCreate: no
/// such folder, a folder of that name, no permission. What stands there stays as it is, but for what killed renders of
/// this picture left beside it.
void checkPicturePath(const std::string& path);

/// Error(CannotCreate) where the path is one of the scene's own files, under whatever name.
void checkKeepsInputs(const std::string& path, const SceneInputs& inputs);

}  // namespace penumbra
