// "interface": no surface at all, only a border between media.
//
// An integrator steps over kPassThrough materials without shading them; for those that do not, the closure is the delta
// lobe that goes straight on. Thread safety: plain values.
#pragma once

#include "materials/material.h"

namespace penumbra {

template <class F>
struct InterfaceBsdf {
    BsdfEval<F> evaluate(const Vec3<F>&, const Vec3<F>&) const { return {Spectrum<F>::constant(F(0.f)), F(0.f)}; }
    BsdfSample<F> sample(const Vec3<F>& wo, F, const Vec2<F>&) const {
        return {-wo, Spectrum<F>::constant(F(1.f)), F(1.f), F(1.f), Mask<F>(true), Mask<F>(true)};
    }
    Mask<F> smoothOnly() const { return Mask<F>(true); }
    Spectrum<F> albedo(const Vec3<F>&) const { return Spectrum<F>::constant(F(1.f)); }
};

struct InterfaceMaterial {
    static constexpr PluginInfo kInfo{"interface", "no scattering: a mere border between media", {}};
    static constexpr bool kPassThrough = true;
    static constexpr bool kUsesLobe = false;
    template <class F>
    using Bsdf = InterfaceBsdf<F>;

    std::uint32_t unused = 0;  ///< a row needs a word

    static InterfaceMaterial make(MaterialInput&) { return {}; }

    template <class F>
    static InterfaceBsdf<F> bsdf(const Records<F, InterfaceMaterial>&, const ShadingContext<F>&) {
        return {};
    }
};

}  // namespace penumbra
