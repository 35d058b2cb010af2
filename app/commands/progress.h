// The progress of a render, shown by a thread of its own while the render runs.
//
// For people, on standard error: a bar that redraws on a terminal; otherwise lines "Progress: 42%", at most one a
// second, a form that render farms parse. For programs: one JSON object a line, once a second, on a descriptor of their
// choice:
//   {"t": RFC 3339, "event": "progress", "spp": samples per pixel so far, "spp_target", "fraction", "eta_s", "rss":
//   bytes}
// The time left assumes that the rest goes as fast as what is done; the order of tiles makes that nearly true.
#pragma once

#include "app/batch/render_job.h"
#include "core/base/ticker.h"

#include <chrono>
#include <memory>
#include <string>

namespace penumbra {

enum class ProgressStyle { None, People, Json };

class ProgressDisplay {
public:
    /// `descriptor`: of the JSON lines. The job must outlive this object.
    ProgressDisplay(const RenderJob& job, ProgressStyle style, int descriptor);
    /// Shows the last state; leaves the cursor on a line of its own.
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

private:
    void show(bool last);
    void drawBar(bool last);
    void printPercent(bool last);
    void printJson();

    double elapsed() const;
    double fraction() const;
    /// Seconds; negative where nothing is known yet.
    double secondsLeft() const;

    const RenderProgress& progress_;
    const int samplesPerPixel_;
    const ProgressStyle style_;
    const int descriptor_;
    const bool terminal_;
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    int printedPercent_ = -1;
    std::unique_ptr<Ticker> ticker_;  // last: it uses all above
};

/// Now, as "2026-11-26T01:02:03Z".
std::string timeText();

/// "0:07", "12:34", "2:03:04".
std::string durationText(double seconds);

}  // namespace penumbra
