// The light types and the table of a scene's lights: the one place that lists them. A new light is one file and one
// entry of LightTypes; its factory entry is the scene builder's, its property tests are folds over this list.
//
// A light's id is its number in order of adding (dense from 0). Each lane of a group has its own light; a group is
// sampled by a loop over the distinct types in it, each computing all lanes, and a select. Scenes with one type (most)
// pass the loop once without a select, and where all lanes have one light, Records turns its gathers into broadcasts.
//
// Thread safety: immutable once built.
// Invariants: places()[id] is tag << kRowBits | row.
#pragma once

#include "core/base/error.h"
#include "lights/area_cylinder.h"
#include "lights/area_disk.h"
#include "lights/area_rectangle.h"
#include "lights/area_sphere.h"
#include "lights/area_triangle.h"
#include "lights/distant.h"
#include "lights/goniometric.h"
#include "lights/infinite_constant.h"
#include "lights/infinite_image.h"
#include "lights/infinite_portal.h"
#include "lights/point.h"
#include "lights/projection.h"
#include "lights/spot.h"

#include <algorithm>
#include <span>
#include <tuple>

namespace penumbra {

using LightTypes = TypeList<RectangleLight, TriangleLight, SphereLight, DiskLight, CylinderLight, PointLight, SpotLight,
                            GoniometricLight, ProjectionLight, DistantLight, ConstantInfiniteLight, ImageInfiniteLight,
                            PortalInfiniteLight>;

/// What `list lights` shows: each plug-in once, though several types (the shapes of an area light) share it.
std::vector<PluginInfo> lightPlugins();

namespace detail {
template <class... Ts>
std::tuple<std::vector<Ts>...> lightRows(TypeList<Ts...>);
}

class LightTable {
public:
    static constexpr unsigned kRowBits = 27;

    /// The id of the new light. Error(BadData) where its row lies beyond the reach of Records or the bits of a place.
    template <class T>
    std::uint32_t add(const T& light);

    std::uint32_t size() const { return std::uint32_t(places_.size()); }
    bool empty() const { return places_.empty(); }
    /// The lights that a ray which leaves the scene meets: all of them.
    std::span<const std::uint32_t> infiniteIds() const { return infiniteIds_; }
    float power(std::uint32_t id) const;
    std::optional<LightBounds> bounds(std::uint32_t id) const;
    /// Whether the light is of one of these types.
    template <class... Ts>
    bool isA(std::uint32_t id) const {
        return ((tag(id) == kTagOf<Ts, LightTypes>) || ...);
    }
    template <class T>
    std::span<const T> rows() const {
        return std::get<std::vector<T>>(rows_);
    }
    const std::uint32_t* places() const { return places_.data(); }
    std::uint32_t tag(std::uint32_t id) const { return places_[id] >> kRowBits; }
    std::uint32_t row(std::uint32_t id) const { return places_[id] & ((1u << kRowBits) - 1u); }

    LightTables tables;

private:
    decltype(detail::lightRows(LightTypes{})) rows_;
    std::vector<std::uint32_t> places_, infiniteIds_;
};

template <class T>
std::uint32_t LightTable::add(const T& light) {
    static_assert(kTagOf<T, LightTypes> < LightTypes::size && LightTypes::size <= 32u);
    std::vector<T>& rows = std::get<std::vector<T>>(rows_);
    constexpr std::size_t kMaxRows = std::min(std::size_t(1) << kRowBits, (std::size_t(1) << 31) / (sizeof(T) / 4));
    if (rows.size() >= kMaxRows) throw Error(ErrorKind::BadData, "too many lights of one type");
    const std::uint32_t id = size();
    places_.push_back(kTagOf<T, LightTypes> << kRowBits | std::uint32_t(rows.size()));
    rows.push_back(light);
    if (T::kInfinite) infiniteIds_.push_back(id);
    return id;
}

inline float LightTable::power(std::uint32_t id) const {
    float result = 0.f;
    dispatch(LightTypes{}, tag(id), [&]<class T>() { result = rows<T>()[row(id)].power(tables); });
    return result;
}

inline std::optional<LightBounds> LightTable::bounds(std::uint32_t id) const {
    return dispatch(LightTypes{}, tag(id), [&]<class T>() { return rows<T>()[row(id)].bounds(tables); });
}

namespace detail {

/// Calls f.operator()<T>(Records<F, T>) for every type T in the group and gathers the results lane by lane.
template <class F, class Result, class Function>
Result forEachLightType(const LightTable& lights, const UInt<F>& id, Function&& f) {
    const std::uint32_t firstId = lane(id, 0);
    if (all(id == UInt<F>(firstId)))
        return dispatch(LightTypes{}, lights.tag(firstId), [&]<class T>() {
            return f.template operator()<T>(Records<F, T>::ofRow(lights.rows<T>().data(), lights.row(firstId)));
        });
    const UInt<F> place = gather(lights.places(), id);
    const UInt<F> tag = place >> int(LightTable::kRowBits), row = place & UInt<F>((1u << LightTable::kRowBits) - 1u);
    const auto ofTag = [&](std::uint32_t wanted, const UInt<F>& rows) {
        return dispatch(LightTypes{}, wanted, [&]<class T>() {
            return f.template operator()<T>(Records<F, T>(lights.rows<T>().data(), rows));
        });
    };
    const std::uint32_t firstTag = lane(tag, 0);
    Mask<F> mine = tag == UInt<F>(firstTag);
    if (all(mine)) return ofTag(firstTag, row);

    // Lanes of another type read the row of a lane of this one: their own could lie beyond the table.
    Result result = ofTag(firstTag, select(mine, row, UInt<F>(lane(row, 0))));
    Mask<F> todo = !mine;
    while (any(todo)) {
        const int next = std::countr_zero(bits(todo));
        const std::uint32_t nextTag = lane(tag, next);
        mine = tag == UInt<F>(nextTag);
        result = select(mine, ofTag(nextTag, select(mine, row, UInt<F>(lane(row, next)))), result);
        todo = todo & !mine;
    }
    return result;
}

}  // namespace detail

/// A sample of each lane's own light. Lanes that want none may carry any id of the table.
template <class F>
LightSample<F> sampleLight(const LightTable& lights, const UInt<F>& id, const Vec3<F>& p, const Vec2<F>& u) {
    return detail::forEachLightType<F, LightSample<F>>(
        lights, id, [&]<class T>(const Records<F, T>& light) { return T::sample(light, lights.tables, p, u); });
}

/// What a ray that met each lane's own light sees, and the density with which sampleLight would have chosen it.
template <class F>
LightEval<F> evaluateLight(const LightTable& lights, const UInt<F>& id, const LightHit<F>& hit) {
    return detail::forEachLightType<F, LightEval<F>>(lights, id, [&]<class T>(const Records<F, T>& light) {
        if constexpr (T::kDelta)
            return lightEval(Mask<F>(false), Spectrum<F>::constant(F(0.f)), F(0.f));
        else
            return T::evaluate(light, lights.tables, hit);
    });
}

}  // namespace penumbra
