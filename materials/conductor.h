// "conductor": a metal, smooth or rough (GGX), alike from both sides.
//
// Per channel, the complex index of refraction decides the colour at every angle. `reflectance` r instead of eta and k
// stands for the index 1 + i k, k = 2 sqrt(r) / sqrt(1 - r), which reflects r at normal incidence.
// Single scattering: rough metals lose the light that would bounce between microfacets, unless `multiscatter` gives it back.
// Thread safety: plain values. Sources: fresnel_rule.h, microfacet.h, compensation.h.
#pragma once

#include "materials/compensation.h"

namespace penumbra {

template <class F>
struct ConductorBsdf {
    ConductorRule<F> fresnel;
    Ggx<F> ggx;
    Mask<F> smooth;
    MetalCompensation<F> compensation;

    BsdfEval<F> evaluate(const Vec3<F>& woGiven, const Vec3<F>& wiGiven) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        const Vec3<F> wi{wiGiven.x, wiGiven.y, flipSign(below, wiGiven.z)};
        const Mask<F> lit = (wo.z > F(0.f)) & (wi.z > F(0.f)) & !smooth;
        const BsdfEval<F> value = aboveSurface(wo, wi);
        return {select(lit, value.fCos, Spectrum<F>::constant(F(0.f))), select(lit, value.pdf, F(0.f))};
    }

    BsdfSample<F> sample(const Vec3<F>& woGiven, F, const Vec2<F>& uGiven) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        Vec2<F> u = uGiven;
        Mask<F> again(false);
        if (any(compensation.active)) again = takeBelow(compensation.probability(wo), u.x);
        Vec3<F> m{F(0.f), F(0.f), F(1.f)};
        if (any(!smooth)) m = select(smooth, m, ggx.sampleVisible(wo, u));
        const F cosHalf = clamp(dot(wo, m), F(0.f), F(1.f));
        Vec3<F> wi = m * (F(2.f) * cosHalf) - wo;
        if (any(again)) wi = select(again, cosineHemisphere(u), wi);
        Mask<F> valid = (wo.z > F(0.f)) & (wi.z > F(0.f));
        Spectrum<F> weight = fresnel(cosHalf) * select(smooth, F(1.f), ggx.shadowing(wo, wi));
        F pdf = select(smooth, F(1.f), F(0.5f) * ggx.density(m, F(1.f)) / (wo.z + ggx.shape(wo)));
        if (any(compensation.active)) {
            const BsdfEval<F> both = aboveSurface(wo, {wi.x, wi.y, max(wi.z, F(0.f))});
            weight = select(compensation.active, both.fCos * (F(1.f) / max(both.pdf, F(1e-20f))), weight);
            pdf = select(compensation.active, both.pdf, pdf);
            valid = valid & (pdf > F(1e-20f));
        }
        wi.z = flipSign(below, wi.z);
        return {wi, weight, pdf, F(1.f), smooth, valid};
    }

    Mask<F> smoothOnly() const { return smooth; }
    Spectrum<F> albedo(const Vec3<F>& wo) const { return fresnel(min(abs(wo.z), F(1.f))); }

private:
    /// Of rough lanes.
    BsdfEval<F> aboveSurface(const Vec3<F>& wo, const Vec3<F>& wi) const {
        const Vec3<F> h = wo + wi;
        const F h2 = lengthSquared(h);
        const GgxReflection<F> r = ggx.reflection(wo, wi, ggx.density(h, h2));
        const BsdfEval<F> single{fresnel(min(F(0.5f) * sqrt(h2), F(1.f))) * r.fCos, r.pdf};  // wo.m = |h| / 2
        return any(compensation.active) ? compensation.add(single, wo, wi) : single;
    }
};

/// The members that say which metal, and how they are read from a scene and at a hit. Derive from it.
struct ConductorInputs {
    SpectrumInput reflectance{};
    std::uint32_t byReflectance = 0;
    Spectrum<float> difference{}, product{};  ///< of ConductorRule, where not by reflectance

    /// `prefix` comes before the names of eta and k. `above`: the index of what lies over the metal.
    static ConductorInputs make(MaterialInput& input, const std::string& prefix = {}, float above = 1.f) {
        ConductorInputs m;
        const std::string eta = prefix + "eta", k = prefix + "k";
        const ParameterSet& parameters = input.parameters();
        if (parameters.findAny("reflectance")) {
            if (parameters.findAny(eta) || parameters.findAny(k))
                input.fail("a conductor takes either reflectance or " + eta + " and " + k + ", not both");
            m.byReflectance = 1;
            m.reflectance = input.albedo("reflectance", {0.5f, 0.5f, 0.5f});
            return m;
        }
        const ConductorIndex index = input.conductorIndex(eta, k);
        // The square of the square must stay finite; reflectance is 1 to float precision long before.
        const auto squared = [above](const Rgb& x) {
            const Rgb relative = clamp((1.f / above) * x, 0.f, 1e4f);
            return relative * relative;
        };
        const Rgb eta2 = squared(index.eta), k2 = squared(index.k), d = eta2 - k2, p = 4.f * (eta2 * k2);
        m.difference = {d.r, d.g, d.b};
        m.product = {p.r, p.g, p.b};
        return m;
    }

