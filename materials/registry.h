// The materials that Penumbra has, what each must offer, and the table that holds those of one scene.
//
// To add a material: write its file (bsdf.h says what it needs) and name it in MaterialTypes. The factory, `penumbra
// list` and the property tests are folds over that list.
//
// MaterialTable keeps one vector of rows a type. A scene numbers its materials densely so that those of one type (tag)
// are neighbours: the batch driver sorts hits by this id and cuts groups of lanes where the tag changes, and within a
// group equal materials stand together, which makes their look-ups broadcasts.
//
// Thread safety: building is single-threaded; a finished table is immutable and safe for any number of threads.
// Invariants: ids of tag t are firstId(t) .. firstId(t + 1) - 1, and the row of an id is id - firstId(t). Beside them stand
// the ids of mixes (mix.h), kMixFlag + row, which no closure belongs to; the members of a mix are older than itself.
#pragma once

#include "materials/blinn.h"
#include "materials/coated_conductor.h"
#include "materials/coated_diffuse.h"
#include "materials/conductor.h"
#include "materials/dielectric.h"
#include "materials/diffuse.h"
#include "materials/diffuse_transmission.h"
#include "materials/hair.h"
#include "materials/interface.h"
#include "materials/measured.h"
#include "materials/mix.h"
#include "materials/phong.h"
#include "materials/relief.h"
#include "materials/thin_dielectric.h"

#include <array>
#include <concepts>
#include <optional>
#include <tuple>
#include <utility>

namespace penumbra {

using MaterialTypes =
    TypeList<DiffuseMaterial, ConductorMaterial, DielectricMaterial, CoatedDiffuseMaterial, InterfaceMaterial,
             ThinDielectricMaterial, DiffuseTransmissionMaterial, PhongMaterial, BlinnMaterial, CoatedConductorMaterial,
             HairMaterial, MeasuredMaterial>;

/// All that a scene file may call a material: those of MaterialTypes, and mixes of them.
std::vector<PluginInfo> materialPlugins();

/// What an integrator asks of a closure.
template <class B, class F>
concept BsdfClosure = std::is_trivially_copyable_v<B> &&
    requires(const B& bsdf, const Vec3<F>& w, F uLobe, const Vec2<F>& u) {
    { bsdf.evaluate(w, w) } -> std::same_as<BsdfEval<F>>;
    { bsdf.sample(w, uLobe, u) } -> std::same_as<BsdfSample<F>>;
    { bsdf.smoothOnly() } -> std::same_as<Mask<F>>;
    { bsdf.albedo(w) } -> std::same_as<Spectrum<F>>;
};

/// M makes closures for lanes of type F.
template <class M, class F>
concept ShadesLanes = BsdfClosure<typename M::template Bsdf<F>, F> &&
    requires(const Records<F, M>& records, const ShadingContext<F>& context) {
    { M::bsdf(records, context) } -> std::same_as<typename M::template Bsdf<F>>;
};

/// What every entry of MaterialTypes must be.
template <class M>
concept Material = std::is_trivially_copyable_v<M> && sizeof(M) % 4 == 0 &&
                   ShadesLanes<M, float>&& ShadesLanes<M, Lanes8f>&& requires(MaterialInput& input) {
    { M::kInfo } -> std::same_as<const PluginInfo&>;
    { M::kPassThrough } -> std::same_as<const bool&>;
    { M::make(input) } -> std::same_as<M>;
};

/// Where a material was put while the table is built; kTags is the tag of mixes. Becomes an id (MaterialTable::id) when all
/// are in.
struct MaterialHandle {
    std::uint32_t tag = 0, row = 0;
};

class MaterialTable {
public:
    static constexpr unsigned kTags = MaterialTypes::size;

