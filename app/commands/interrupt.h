// What INT (Ctrl-C), TERM and HUP do.
//
// By default they end the process at once, with exit code 128 + signal: nothing is worth waiting for while a scene is
// read. While an InterruptGuard lives, the first of them only raises stopRequested(), so that a render ends where its
// film is whole and a file that is being written appears whole; a second one ends the process all the same. HUP stays
// ignored where whoever started the program ignored it (nohup).
#pragma once

#include <atomic>
#include <string>

namespace penumbra {

/// Thrown where a signal ended the work; main() turns it into the exit code.
struct Interrupted {
    int signal;
    std::string outcome;  ///< what became of the output
};

/// Call it once, before there are threads.
void installInterrupts();

/// Invariant: one at a time.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;
};

const std::atomic<bool>& stopRequested();
/// Throws Interrupted where a stop is requested.
void throwIfInterrupted(const std::string& outcome);

}  // namespace penumbra
