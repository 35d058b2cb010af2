// PartialWriter: keeps what there is of a picture on disk while it is rendered, for those who cannot wait or whose
// machine may die.
//
// Each file replaces the one before as a whole (AtomicFile), so whenever the process is killed, what stands there is a
// picture. An EXR says how much of it is done: "partial" in its header, and "samples" in every pixel. What cannot be
// written is told once and tried again; the render goes on. Writing takes at most a twentieth of the time.
#pragma once

#include "app/batch/render_job.h"
#include "core/base/ticker.h"

#include <functional>
#include <string>

namespace penumbra {

class PartialWriter {
public:
    /// From now on, every so many seconds. The job was made with RenderOptions::isWatched and outlives this object;
    /// `warn` is called on another thread. Error(Usage) for a path that is no regular file, as those keep what was
    /// written before.
    PartialWriter(const RenderJob& job, const std::string& path, double seconds,
                  std::function<void(const std::string&)> warn);

private:
    Ticker::Pause write();

    const RenderJob& job_;
    const std::string path_;
    const double seconds_;
    const std::function<void(const std::string&)> warn_;
    bool warned_ = false;
    Ticker ticker_;  // last: it uses all above
};

}  // namespace penumbra
