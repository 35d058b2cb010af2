// Ticker: work that is done now and then, on a thread of its own, while something else goes on.
//
// The destructor lets a call in progress end and makes no other. Thread safety: one Ticker belongs to one thread; the
// work runs on another.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace penumbra {

class Ticker {
public:
    using Pause = std::chrono::milliseconds;

    /// Calls `work` after `first`, and after each call again when the pause that it returned is over. It must not
    /// throw.
    Ticker(Pause first, std::function<Pause()> work)
        : work_(std::move(work)), thread_([this, first] { loop(first); }) {}
    ~Ticker() {
        {
            const std::lock_guard lock(mutex_);
            ended_ = true;
        }
        wake_.notify_one();
        thread_.join();
    }
    Ticker(const Ticker&) = delete;
    Ticker& operator=(const Ticker&) = delete;

private:
    void loop(Pause pause) {
        std::unique_lock lock(mutex_);
        while (!wake_.wait_for(lock, pause, [this] { return ended_; })) {
            lock.unlock();
            pause = work_();
            lock.lock();
        }
    }

    const std::function<Pause()> work_;
    std::mutex mutex_;
    std::condition_variable wake_;
    bool ended_ = false;
    std::thread thread_;  // last: the loop uses all above
};

}  // namespace penumbra
