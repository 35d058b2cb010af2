// checkerboard: squares of side 1 in the plane of (s, t), or cubes in the texture's space: tex1 where the sum of the
// coordinates' floors is even and tex2 where it is odd.
//
// It is filtered exactly by a tent along each axis that reaches 1.5 footprints to either side, as the pbrt format does.
// With the signs +1 and -1 for the two sorts of stripes along an axis, the filtered board is the product of the
// filtered stripes of all axes, because tent and board are both products.
#pragma once

#include "core/image/texture_mapping.h"
#include "core/image/texture_plugin.h"

namespace penumbra {

struct CheckerboardTexture {
    static constexpr auto kParameters = TextureMapping::parameters({
        {"spectrum or float texture", "tex1", "1", "the cells where the sum of the coordinates' floors is even"},
        {"spectrum or float texture", "tex2", "0", "the other cells"},
        {"integer", "dimension", "2", "of the board: 2 or 3"},
    });
    static constexpr PluginInfo kInfo{"checkerboard", "squares or cubes of two textures", kParameters};

    static TextureOperand make(TextureInput& input, TextureTables& tables) {
        CheckerboardTexture t;
        t.even = input.value("tex1", 1.f);
        t.odd = input.value("tex2", 0.f);
        const int dimension = input.parameters().integer("dimension", 2);
        if (dimension != 2 && dimension != 3)
            input.fail("dimension " + std::to_string(dimension) + " of a checkerboard is neither 2 nor 3");
        t.isSolid = dimension == 3;
        if (t.isSolid) {
            t.space = TextureSpace::make(input);
        } else {
            t.mapping = TextureMapping::make(input);
        }
        return tables.append(t, {t.even, t.odd}, input);
    }

    template <class V, class F>
    V evaluate(const TextureContext<F>& at, const TextureTables& tables) const {
        const F board = isSolid ? cubes(at) : squares(at);
        const F weight = clamp(F(0.5f) + F(0.5f) * board, F(0.f), F(1.f));  // NaN becomes 0
        return tables.blend<V>(odd, even, weight, at);
    }

    /// Stripes of width 1, +1 where floor(x) is even and -1 where it is odd, under a tent of half-width r.
    template <class F>
    static F stripes(F x, F r) {
        x = x - F(2.f) * floor(x * F(0.5f));  // [0, 2]: the period
        r = clamp(r, F(0.f), F(1e6f));
        // Narrow: only the nearest edge matters. To its right it is the cumulative tent, times two, minus one.
        const F edge = floor(x + F(0.5f));
        const F offset = x - edge;
        const F d = clamp(offset / max(r, F(1e-30f)), F(-1.f), F(1.f));
        const F narrow =
            sign(edge) * select(r > F(0.f), d * (F(2.f) - abs(d)), select(offset < F(0.f), F(-1.f), F(1.f)));
        // Wide: the second difference of the second antiderivative, which is a tent's convolution.
        const F wide =
            (antiderivative(x + r) - F(2.f) * antiderivative(x) + antiderivative(x - r)) / max(r * r, F(0.25f));
        return select(r <= F(0.5f), narrow, clamp(wide, F(-1.f), F(1.f)));
    }

    bool isSolid = false;
    TextureMapping mapping;  ///< of squares
    TextureSpace space;      ///< of cubes
    TextureOperand even, odd;

private:
    template <class F>
    F squares(const TextureContext<F>& at) const {
        const MappedPoint<F> m = mapping.map(at);
        return stripes(m.s, F(1.5f) * m.widthS) * stripes(m.t, F(1.5f) * m.widthT);
    }
    template <class F>
    F cubes(const TextureContext<F>& at) const {
        const Vec3<F> p = space.point(at), reach = space.widths(at) * F(1.5f);
        return stripes(p.x, reach.x) * stripes(p.y, reach.y) * stripes(p.z, reach.z);
    }
    /// +1 where floor(x) is even, -1 where it is odd.
    template <class F>
    static F sign(F x) {
        const F whole = floor(x);
        return F(1.f) - F(2.f) * (whole - F(2.f) * floor(whole * F(0.5f)));
    }
    /// The periodic part of the stripes' second antiderivative; the rest is linear and has no second difference.
    template <class F>
    static F antiderivative(F x) {
        const F f = x - floor(x);
        return F(-0.5f) * sign(x) * f * (F(1.f) - f);
    }
};

}  // namespace penumbra
