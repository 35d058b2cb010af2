// stratified: jittered sampling. The samples of a pixel fill an x by y grid of strata, one each, in every pair of dimensions;
// pairs are shuffled against each other by a random permutation (padding). Samples beyond x*y begin another grid.
//
// The permutation is the hashed cycle walk of Kensler, "Correlated Multi-Jittered Sampling", Pixar TM 13-01, 2013.
#pragma once

#include "core/base/plugin.h"
#include "samplers/sample_address.h"
#include "samplers/sampler_input.h"

namespace penumbra {

struct StratifiedSampler {
    static constexpr ParameterInfo kParameters[] = {
        {"integer", "xsamples", "4", "strata in x"},
        {"integer", "ysamples", "4", "strata in y; samples per pixel are xsamples * ysamples"},
        {"bool", "jitter", "true", "random place in each stratum; false: its centre"},
        {"integer", "seed", "0", "seed of the randomisation"},
    };
    static constexpr PluginInfo kInfo{"stratified", "jittered: one sample in each cell of a grid, per pair of dimensions",
                                      kParameters};

    static StratifiedSampler make(SamplerInput& input) {
        StratifiedSampler s;
        int x = input.parameters.integer("xsamples", 4), y = input.parameters.integer("ysamples", 4);
        s.jitter = input.parameters.boolean("jitter", true) ? 1.f : 0.f;
        x = x > 0 ? (x < 32768 ? x : 32768) : 1;
        y = y > 0 ? (y < 32768 ? y : 32768) : 1;
        if (input.samplesOverride > 0 && input.samplesOverride != x * y) {
            // The squarest grid of exactly that many cells.
            x = 1;
            for (int i = 1; i * i <= input.samplesOverride; ++i)
                if (input.samplesOverride % i == 0) x = i;
            y = input.samplesOverride / x;
        }
        s.x = std::uint32_t(x);
        s.y = std::uint32_t(y);
        input.samplesPerPixel = x * y;
        return s;
    }

    template <class F>
    VertexAddress<F> atVertex(const SampleAddress<F>& a, std::uint32_t vertex) const {
        return {a.seed, a.index, vertex};
    }
    template <class F>
    F get1(const VertexAddress<F>& v, Dim dim) const {
        const Place<F> p = place<F>(v, dim);
        return inside<F>(p.stratum, x * y, p.noise);
    }
    template <class F>
    Vec2<F> get2(const VertexAddress<F>& v, Dim dim) const {
        const Place<F> p = place<F>(v, dim);
        const UInt<F> row = divide<F>(p.stratum, x);
        return {inside<F>(p.stratum - row * UInt<F>(x), x, p.noise),
                inside<F>(row, y, mixBits(p.noise ^ UInt<F>(0xB5297A4Du)))};
    }

    std::uint32_t x = 4, y = 4;
    float jitter = 1.f;

private:
    template <class F>
    struct Place {
        UInt<F> stratum, noise;
    };

    /// The stratum that a permutation of the grid, hashed from pixel, pass and dimension, gives to this sample.
    template <class F>
    Place<F> place(const VertexAddress<F>& a, Dim dim) const {
        const std::uint32_t n = x * y, key = dimensionKey(a.vertex, std::uint32_t(dim));
        const UInt<F> pass = divide<F>(a.index, n), i = a.index - pass * UInt<F>(n);
        const UInt<F> seed = mixBits(mixBits(a.seed ^ UInt<F>(key)) + pass * UInt<F>(0x9E3779B9u));
        return {permute<F>(i, n, seed), mixBits(seed + a.index * UInt<F>(0x2C1B3C6Du))};
    }

    template <class F>
    static UInt<F> permute(const UInt<F>& i, std::uint32_t n, const UInt<F>& seed) {
        if (n == 1) return UInt<F>(0u);
        const std::uint32_t mask = std::bit_ceil(n) - 1;
        // A permutation of 0..mask, walked along its cycle until it lands below n.
        const auto step = [&](UInt<F> v) {
            const UInt<F> m(mask);
            v = v ^ seed;
            v = v * UInt<F>(0xE170893Du);
            v = v ^ (seed >> 16);
            v = v ^ ((v & m) >> 4);
            v = v ^ (seed >> 8);
            v = v * UInt<F>(0x0929EB3Fu);
            v = v ^ (seed >> 23);
            v = v ^ ((v & m) >> 1);
            v = v * (UInt<F>(1u) | (seed >> 27));
            v = v * UInt<F>(0x6935FA69u);
            v = v ^ ((v & m) >> 11);
            v = v * UInt<F>(0x74DCB303u);
            v = v ^ ((v & m) >> 2);
            v = v * UInt<F>(0x9E501CC3u);
            v = v ^ ((v & m) >> 2);
            v = v * UInt<F>(0xC860A3DFu);
            v = v & m;
            return v ^ (v >> 5);
        };
        UInt<F> v = step(i);
        Mask<F> active = !(v < UInt<F>(n));
        while (any(active)) {
            v = select(active, step(v), v);
            active = !(v < UInt<F>(n));
        }
        // A random rotation, since the walk alone is a poor permutation of very small n.
        const UInt<F> shifted = v + (mixBits(seed) & UInt<F>(0x3FFFFFFFu));
        return shifted - divide<F>(shifted, n) * UInt<F>(n);
    }

    /// a / n for any a; lanes have no integer division.
    template <class F>
    static UInt<F> divide(const UInt<F>& a, std::uint32_t n) {
        UInt<F> q;
        for (int k = 0; k < kLanes<F>; ++k) setLane(q, k, lane(a, k) / n);
        return q;
    }

    template <class F>
    F inside(const UInt<F>& stratum, std::uint32_t count, const UInt<F>& noise) const {
        const F offset = jitter != 0.f ? unitFloat<F>(noise) : F(0.5f);
        return min((toFloat<F>(stratum) + offset) * F(1.f / float(count)), F(kOneMinusEpsilon));
    }
};

}  // namespace penumbra
