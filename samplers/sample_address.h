// How random numbers are addressed: every number a path draws is a pure function of (pixel, sample index, vertex, dimension)
// and the render's seed, so samples may be made in any order, on any thread, and again.
//
// Conventions: `vertex` counts every step of a path, 0 at the camera, surfaces that are merely passed through included (it is
// not the counter that maxdepth limits). All lanes of a group stand at the same vertex, so it is a plain number.
#pragma once

#include "core/math/hash.h"
#include "core/math/vector.h"

namespace penumbra {

/// Named dimensions of one vertex. Pairs are drawn with get2, single numbers with get1.
enum class Dim : std::uint32_t { Filter, Lens, Time, LightPosition, Direction, Lobe, LightPick, Roulette, ShadowRoulette, Mix, Material };

/// One sample of one pixel. `seed` hashes (pixel, replicate, the render's seed); see addressOf.
template <class F>
struct SampleAddress {
    UInt<F> seed, index;
};

/// What all draws of one sample at one vertex share; each sampler prepares it in its own way (atVertex).
template <class F>
struct VertexAddress {
    UInt<F> seed, index;
    std::uint32_t vertex;
};

/// Sample i belongs to replicate plane i mod R and is point i / R of that plane's own randomisation. A bijection of the
/// pixel number for each plane, so no two pixels share a randomisation.
template <class F>
SampleAddress<F> addressOf(const UInt<F>& pixel, const UInt<F>& sample, std::uint32_t replicates, std::uint32_t seed) {
    if (replicates == 1) return {mixBits(pixel + UInt<F>(mixBits(seed ^ 0x5BD1E995u))), sample};
    UInt<F> plane, index;
    for (int i = 0; i < kLanes<F>; ++i) {
        setLane(plane, i, lane(sample, i) % replicates);
        setLane(index, i, lane(sample, i) / replicates);
    }
    return {mixBits(pixel + mixBits(plane * UInt<F>(0x9E3779B9u) + UInt<F>(mixBits(seed ^ 0x5BD1E995u)))), index};
}

/// The hash that tells apart the (vertex, dimension) pairs of one sample; a plain number for the whole group.
inline std::uint32_t dimensionKey(std::uint32_t vertex, std::uint32_t dim) {
    return mixBits(vertex * 0x2545F491u + dim * 0x9E3779B9u + 0x68E31DA4u);
}

}  // namespace penumbra
