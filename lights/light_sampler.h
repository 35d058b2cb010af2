// LightSampler: which light a path looks at next, and how likely that was.
//
// Three rules: `uniform` (every light alike), `power` (by emitted flux) and `bvh` (by what a light may contribute at
// the place, light_tree.h). The first two pick by inverting one cumulative table, so that stratified numbers spread
// over the lights in proportion; probabilities are exact (core/math/distribution.h), those of the tree, too. The tree
// holds what has a place. Distant and infinite lights stand beside it: n of them have n / (n + 1) of the picks, as in
// pbrt, divided by their flux. Where nothing has a place, `bvh` is `power`. A constant infinite light is never picked
// unless `includeUniformInfinite` says so: BSDF sampling is nearly perfect for it. It then has probability 0, which
// gives BSDF sampling its whole weight; a strategy that samples lights only must ask for it.
//
// Thread safety: immutable once built.
// Invariants: a light of power 0 is never picked; where nothing can be picked, empty() and every probability is 0.
#pragma once

#include "core/math/distribution.h"
#include "lights/light_tree.h"
#include "lights/registry.h"

namespace penumbra {

enum class LightSelection { Uniform, Power, Bvh };

class LightSampler {
public:
    LightSampler() = default;
    /// REQUIRES: lights.tables.sceneRadius is set. Error(BadData) beyond kMaxCells lights.
    LightSampler(LightSelection selection, const LightTable& lights, bool includeUniformInfinite);

    bool empty() const { return cells_ == 0; }
    /// Only one light can be picked: pick() does not look at its number.
    bool isSingle() const { return only_ >= 0; }
    /// Whether it matters where light is wanted.
    bool isByPlace() const { return tree_.units() > 0; }

    /// A light for `at`, which matters where isByPlace() only, by u in [0, 1). Where the probability is 0, none can
    /// contribute, and the id is any light's. REQUIRES: !empty().
    template <class F>
    void pick(const LitPoint<F>& at, F u, UInt<F>& id, F& probability) const {
        if (only_ >= 0) {
            id = UInt<F>(std::uint32_t(only_));
            probability = F(1.f);
            return;
        }
        const Cell<F> cell = sampleCell(table_.data(), UInt<F>(0u), UInt<F>(cells_), UInt<F>(stride_), u);
        id = cell.index;
        probability = cell.probability;
        if (isByPlace()) pickByPlace(at, u, id, probability);
    }

    /// Of picking this light at that place. Ids beyond the table's end are not allowed, whatever empty() says.
    template <class F>
    F probability(const LitPoint<F>& at, const UInt<F>& id) const {
        if (only_ >= 0) return select(id == UInt<F>(std::uint32_t(only_)), F(1.f), F(0.f));
        if (empty()) return F(0.f);
        if (!isByPlace()) return cellProbability<F>(table_.data(), UInt<F>(0u), id);
        const UInt<F> cell = gather(cellOf_.data(), id);
        const F beside = cellProbability<F>(table_.data(), UInt<F>(0u), cell);
        return select(cell == UInt<F>(0u), probabilityOf<F>(tree_.unitsOf(at, id)), beside);
    }

private:
    void buildTable(const std::vector<double>& weights);
    void buildTree(const LightTable& lights, const std::vector<double>& powers);

    /// From the cell to its light: the first cell is the tree's.
    template <class F>
    void pickByPlace(const LitPoint<F>& at, F u, UInt<F>& id, F& probability) const {
        const Mask<F> inTree = id == UInt<F>(0u);
        if (!all(inTree)) id = gather(lightOf_.data(), id);
        if (none(inTree)) return;
        UInt<F> light, units;
        tree_.pick(at, toUInt(u * F(float(LightTree::kUnits))), inTree, light, units);
        id = select(inTree, light, id);
        probability = select(inTree, probabilityOf<F>(units), probability);
    }
    template <class F>
    static F probabilityOf(const UInt<F>& units) {
        return toFloat<F>(units) * F(1.f / float(LightTree::kUnits));
    }

    LightTree tree_;
    std::vector<float> table_;  ///< of all lights; where there is a tree, of the tree and the lights beside it
    std::uint32_t cells_ = 0, stride_ = 0;
    std::vector<std::uint32_t> lightOf_, cellOf_;  ///< where there is a tree: by cell, by light
    std::int64_t only_ = -1;  ///< the one light that can be picked, -1 where there are several or none
};

}  // namespace penumbra
