// independent: every number is drawn by itself from a hash. The plain Monte Carlo against which all else is measured:
// the error falls as 1/sqrt(n), and the standard error it reports is exact in expectation.
#pragma once

#include "core/base/plugin.h"
#include "samplers/sample_address.h"
#include "samplers/sampler_input.h"

namespace penumbra {

struct IndependentSampler {
    static constexpr ParameterInfo kParameters[] = {
        {"integer", "pixelsamples", "4", "samples per pixel"},
        {"integer", "seed", "0", "seed of the randomisation"},
    };
    static constexpr PluginInfo kInfo{"independent", "hashed numbers, each independent of all others", kParameters};

    static IndependentSampler make(SamplerInput& input) {
        input.samplesPerPixel = input.countOr(input.parameters.integer("pixelsamples", 4));
        return {};
    }

    template <class F>
    VertexAddress<F> atVertex(const SampleAddress<F>& a, std::uint32_t vertex) const {
        return {mixBits(a.index * UInt<F>(0x9E3779B9u) + a.seed), a.index, vertex};
    }
    template <class F>
    F get1(const VertexAddress<F>& v, Dim dim) const {
        return unitFloat<F>(draw<F>(v, dim));
    }
    template <class F>
    Vec2<F> get2(const VertexAddress<F>& v, Dim dim) const {
        const UInt<F> x = draw<F>(v, dim);
        return {unitFloat<F>(x), unitFloat<F>(mixBits(x ^ UInt<F>(0xB5297A4Du)))};
    }

private:
    template <class F>
    static UInt<F> draw(const VertexAddress<F>& v, Dim dim) {
        return mixBits(v.seed ^ UInt<F>(dimensionKey(v.vertex, std::uint32_t(dim))));
    }
};

}  // namespace penumbra
