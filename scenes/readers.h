// The readers of scene formats: which of them reads a file, by its extension.
//
// A new format is one file or folder beside pbrt/ and one entry of the table in readers.cpp.
// Errors: Error as the readers throw it (see pbrt/reader.h); BadData for an extension that no reader has.
// Thread safety: all functions may be called from several threads at once, each with its own Warnings.
#pragma once

#include "core/base/warnings.h"
#include "scenes/description.h"

#include <string>
#include <string_view>

namespace penumbra {

/// Reads a scene file. "-" is standard input; that and a name without extension are read as pbrt text. An extension .gz
/// after the format's own says that the file is compressed.
/// Where `root` is not empty, no file outside that folder is read (SceneDescription::root).
SceneDescription readScene(const std::string& path, Warnings& warnings, const std::string& root = {});

/// Reads a scene in the pbrt format from memory; `nameForMessages` stands for it in messages, the files that it names
/// are found from `folder`.
SceneDescription readSceneText(std::string_view text, const std::string& nameForMessages, const std::string& folder,
                               Warnings& warnings, const std::string& root = {});

}  // namespace penumbra
