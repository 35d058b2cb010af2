#include "app/commands/threads.h"

#include "app/commands/console.h"
#include "core/base/error.h"

#include <charconv>
#include <cstdlib>
#include <string>

namespace penumbra {

int chooseThreads(int asked) {
    if (asked > 0) return asked;
    for (const char* variable : {"SLURM_CPUS_PER_TASK", "CUE_THREADS"}) {
        const char* value = std::getenv(variable);
        if (!value || !*value) continue;
        const std::string text = value;
        int threads = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), threads);
        if (error == std::errc() && end == text.data() + text.size() && threads >= 1 && threads <= kMostThreads)
            return threads;
        printWarning(std::string(variable) + " is " + quote(text) + ", which is no number of threads; it is ignored");
    }
    return 0;
}

}  // namespace penumbra
