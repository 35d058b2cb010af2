// The ray roof: how much of what Embree alone could do rendering gets done.
//
// The rays that a render traces are recorded (ray_record.h), then traced again raw on the same threads, once in the
// packets of eight that rendering used and once one by one: no camera, shading, sorting or film. The faster of the two
// is the roof of any renderer that traces these rays through Embree, and rendering's samples per second are given as a
// fraction of it. (Small scenes are rendered without Embree, see core/geometry/face_list.h: there the fraction may be above
// one.) Rendering and the two replays take turns, in an order that changes from round to round, and each
// round gives a fraction of its own: so what the machine does meanwhile falls on all three alike.
//
// What is measured are whole tiles, with all their samples (at most kMostSamplesPerPixel a pixel), from all over the
// picture: as many as the memory for the rays holds. The three share out the same tiles to threads in the same way.
//
// Thread safety: one measurement at a time; it uses the threads that the process is limited to.
#pragma once

#include "app/batch/render_job.h"
#include "bench/lab/measure.h"
#include "bench/lab/ray_record.h"

namespace penumbra {

struct RayRoofOptions {
    std::size_t memoryBytes = std::size_t(512) << 20;  ///< for the rays
    int rounds = 5;
};

struct RayRoof {
    RayRoofOptions options;
    int threads = 0;
    std::size_t tiles = 0, tilesOfPicture = 0;
    std::uint32_t samplesPerPixel = 0;
    std::uint64_t samples = 0;       ///< of one round's rendering
    ReplayCounts rays;               ///< what they trace
    Spread render, packets, singly;  ///< samples per second
    bool packetsAreRoof = false;     ///< the better of the two, by its median
    Spread fraction;                 ///< of each round: rendering's rate divided by the roof's
    static constexpr std::uint32_t kMostSamplesPerPixel = 256;
};

/// Error(Usage) where the memory does not hold the rays of one tile; Error(Internal) where a replay finds other hits
/// than rendering did.
RayRoof measureRayRoof(const RenderJob& job, const RayRoofOptions& options);

}  // namespace penumbra
