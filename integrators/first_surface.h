// AOVs: what paths see at the first surface that is more than a border of media. The batch driver asks for it where a film
// wants it; whatever integrator then makes of the hit, the AOVs are the same.
//
// Compiled once, for one lane and for eight, and not with every integrator: it is off the hot way.
#pragma once

#include "core/geometry/surface_point.h"
#include "integrators/path_batch.h"

namespace penumbra {

/// Adds to film.aovs() what those of the group's paths see that meet their first surface. `tag`: of the materials, none that
/// lets paths pass. Thread safety and determinism as Film::add.
template <class F>
void recordFirstSurface(const Scene& scene, const SlotBuffer& slots, const RayGroup<F>& g, const Hit<F>& hit, const UInt<F>& material,
                        unsigned tag, Film& film) noexcept;

extern template void recordFirstSurface<float>(const Scene&, const SlotBuffer&, const RayGroup<float>&, const Hit<float>&,
                                               const UInt<float>&, unsigned, Film&) noexcept;
extern template void recordFirstSurface<Lanes8f>(const Scene&, const SlotBuffer&, const RayGroup<Lanes8f>&, const Hit<Lanes8f>&,
                                                 const UInt<Lanes8f>&, unsigned, Film&) noexcept;

}  // namespace penumbra
