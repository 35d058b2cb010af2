// sobol: Owen-scrambled Sobol points, the default. Each vertex of a path has its own shuffle of the sequence, under which all
// its dimensions are dimensions of one Sobol point set (direction 0-1, light position 2-3, then the single numbers), so what
// happens at a vertex is stratified jointly; vertices are padded against each other. The direction has the best pair: indirect
// light is what converges last. (Measured and dropped: one point set for several vertices. Its higher pairs are so much
// worse at the usual 64 samples that the joint stratification does not make up for it.)
//
// Scrambling is nested uniform (Owen 1995) by a hash of the reversed digits (Laine & Karras 2011, in Vegdahl's stronger
// form), the shuffle of the index is the same operation (Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020).
// Any prefix of 2^k samples is a scrambled net: error falls as n^-1.5 for smooth integrands instead of n^-0.5.
#pragma once

#include "core/base/plugin.h"
#include "samplers/sample_address.h"
#include "samplers/sampler_input.h"
#include "samplers/sobol_tables.h"

namespace penumbra {

struct SobolSampler {
    static constexpr ParameterInfo kParameters[] = {
        {"integer", "pixelsamples", "16", "samples per pixel; powers of two stratify best"},
        {"string", "randomization", "owen", "accepted for compatibility: always Owen scrambling"},
        {"integer", "seed", "0", "seed of the randomisation"},
    };
    static constexpr PluginInfo kInfo{"sobol", "Owen-scrambled Sobol points, stratified jointly at each vertex (default)",
                                      kParameters};

    static SobolSampler make(SamplerInput& input) {
        input.parameters.text("randomization", "");
        input.samplesPerPixel = input.countOr(input.parameters.integer("pixelsamples", 16));
        return {};
    }

    template <class F>
    VertexAddress<F> atVertex(const SampleAddress<F>& a, std::uint32_t vertex) const {
        const UInt<F> seed = mixBits(a.seed ^ UInt<F>(dimensionKey(vertex, 0)));
        return {seed, shuffled<F>(a.index, seed), vertex};
    }
    template <class F>
    F get1(const VertexAddress<F>& v, Dim dim) const {
        return coordinate<F>(v, firstDimension(dim), std::uint32_t(dim));
    }
    template <class F>
    Vec2<F> get2(const VertexAddress<F>& v, Dim dim) const {
        const int d = firstDimension(dim);
        return {coordinate<F>(v, d, std::uint32_t(dim)), coordinate<F>(v, d + 1, std::uint32_t(dim) + 0x100u)};
    }

private:
    /// Which dimension of the point set a named dimension is. Those of the camera's vertex and of later ones never meet.
    static constexpr int firstDimension(Dim dim) {
        switch (dim) {
            case Dim::Filter: return 0;
            case Dim::Lens: return 2;
            case Dim::Time: return 4;
            case Dim::LightPosition: return 2;
            case Dim::Direction: return 0;
            case Dim::Lobe: return 4;
            case Dim::LightPick: return 5;
            case Dim::Roulette: return 6;
            case Dim::ShadowRoulette: return 7;
            case Dim::Mix: return 8;
            case Dim::Material: return 7;  // hashed whole: its leading bits, which stand in lockstep with the other 7, decide nothing
        }
        return 0;
    }

    /// Permutes each binary subtree of the digits independently; works on digits from bit 0 (most significant) upwards.
    template <class U>
    static U scrambleReversed(U x, U seed) {
        x = x ^ (x * U(0x3D20ADEAu));
        x = x + seed;
        x = x * ((seed >> 16) | U(1u));
        x = x ^ (x * U(0x05526C56u));
        x = x ^ (x * U(0x53A22864u));
        return x;
    }
    /// Only the low bits are shuffled (each with those above deciding how): a shuffle of blocks within blocks all the same, and
    /// the points of a render with at most 2^kSobolShortBits samples need no other columns of the matrices.
    template <class F>
    static UInt<F> shuffled(const UInt<F>& index, const UInt<F>& seed) {
        constexpr std::uint32_t kLow = (1u << kSobolShortBits) - 1u;
        const UInt<F> all = reverseBits(scrambleReversed(reverseBits(index), seed));
        return (all & UInt<F>(kLow)) | (index & UInt<F>(~kLow));
    }
    template <class F>
    static F coordinate(const VertexAddress<F>& v, int dimension, std::uint32_t salt) {
        const UInt<F> s = mixBits(v.seed + UInt<F>(mixBits(salt + 0x51633E2Du)));
        return unitFloat<F>(reverseBits(scrambleReversed(sobolReversed(v.index, dimension), s)));
    }
};

}  // namespace penumbra
