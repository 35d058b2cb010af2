// Renderer: the library for programs of others, which find it by find_package(Penumbra). A scene file in, an estimate of
// every pixel with its error out.
//
//     penumbra::RendererSettings settings;
//     settings.samples = 64;
//     penumbra::Renderer renderer("cornell.pbrt", settings);
//     renderer.render();
//     const penumbra::Picture picture = renderer.picture();      // or renderer.write("cornell.exr")
//
// The picture is the one that `penumbra render` makes, to the bit: a function of the scene and the settings but for
// `threads`. This header and core/base/error.h are the whole public interface; they show nothing of the lanes within, whose
// layout depends on how Penumbra was compiled. The processor must know AVX2 (x86-64-v3), as the program says when it starts.
//
// Errors: Error, whose kind() is the exit code that the program would end with and whose text begins with
// "file:line:column: " where a scene is at fault. Thread safety: a Renderer belongs to one thread; one render at a time in a
// process uses its threads well.
#pragma once

#include "core/base/error.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace penumbra {

/// What is asked for against the scene file. Zero, empty or unset: as the file says.
struct RendererSettings {
    int samples = 0;              ///< per pixel
    int width = 0, height = 0;    ///< pixels; both or none
    std::optional<std::uint32_t> seed;
    std::string sampler, integrator;     ///< names that `penumbra list` knows
    std::optional<int> maxDepth;         ///< scattering events
    std::vector<std::string> overrides;  ///< "Film.iso=200" and the like, as the option -D takes them
    std::string root;                    ///< the only folder that files are read from; empty: any
    int replicates = 1;                  ///< independent randomisations whose spread gives the error
    int threads = 0;                     ///< 0: every processor; changes no bit
    bool strict = false;                 ///< a warning of reading or building the scene is an Error
};

/// Pixels row by row from the top left; values are linear RGB as the film's sensor gives them.
struct Picture {
    int x0 = 0, y0 = 0;              ///< of the first pixel in the whole picture (a crop window begins elsewhere)
    int width = 0, height = 0;
    std::vector<float> color;          ///< R G B of each pixel: the mean of its samples
    std::vector<float> standardError;  ///< R G B: of that mean; NaN where unknown (one sample)
    std::vector<float> alpha;
    std::vector<std::uint32_t> samples;
};

class Renderer {
public:
    /// Reads and builds the scene. "-" is standard input.
    explicit Renderer(const std::string& scene, const RendererSettings& settings = {});
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Called some ten times a second, on a thread of its own, with the fraction that is done; false ends the render early.
    /// It must not throw.
    using Progress = std::function<bool(double)>;

    /// Renders every sample of every pixel; a second call does nothing. False where `progress` ended it: the Renderer then
    /// holds no whole picture, and never will.
    bool render(const Progress& progress = {});

    Picture picture() const;
    /// By extension, as the program does: .exr with error and recipe; .png .jpg .tif for display; .hdr .pfm linear.
    void write(const std::string& path) const;
    /// R G B of one sample of one pixel of the whole picture, alone, as it goes into the mean; NaN where it is invalid.
    std::array<float, 3> sample(int x, int y, std::uint32_t index) const;

    const std::vector<std::string>& warnings() const;  ///< of reading and building the scene
    std::uint64_t invalidSamples() const;              ///< that were not finite and count as black

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace penumbra
