// Unicode: canonical composition (Normalization Form C of Unicode Standard Annex 15), so that names which look alike are
// alike however an editor has written their accents.
//
// Thread safety: pure functions.
#pragma once

#include <string>
#include <string_view>

namespace penumbra {

/// The text in Normalization Form C; Error(BadData) where it is not UTF-8.
std::string composed(std::string_view utf8);

}  // namespace penumbra
