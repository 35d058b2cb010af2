#include "app/commands/version.h"

#include "core/base/byte_reader.h"
#include "core/base/parallel.h"
#include "core/base/sha256.h"
#include "core/base/version.h"
#include "core/color/display.h"
#include "core/geometry/accelerator.h"
#include "core/image/image_io.h"

#include <fmt/format.h>
#include <CLI/Version.hpp>
#include <nlohmann/json.hpp>

namespace penumbra {

std::string versionText() {
    std::string text = fmt::format("penumbra {} ({}, {})\n", kVersion,
                                   kNativeBuild ? "compiled for this machine alone" : "x86-64-v3", __VERSION__);
    const std::string json = fmt::format("nlohmann-json {}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                         NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH);
    const std::string format =
        fmt::format("fmt {}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100);
    for (const std::string& library :
         {Accelerator::libraryVersion(), parallelLibraryVersion(), imageLibraryVersion(), exrLibraryVersion(),
          displayLibraryVersion(), Sha256::libraryVersion(), ByteReader::libraryVersion(),
          std::string("CLI11 ") + CLI11_VERSION, format, json})
        text += library + "\n";
    return text;
}

}  // namespace penumbra
