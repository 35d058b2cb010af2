// "dielectric": the border of a transparent body, smooth or rough (GGX).
//
// The outside is the side of the normal; `eta` is the index inside over that outside. Light reflects by Fresnel's
// equations and refracts by Snell's law at the microfacet; refracted radiance scales by (n_o / n_i)^2, wo's index over
// wi's. An index within 1e-4 of 1 passes light straight on. What happens inside the body is the business of media.
// Single scattering: rough borders lose the light that would bounce between microfacets, unless `multiscatter` gives it back.
// Thread safety: plain values. Sources: Walter et al., EGSR 2007, eq. 16-21; fresnel_rule.h, microfacet.h, compensation.h.
#pragma once

#include "materials/compensation.h"

#include <cmath>

namespace penumbra {

/// Reads the parameter that is the index of a dielectric or a coat; an index no matter has is an error.
inline float readInterfaceIndex(MaterialInput& input, std::string_view name = "eta") {
    const float eta = input.dielectricIndex(name, 1.5f);
    if (!(eta >= 0.01f && eta <= 100.f)) input.fail(std::string(name) + " must lie between 0.01 and 100");
    return eta;
}

template <class F>
struct DielectricBsdf {
    F eta, inverseEta;
    Ggx<F> ggx;
    Mask<F> smooth;
    DielectricRule<F> rule;
    DielectricCompensation<F> compensation;

    BsdfEval<F> evaluate(const Vec3<F>& woGiven, const Vec3<F>& wiGiven) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        const Vec3<F> wi{wiGiven.x, wiGiven.y, flipSign(below, wiGiven.z)};
        const F relative = select(below, inverseEta, eta);
        const Mask<F> lit = (wo.z > F(0.f)) & (wi.z != F(0.f)) & !smooth;
        const BsdfEval<F> value = fromAbove(wo, wi, below, relative);
        return {select(lit, value.fCos, Spectrum<F>::constant(F(0.f))), select(lit, value.pdf, F(0.f))};
    }

    BsdfSample<F> sample(const Vec3<F>& woGiven, F uGiven, const Vec2<F>& u) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        const F relative = select(below, inverseEta, eta), inverse = select(below, eta, inverseEta);
        F uLobe = uGiven;
        Mask<F> again(false);
        if (any(compensation.active)) again = takeBelow(compensation.probability(wo, below), uLobe);
        Vec3<F> m{F(0.f), F(0.f), F(1.f)};
        if (any(!smooth)) m = select(smooth, m, ggx.sampleVisible(wo, u));
        const F om = clamp(dot(wo, m), F(0.f), F(1.f));
        const DielectricFresnel<F> fresnel = rule(om, relative);
        Mask<F> reflects = uLobe < fresnel.reflectance;

        const Vec3<F> reflected = m * (F(2.f) * om) - wo;
        const Vec3<F> refracted = (m * (om - fresnel.etaCosRefracted) - wo) * inverse;
        Vec3<F> wi = select(reflects, reflected, refracted);
        if (any(again)) {
            reflects = select(again, uLobe < F(1.f) - compensation.transmitted(below), reflects);
            const Vec3<F> diffuse = cosineHemisphere(u);
            wi = select(again, {diffuse.x, diffuse.y, flipSign(!reflects, diffuse.z)}, wi);
        }
        Mask<F> valid = (wo.z > F(0.f)) & select(reflects, wi.z > F(0.f), wi.z < F(0.f));

        const F chosen = select(reflects, fresnel.reflectance, F(1.f) - fresnel.reflectance);
        const F scale = select(reflects, F(1.f), inverse * inverse);
        F weight = scale * select(smooth, F(1.f), ggx.shadowing(wo, wi));
        const F pdfReflect = F(0.5f) * ggx.density(m, F(1.f)) / (wo.z + ggx.shape(wo));
        // |wi.m| = etaCosRefracted / eta and |wo + eta wi| = |wo.m - etaCosRefracted|
        const F hLength = om - fresnel.etaCosRefracted;
        const F toRefract = F(4.f) * om * fresnel.etaCosRefracted * relative / max(hLength * hLength, F(1e-20f));
        F pdf = chosen * select(smooth, F(1.f), pdfReflect * select(reflects, F(1.f), toRefract));
        if (any(compensation.active)) {
            const BsdfEval<F> both = fromAbove(wo, wi, below, relative);
            weight = select(compensation.active, both.fCos.r / max(both.pdf, F(1e-20f)), weight);
            pdf = select(compensation.active, both.pdf, pdf);
            valid = valid & (pdf > F(1e-20f));
        }
        wi.z = flipSign(below, wi.z);
        return {wi, Spectrum<F>::constant(weight), pdf, select(reflects, F(1.f), relative), smooth, valid};
    }
    Mask<F> smoothOnly() const { return smooth; }
    Spectrum<F> albedo(const Vec3<F>&) const { return Spectrum<F>::constant(F(1.f)); }

