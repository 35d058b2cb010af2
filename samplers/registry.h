// The samplers there are. A new one is a file beside this and an entry in SamplerTypes.
#pragma once

#include "samplers/independent.h"
#include "samplers/sobol.h"
#include "samplers/stratified.h"

#include <variant>

namespace penumbra {

using SamplerTypes = TypeList<SobolSampler, StratifiedSampler, IndependentSampler>;

/// One sampler of any registered type: a value, dispatched by its tag at each draw (a well-predicted branch).
class Sampler {
public:
    Sampler() = default;
    template <class T>
    Sampler(const T& sampler) : tag_(kTagOf<T, SamplerTypes>), sampler_(sampler) {}

    template <class F>
    F get1(const SampleAddress<F>& a, std::uint32_t vertex, Dim dim) const {
        return dispatch(SamplerTypes{}, tag_,
                        [&]<class T>() { return std::get_if<T>(&sampler_)->template get1<F>(a, vertex, dim); });
    }
    template <class F>
    Vec2<F> get2(const SampleAddress<F>& a, std::uint32_t vertex, Dim dim) const {
        return dispatch(SamplerTypes{}, tag_,
                        [&]<class T>() { return std::get_if<T>(&sampler_)->template get2<F>(a, vertex, dim); });
    }
    const PluginInfo& info() const;

private:
    template <class... Ts>
    static std::variant<Ts...> storage(TypeList<Ts...>);
    unsigned tag_ = 0;
    decltype(storage(SamplerTypes{})) sampler_;
};

/// Makes the sampler of that name; false where there is none.
bool makeSampler(std::string_view name, SamplerInput& input, Sampler& out);

}  // namespace penumbra
