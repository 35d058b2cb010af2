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

    /// The numbers of one vertex of a sample; ask for those that are needed, in any order.
    template <class F>
    class Numbers {
    public:
        F get1(Dim dim) const {
            return dispatch(SamplerTypes{}, sampler_.tag_, [&]<class T>() { return sampler_.as<T>().template get1<F>(at_, dim); });
        }
        Vec2<F> get2(Dim dim) const {
            return dispatch(SamplerTypes{}, sampler_.tag_, [&]<class T>() { return sampler_.as<T>().template get2<F>(at_, dim); });
        }

    private:
        friend class Sampler;
        Numbers(const Sampler& sampler, const VertexAddress<F>& at) : sampler_(sampler), at_(at) {}
        const Sampler& sampler_;
        VertexAddress<F> at_;
    };

    template <class F>
    Numbers<F> at(const SampleAddress<F>& a, std::uint32_t vertex) const {
        return {*this, dispatch(SamplerTypes{}, tag_, [&]<class T>() { return as<T>().template atVertex<F>(a, vertex); })};
    }
    const PluginInfo& info() const;

private:
    template <class T>
    const T& as() const { return *std::get_if<T>(&sampler_); }
    template <class... Ts>
    static std::variant<Ts...> storage(TypeList<Ts...>);
    unsigned tag_ = 0;
    decltype(storage(SamplerTypes{})) sampler_;
};

/// Makes the sampler of that name; false where there is none.
bool makeSampler(std::string_view name, SamplerInput& input, Sampler& out);

}  // namespace penumbra
