// ASCII letter case, whatever the locale.
#pragma once

#include <string>
#include <string_view>

namespace penumbra {

inline std::string lowerCase(std::string_view text) {
    std::string out(text);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return out;
}

}  // namespace penumbra
