// Textures: functions of the surface that materials look up at a hit, over lanes.
//
// Conventions: uv as the shape gives them; `footprint` is the width that the ray's cone covers there, in units of uv
// (0: a point), from which the level of an image pyramid is chosen. Texture ids index one table for the whole scene;
// kNoTexture means "no texture" and must not be looked up. Thread safety: immutable after the scene is built.
// Failures (none can happen after building) are never thrown from look-ups.
#pragma once

#include "core/math/spectrum.h"
#include "core/math/vector.h"

#include <cstdint>
#include <memory>

namespace penumbra {

inline constexpr std::uint32_t kNoTexture = 0xFFFFFFFFu;

template <class F>
struct TextureContext {
    Vec2<F> uv;
    F footprint;
    Vec3<F> p;            ///< world-space point, for mappings that are not uv
};

class Textures {
public:
    Textures();
    ~Textures();
    Textures(Textures&&) noexcept;
    Textures& operator=(Textures&&) noexcept;

    /// Values at every lane's own texture; lanes with kNoTexture get 0. Ids of different textures may stand in one group.
    template <class F> Spectrum<F> spectrum(const UInt<F>& texture, const TextureContext<F>& at) const;
    /// The same as one number: mean of r, g, b, or the alpha channel where the image has one (PBRT-v4's rule).
    template <class F> F scalar(const UInt<F>& texture, const TextureContext<F>& at) const;
};

}  // namespace penumbra
