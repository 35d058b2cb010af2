// What fuzz targets hold the code to, beyond what the sanitizers see.
#pragma once

#include "core/base/error.h"
#include "core/base/warnings.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace penumbra::fuzz {

inline void require(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "fuzz: does not hold: %s\n", what);
    std::abort();
}

/// One line that a terminal can show.
inline void requireGoodMessage(std::string_view message) {
    const auto isShown = [](char c) { return static_cast<unsigned char>(c) >= 0x20; };
    require(!message.empty() && message.size() < 10000, "a message has a length for people");
    require(std::all_of(message.begin(), message.end(), isShown), "a message has no control characters");
}

inline void requireGoodWarnings(const Warnings& warnings) {
    for (const std::string& text : warnings.all())
        requireGoodMessage(text);
}

/// A wrong input is an error of the input.
inline void requireGoodError(const Error& e) {
    const ErrorKind kind = e.kind();
    require(kind == ErrorKind::BadData || kind == ErrorKind::MissingInput || kind == ErrorKind::NotPermitted ||
                kind == ErrorKind::OutOfMemory,
            "an input's error is the input's fault");
    requireGoodMessage(e.what());
}

/// Runs f(warnings) as one execution of a target; what goes wrong and what is warned of has to be good.
template <class Function>
int execute(Function&& f) {
    Warnings warnings;
    try {
        f(warnings);
    } catch (const Error& e) {
        requireGoodError(e);
    }
    requireGoodWarnings(warnings);
    return 0;
}

}  // namespace penumbra::fuzz
