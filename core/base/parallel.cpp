#include "core/base/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/version.h>

#ifdef PENUMBRA_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace penumbra {

struct ThreadLimit::State {
    tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads)
    : state_(new State{tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                           std::size_t(threads > 0 ? threads : available()))}) {}
ThreadLimit::~ThreadLimit() = default;

int ThreadLimit::available() { return tbb::info::default_concurrency(); }
int ThreadLimit::current() { return int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)); }

std::string parallelLibraryVersion() { return std::string("oneTBB ") + TBB_runtime_version(); }

void parallelFor(std::size_t count, const std::function<void(std::size_t)>& task) {
    // TBB itself is not instrumented: under the thread sanitizer the loop's start and end are declared by hand, and what
    // tasks do to each other is still checked.
#ifdef PENUMBRA_TSAN
    char begin, end;
    __tsan_release(&begin);
#endif
    // An arena of its own: that of the calling thread never has more workers than the machine has processors.
    tbb::task_arena arena(ThreadLimit::current());
    arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, count, 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
#ifdef PENUMBRA_TSAN
                __tsan_acquire(&begin);
#endif
                for (std::size_t i = range.begin(); i != range.end(); ++i) task(i);
#ifdef PENUMBRA_TSAN
                __tsan_release(&end);
#endif
            },
            tbb::simple_partitioner());
    });
#ifdef PENUMBRA_TSAN
    __tsan_acquire(&end);
#endif
}

}  // namespace penumbra
