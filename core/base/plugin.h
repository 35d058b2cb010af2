// What every registered plug-in (sampler, material, light, integrator) says of itself, and the folds over a registry.
//
// A plug-in is a type with `static constexpr PluginInfo kInfo`; a registry is a TypeList of such types. Factories, the
// `list` command, documentation tables and the property tests are folds over that list, so a new plug-in is one file
// and one entry of a list, and is tested the moment it is registered. There are no self-registering statics.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace penumbra {

struct ParameterInfo {
    std::string_view type, name, standard, meaning;   ///< standard: the default, as text
};

struct PluginInfo {
    std::string_view name;
    std::string_view summary;      ///< one line
    std::span<const ParameterInfo> parameters;
};

template <class... Ts>
struct TypeList {
    static constexpr unsigned size = sizeof...(Ts);
};

/// Calls f.template operator()<T>() for every type of the list, in order.
template <class... Ts, class Function>
void forEachType(TypeList<Ts...>, Function&& f) {
    (f.template operator()<Ts>(), ...);
}

/// Index of T in the list: the tag of a T.
template <class T, class List>
inline constexpr unsigned kTagOf = 0;
template <class T, class... Ts>
inline constexpr unsigned kTagOf<T, TypeList<T, Ts...>> = 0;
template <class T, class U, class... Ts>
inline constexpr unsigned kTagOf<T, TypeList<U, Ts...>> = 1 + kTagOf<T, TypeList<Ts...>>;

/// Returns f.template operator()<T>() for the type whose tag is given. A chain of compares: lists are short, and the branch
/// is well predicted because groups of lanes hold one tag. REQUIRES: tag is that of a type of the list.
template <class T, class... Rest, class Function>
inline decltype(auto) dispatch(TypeList<T, Rest...>, unsigned tag, Function&& f) {
    if constexpr (sizeof...(Rest) == 0) {
        return f.template operator()<T>();
    } else {
        if (tag == 0) return f.template operator()<T>();
        return dispatch(TypeList<Rest...>{}, tag - 1, f);
    }
}

template <class... Ts>
std::vector<std::string> pluginNames(TypeList<Ts...>) {
    return {std::string(Ts::kInfo.name)...};
}

}  // namespace penumbra
