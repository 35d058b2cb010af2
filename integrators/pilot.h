// A first look at a scene, for decisions that only cost time where they are wrong.
#pragma once

#include "integrators/integrator.h"

namespace penumbra {

/// How bright the picture typically is, as radiance in the film's RGB: the squared mean of the root of its brightest channel,
/// which a few very bright spots do not move. From a thousand paths of `integrator` that are spread over the whole picture,
/// crop window or not: a function of scene and settings alone. 0 where they find no light.
float typicalRadiance(const Scene& scene, const Integrator& integrator);

}  // namespace penumbra
