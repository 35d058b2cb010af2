#include "app/batch/live_display.h"

#include "app/batch/pixels.h"
#include "core/base/error.h"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>

namespace penumbra {
namespace {

using std::chrono::milliseconds;

constexpr std::string_view kChannels[] = {"R", "G", "B", "A"};
constexpr int kPartSize = 128;  ///< pixels
constexpr milliseconds kPause{250};

/// A message in the making.
class Packet {
public:
    enum class Type : char { Create = 4, Update = 5 };
    Packet(Type type, const std::string& image) : bytes_(sizeof(std::uint32_t), '\0') {
        bytes_ += char(type);
        bytes_ += '\0';  // do not raise the viewer's window
        text(image);
    }
    void number(std::int32_t n) { append(&n, sizeof n); }
    void text(std::string_view t) {
        bytes_.append(t);
        bytes_ += '\0';
    }
    void channels() {
        number(std::int32_t(std::size(kChannels)));
        for (const std::string_view name : kChannels)
            text(name);
    }
    void floats(const std::vector<float>& values) { append(values.data(), values.size() * sizeof(float)); }
    const std::string& finish() {
        const auto size = std::uint32_t(bytes_.size());
        std::memcpy(bytes_.data(), &size, sizeof size);
        return bytes_;
    }

private:
    void append(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
    std::string bytes_;
};

/// What keeps us from the viewer; it never leaves this file.
struct Unreachable {
    std::string why;
};

[[noreturn]] void failNow(const char* what, int reason) {
    throw Unreachable{std::string(what) + ": " + std::strerror(reason)};
}

}  // namespace

DisplayAddress parseDisplayAddress(const std::string& text) {
    DisplayAddress address;
    const std::size_t bracket = text.rfind(']'), colon = text.rfind(':');
    const bool hasPort = colon != std::string::npos && (bracket == std::string::npos || colon > bracket);
    std::string host = text.substr(0, hasPort ? colon : text.size());
    if (host.size() >= 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
    if (!host.empty()) address.host = host;
    if (hasPort) address.port = text.substr(colon + 1);
    int port = 0;
    const char* end = address.port.data() + address.port.size();
    const auto [stop, error] = std::from_chars(address.port.data(), end, port);
    if (text.empty() || error != std::errc() || stop != end || port < 1 || port > 65535 ||
        address.host.find('\0') != std::string::npos)
        throw Error(ErrorKind::Usage, quote(text) + " is not HOST:PORT with a port from 1 to 65535");
    return address;
}

/// A socket that waits for nobody longer than it is told. Throws Unreachable.
class LiveDisplay::Connection {
public:
    Connection(const DisplayAddress& address, milliseconds patience, const std::atomic<Clock::time_point>& deadline)
        : deadline_(deadline) {
        addrinfo hints{}, *found = nullptr;
        hints.ai_socktype = SOCK_STREAM;
        hints.ai_flags = AI_NUMERICSERV;
        if (const int result = ::getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found))
            throw Unreachable{::gai_strerror(result)};
        const std::unique_ptr<addrinfo, void (*)(addrinfo*)> all(found, ::freeaddrinfo);
        int reason = ECONNREFUSED;
        for (const addrinfo* a = found; a && socket_ < 0; a = a->ai_next)
            if (!tryToConnect(*a, patience)) {
                reason = errno;
                close();
            }
        if (socket_ < 0) failNow("cannot connect", reason);
    }
    ~Connection() { close(); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    void send(std::string_view bytes, milliseconds patience) {
        while (!bytes.empty()) {
            waitFor(POLLOUT, patience);
            const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent >= 0)
                bytes.remove_prefix(std::size_t(sent));
            else if (errno != EAGAIN && errno != EINTR)
                failNow("cannot send", errno);
        }
    }
    /// Throws where the viewer has left.
    void check() const {
        char ignored;
        const ssize_t got = ::recv(socket_, &ignored, 1, MSG_PEEK);
        if (got == 0) throw Unreachable{"it closed the connection"};
        if (got < 0 && errno != EAGAIN && errno != EINTR) failNow("it left", errno);
    }
    /// No more comes; waits until the viewer has read it all and closes, too. It need not say so.
    void finish(milliseconds patience) {
        ::shutdown(socket_, SHUT_WR);
        char ignored[256];
        try {
            do
                waitFor(POLLIN, patience);
            while (::recv(socket_, ignored, sizeof ignored, 0) > 0);
        } catch (const Unreachable&) {
        }
    }

private:
    bool tryToConnect(const addrinfo& a, milliseconds patience) {
        socket_ = ::socket(a.ai_family, a.ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, a.ai_protocol);
        if (socket_ < 0) return false;
        if (::connect(socket_, a.ai_addr, a.ai_addrlen) == 0) return true;
        if (errno != EINPROGRESS && errno != EINTR) return false;
        try {
            waitFor(POLLOUT, patience);
        } catch (const Unreachable&) {
            errno = ETIMEDOUT;
            return false;
        }
        int result = 0;
        socklen_t size = sizeof result;
        ::getsockopt(socket_, SOL_SOCKET, SO_ERROR, &result, &size);
        errno = result;
        return result == 0;
    }
    void waitFor(short event, milliseconds patience) {
        constexpr milliseconds kSlice{50};  // after which it looks whether the deadline has been moved
        const Clock::time_point end = Clock::now() + patience;
        while (true) {
            if (Clock::now() >= deadline_.load()) throw Unreachable{"it takes too long"};
            pollfd p{socket_, event, 0};
            const int ready = ::poll(&p, 1, int(kSlice.count()));
            if (ready > 0) return;
            if (ready < 0 && errno != EINTR) failNow("cannot wait", errno);
            if (Clock::now() >= end) throw Unreachable{"it takes nothing"};
        }
    }
    void close() {
        if (socket_ >= 0) ::close(socket_);
        socket_ = -1;
    }

    const std::atomic<Clock::time_point>& deadline_;
    int socket_ = -1;
};

LiveDisplay::LiveDisplay(const RenderJob& job, const DisplayAddress& address, std::string name,
                         std::function<void(const std::string&)> warn, const DisplayPatience& patience)
    : job_(job), address_(address), name_(std::move(name)), warn_(std::move(warn)), patience_(patience) {
    const int width = job.film().crop().width(), height = job.film().crop().height();
    for (int y = 0; y < height; y += kPartSize)
        for (int x = 0; x < width; x += kPartSize)
            parts_.push_back({{x, y, std::min(x + kPartSize, width), std::min(y + kPartSize, height)}});
    ticker_ = std::make_unique<Ticker>(milliseconds(0), [this] { return work(); });
}

LiveDisplay::~LiveDisplay() {
    const bool whole = job_.isWhole();
    deadline_ = Clock::now() + (whole ? patience_.close : milliseconds(0));
    ticker_.reset();
    const bool isGone = warned_ && !connection_;
    if (!whole || isGone) return;
    try {
        update();
        connection_->finish(patience_.close);
    } catch (const Unreachable& e) {
        report(e.why);
    }
}

Ticker::Pause LiveDisplay::work() {
    try {
        update();
        return kPause;
    } catch (const Unreachable& e) {
        connection_.reset();
        if (Clock::now() < deadline_.load()) report(e.why);
        return patience_.retry;
    }
}

void LiveDisplay::report(const std::string& why) {
    if (!std::exchange(warned_, true))
        warn_("the display server " + address_.host + ":" + address_.port + " cannot be reached: " + why +
              "; the picture does not depend on it");
}

/// Sends every part that has changed.
void LiveDisplay::update() {
    if (!connection_) connect();
    connection_->check();
    for (Part& part : parts_)
        if (state(part.window) != part.sent) send(part);
}

void LiveDisplay::connect() {
    connection_ = std::make_unique<Connection>(address_, patience_.connect, deadline_);
    Packet packet(Packet::Type::Create, name_);
    packet.number(job_.film().crop().width());
    packet.number(job_.film().crop().height());
    packet.channels();
    connection_->send(packet.finish(), patience_.send);
    for (Part& part : parts_)
        part.sent = 0;
}

void LiveDisplay::send(Part& part) {
    const Tile& w = part.window;
    const std::size_t pixels = std::size_t(w.x1 - w.x0) * std::size_t(w.y1 - w.y0);
    const std::uint64_t before = state(w);
    std::vector<float> planes(std::size(kChannels) * pixels);
    visitPixels(job_, w, [&](std::size_t to, std::size_t pixel) {
        const PixelEstimate e = job_.film().estimate(pixel);
        for (std::size_t c = 0; c < 3; ++c)
            planes[c * pixels + to] = float(e.mean[c]);
        planes[3 * pixels + to] = float(e.alpha);
    });
    Packet packet(Packet::Type::Update, name_);
    packet.channels();
    for (const int n : {w.x0, w.y0, w.x1 - w.x0, w.y1 - w.y0})
        packet.number(n);
    packet.floats(planes);
    connection_->send(packet.finish(), patience_.send);
    part.sent = before;
}

/// A number that grows with every sample: all pixels of a tile have equally many.
std::uint64_t LiveDisplay::state(const Tile& window) const {
    std::uint64_t samples = 0;
    job_.visitTiles(window, [&](const Tile& t) {
        samples += job_.film().samples(std::size_t(t.y0) * std::size_t(job_.film().crop().width()) + std::size_t(t.x0));
    });
    return samples;
}

}  // namespace penumbra
