#include "app/commands/progress.h"

#include "app/batch/statistics.h"
#include "app/commands/console.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <ctime>

namespace penumbra {
namespace {

using namespace std::chrono_literals;
constexpr auto kRedraw = 200ms, kLine = 1000ms;

}  // namespace

std::string timeText() {
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

std::string durationText(double seconds) {
    const auto whole = std::int64_t(std::llround(std::fmin(std::fmax(seconds, 0), 1e9)));
    const std::int64_t hours = whole / 3600, minutes = whole / 60 % 60, rest = whole % 60;
    return hours ? fmt::format("{}:{:02}:{:02}", hours, minutes, rest) : fmt::format("{}:{:02}", minutes, rest);
}

ProgressDisplay::ProgressDisplay(const RenderJob& job, ProgressStyle style, int descriptor)
    : progress_(job.progress()),
      samplesPerPixel_(job.scene().samplesPerPixel),
      style_(style),
      descriptor_(descriptor),
      terminal_(errorIsTerminal()) {
    if (style_ == ProgressStyle::None) return;
    const Ticker::Pause pause = style_ == ProgressStyle::People && terminal_ ? kRedraw : kLine;
    ticker_ = std::make_unique<Ticker>(pause, [this, pause] {
        show(false);
        return pause;
    });
}

ProgressDisplay::~ProgressDisplay() {
    if (!ticker_) return;
    ticker_.reset();
    show(true);
}

void ProgressDisplay::show(bool last) {
    if (style_ == ProgressStyle::Json)
        printJson();
    else if (terminal_)
        drawBar(last);
    else
        printPercent(last);
}

double ProgressDisplay::elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

double ProgressDisplay::fraction() const {
    return progress_.samples ? double(progress_.samplesDone.load(std::memory_order_relaxed)) / double(progress_.samples)
                             : 1;
}

double ProgressDisplay::secondsLeft() const {
    const double done = fraction();
    return done > 0 ? elapsed() * (1 - done) / done : -1;
}

void ProgressDisplay::drawBar(bool last) {
    const double done = fraction(), left = secondsLeft();
    const double rate = double(progress_.samplesDone.load(std::memory_order_relaxed)) / std::fmax(elapsed(), 1e-3);
    const std::string time = last       ? " in " + durationText(elapsed())
                             : left < 0 ? std::string()
                                        : "  " + durationText(left) + " left";
    const std::string text = fmt::format(" {:3.0f}%  {} samples/s{}", std::floor(100 * done), countText(rate), time);
    const int room = errorColumns() - int(text.size()) - 4;
    const int width = std::clamp(room, 0, 40), filled = int(done * width);
    std::string bar =
        width >= 10 ? "[" + std::string(std::size_t(filled), '#') + std::string(std::size_t(width - filled), '.') + "]"
                    : "";
    printTo(STDERR_FILENO, "\r" + bar + text + "\x1b[K" + (last ? "\n" : ""));
}

void ProgressDisplay::printPercent(bool last) {
    const int percent = int(std::floor(100 * fraction()));
    if (percent == printedPercent_ || (last && percent < 100)) return;
    printedPercent_ = percent;
    printNote(fmt::format("Progress: {}%", percent));
}

void ProgressDisplay::printJson() {
    const double left = secondsLeft();
    const nlohmann::ordered_json line = {
        {"t", timeText()},
        {"event", "progress"},
        {"spp", fraction() * samplesPerPixel_},
        {"spp_target", samplesPerPixel_},
        {"fraction", fraction()},
        {"eta_s", left < 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(left)},
        {"rss", presentMemoryBytes()},
    };
    printTo(descriptor_, line.dump() + "\n");
}

}  // namespace penumbra
