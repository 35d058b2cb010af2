// The renderer that the closed-form suites judge: scene text through the reader, the builder and the render job that
// the program uses.
#pragma once

#include "tests/proof/closed_form.h"

namespace penumbra {

/// Reads, builds and renders the scene, its files in a temporary folder. Throws Error where that fails, a warning
/// included; a picture with samples that are not finite has a mean of NaN, which no test accepts.
///
/// Thread safety: the function returned may be called from one thread at a time.
PictureMean pictureMeanOfRenders();

}  // namespace penumbra
