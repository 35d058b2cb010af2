// "coatedconductor": a dielectric coat, smooth or rough (GGX), over a metal, smooth or rough; alike from both sides.
//
// The scene format defines this material as the expected value of a random walk between coat and metal, whose gap
// absorbs (coat_interface.h) and which ends after `maxdepth` events, so that light meets the metal at most
// K = ceil(maxdepth / 2) times. With both smooth the walk has one way to go, and its sum is
//   R = F + T^2 A Rm sum_{k < K} (Rm F A)^k,   T = 1 - F, A what is left of two crossings of the gap, Rm of the metal.
// Else nothing closed is known, and evaluate() *estimates*: one such walk from wo for each of `nsamples`, which connects
// to wi at every meeting with the metal, by both of
//   the metal reflecting what enters from wi by a facet of the coat, and
//   the coat refracting to wi what the metal reflects at random,
// weighed against each other by the power heuristic where the surfaces leave a choice. Every number of the walk comes
// from the closure's own seed, so that evaluate() is a function of its arguments, unbiased over seeds
// (ShadingContext::chance). With a smooth coat the first meeting, most of the light, is exact.
//
// The density is another matter: sample() draws from three lobes that need no walk. The coat's reflection; the metal's
// as the coat bends it, as wide as both roughnesses make it; and a cosine lobe for what goes astray between the two.
//
// Thread safety: plain values. Sources: Guo, Hasan & Zhao, SIGGRAPH Asia 2018 (position-free walks, both connections);
// Belcour, SIGGRAPH 2018 (widths of lobes add as variances).
#pragma once

#include "core/math/hash.h"
#include "core/math/warps.h"
#include "materials/coat_interface.h"
#include "materials/conductor.h"
#include "materials/dielectric.h"

namespace penumbra {

template <class F>
struct CoatedConductorBsdf {
    CoatInterface<F> coat;
    ConductorBsdf<F> metal;
    UInt<F> metalBounces, walks, seed;
    Ggx<F> lobe;   ///< of the metal's reflection, seen inside the coat, widened by the coat's roughness
    F astray;      ///< share of the cosine lobe in what sample() draws below the coat

    BsdfEval<F> evaluate(const Vec3<F>& woGiven, const Vec3<F>& wiGiven) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        const Vec3<F> wi{wiGiven.x, wiGiven.y, flipSign(below, wiGiven.z)};
        const Mask<F> rough = !smoothOnly(), lit = (wo.z > F(0.f)) & (wi.z > F(0.f)) & rough;
        if (none(lit)) return {Spectrum<F>::constant(F(0.f)), F(0.f)};
        const BsdfEval<F> value = aboveSurface(wo, {wi.x, wi.y, max(wi.z, F(0.f))}, topProbability(wo), lit);
        return {select(lit, value.fCos, Spectrum<F>::constant(F(0.f))), select(lit, value.pdf, F(0.f))};
    }

    BsdfSample<F> sample(const Vec3<F>& woGiven, F uLobe, const Vec2<F>& u) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        const F top = topProbability(wo);
        const Mask<F> takesTop = uLobe < top, delta = takesTop & coat.smooth;
        const Mask<F> takesCosine = uLobe < top + (F(1.f) - top) * astray;

        Vec3<F> wi{-wo.x, -wo.y, wo.z};
        if (!all(delta)) {
            Vec3<F> m{F(0.f), F(0.f), F(1.f)};
            if (any(!coat.smooth)) m = select(coat.smooth, m, coat.ggx.sampleVisible(wo, u));
            const Vec3<F> fromTop = m * (F(2.f) * max(dot(wo, m), F(0.f))) - wo;
            const Vec3<F> fromBelow = select(takesCosine, cosineHemisphere(u), sampleMetal(wo, u));
            wi = select(delta, wi, select(takesTop, fromTop, fromBelow));
        }
        const Mask<F> valid = (wo.z > F(0.f)) & (wi.z > F(0.f));
        wi.z = max(wi.z, F(0.f));