    /// Makes the material of that type; nothing where no type has the name (pluginNames(MaterialTypes{}) lists them).
    std::optional<MaterialHandle> add(std::string_view type, MaterialInput& input) {
        std::optional<MaterialHandle> handle;
        forEachType(MaterialTypes{}, [&]<Material M>() {
            if (M::kInfo.name == type) handle = add(M::make(input));
        });
        return handle;
    }
    template <Material M>
    MaterialHandle add(const M& material) {
        constexpr unsigned tag = kTagOf<M, MaterialTypes>;
        auto& rows = std::get<tag>(rows_);
        rows.push_back(material);
        for (unsigned later = tag + 1; later <= kTags; ++later)
            ++first_[later];
        return {tag, std::uint32_t(rows.size() - 1)};
    }
    MaterialHandle addMix(MaterialHandle first, MaterialHandle second, const ScalarInput& amount) {
        mixes_.push_back({.amount = amount});
        mixMembers_.push_back({first, second});
        return {kTags, std::uint32_t(mixes_.size() - 1)};
    }
    /// REQUIRES: not the handle of a mix, whose members have reliefs of their own.
    void setRelief(MaterialHandle handle, const ReliefRecord& relief) { given_.push_back({handle, relief}); }
    MaterialTables& tables() { return tables_; }

    /// Call once, when all materials are in and before the table is read.
    void finish();

    /// REQUIRES: finish().
    std::uint32_t id(MaterialHandle handle) const {
        return (handle.tag == kTags ? kMixFlag : first_[handle.tag]) + handle.row;
    }

    const std::vector<MixMaterial>& mixes() const { return mixes_; }
    /// Whether choosing from mixes needs to know what the surface is like at the hit.
    bool mixesAreTextured() const { return mixesAreTextured_; }

    /// Whether some material of the type has a relief. Where not, reliefs() need not be asked.
    template <Material M>
    bool hasRelief() const {
        return hasRelief_[kTagOf<M, MaterialTypes>];
    }
    /// The relief of every material by its id. REQUIRES: some hasRelief().
    template <class F>
    Records<F, ReliefRecord> reliefs(const UInt<F>& id) const {
        return {reliefs_.data(), id};
    }

    /// Mixes are not counted.
    std::uint32_t size() const { return first_[kTags]; }
    /// First id of a tag; of kTags: the number of materials.
    std::uint32_t firstId(unsigned tag) const { return first_[tag]; }
    /// REQUIRES: id < size().
    unsigned tag(std::uint32_t id) const {
        unsigned tag = 0;
        while (id >= first_[tag + 1])
            ++tag;
        return tag;
    }
    static bool isPassThrough(unsigned tag) {
        bool result = false;
        dispatch(MaterialTypes{}, tag, [&]<Material M>() { result = M::kPassThrough; });
        return result;
    }

    template <Material M>
    const std::vector<M>& rows() const {
        return std::get<kTagOf<M, MaterialTypes>>(rows_);
    }
    /// The rows of lanes whose ids all have M's tag.
    template <Material M, class F>
    Records<F, M> records(const UInt<F>& id) const {
        return {rows<M>().data(), id - UInt<F>(first_[kTagOf<M, MaterialTypes>])};
    }
    /// For ShadingContext::tables.
    const float* tableData() const { return tables_.data(); }

private:
    template <class List>
    struct RowsOf;
    template <class... Ms>
    struct RowsOf<TypeList<Ms...>> {
        using type = std::tuple<std::vector<Ms>...>;
    };

    RowsOf<MaterialTypes>::type rows_;
    std::array<std::uint32_t, kTags + 1> first_{};
    std::vector<MixMaterial> mixes_;
    std::vector<std::array<MaterialHandle, 2>> mixMembers_;  ///< until finish()
    bool mixesAreTextured_ = false;
    std::vector<std::pair<MaterialHandle, ReliefRecord>> given_;  ///< until finish()
    std::vector<ReliefRecord> reliefs_;                           ///< by id; empty where there is none
    std::array<bool, kTags> hasRelief_{};                         ///< by tag
    MaterialTables tables_;
};

}  // namespace penumbra
