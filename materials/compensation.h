// What single scattering by rough (GGX) facets loses, given back: the light that meets several facets, as a lobe that is
// nearly diffuse. An option of rough materials ("bool multiscatter").
//
// E(w): the energy that single scattering reflects (and transmits) from w, and Em its cosine-weighted mean. For facets that
// lose nothing a lobe (1 - E(wo)) (1 - E(wi)) / (pi (1 - Em)) makes both sum to one from everywhere, and is reciprocal.
// Metals: it is tinted by what the facets absorb on the way, Fm^2 Em / (1 - Fm (1 - Em)), Fm the mean of Fresnel's factor.
// Dielectrics: of what is lost on a side, a fraction t leaves on the other, with that side's (1 - E) and its mean. t is the
// mean of Fresnel's transmittance from outside, and from inside what reciprocity makes of it; both at most 1.
// E stands in a table (roughness_table.h): exact for isotropic roughness to 1e-3 of E; where anisotropic, the sum is one to
// 1e-2 (tests/materials_compensation_test.cpp). What the lobe does not know: that several bounces leave a colour and a
// direction that are less than diffuse.
// Thread safety: plain values. Sources: Kelemen & Szirmay-Kalos, Eurographics short papers 2001; Kulla & Conty, "Revisiting
// physically based shading at Imageworks", SIGGRAPH 2017 course.
#pragma once

#include "core/math/warps.h"
#include "materials/fresnel_rule.h"
#include "materials/roughness_table.h"

namespace penumbra {

inline constexpr ParameterInfo kMultiscatterParameter{
    "bool", "multiscatter", "false", "give back what rough facets lose by scattering light once only"};

/// A material's table of E.
struct EnergyInputs : RoughnessTableInputs {
    std::uint32_t multiscatter = 0;  ///< 1: there is one
};
/// Of rough mirrors: both functions are E, both averages Em. None where the surface is smooth.
EnergyInputs mirrorEnergy(MaterialInput& input, const RoughnessInputs& rough);

/// Of dielectrics: from outside, and from inside.
EnergyInputs dielectricEnergy(MaterialInput& input, const RoughnessInputs& rough, float eta, bool schlick);
/// The cosine-weighted mean of what a smooth border transmits from outside.
float meanTransmittance(float eta, bool schlick);

/// 2 int_0^1 mu F(mu) dmu of a metal.
Spectrum<float> meanReflectance(const ConductorRule<float>& rule);
/// The block of that mean where perpendicular light is reflected by i / kReflectanceSteps.
inline constexpr std::uint32_t kReflectanceSteps = 64;
std::uint32_t meanReflectanceTable(MaterialInput& input);

/// What a metal's single scattering lacks; wo and wi stand above the surface.
template <class F>
struct MetalCompensation {
    Mask<F> active;
    RoughnessTable<F> energy;
    F meanLost;        ///< 1 - Em
    Spectrum<F> tint;  ///< what is left of the light that meets several facets
    F once;            ///< the mean of Fresnel's factor, over the channels: single scattering's share is E times that

    F lost(const Vec3<F>& w) const { return F(1.f) - energy.at(w).first; }
    /// With which sample() should take this lobe; 0 where it is not active.
    F probability(const Vec3<F>& wo) const {
        const F lostHere = lost(wo), again = lostHere * average(tint);
        const F p = again / max(again + (F(1.f) - lostHere) * once, F(1e-20f));
        return select(active, p, F(0.f));
    }
    /// Both lobes, given the single one.
    BsdfEval<F> add(const BsdfEval<F>& single, const Vec3<F>& wo, const Vec3<F>& wi) const {
        const F cosine = wi.z * F(kInvPi), strength = lost(wo) * lost(wi) / max(meanLost, F(1e-6f)) * cosine;
        return {single.fCos + tint * select(active, strength, F(0.f)), lerp(probability(wo), single.pdf, cosine)};
    }
};

/// `mean` is that of Fresnel's factor.
template <class F>
MetalCompensation<F> metalCompensation(const Mask<F>& active, const RoughnessTable<F>& energy, const Spectrum<F>& mean) {
    const F reflected = energy.averages().first, lost = F(1.f) - reflected;
    const auto tint = [&](F f) { return f * f * reflected / max(F(1.f) - f * lost, F(1e-6f)); };
    return {active, energy, lost, {tint(mean.r), tint(mean.g), tint(mean.b)}, average(mean)};
}

/// What a dielectric's single scattering lacks. wo stands above the surface, whichever side `inside` says that is.
template <class F>
struct DielectricCompensation {
    Mask<F> active;
    RoughnessTable<F> energy;
    F meanLostOutside, meanLostInside;        ///< 1 - Em
    F transmittedOutside, transmittedInside;  ///< t of the side that light comes from

    F lost(const Vec3<F>& w, const Mask<F>& inside) const {
        const auto [outer, inner] = energy.at(w);
        return F(1.f) - select(inside, inner, outer);
    }
    /// With which sample() should take this lobe; 0 where it is not active.
    F probability(const Vec3<F>& wo, const Mask<F>& inside) const {
        return select(active, max(lost(wo, inside), F(0.f)), F(0.f));
    }
    F transmitted(const Mask<F>& inside) const { return select(inside, transmittedInside, transmittedOutside); }
    /// Both lobes, given the single one; `relative` is the index of the far side over that of wo's.
    BsdfEval<F> add(const BsdfEval<F>& single, const Vec3<F>& wo, const Vec3<F>& wi, const Mask<F>& inside,
                    F relative) const {
        const Mask<F> reflects = wi.z > F(0.f), ends = select(reflects, inside, !inside);
        const F t = transmitted(inside), share = select(reflects, F(1.f) - t, t);
        const F meanLost = max(select(ends, meanLostInside, meanLostOutside), F(1e-6f));
        const F cosine = abs(wi.z) * F(kInvPi), fromHere = probability(wo, inside);
        const F onward = lost({wi.x, wi.y, abs(wi.z)}, ends) / meanLost;
        const F scale = select(reflects, F(1.f), F(1.f) / (relative * relative));
        const F strength = fromHere * onward * share * cosine * scale;
        return {single.fCos + Spectrum<F>::constant(select(active, max(strength, F(0.f)), F(0.f))),
                lerp(fromHere, single.pdf, share * cosine)};
    }
};

/// `transmittance` is that of the smooth border from outside. What goes over must be the same for light and for sight:
/// transmittedOutside / meanLostInside = eta^2 transmittedInside / meanLostOutside.
template <class F>
DielectricCompensation<F> dielectricCompensation(const Mask<F>& active, const RoughnessTable<F>& energy, F eta,
                                                 F transmittance) {
    const auto [outer, inner] = energy.averages();
    const F lostOutside = max(F(1.f) - outer, F(1e-6f)), lostInside = max(F(1.f) - inner, F(1e-6f));
    const F ratio = lostOutside / (eta * eta * lostInside), t = min(transmittance, F(1.f) / ratio);
    return {active, energy, lostOutside, lostInside, t, min(t * ratio, F(1.f))};
}

}  // namespace penumbra