        F pdf(0.f);
        Spectrum<F> weight = Spectrum<F>::constant(F(0.f));
        const Mask<F> spread = !delta, evaluated = valid & spread;
        if (any(evaluated)) {
            const BsdfEval<F> value = aboveSurface(wo, wi, top, evaluated);
            pdf = select(evaluated, value.pdf, F(0.f));
            weight = select(evaluated, value.fCos * (F(1.f) / max(pdf, F(1e-20f))), weight);
        }
        if (any(delta)) {
            const F fresnel = coatReflectance(wo.z);
            const Spectrum<F> mirrored =
                select(metal.smooth, albedo(wo), Spectrum<F>::constant(fresnel / max(top, F(1e-20f))));
            weight = select(delta, mirrored, weight);
            pdf = select(delta, top, pdf);
        }
        wi.z = flipSign(below, wi.z);
        const Mask<F> useful = valid & (pdf > F(1e-20f));
        return {wi, weight, pdf, F(1.f), delta, useful};
    }

    Mask<F> smoothOnly() const { return coat.smooth & metal.smooth; }

    /// Exact where both are smooth; of rough layers an estimate.
    Spectrum<F> albedo(const Vec3<F>& wo) const {
        const DielectricFresnel<F> fresnel = dielectricFresnel(min(abs(wo.z), F(1.f)), coat.eta);
        const F through = F(1.f) - fresnel.reflectance, cosine = min(fresnel.etaCosRefracted * coat.inverseEta, F(1.f));
        const F left = sqr(coat.crossing(cosine));
        const Spectrum<F> onMetal = metal.fresnel(cosine) * left;
        return Spectrum<F>::constant(fresnel.reflectance) +
               onMetal * geometricSum(onMetal * fresnel.reflectance, metalBounces) * (through * through);
    }

