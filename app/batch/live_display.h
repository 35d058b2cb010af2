// LiveDisplay: shows a picture in a viewer while it is rendered, over TCP, in the protocol that tev listens to.
//
// One connection, one way. A packet is its length in bytes (itself included) as a 32-bit integer, its type as one byte,
// and what belongs to the type; numbers are little-endian, strings end in a zero byte. We send "create image" once,
// then "update" for the parts that have changed since they were last sent: all of it in a thread of its own that reads
// the film by tiles. The queue is what has changed, so it cannot grow; the render never waits for the viewer. A viewer
// that is not there, goes away or takes nothing is told once and tried again; then the image is created anew.
#pragma once

#include "app/batch/render_job.h"
#include "core/base/ticker.h"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

struct DisplayAddress {
    static constexpr int kStandardPort = 14158;
    std::string host = "127.0.0.1", port = std::to_string(kStandardPort);
};
/// "host:port", "host", "[::1]:port". Error(Usage) where the port is none.
DisplayAddress parseDisplayAddress(const std::string& text);

/// How long the viewer may keep us waiting (looking its name up may take as long again as the system likes): to take us
/// on, to take anything at all, until we try again, and in all when the render is done.
struct DisplayPatience {
    std::chrono::milliseconds connect{1000}, send{2000}, retry{3000}, close{5000};
};

class LiveDisplay {
public:
    /// The job was made with RenderOptions::isWatched and outlives this object. `name`: of the image in the viewer.
    /// `warn` is called on another thread.
    LiveDisplay(const RenderJob& job, const DisplayAddress& address, std::string name,
                std::function<void(const std::string&)> warn, const DisplayPatience& patience = {});
    /// Of a job that is whole it sends what is left.
    ~LiveDisplay();
    LiveDisplay(const LiveDisplay&) = delete;
    LiveDisplay& operator=(const LiveDisplay&) = delete;

private:
    using Clock = std::chrono::steady_clock;
    class Connection;
    struct Part {
        Tile window;
        std::uint64_t sent = 0;  ///< state() of what was sent last
    };

    Ticker::Pause work();
    void update();
    void connect();
    void report(const std::string& why);
    void send(Part& part);
    std::uint64_t state(const Tile& window) const;

    const RenderJob& job_;
    const DisplayAddress address_;
    const std::string name_;
    const std::function<void(const std::string&)> warn_;
    const DisplayPatience patience_;
    std::vector<Part> parts_;
    std::unique_ptr<Connection> connection_;  ///< none: not connected
    bool warned_ = false;
    std::atomic<Clock::time_point> deadline_{Clock::time_point::max()};  ///< behind which nothing is waited for
    std::unique_ptr<Ticker> ticker_;                                     // last: it uses all above
};

}  // namespace penumbra
