// LightMasks: which area lights have holes (an alpha between 0 and 1, or a texture of it), for light sampling.
//
// A ray that meets such a light has met the part that is there, and sees all of its emission; a sampled point sheds alpha times
// as much. So both strategies expect alpha times the emission, and multiple importance sampling may mix them as ever. (PBRT-v4
// decides a sampled point by a hash and a point that was met a second time, so there it depends on the strategy.)
// Shapes whose alpha is the number 0 are no part of this: no ray meets them, and all their light is sampled.
//
// Thread safety: immutable once built. Invariant: ids of lights that were never added are whole.
#pragma once

#include "core/geometry/geometry.h"
#include "core/image/texture.h"

namespace penumbra {

class LightMasks {
public:
    /// The lights of a shape, `first` and those after it.
    void add(std::uint32_t first, std::uint32_t count, std::uint32_t shape);

    bool empty() const { return shapes_.empty(); }
    /// The part of its emission that each lane's light sheds from the point p on it; 1 of a whole light.
    template <class F>
    F at(const Geometry& geometry, const Textures& textures, const UInt<F>& light, const Vec3<F>& p) const;

private:
    std::vector<std::uint32_t> shapes_;   ///< by light: the shape, or kNone
};

}  // namespace penumbra
