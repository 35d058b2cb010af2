#include "app/batch/partial_writer.h"

#include "core/base/error.h"
#include "core/base/text.h"

#include <algorithm>
#include <filesystem>

namespace penumbra {
namespace {

std::string replaceable(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
        throw Error(ErrorKind::Usage,
                    pathText(path) + ": is no regular file, so no picture can be kept there while it is rendered");
    return path;
}

Ticker::Pause pauseOf(double seconds) {
    return Ticker::Pause(std::int64_t(1e3 * seconds));
}

}  // namespace

PartialWriter::PartialWriter(const RenderJob& job, const std::string& path, double seconds,
                             std::function<void(const std::string&)> warn)
    : job_(job), path_(replaceable(path)), seconds_(seconds), warn_(std::move(warn)), ticker_(pauseOf(seconds), [this] {
          return write();
      }) {}

Ticker::Pause PartialWriter::write() {
    constexpr double kShare = 1.0 / 20;
    const auto start = std::chrono::steady_clock::now();
    std::string failure;
    try {
        job_.writePicture(path_);
    } catch (const std::exception& e) {
        failure = e.what();
    }
    if (!failure.empty() && !std::exchange(warned_, true)) warn_(failure + "; the render goes on and will try again");
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return pauseOf(std::max(seconds_, took * (1 / kShare - 1)));
}

}  // namespace penumbra
