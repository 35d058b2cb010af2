// Integrator: what turns rays into radiance. One file a type; see integrators/registry.h.
//
// An integrator renders the samples [begin, end) of the pixels of one tile into the film. It is given the tile for itself,
// so it may add to the film's pixels of that tile without locks.
// Thread safety: render() is const and runs on many threads at once, on different tiles.
#pragma once

#include "core/film/clamp.h"
#include "scenes/scene.h"

#include <memory>
#include <vector>

namespace penumbra {

/// Pixels of the film (crop window coordinates), upper ends exclusive.
struct Tile {
    int x0, y0, x1, y1;
};

struct SampleRange {
    std::uint32_t begin, end;
};

/// A sample that became black because its value was not finite or beyond the sums' range.
struct InvalidSample {
    std::uint32_t pixel, sample;
};

/// What one call counted. Counts of different calls add up.
struct RenderCounts {
    std::uint64_t paths = 0, rays = 0, shadowRays = 0;
    std::uint64_t groups = 0, liveLanes = 0;           ///< shading calls, and lanes that were live in them
    std::uint64_t invalid = 0;
    std::vector<InvalidSample> firstInvalid;           ///< at most kMostInvalid, the lowest (pixel, sample) first
    static constexpr std::size_t kMostInvalid = 16;
    ClampedLight clamped;                              ///< what FilmSettings::maxComponent took from valid samples

    void add(const RenderCounts& other);
    void addInvalid(InvalidSample s);
};

/// Where rays are copied to while they are traced (ray_roof); eight at a time with their live lanes.
class RayRecorder {
public:
    virtual ~RayRecorder() = default;
    virtual void nearest(const RayHitPacket& rays, unsigned live, Coherence coherence) = 0;
    virtual void shadow(const RayPacket& rays, unsigned live) = 0;
};

struct RenderControls {
    int lanes = 8;                  ///< 8, or 1: the same source in scalar, the same bits, for replay and debugging
    int batchSize = 1024;           ///< paths in flight per thread; at most kMaxBatch; no bit depends on it
    RayRecorder* recorder = nullptr;
};
inline constexpr int kMaxBatch = 4096;

class Integrator {
public:
    virtual ~Integrator() = default;
    virtual void render(const Scene& scene, const Tile& tile, SampleRange samples, const RenderControls& controls, Film& film,
                        RenderCounts& counts) const noexcept = 0;
};

}  // namespace penumbra
