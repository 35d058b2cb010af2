// RenderJob: one scene rendered into one film. The library's front door: a scene file in, an estimate of every pixel with its
// error out.
//
//     Warnings warnings;
//     RenderJob job(RenderOptions{.scene = "scene.pbrt"}, warnings);
//     job.run();
//     job.writePicture("picture.exr");
//
// The picture is a function of the scene and the options that change it (BuildOptions, samples): threads, tiles, lanes and
// batches change no bit. Errors: Error, as the parts throw it. Thread safety: one job belongs to one thread, but progress()
// may be read from any.
#pragma once

#include "core/base/warnings.h"
#include "core/film/film.h"
#include "integrators/integrator.h"
#include "scenes/builder.h"

#include <atomic>
#include <string>

namespace penumbra {

struct RenderOptions {
    std::string scene;                ///< path; "-": standard input
    BuildOptions build;
    int replicates = 1;               ///< planes of the film
    int tileSize = 16;                ///< pixels; changes no bit
    RenderControls controls;
    std::string command;              ///< what the user typed, for the header of the picture
};

struct RenderProgress {
    std::atomic<std::uint64_t> tilesDone{0};
    std::uint64_t tiles = 0;
};

struct RenderTimes {
    double parse = 0, build = 0, render = 0;   ///< seconds
};

class RenderJob {
public:
    RenderJob(const RenderOptions& options, Warnings& warnings);
    /// A description made elsewhere (tests, tools) in the place of a file.
    RenderJob(SceneDescription description, const RenderOptions& options, Warnings& warnings);

    /// Renders all samples of all pixels.
    void run();
    /// One sample of one pixel of the whole picture, alone and in scalar, as run() would make it. Error(Usage) outside the crop window.
    Spectrum<float> replay(int x, int y, std::uint32_t sample) const;

    const Scene& scene() const { return scene_; }
    const Film& film() const { return film_; }
    const RenderCounts& counts() const { return counts_; }
    const RenderTimes& times() const { return times_; }
    const RenderProgress& progress() const { return progress_; }
    const RenderOptions& options() const { return options_; }

    /// By extension: .exr with the error and the header that repeats the picture; .png .jpg .tif ... through the default display
    /// transform; .hdr .pfm linear.
    void writePicture(const std::string& path) const;

private:
    void prepare(SceneDescription description, Warnings& warnings);

    RenderOptions options_;
    Scene scene_;
    Film film_;
    std::unique_ptr<Integrator> integrator_;
    RenderCounts counts_;
    RenderTimes times_;
    RenderProgress progress_;
};

/// Error(Usage) where the extension of an output path is unknown or its folder does not exist: asked before a long render.
void checkPicturePath(const std::string& path);

}  // namespace penumbra
