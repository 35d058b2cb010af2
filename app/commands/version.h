// What --version prints.
#pragma once

#include <string>

namespace penumbra {

/// The version of the program, how it was compiled, and a line for each library as it says itself at run time.
std::string versionText();

}  // namespace penumbra
