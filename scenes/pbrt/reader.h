// The reader of scenes in the pbrt-v4 text format (and of common habits of pbrt-v3 files).
//
// Errors: Error, the message beginning with "file:line:column: " and ending with how the file came to be included;
// MissingInput where a file cannot be opened, BadData else. Warnings begin with the place, too.
// Hostile input ends in an Error: see sources.h, values.h, parser.h for the limits.
#pragma once

#include "core/base/warnings.h"
#include "scenes/description.h"

#include <string>
#include <string_view>

namespace penumbra {

/// Reads a file (plain or gzip), or standard input where `path` is "-".
/// `root` as SceneDescription has it.
SceneDescription readPbrtFile(const std::string& path, Warnings& warnings, const std::string& root = {});

/// Reads a text; `name` stands for it in messages, other files are found from `folder`.
SceneDescription readPbrtText(std::string_view text, const std::string& name, const std::string& folder,
                              Warnings& warnings, const std::string& root = {});

}  // namespace penumbra