private:
    /// The numbers of a walk, in order: pure functions of its key.
    struct Numbers {
        UInt<F> key;
        std::uint32_t drawn = 0;
        F one() { return unitFloat<F>(mixBits(key + UInt<F>(0x9E3779B9u * ++drawn))); }
        Vec2<F> pair() {
            const F x = one();
            return {x, one()};
        }
    };

    F coatReflectance(F cosine) const { return dielectricFresnel(min(cosine, F(1.f)), coat.eta).reflectance; }

    /// The probability with which sample() picks the coat's reflection; all where there is nothing but mirrors.
    F topProbability(const Vec3<F>& wo) const {
        const F top = coatReflectance(abs(wo.z));
        return select(smoothOnly(), F(1.f), top / max(average(albedo(wo)), F(1e-20f)));
    }

    /// All but delta lobes; wo.z, wi.z >= 0. The value only of `wanted` lanes.
    BsdfEval<F> aboveSurface(const Vec3<F>& wo, const Vec3<F>& wi, F top, const Mask<F>& wanted) const {
        F topCos(0.f), topPdf(0.f);
        if (any(!coat.smooth)) {
            const Vec3<F> h = wo + wi;
            const F h2 = lengthSquared(h);
            const GgxReflection<F> r = coat.ggx.reflection(wo, wi, coat.ggx.density(h, h2));
            topCos = select(coat.smooth, F(0.f), r.fCos * coatReflectance(F(0.5f) * sqrt(h2)));
            topPdf = select(coat.smooth, F(0.f), r.pdf * top);
        }
        const F pdf = topPdf + (F(1.f) - top) * lerp(astray, metalDensity(wo, wi), wi.z * F(kInvPi));
        return {estimateBelow(wo, wi, wanted) + Spectrum<F>::constant(topCos), pdf};
    }

    /// A direction outside (z > 0), and the same light inside a smooth coat, pointing away from the metal.
    Vec3<F> inside(const Vec3<F>& w) const {
        const F etaCos = dielectricFresnel(min(w.z, F(1.f)), coat.eta).etaCosRefracted;
        return Vec3<F>{w.x, w.y, etaCos} * coat.inverseEta;
    }
    /// The lobe of the metal as a smooth coat shows it. What it totally reflects points nowhere: z <= 0.
    Vec3<F> sampleMetal(const Vec3<F>& wo, const Vec2<F>& u) const {
        const Vec3<F> from = inside(wo);
        const Vec3<F> m = lobe.sampleVisible(from, u);
        const Vec3<F> up = m * (F(2.f) * max(dot(from, m), F(0.f))) - from;
        const F x = up.x * coat.eta, y = up.y * coat.eta, cosSquared = F(1.f) - x * x - y * y;
        return {x, y, select((from.z > F(0.f)) & (up.z > F(0.f)), safeSqrt(cosSquared), F(0.f))};
    }
    F metalDensity(const Vec3<F>& wo, const Vec3<F>& wi) const {
        const Vec3<F> from = inside(wo), to = inside(wi), h = from + to;
        const F pdf = lobe.reflection(from, to, lobe.density(h, lengthSquared(h))).pdf;
        // d(to) / d(wi) = cos wi / (eta^2 cos to)
        const F jacobian = wi.z * sqr(coat.inverseEta) / max(to.z, F(1e-10f));
        return select((from.z > F(0.f)) & (to.z > F(0.f)), pdf * jacobian, F(0.f));
    }

    /// a^2 / (a^2 + b^2); a > 0.
    static F powerHeuristic(F a, F b) { return F(1.f) / (F(1.f) + sqr(b / max(a, F(1e-20f)))); }

    /// What comes to wo from wi by way of the metal, times cos wi.
    Spectrum<F> estimateBelow(const Vec3<F>& wo, const Vec3<F>& wi, const Mask<F>& wanted) const {
        Spectrum<F> sum = Spectrum<F>::constant(F(0.f));
        for (std::uint32_t i = 0;; ++i) {
            const Mask<F> walking = wanted & (UInt<F>(i) < walks);
            if (none(walking)) break;
            sum += walk(wo, wi, Numbers{mixBits(seed ^ UInt<F>(mixBits(i)))}, walking);
        }
        return sum * (F(1.f) / toFloat<F>(walks));
    }

    Spectrum<F> walk(const Vec3<F>& wo, const Vec3<F>& wi, Numbers numbers, Mask<F> walking) const {
        constexpr std::uint32_t kSurelyGoesOn = 2;
        const auto [into, intoFraction] = coat.enter(wo, numbers.pair());
        const auto [light, lightFraction] = coat.enter(wi, numbers.pair());
        const F arrives = lightFraction * coat.crossing(light.z) * wi.z / max(-light.z, F(1e-6f));
        F lightDensity(0.f);
        const Mask<F> roughCoat = !coat.smooth, roughMetal = !metal.smooth;
        if (any(walking & roughCoat & roughMetal)) lightDensity = coat.leave(-light, wi).density;

        Spectrum<F> sum = Spectrum<F>::constant(F(0.f));
        // Radiance loses 1 / eta^2 where it enters: light that leaves regains it.
        Spectrum<F> throughput =
            Spectrum<F>::constant(intoFraction * coat.crossing(into.z) * sqr(coat.inverseEta));
        Vec3<F> down = into;
        for (std::uint32_t k = 0;; ++k) {
            walking = walking & (UInt<F>(k) < metalBounces) & (maxComponent(throughput) > F(0.f));
            if (none(walking)) return sum;
            const auto add = [&](const Spectrum<F>& value, const Mask<F>& lanes) {
                sum += select(walking & lanes, throughput * value, Spectrum<F>::constant(F(0.f)));
            };
            if (any(walking & roughMetal)) {
                const BsdfEval<F> met = metal.evaluate(-down, -light);
                const F weight = select(coat.smooth, F(1.f), powerHeuristic(lightDensity, met.pdf));
                add(met.fCos * (arrives * weight), roughMetal);
            }
            const BsdfSample<F> s = metal.sample(-down, F(0.f), numbers.pair());
            throughput *= s.weight * coat.crossing(s.wi.z);
            walking = walking & s.valid;
            if (any(walking & roughCoat)) {
                const auto exit = coat.leave(s.wi, wi);
                const F weight = select(metal.smooth, F(1.f), powerHeuristic(s.pdf, exit.density));
                add(Spectrum<F>::constant(exit.fCos * weight), roughCoat);
            }
            const auto [back, fraction] = coat.sendBack(s.wi, numbers.pair());
            throughput *= fraction * coat.crossing(back.z);
            down = back;
            if (k < kSurelyGoesOn) continue;
            const F survival = min(maxComponent(throughput) * sqr(coat.eta), F(1.f));
            walking = walking & (numbers.one() < survival);
            throughput *= F(1.f) / max(survival, F(1e-20f));
        }
    }
};

