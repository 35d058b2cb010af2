// Small pieces of text work that cold code shares.
#pragma once

#include "core/base/error.h"

#include <string>
#include <string_view>

namespace penumbra {

/// ASCII letters in lower case, whatever the locale.
inline std::string lowerCase(std::string_view text) {
    std::string out(text);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return out;
}

/// A path as a message begins with it: control characters escaped, cut where no system would take it.
inline std::string pathText(std::string_view path) {
    constexpr std::size_t kLongestPath = 4096;
    const std::string quoted = quote(path, kLongestPath);
    return quoted.substr(1, quoted.size() - 2);
}

}  // namespace penumbra