private:
    /// Of rough lanes, wo.z > 0; `inside` is the side of wo.
    BsdfEval<F> fromAbove(const Vec3<F>& wo, const Vec3<F>& wi, const Mask<F>& inside, F relative) const {
        const Mask<F> reflects = wi.z > F(0.f);
        // The generalised half vector, on wo's side (Walter et al., eq. 13 and 16): wo + wi, or +-(wo + eta wi).
        Vec3<F> h = wo + wi * select(reflects, F(1.f), relative);
        h = flipSign(h.z < F(0.f), h);
        const F h2 = lengthSquared(h), inverseLength = F(1.f) / sqrt(max(h2, F(1e-30f)));
        const F om = dot(wo, h) * inverseLength, im = dot(wi, h) * inverseLength;
        const Mask<F> facing = (om > F(0.f)) & (reflects | (im < F(0.f)));

        const F fresnel = rule(clamp(om, F(0.f), F(1.f)), relative).reflectance;
        const GgxReflection<F> r = ggx.reflection(wo, {wi.x, wi.y, abs(wi.z)}, ggx.density(h, h2));
        // Refraction has the Jacobian eta^2 |wi.m| / |h|^2 where reflection has 1 / (4 wo.m); radiance scales by 1 /
        // eta^2.
        const F refraction = F(4.f) * (F(1.f) - fresnel) * abs(om * im) * inverseLength * inverseLength;
        const F f = r.fCos * select(reflects, fresnel, refraction);
        const F pdf = r.pdf * select(reflects, fresnel, refraction * relative * relative);
        const BsdfEval<F> single{Spectrum<F>::constant(select(facing, f, F(0.f))), select(facing, pdf, F(0.f))};
        return any(compensation.active) ? compensation.add(single, wo, wi, inside, relative) : single;
    }
};

struct DielectricMaterial : RoughnessInputs, EnergyInputs {
    static constexpr ParameterInfo kParameters[] = {
        {"float", "eta", "1.5", "index inside over index outside; a spectrum counts with its mean (no dispersion)"},
        kRoughnessParameter,
        kURoughnessParameter,
        kVRoughnessParameter,
        kRemapRoughnessParameter,
        kFresnelParameter,
        kMultiscatterParameter,
    };
    static constexpr PluginInfo kInfo{"dielectric", "glass, water: smooth or rough (GGX) reflection and refraction",
                                      kParameters};
    static constexpr bool kPassThrough = false;
    static constexpr bool kUsesLobe = true;
    template <class F>
    using Bsdf = DielectricBsdf<F>;

    float eta = 1.5f, inverseEta = 1.f / 1.5f;
    std::uint32_t schlick = 0;
    float transmittance = 1.f;  ///< meanTransmittance, for multiscatter

    static DielectricMaterial make(MaterialInput& input) {
        DielectricMaterial m{RoughnessInputs::make(input), {}};
        m.eta = readInterfaceIndex(input);
        // Without a step of the index facets deviate nothing: refraction is a delta lobe however rough they are.
        if (std::abs(m.eta - 1.f) < 1e-4f) m.eta = 1.f;
        m.inverseEta = 1.f / m.eta;
        m.schlick = readSchlick(input);
        if (input.parameters().boolean("multiscatter", false) && m.eta != 1.f) {
            static_cast<EnergyInputs&>(m) = dielectricEnergy(input, m, m.eta, m.schlick);
            m.transmittance = meanTransmittance(m.eta, m.schlick);
        }
        return m;
    }

    template <class F>
    static DielectricBsdf<F> bsdf(const Records<F, DielectricMaterial>& m, const ShadingContext<F>& at) {
        using M = DielectricMaterial;
        const SurfaceRoughness<F> rough = surface(m, at);
        const F eta = m(&M::eta), inverse = m(&M::inverseEta);
        const Mask<F> smooth = rough.smooth | (eta == F(1.f));
        const Mask<F> multiscatter = m(&M::multiscatter) != UInt<F>(0u);
        DielectricCompensation<F> compensation{Mask<F>(false), {}, F(0.f), F(0.f), F(0.f), F(0.f)};
        if (any(multiscatter))
            compensation = dielectricCompensation(multiscatter & !smooth, reader(m, at.tables, rough), eta,
                                                  m(&M::transmittance));
        return {eta, inverse, rough.ggx, smooth, {m(&M::schlick) != UInt<F>(0u)}, compensation};
    }
};

}  // namespace penumbra
