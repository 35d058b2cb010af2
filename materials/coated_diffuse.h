// "coateddiffuse": a dielectric coat, smooth or rough (GGX), over a Lambertian base; alike from both sides.
//
// The scene format defines this material as the expected value of a random walk between coat and base, whose gap
// absorbs (optical thickness `thickness` for a perpendicular crossing) and which ends after `maxdepth` events, so that
// light meets the base at most K = ceil(maxdepth / 2) times. Because the base forgets directions that expectation is a
// product, with the T, rho and tau of coat_table.h:
//   f(wo, wi) = f_top + T(wo) T(wi) R / (pi eta^2) sum_{k < K} (R rho)^k.
// So this closure evaluates it exactly, without noise; a smooth coat's T is (1 - Fresnel) exp(-thickness / cos
// refracted).
//
// Sampling: the coat's reflection or the cosine lobe, in proportion to what each reflects from wo. Thread safety: plain
// values. Sources: Guo, Hasan & Zhao, SIGGRAPH Asia 2018 (the walk); Saunderson 1942 (the series).
#pragma once

#include "core/math/warps.h"
#include "materials/coat_interface.h"
#include "materials/coat_table.h"
#include "materials/dielectric.h"

namespace penumbra {

/// Where a lane's T and R come from.
template <class F>
struct CoatReader {
    F eta, opticalThickness;
    RoughnessTable<F> table;

    struct Value {
        F transmitted, reflected;
    };

    /// T and R of a direction with z > 0.
    Value operator()(const Vec3<F>& w) const {
        Value smoothValue{F(0.f), F(0.f)};
        if (any(table.smooth)) {
            const DielectricFresnel<F> fresnel = dielectricFresnel(min(w.z, F(1.f)), eta);
            const F path = opticalThickness * eta / max(fresnel.etaCosRefracted, F(1e-6f));
            smoothValue = {(F(1.f) - fresnel.reflectance) * exp(-path), fresnel.reflectance};
        }
        if (all(table.smooth)) return smoothValue;
        const auto [transmitted, reflected] = table.at(w);
        return {select(table.smooth, smoothValue.transmitted, transmitted),
                select(table.smooth, smoothValue.reflected, reflected)};
    }
};

template <class F>
struct CoatedDiffuseBsdf {
    CoatReader<F> coat;
    Spectrum<F> base;  ///< R / (pi eta^2) times the series: f of the base is base T(wo) T(wi)
    F baseAlbedo;      ///< pi eta^2 tau: base T(wo) times this is what the base reflects from wo

    BsdfEval<F> evaluate(const Vec3<F>& woGiven, const Vec3<F>& wiGiven) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        const Vec3<F> wi{wiGiven.x, wiGiven.y, flipSign(below, wiGiven.z)};
        const Mask<F> lit = (wo.z > F(0.f)) & (wi.z > F(0.f));
        const auto fromWo = coat(wo);
        const BsdfEval<F> value = aboveSurface(wo, {wi.x, wi.y, max(wi.z, F(0.f))}, fromWo, topProbability(fromWo));
        return {select(lit, value.fCos, Spectrum<F>::constant(F(0.f))), select(lit, value.pdf, F(0.f))};
    }

    BsdfSample<F> sample(const Vec3<F>& woGiven, F uLobe, const Vec2<F>& u) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        const auto fromWo = coat(wo);
        const F top = topProbability(fromWo);
        const Mask<F> takesTop = uLobe < top, delta = takesTop & coat.table.smooth;

        Vec3<F> m{F(0.f), F(0.f), F(1.f)};
        if (any(takesTop & !coat.table.smooth)) m = select(coat.table.smooth, m, coat.table.ggx.sampleVisible(wo, u));
        Vec3<F> wi = select(takesTop, m * (F(2.f) * max(dot(wo, m), F(0.f))) - wo, cosineHemisphere(u));
        const Mask<F> above = (wo.z > F(0.f)) & (wi.z > F(0.f));
        wi.z = max(wi.z, F(0.f));

        const BsdfEval<F> value = aboveSurface(wo, wi, fromWo, top);
        const Spectrum<F> mirror = Spectrum<F>::constant(fromWo.reflected / max(top, F(1e-20f)));
        const Spectrum<F> weight = select(delta, mirror, value.fCos * (F(1.f) / max(value.pdf, F(1e-20f))));
        const F pdf = select(delta, top, value.pdf);
        const Mask<F> valid = above & (pdf > F(1e-20f));
        wi.z = flipSign(below, wi.z);
        return {wi, weight, pdf, F(1.f), delta, valid};
    }

    Mask<F> smoothOnly() const { return Mask<F>(false); }
    Spectrum<F> albedo(const Vec3<F>& wo) const {
        const auto fromWo = coat(Vec3<F>{wo.x, wo.y, abs(wo.z)});
        return Spectrum<F>::constant(fromWo.reflected) + base * (fromWo.transmitted * baseAlbedo);
    }

