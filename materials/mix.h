// "mix": two materials of the scene, one of which alone is met at each hit, chosen at random.
//
// A mix has no closure. It is a node of a tree whose leaves are materials of MaterialTypes, and its id (registry.h) has
// the bit kMixFlag. Between tracing and sorting, the driver takes the ids of mixes down to leaves with chooseFromMixes, so
// that everything at a hit (emission, light sampling, scattering) sees one and the same material, and groups of lanes stay
// of one kind. The number that decides belongs to the path's vertex, like every other that a path draws.
//
// One number serves the whole tree: the second member is taken where u < amount, and the part of the unit interval that u
// fell into is stretched to a whole one for the next level. So leaves own intervals of u, of their probability's length up
// to rounding (2^-24), however deep they lie, and numbers that are spread evenly choose evenly.
// Thread safety: plain values.
#pragma once

#include "core/math/warps.h"
#include "materials/material.h"

namespace penumbra {

inline constexpr std::uint32_t kMixFlag = 0x80000000u;

struct MixMaterial {
    static constexpr ParameterInfo kParameters[] = {
        {"string", "materials", "", "the names of two materials, mixes and interfaces included"},
        {"float", "amount", "0.5", "probability of the second; texture or number"},
    };
    static constexpr PluginInfo kInfo{"mix", "at each hit one of two materials, at random", kParameters};

    std::uint32_t first = 0, second = 0;  ///< ids
    ScalarInput amount;
};

/// Takes ids that may be those of mixes to what is met, with u in [0, 1).
template <class F>
UInt<F> chooseFromMixes(const MixMaterial* mixes, UInt<F> id, F u, const ShadingContext<F>& at) {
    for (;;) {
        const Mask<F> isMix = (id & UInt<F>(kMixFlag)) != UInt<F>(0u);
        if (none(isMix)) return id;
        const Records<F, MixMaterial> mix(mixes, select(isMix, id & UInt<F>(~kMixFlag), UInt<F>(0u)));
        const F amount = clamp(at.scalar(mix, &MixMaterial::amount), F(0.f), F(1.f));
        F rest = u;
        const Mask<F> takesSecond = takeBelow(amount, rest);
        u = select(isMix, rest, u);
        const UInt<F> member = select(takesSecond, mix(&MixMaterial::second), mix(&MixMaterial::first));
        id = select(isMix, member, id);
    }
}

}  // namespace penumbra
