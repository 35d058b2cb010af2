// What tests look at in the files that a render leaves.
#pragma once

#include "core/image/exr.h"
#include "tests/run_program.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>

namespace penumbra {

/// The JSON of how the picture is made again.
inline std::string recipeText(const ExrFile& file) {
    for (const auto& [name, value] : file.header.attributes)
        if (name == "penumbra") return std::get<std::string>(value);
    ADD_FAILURE() << "no recipe";
    return "{}";
}

/// What ought not to be lost: names of temporary files have ".tmp." in them.
inline std::vector<std::string> leftovers(const std::string& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (contains(entry.path().filename().string(), ".tmp.")) names.push_back(entry.path().filename());
    return names;
}

/// Waits until that is true, for a minute at most.
inline bool waitUntil(const std::function<bool()>& isTrue) {
    using namespace std::chrono_literals;
    for (int i = 0; i < 6000; ++i) {
        if (isTrue()) return true;
        std::this_thread::sleep_for(10ms);
    }
    return false;
}

}  // namespace penumbra
