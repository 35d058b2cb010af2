// What a render took and how good its picture is, for people (--stats) and for programs (--stats=json).
//
// Units: seconds, bytes. Thread safety: plain data.
#pragma once

#include "app/batch/render_job.h"

#include <array>
#include <cstdint>
#include <string>

namespace penumbra {

/// The standard error of a picture as one number: the root of the mean square over pixels and channels whose error is
/// known.
struct PictureError {
    double rootMeanSquare = 0;
    double mean = 0;                  ///< of all pixels and channels
    double relative = 0;              ///< to the mean; 0 for a black picture
    std::uint64_t unknownPixels = 0;  ///< pixels with a channel of unknown error
    bool isKnown = false;             ///< of any pixel
};
PictureError pictureError(const Film& film);
/// "1.2 % of the mean".
std::string errorText(const PictureError& error);

/// What a limit on samples (--clamp, the film's maxcomponentvalue) does to a picture: it becomes too dark.
struct ClampBias {
    float limit = kInfinity;                ///< infinity: none, and so no bias
    std::uint64_t samples = 0;              ///< that were above the limit
    std::array<double, 3> meanLost{0, 0, 0};  ///< an unbiased estimate of what is missing from the picture's mean, by channel
    /// To the mean that the picture, which has this one, should have: of all channels together.
    double relativeTo(double pictureMean) const;
};
ClampBias clampBias(const RenderJob& job);
/// "3 samples limited to 10: on average the picture is too dark by 1.2 %".
std::string clampText(const ClampBias& bias, const PictureError& error);

struct RenderStatistics {
    RenderTimes times;
    int threads = 0;
    RenderCounts counts;
    double samplesPerSecond = 0, raysPerSecond = 0;  ///< of rendering alone; rays: to surfaces and to lights together
    double meanLiveLanes = 0;                        ///< of a shading call
    std::size_t filmBytes = 0, geometryBytes = 0, textureBytes = 0;
    std::uint64_t peakMemoryBytes = 0;  ///< of the process so far
    PictureError error;
    ClampBias clamp;
};
/// REQUIRES: the job has run.
RenderStatistics statisticsOf(const RenderJob& job);

/// Lines for people, each ending in a line feed.
std::string statisticsText(const RenderStatistics& statistics);
/// One JSON object without line feeds; `job` gives the recipe beside it.
std::string statisticsJson(const RenderStatistics& statistics, const RenderJob& job);

/// "1.5 GiB", "3.58 M": three digits and a prefix, of 1024 for bytes and of 1000 for counts.
std::string bytesText(double bytes);
std::string countText(double count);

/// The largest and the present memory of the process that is held in RAM.
std::uint64_t peakMemoryBytes();
std::uint64_t presentMemoryBytes();

}  // namespace penumbra
