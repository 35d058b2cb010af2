// "conductor": a metal, smooth or rough (GGX), alike from both sides.
//
// Per channel, the complex index of refraction decides the colour at every angle. `reflectance` r instead of eta and k
// stands for the index 1 + i k, k = 2 sqrt(r) / sqrt(1 - r), which reflects r at normal incidence.
// Single scattering: rough metals lose the light that would bounce between microfacets.
// Thread safety: plain values. Sources: fresnel.h, microfacet.h.
#pragma once

#include "materials/fresnel.h"
#include "materials/microfacet.h"

namespace penumbra {

template <class F>
struct ConductorBsdf {
    ConductorConstants<Spectrum<F>> index;
    Ggx<F> ggx;
    Mask<F> smooth;

    BsdfEval<F> evaluate(const Vec3<F>& woGiven, const Vec3<F>& wiGiven) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        const Vec3<F> wi{wiGiven.x, wiGiven.y, flipSign(below, wiGiven.z)};
        const Mask<F> lit = (wo.z > F(0.f)) & (wi.z > F(0.f)) & !smooth;
        const Vec3<F> h = wo + wi;
        const F h2 = lengthSquared(h);
        const GgxReflection<F> r = ggx.reflection(wo, wi, ggx.density(h, h2));
        const Spectrum<F> fresnel = conductorReflectance(min(F(0.5f) * sqrt(h2), F(1.f)), index);  // wo.m = |h| / 2
        return {fresnel * select(lit, r.fCos, F(0.f)), select(lit, r.pdf, F(0.f))};
    }

    BsdfSample<F> sample(const Vec3<F>& woGiven, F, const Vec2<F>& u) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        Vec3<F> m{F(0.f), F(0.f), F(1.f)};
        if (any(!smooth)) m = select(smooth, m, ggx.sampleVisible(wo, u));
        const F cosHalf = clamp(dot(wo, m), F(0.f), F(1.f));
        Vec3<F> wi = m * (F(2.f) * cosHalf) - wo;
        const Mask<F> valid = (wo.z > F(0.f)) & (wi.z > F(0.f));
        const Spectrum<F> fresnel = conductorReflectance(cosHalf, index);
        const F weight = select(smooth, F(1.f), ggx.shadowing(wo, wi));
        const F pdf = select(smooth, F(1.f), F(0.5f) * ggx.density(m, F(1.f)) / (wo.z + ggx.shape(wo)));
        wi.z = flipSign(below, wi.z);
        return {wi, fresnel * weight, pdf, F(1.f), smooth, valid};
    }

    Mask<F> smoothOnly() const { return smooth; }
    Spectrum<F> albedo(const Vec3<F>& wo) const { return conductorReflectance(min(abs(wo.z), F(1.f)), index); }
};

struct ConductorMaterial : RoughnessInputs {
    static constexpr ParameterInfo kParameters[] = {
        {"spectrum", "eta", "metal-Cu-eta", "index of refraction"},
        {"spectrum", "k", "metal-Cu-k", "absorption coefficient"},
        {"spectrum", "reflectance", "", "at normal incidence, instead of eta and k; texture or any spectrum"},
        kRoughnessParameter,
        kURoughnessParameter,
        kVRoughnessParameter,
        kRemapRoughnessParameter,
    };
    static constexpr PluginInfo kInfo{"conductor", "metal, smooth or rough (GGX), two-sided", kParameters};
    static constexpr bool kPassThrough = false;
    static constexpr bool kUsesLobe = false;
    template <class F>
    using Bsdf = ConductorBsdf<F>;

    SpectrumInput reflectance{};
    std::uint32_t byReflectance = 0;
    Spectrum<float> difference{}, product{};  ///< ConductorConstants where not by reflectance

    static ConductorMaterial make(MaterialInput& input) {
        ConductorMaterial m{RoughnessInputs::make(input)};
        const ParameterSet& parameters = input.parameters();
        if (parameters.findAny("reflectance")) {
            if (parameters.findAny("eta") || parameters.findAny("k"))
                input.fail("a conductor takes either reflectance or eta and k, not both");
            m.byReflectance = 1;
            m.reflectance = input.albedo("reflectance", {0.5f, 0.5f, 0.5f});
            return m;
        }
        const ConductorIndex index = input.conductorIndex("eta", "k");
        // The square of the square must stay finite; reflectance is 1 to float precision long before.
        const Rgb eta = clamp(index.eta, 0.f, 1e4f), k = clamp(index.k, 0.f, 1e4f);
        const Rgb difference = eta * eta - k * k, product = 4.f * (eta * eta * k * k);
        m.difference = {difference.r, difference.g, difference.b};
        m.product = {product.r, product.g, product.b};
        return m;
    }

    template <class F>
    static ConductorBsdf<F> bsdf(const Records<F, ConductorMaterial>& m, const ShadingContext<F>& at) {
        const SurfaceRoughness<F> rough = surface(m, at);
        ConductorConstants<Spectrum<F>> index{m(&ConductorMaterial::difference), m(&ConductorMaterial::product)};
        const Mask<F> byReflectance = m(&ConductorMaterial::byReflectance) != UInt<F>(0u);
        if (any(byReflectance)) {
            const Spectrum<F> r = at.spectrum(m, &ConductorMaterial::reflectance);
            const Spectrum<F> one = Spectrum<F>::constant(F(1.f));
            const auto kSquared = [](F x) {
                const F r = min(x, F(0.9999f));
                return F(4.f) * r / (F(1.f) - r);
            };
            const Spectrum<F> k2{kSquared(r.r), kSquared(r.g), kSquared(r.b)};
            index.difference = select(byReflectance, one - k2, index.difference);
            index.product = select(byReflectance, F(4.f) * k2, index.product);
        }
        return {index, rough.ggx, rough.smooth};
    }
};

}  // namespace penumbra