struct CoatRoughness : RoughnessInputs {};
struct MetalRoughness : RoughnessInputs {};

struct CoatedConductorMaterial : CoatRoughness, MetalRoughness, ConductorInputs {
    static constexpr ParameterInfo kParameters[] = {
        {"spectrum", "conductor.eta", "metal-Cu-eta", "index of refraction of the metal"},
        {"spectrum", "conductor.k", "metal-Cu-k", "absorption coefficient of the metal"},
        {"spectrum", "reflectance", "", "of the bare metal at normal incidence, instead of eta and k"},
        {"float", "conductor.roughness", "0", "of the metal; 0 is smooth; texture or number"},
        {"float", "conductor.uroughness", "conductor.roughness", "roughness of the metal along the tangent"},
        {"float", "conductor.vroughness", "conductor.roughness", "roughness of the metal across the tangent"},
        {"float", "interface.eta", "1.5", "index of the coat; a spectrum counts with its mean"},
        {"float", "interface.roughness", "0", "of the coat; 0 is smooth; texture or number"},
        {"float", "interface.uroughness", "interface.roughness", "roughness of the coat along the tangent"},
        {"float", "interface.vroughness", "interface.roughness", "roughness of the coat across the tangent"},
        kGapThicknessParameter,
        kGapAlbedoParameter,
        {"integer", "maxdepth", "10", "light meets the metal at most half as often, rounded up"},
        {"integer", "nsamples", "1", "walks between coat and metal, averaged, where one of them is rough"},
        kRemapRoughnessParameter,
    };
    static constexpr PluginInfo kInfo{"coatedconductor", "metal under a dielectric coat, each smooth or rough, two-sided",
                                      kParameters};
    static constexpr bool kPassThrough = false;
    static constexpr bool kUsesLobe = true;
    static constexpr bool kEstimates = true;
    template <class F>
    using Bsdf = CoatedConductorBsdf<F>;

    float eta = 1.5f, opticalThickness = 0.01f;
    std::uint32_t metalBounces = 5, walks = 1;

    static CoatedConductorMaterial make(MaterialInput& input);
    bool needsTangent() const { return CoatRoughness::needsTangent() || MetalRoughness::needsTangent(); }

    template <class F>
    static CoatedConductorBsdf<F> bsdf(const Records<F, CoatedConductorMaterial>& m, const ShadingContext<F>& at) {
        using M = CoatedConductorMaterial;
        const auto coat = RoughnessInputs::surface<F, M, CoatRoughness>(m, at);
        const auto metal = RoughnessInputs::surface<F, M, MetalRoughness>(m, at);
        const F eta = m(&M::eta), inverseEta = F(1.f) / eta;
        // A facet that tilts by d turns what it refracts, seen inside, by (1 - 1/eta) d, and what it reflects by 2 d;
        // light passes the coat twice.
        const F bend = F(0.5f) * sqr(F(1.f) - inverseEta);
        const auto width = [&](F onMetal, F inCoat) {
            const F variance = select(metal.smooth, F(0.f), sqr(onMetal)) + select(coat.smooth, F(0.f), bend * sqr(inCoat));
            return max(sqrt(variance), F(1e-4f));
        };
        const Ggx<F> lobe{width(metal.ggx.ax, coat.ggx.ax), width(metal.ggx.ay, coat.ggx.ay)};
        return {{eta, inverseEta, m(&M::opticalThickness), coat.ggx, coat.smooth},
                {{ConductorInputs::index(m, ConductorInputs::reflectanceOf(m, at), sqr(inverseEta)), Mask<F>(false)},
                 metal.ggx,
                 metal.smooth,
                 {Mask<F>(false), {}, F(0.f), {}, F(0.f)}},
                m(&M::metalBounces),
                m(&M::walks),
                floatBits(at.chance),
                lobe,
                min(max(lobe.ax, lobe.ay), F(0.5f))};
    }
};

}  // namespace penumbra
