// Parallel loops. With parallel.cpp the only file that knows TBB.
//
// The number of threads is set once, for the process, by ThreadLimit; Embree's builds obey it too.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace penumbra {

/// While it lives, at most `threads` threads work (0: one per processor that this process may use).
class ThreadLimit {
public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

    static int available();   ///< processors that this process may use
    static int current();     ///< threads that loops run on now

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// "oneTBB 2021.8.0", as the library says at run time.
std::string parallelLibraryVersion();

/// Calls task(i) for every i in [0, count), each once, in any order and on any thread. Tasks are handed out one by one, so
/// make them big. The tasks must not throw.
void parallelFor(std::size_t count, const std::function<void(std::size_t)>& task);

}  // namespace penumbra
