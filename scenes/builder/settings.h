// Everything before WorldBegin: film, camera, filter, sampler, integrator, with the command line's overrides applied.
#pragma once

#include "scenes/builder.h"
#include "scenes/builder/context.h"

namespace penumbra::builder {

/// The times between which the shutter is open.
struct Shutter {
    double open = 0, close = 1;
};

/// The film's colour space; srgb where the name is unknown (the reader has said so).
const ColorSpace& filmColorSpace(const SceneDescription& scene);

Shutter readShutter(const CameraEntity& camera, const BuildContext& context);
FilmSettings readFilm(const FilmEntity& film, Shutter shutter, const BuildOptions& options, BuildContext& context);
/// How much of a pixel the cone of a ray covers across, for the filtering of textures: the more samples there are, the
/// less each of them stands for.
float readConeScale(const ParameterSet& options, int samplesPerPixel);
Camera readCamera(const SceneDescription& scene, Shutter shutter, const FilmSettings& film, float coneScale,
                  const BuildOptions& options, BuildContext& context);
FilterSettings readFilter(const Entity& filter, BuildContext& context);
IntegratorSettings readIntegrator(const Entity& integrator, const BuildOptions& options, BuildContext& context);

struct SamplerChoice {
    Sampler sampler;
    int samplesPerPixel = 16;
    std::uint32_t seed = 0;
};
SamplerChoice readSampler(const SceneDescription& scene, const BuildOptions& options, BuildContext& context);

/// Warns of Option directives that would change the picture and are not there.
void readOptions(const ParameterSet& options, BuildContext& context);

}  // namespace penumbra::builder
