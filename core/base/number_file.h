// Text files of numbers: measured spectra, prescriptions of lenses.
//
// Numbers stand between white space and commas; a # begins a comment. Errors: Error(MissingInput), or Error(BadData)
// that names file, line and column. Thread safety: plain functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// All numbers of the file, in order. `what` is what a file of more than 8 MiB is not: "spectrum".
std::vector<float> readNumbers(const std::string& path, std::string_view what);

}  // namespace penumbra