    /// The reflectance of M, a type derived from this one, in lanes that go by it.
    template <class F, class M>
    static Spectrum<F> reflectanceOf(const Records<F, M>& m, const ShadingContext<F>& at) {
        if (none(isByReflectance(m))) return Spectrum<F>::constant(F(0.f));
        return at.spectrum(m, static_cast<SpectrumInput M::*>(&ConductorInputs::reflectance));
    }
    /// `perSquare` is 1 / n^2 of what lies over the metal.
    template <class F, class M>
    static ConductorConstants<Spectrum<F>> index(const Records<F, M>& m, const Spectrum<F>& reflectance, F perSquare) {
        const ConductorConstants<Spectrum<F>> given{m(static_cast<Spectrum<float> M::*>(&ConductorInputs::difference)),
                                                    m(static_cast<Spectrum<float> M::*>(&ConductorInputs::product))};
        const Mask<F> byReflectance = isByReflectance(m);
        if (none(byReflectance)) return given;
        const auto r = constantsOfReflectance(reflectance.r), g = constantsOfReflectance(reflectance.g),
                   b = constantsOfReflectance(reflectance.b);
        const Spectrum<F> d{r.difference, g.difference, b.difference}, p{r.product, g.product, b.product};
        return {select(byReflectance, d * perSquare, given.difference),
                select(byReflectance, p * sqr(perSquare), given.product)};
    }
    template <class F, class M>
    static Mask<F> isByReflectance(const Records<F, M>& m) {
        return m(static_cast<std::uint32_t M::*>(&ConductorInputs::byReflectance)) != UInt<F>(0u);
    }
};

struct ConductorMaterial : RoughnessInputs, EnergyInputs, ConductorInputs {
    static constexpr ParameterInfo kParameters[] = {
        {"spectrum", "eta", "metal-Cu-eta", "index of refraction"},
        {"spectrum", "k", "metal-Cu-k", "absorption coefficient"},
        {"spectrum", "reflectance", "", "at normal incidence, instead of eta and k; texture or any spectrum"},
        kRoughnessParameter,
        kURoughnessParameter,
        kVRoughnessParameter,
        kRemapRoughnessParameter,
        kFresnelParameter,
        kMultiscatterParameter,
    };
    static constexpr PluginInfo kInfo{"conductor", "metal, smooth or rough (GGX), two-sided", kParameters};
    static constexpr bool kPassThrough = false;
    static constexpr bool kUsesLobe = false;
    template <class F>
    using Bsdf = ConductorBsdf<F>;

    std::uint32_t schlick = 0;  ///< difference is then the reflectance of perpendicular light
    Spectrum<float> mean{};       ///< meanReflectance, where not by reflectance
    std::uint32_t meanTable = 0;  ///< of it, where by reflectance

    static ConductorMaterial make(MaterialInput& input) {
        ConductorMaterial m{RoughnessInputs::make(input), {}, ConductorInputs::make(input)};
        m.schlick = readSchlick(input);
        if (m.schlick && !m.byReflectance)
            m.difference = conductorReflectance(1.f, ConductorConstants<Spectrum<float>>{m.difference, m.product});
        if (input.parameters().boolean("multiscatter", false)) m.compensate(input);
        return m;
    }

    template <class F>
    static ConductorBsdf<F> bsdf(const Records<F, ConductorMaterial>& m, const ShadingContext<F>& at) {
        using M = ConductorMaterial;
        const SurfaceRoughness<F> rough = surface(m, at);
        const Mask<F> schlick = m(&M::schlick) != UInt<F>(0u), byReflectance = isByReflectance(m);
        const Spectrum<F> reflectance = reflectanceOf(m, at);
        ConductorRule<F> rule{index(m, reflectance, F(1.f)), schlick};
        if (any(byReflectance & schlick))
            rule.index.difference = select(byReflectance & schlick, reflectance, rule.index.difference);
        const Mask<F> multiscatter = m(&M::multiscatter) != UInt<F>(0u);
        MetalCompensation<F> compensation{Mask<F>(false), {}, F(0.f), {}, F(0.f)};
        if (any(multiscatter)) {
            const Spectrum<F> looked = meanOf(m, at, rule.schlick, reflectance);
            compensation = metalCompensation(multiscatter & !rough.smooth, reader(m, at.tables, rough),
                                             select(byReflectance, looked, m(&M::mean)));
        }
        return {rule, rough.ggx, rough.smooth, compensation};
    }

private:
    void compensate(MaterialInput& input) {
        static_cast<EnergyInputs&>(*this) = mirrorEnergy(input, *this);
        if (byReflectance)
            meanTable = meanReflectanceTable(input);
        else
            mean = meanReflectance({{difference, product}, schlick != 0});
    }
    /// The mean of Fresnel's factor for a reflectance of perpendicular light.
    template <class F>
    static Spectrum<F> meanOf(const Records<F, ConductorMaterial>& m, const ShadingContext<F>& at, const Mask<F>& schlick,
                              const Spectrum<F>& reflectance) {
        const UInt<F> table = m(&ConductorMaterial::meanTable);
        const auto channel = [&](F r) {
            const F step = r * F(float(kReflectanceSteps)), cell = min(floor(step), F(float(kReflectanceSteps - 1)));
            const UInt<F> word = table + toUInt(cell);
            const F exact = lerp(step - cell, gather(at.tables, word), gather(at.tables, word + UInt<F>(1u)));
            return select(schlick, (F(20.f) * r + F(1.f)) * F(1.f / 21.f), exact);
        };
        return {channel(reflectance.r), channel(reflectance.g), channel(reflectance.b)};
    }
};

}  // namespace penumbra
