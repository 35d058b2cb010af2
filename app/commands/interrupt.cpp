#include "app/commands/interrupt.h"

#include <unistd.h>

#include <csignal>
#include <initializer_list>

namespace penumbra {
namespace {

// Read and written by the handler.
std::atomic<bool> guarded{false}, stop{false};
std::atomic<int> received{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void onSignal(int signal) {
    if (!guarded || received.exchange(signal) != 0) ::_exit(128 + signal);
    stop = true;
}

}  // namespace

void installInterrupts() {
    struct sigaction action = {};
    action.sa_handler = onSignal;
    action.sa_flags = SA_RESTART;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction before = {};
        ::sigaction(signal, nullptr, &before);
        if (signal != SIGHUP || before.sa_handler != SIG_IGN) ::sigaction(signal, &action, nullptr);
    }
}

InterruptGuard::InterruptGuard() {
    guarded = true;
}
InterruptGuard::~InterruptGuard() {
    guarded = false;
}

const std::atomic<bool>& stopRequested() {
    return stop;
}

void throwIfInterrupted(const std::string& outcome) {
    if (stop) throw Interrupted{received, outcome};
}

}  // namespace penumbra
