#include "core/base/module.h"

#include "core/base/error.h"

#include <dlfcn.h>

#include <fmt/format.h>

#include <cfenv>
#include <filesystem>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

/// Where the module lies; its bare name, for the dynamic loader to find, where it is in none of our folders.
std::string locate(const std::string& file) {
    std::error_code none;
    const fs::path folder = fs::read_symlink("/proc/self/exe", none).parent_path();
    if (!none)
        for (const fs::path& candidate : {folder / file, folder / PENUMBRA_MODULE_FOLDER / file})
            if (fs::exists(candidate, none)) return candidate.string();
    return file;
}

std::string lastReason() {
    const char* reason = ::dlerror();
    return reason ? reason : "the dynamic loader gives no reason";
}

[[noreturn]] void refuse(const std::string& file, const std::string& reason) {
    throw Error(ErrorKind::Configuration,
                fmt::format("Penumbra's module {} cannot be loaded: {} (it belongs beside the program or in {} from "
                            "there; LD_LIBRARY_PATH may name another folder)",
                            file, reason, PENUMBRA_MODULE_FOLDER));
}

}  // namespace

void* loadModuleFunction(const std::string& file, const char* symbol) {
    // Libraries compiled for fast mathematics flush denormal numbers from their start on, in the thread that loads
    // them: a picture must not depend on that.
    std::fenv_t floatingPoint;
    std::fegetenv(&floatingPoint);
    void* const module = ::dlopen(locate(file).c_str(), RTLD_LAZY | RTLD_LOCAL);
    std::fesetenv(&floatingPoint);
    if (!module) refuse(file, lastReason());
    void* const address = ::dlsym(module, symbol);
    if (!address) refuse(file, lastReason());
    return address;
}

}  // namespace penumbra
