// LightSampler: which light a path looks at next, and how likely that was.
//
// Two rules: `uniform` (every light alike) and `power` (by emitted flux). Both pick by inverting one cumulative table,
// so that stratified numbers spread over the lights in proportion; probabilities are exact (core/math/distribution.h).
// A constant infinite light is never picked unless `includeUniformInfinite` says so: BSDF sampling is nearly perfect
// for it. It then has probability 0, which gives BSDF sampling its whole weight; a strategy that samples lights only
// must ask for it.
//
// Thread safety: immutable once built.
// Invariants: a light of power 0 is never picked; where nothing can be picked, empty() and every probability is 0.
#pragma once

#include "core/math/distribution.h"
#include "lights/registry.h"

#include <string_view>

namespace penumbra {

enum class LightSelection { Uniform, Power };

/// "uniform" or "power"; Error(Usage) for any other word (to substitute "bvh" and the like is the caller's business).
LightSelection lightSelectionFromName(std::string_view name);

class LightSampler {
public:
    LightSampler() = default;
    /// REQUIRES: lights.tables.sceneRadius is set. Error(BadData) beyond kMaxCells lights.
    LightSampler(LightSelection selection, const LightTable& lights, bool includeUniformInfinite);

    bool empty() const { return lights_ == 0; }
    /// Only one light can be picked: pick() does not look at its number.
    bool isSingle() const { return only_ >= 0; }

    /// REQUIRES: !empty(), u in [0, 1).
    template <class F>
    void pick(F u, UInt<F>& id, F& probability) const {
        if (only_ >= 0) {
            id = UInt<F>(std::uint32_t(only_));
            probability = F(1.f);
            return;
        }
        const Cell<F> cell = sampleCell(table_.data(), UInt<F>(0u), UInt<F>(lights_), UInt<F>(stride_), u);
        id = cell.index;
        probability = cell.probability;
    }

    /// Of picking this light. Ids beyond the table's end are not allowed, whatever empty() says.
    template <class F>
    F probability(const UInt<F>& id) const {
        if (only_ >= 0) return select(id == UInt<F>(std::uint32_t(only_)), F(1.f), F(0.f));
        if (empty()) return F(0.f);
        return cellProbability<F>(table_.data(), UInt<F>(0u), id);
    }

private:
    std::vector<float> table_;
    std::uint32_t lights_ = 0, stride_ = 0;
    std::int64_t only_ = -1;  ///< the one light that can be picked, -1 where there are several or none
};

}  // namespace penumbra
