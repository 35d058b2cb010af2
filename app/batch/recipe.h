// The recipe of a picture: what it takes to render the same bits again. It is the attribute "penumbra" of every EXR.
//
// A recipe holds nothing that changes from run to run (times, threads, the name of the picture), so that the same
// picture has the same header on every machine.
#pragma once

#include "app/batch/render_job.h"

#include <string>

namespace penumbra {

/// The command line that renders the same picture, as a shell takes it: the scene and the options that change bits.
std::string repeatCommand(const RenderOptions& options);
/// The command line that replays one sample; the pixel is one of the film.
std::string replayCommand(const RenderJob& job, InvalidSample sample);

/// A JSON object.
std::string recipeJson(const RenderJob& job);

/// "bvh", "power" or "uniform", as --light-selection takes it.
const char* lightSelectionName(LightSelection selection);

}  // namespace penumbra
