// Overrides of scene settings from a command line: "Film.iso=200" sets a parameter of a directive, "Camera=spherical" its
// type and drops the parameters of the old one.
//
// What may be overridden stands before WorldBegin: Camera, Film, PixelFilter, Sampler, Integrator. Several numbers are
// separated by commas. Of several overrides of one thing the last counts. Messages of the builder name an override as
// the place of its value: the description's table of files gains an entry "-D Film.iso=200" without a digest.
// Errors: Error(Usage) here for a form or a directive that is unknown; in the builder for a parameter that nothing asks
// for and for a value of the wrong type. Thread safety: plain functions.
#pragma once

#include "scenes/description.h"

#include <span>
#include <string>

namespace penumbra {

void applyOverrides(SceneDescription& scene, std::span<const std::string> overrides);

}  // namespace penumbra
