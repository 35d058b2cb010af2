// marble: veins across the y axis of the texture's space, distorted by noise: colours of a spline at
// 1/2 + 1/2 sin(y + variation noise).
//
// The colours are an albedo in sRGB whatever the role; taken to the film's space once, because a spline is linear in
// its control points.
#pragma once

#include "core/image/texture_octaves.h"

namespace penumbra {

struct MarbleTexture {
    static constexpr ParameterInfo kParameters[] = {
        kOctaveParameters[0],
        kOctaveParameters[1],
        {"float", "scale", "1", "of the space: the veins lie 2 pi / scale apart"},
        {"float", "variation", "0.2", "how far the noise distorts the veins"},
    };
    static constexpr PluginInfo kInfo{"marble", "veins of marble (spectrum)", kParameters};
    static constexpr int kSegments = 6;  ///< of the spline; segment i has the control points i to i + 3

    static TextureOperand make(TextureInput& input, TextureTables& tables);

    template <class V, class F>
        requires(!std::is_same_v<V, F>)
    V evaluate(const TextureContext<F>& at, const TextureTables&) const {
        const Vec3<F> p = space.point(at) * F(scale);
        const F width = space.footprint(at) * F(std::fabs(scale));
        const F turns = (p.y + F(variation) * brownianNoise(p, width, octaves)) * F(kInvTwoPi);
        const F withinTurn = clamp(turns - floor(turns), F(0.f), F(1.f));  // NaN becomes 0
        return color(F(0.5f) + F(0.5f) * sin(F(kTwoPi) * withinTurn));
    }

    /// The spline's colour at t in [0, 1].
    template <class F>
    Spectrum<F> color(F t) const {
        const F along = clamp(t, F(0.f), F(1.f)) * F(float(kSegments));
        const F first = min(floor(along), F(float(kSegments - 1)));
        const F x = along - first, y = F(1.f) - x;
        const UInt<F> index = toUInt(first);
        const F weights[] = {y * y * y, F(3.f) * y * y * x, F(3.f) * y * x * x, x * x * x};
        Spectrum<F> sum = Spectrum<F>::constant(F(0.f));
        for (std::uint32_t i = 0; i < 4; ++i) {
            const UInt<F> at = (index + UInt<F>(i)) * UInt<F>(3u);
            const float* const c = &colors[0].r;
            sum = sum + Spectrum<F>{gather(c, at), gather(c + 1, at), gather(c + 2, at)} * weights[i];
        }
        return sum;
    }

    TextureSpace space;
    Octaves octaves;
    float scale = 1, variation = 0.2f;
    std::array<Spectrum<float>, kSegments + 3> colors{};  ///< the control points, in the film's space
};

}  // namespace penumbra
