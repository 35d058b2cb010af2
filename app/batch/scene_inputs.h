// SceneInputs: every file that a scene is made of, and the hash that says whether two scenes are one.
//
// The files are the texts that were read and whatever file a parameter of the scene names (images, meshes, measured
// spectra). The hash covers their contents and order, not where they lie or when they were written, and the texts
// inflated: a scene keeps its hash when its folder is moved or a text is compressed.
#pragma once

#include "scenes/description.h"

#include <string>
#include <vector>

namespace penumbra {

struct SceneInputs {
    std::vector<std::string> texts;   ///< as SceneDescription::files
    std::vector<std::string> assets;  ///< paths, in the order in which the scene first names them
    std::string hash;                 ///< SHA-256 of the digests of texts and assets, in hexadecimal
};

/// Reads the assets once, side by side on all threads. A file that cannot be read counts as an empty one: whoever needs
/// it says so.
SceneInputs findSceneInputs(const SceneDescription& scene);

}  // namespace penumbra