private:
    /// The probability with which sample() picks the coat's reflection.
    F topProbability(const typename CoatReader<F>::Value& fromWo) const {
        const F below = average(base) * fromWo.transmitted * baseAlbedo;
        return fromWo.reflected / max(fromWo.reflected + below, F(1e-20f));
    }

    /// All but delta lobes; wo.z, wi.z >= 0.
    BsdfEval<F> aboveSurface(const Vec3<F>& wo, const Vec3<F>& wi, const typename CoatReader<F>::Value& fromWo,
                             F top) const {
        F topCos(0.f), topPdf(0.f);
        if (any(!coat.table.smooth)) {
            const Vec3<F> h = wo + wi;
            const F h2 = lengthSquared(h);
            const GgxReflection<F> r = coat.table.ggx.reflection(wo, wi, coat.table.ggx.density(h, h2));
            const F fresnel = dielectricFresnel(min(F(0.5f) * sqrt(h2), F(1.f)), coat.eta).reflectance;
            topCos = select(coat.table.smooth, F(0.f), r.fCos * fresnel);
            topPdf = select(coat.table.smooth, F(0.f), r.pdf * top);
        }
        const F both = fromWo.transmitted * coat(wi).transmitted * wi.z;
        return {base * both + Spectrum<F>::constant(topCos), topPdf + (F(1.f) - top) * wi.z * F(kInvPi)};
    }
};

struct CoatedDiffuseMaterial : RoughnessInputs, RoughnessTableInputs {
    static constexpr ParameterInfo kParameters[] = {
        {"spectrum", "reflectance", "0.5", "of the base; texture or any spectrum"},
        {"float", "eta", "1.5", "index of the coat; a spectrum counts with its mean"},
        kGapThicknessParameter,
        kGapAlbedoParameter,
        {"integer", "maxdepth", "10", "light meets the base at most half as often, rounded up"},
        kRoughnessParameter,
        kURoughnessParameter,
        kVRoughnessParameter,
        kRemapRoughnessParameter,
    };
    static constexpr PluginInfo kInfo{
        "coateddiffuse", "Lambertian base under a smooth or rough dielectric coat, two-sided", kParameters};
    static constexpr bool kPassThrough = false;
    static constexpr bool kUsesLobe = true;
    template <class F>
    using Bsdf = CoatedDiffuseBsdf<F>;

    SpectrumInput reflectance{};
    float eta = 1.5f, opticalThickness = 0.01f;
    std::uint32_t baseBounces = 5;
    float rho = 0.f, tau = 0.f;  ///< of the first row of the block (coat_table.h)

    static CoatedDiffuseMaterial make(MaterialInput& input);

    template <class F>
    static CoatedDiffuseBsdf<F> bsdf(const Records<F, CoatedDiffuseMaterial>& m, const ShadingContext<F>& at) {
        return closure(m, at.tables, surface(m, at), at.spectrum(m, &CoatedDiffuseMaterial::reflectance));
    }

    /// The closure for a roughness and reflectance already looked up.
    template <class F>
    static CoatedDiffuseBsdf<F> closure(const Records<F, CoatedDiffuseMaterial>& m, const float* tables,
                                        const SurfaceRoughness<F>& rough, const Spectrum<F>& reflectance) {
        using M = CoatedDiffuseMaterial;
        const F eta = m(&M::eta), etaSquared = eta * eta;
        const CoatReader<F> coat{eta, m(&M::opticalThickness), reader(m, tables, rough)};
        F rho = m(&M::rho), tau = m(&M::tau);
        const Mask<F> hasRows = coat.table.hasRows();
        if (any(hasRows)) {
            const auto [rowRho, rowTau] = coat.table.averages();
            rho = select(hasRows, rowRho, rho);
            tau = select(hasRows, rowTau, tau);
        }
        const Spectrum<F> series = geometricSum(reflectance * rho, m(&M::baseBounces));
        return {coat, reflectance * series * (F(kInvPi) / etaSquared), F(kPi) * etaSquared * tau};
    }

    void setBlock(std::uint32_t offset, const TableRows& rows, const float* tables);
};

}  // namespace penumbra
