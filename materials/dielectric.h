// "dielectric": the border of a transparent body, smooth or rough (GGX).
//
// The outside is the side of the normal; `eta` is the index inside over that outside. Light reflects by Fresnel's
// equations and refracts by Snell's law at the microfacet; refracted radiance scales by (n_o / n_i)^2, wo's index over
// wi's. An index within 1e-4 of 1 passes light straight on. What happens inside the body is the business of media.
// Single scattering: rough borders lose the light that would bounce between microfacets.
// Thread safety: plain values. Sources: Walter et al., EGSR 2007, eq. 16-21; fresnel.h, microfacet.h.
#pragma once

#include "materials/fresnel.h"
#include "materials/microfacet.h"

#include <cmath>

namespace penumbra {

/// Reads the parameter eta of a dielectric or a coat; an index no matter has is an error.
inline float readInterfaceIndex(MaterialInput& input) {
    const float eta = input.dielectricIndex("eta", 1.5f);
    if (!(eta >= 0.01f && eta <= 100.f)) input.fail("eta must lie between 0.01 and 100");
    return eta;
}

template <class F>
struct DielectricBsdf {
    F eta, inverseEta;
    Ggx<F> ggx;
    Mask<F> smooth;

    BsdfEval<F> evaluate(const Vec3<F>& woGiven, const Vec3<F>& wiGiven) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        const Vec3<F> wi{wiGiven.x, wiGiven.y, flipSign(below, wiGiven.z)};
        const F relative = select(below, inverseEta, eta);
        const Mask<F> reflects = wi.z > F(0.f);

        // The generalised half vector, on wo's side (Walter et al., eq. 13 and 16): wo + wi, or +-(wo + eta wi).
        Vec3<F> h = wo + wi * select(reflects, F(1.f), relative);
        h = flipSign(h.z < F(0.f), h);
        const F h2 = lengthSquared(h), inverseLength = F(1.f) / sqrt(max(h2, F(1e-30f)));
        const F om = dot(wo, h) * inverseLength, im = dot(wi, h) * inverseLength;
        const Mask<F> facing = (om > F(0.f)) & (reflects | (im < F(0.f)));
        const Mask<F> lit = facing & (wo.z > F(0.f)) & (wi.z != F(0.f)) & !smooth;

        const F fresnel = dielectricFresnel(clamp(om, F(0.f), F(1.f)), relative).reflectance;
        const GgxReflection<F> r = ggx.reflection(wo, {wi.x, wi.y, abs(wi.z)}, ggx.density(h, h2));
        // Refraction has the Jacobian eta^2 |wi.m| / |h|^2 where reflection has 1 / (4 wo.m); radiance scales by 1 /
        // eta^2.
        const F refraction = F(4.f) * (F(1.f) - fresnel) * abs(om * im) * inverseLength * inverseLength;
        const F f = r.fCos * select(reflects, fresnel, refraction);
        const F pdf = r.pdf * select(reflects, fresnel, refraction * relative * relative);
        return {Spectrum<F>::constant(select(lit, f, F(0.f))), select(lit, pdf, F(0.f))};
    }

    BsdfSample<F> sample(const Vec3<F>& woGiven, F uLobe, const Vec2<F>& u) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        const F relative = select(below, inverseEta, eta), inverse = select(below, eta, inverseEta);
        Vec3<F> m{F(0.f), F(0.f), F(1.f)};
        if (any(!smooth)) m = select(smooth, m, ggx.sampleVisible(wo, u));
        const F om = clamp(dot(wo, m), F(0.f), F(1.f));
        const DielectricFresnel<F> fresnel = dielectricFresnel(om, relative);
        const Mask<F> reflects = uLobe < fresnel.reflectance;

        const Vec3<F> reflected = m * (F(2.f) * om) - wo;
        const Vec3<F> refracted = (m * (om - fresnel.etaCosRefracted) - wo) * inverse;
        Vec3<F> wi = select(reflects, reflected, refracted);
        const Mask<F> valid = (wo.z > F(0.f)) & select(reflects, wi.z > F(0.f), wi.z < F(0.f));

        const F chosen = select(reflects, fresnel.reflectance, F(1.f) - fresnel.reflectance);
        const F scale = select(reflects, F(1.f), inverse * inverse);
        const F weight = scale * select(smooth, F(1.f), ggx.shadowing(wo, wi));
        const F pdfReflect = F(0.5f) * ggx.density(m, F(1.f)) / (wo.z + ggx.shape(wo));
        // |wi.m| = etaCosRefracted / eta and |wo + eta wi| = |wo.m - etaCosRefracted|
        const F hLength = om - fresnel.etaCosRefracted;
        const F toRefract = F(4.f) * om * fresnel.etaCosRefracted * relative / max(hLength * hLength, F(1e-20f));
        const F pdf = chosen * select(smooth, F(1.f), pdfReflect * select(reflects, F(1.f), toRefract));
        wi.z = flipSign(below, wi.z);
        return {wi, Spectrum<F>::constant(weight), pdf, select(reflects, F(1.f), relative), smooth, valid};
    }

    Mask<F> smoothOnly() const { return smooth; }
    Spectrum<F> albedo(const Vec3<F>&) const { return Spectrum<F>::constant(F(1.f)); }
};

struct DielectricMaterial : RoughnessInputs {
    static constexpr ParameterInfo kParameters[] = {
        {"float", "eta", "1.5", "index inside over index outside; a spectrum counts with its mean (no dispersion)"},
        kRoughnessParameter,
        kURoughnessParameter,
        kVRoughnessParameter,
        kRemapRoughnessParameter,
    };
    static constexpr PluginInfo kInfo{"dielectric", "glass, water: smooth or rough (GGX) reflection and refraction",
                                      kParameters};
    static constexpr bool kPassThrough = false;
    static constexpr bool kUsesLobe = true;
    template <class F>
    using Bsdf = DielectricBsdf<F>;

    float eta = 1.5f, inverseEta = 1.f / 1.5f;

    static DielectricMaterial make(MaterialInput& input) {
        DielectricMaterial m{RoughnessInputs::make(input)};
        m.eta = readInterfaceIndex(input);
        // Without a step of the index facets deviate nothing: refraction is a delta lobe however rough they are.
        if (std::abs(m.eta - 1.f) < 1e-4f) m.eta = 1.f;
        m.inverseEta = 1.f / m.eta;
        return m;
    }

    template <class F>
    static DielectricBsdf<F> bsdf(const Records<F, DielectricMaterial>& m, const ShadingContext<F>& at) {
        const SurfaceRoughness<F> rough = surface(m, at);
        const F eta = m(&DielectricMaterial::eta);
        const Mask<F> smooth = rough.smooth | (eta == F(1.f));
        return {eta, m(&DielectricMaterial::inverseEta), rough.ggx, smooth};
    }
};

}  // namespace penumbra
