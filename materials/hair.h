// "hair": a dielectric fibre with a coloured core and tilted scales.
//
// Light meets the fibre at the height h = 2 v - 1 across it, reflects (p = 0) or passes through after p - 1 inner
// reflections (p = 1, 2; the rest is one lobe more). The BSDF is the sum over p of
//   M_p(theta_i, theta_o)  how the scales' roughness beta_m spreads it along the fibre, about a direction which their
//                          tilt alpha turns by -2, +1, +4 times alpha,
//   A_p(theta_o, h)        what Fresnel's equations and the core leave of it, and
//   N_p(phi)               how beta_n spreads it around the fibre.
// M and N integrate to one and the A of a core that absorbs nothing sum to one, so no light is lost. The model is not
// reciprocal: A knows wo alone.
//
// Conventions: the fibre runs along local x; theta is measured from the plane across it, phi around it from local y.
// sigma_a is per radius of the fibre. Lobes are drawn with A's mean over the channels, then directions exactly as M and
// N have it, so a sample's weight varies with colour alone. Thread safety: plain values. Sources: Marschner et al.,
// SIGGRAPH 2003; d'Eon et al., EGSR 2011 (M, eq. 7); Chiang, Bitterli, Tappan & Burley, EG 2016 (variances, the rest
// lobe, colour); absorption of pigments after d'Eon et al.
#pragma once

#include "materials/fresnel.h"
#include "materials/material.h"

namespace penumbra {

template <class F>
struct HairBsdf {
    static constexpr int kLobes = 4;  ///< R, TT, TRT and the rest

    F h, eta;
    Spectrum<F> absorption;  ///< per radius
    F variance;              ///< along the fibre, of the lobe R
    F width;                 ///< of the logistic around the fibre
    F sinTilt, cosTilt;      ///< of alpha

    BsdfEval<F> evaluate(const Vec3<F>& wo, const Vec3<F>& wi) const {
        const Fibre fibre(*this, wo);
        const F cosThetaI = sqrt(wi.y * wi.y + wi.z * wi.z);
        const F phi = atan2(wo.y * wi.z - wo.z * wi.y, wo.y * wi.y + wo.z * wi.z);
        return fibre.value(*this, wi.x, cosThetaI, phi);
    }

    BsdfSample<F> sample(const Vec3<F>& wo, F uLobe, const Vec2<F>& u) const {
        const Fibre fibre(*this, wo);
        // The lobe, and what is left of uLobe within it.
        F left = uLobe, share = fibre.share[0], variance = fibre.variance[0], turn = fibre.turn[0];
        F sinTheta = fibre.sinTheta[0], cosTheta = fibre.cosTheta[0];
        Mask<F> isRest(false);
        for (int p = 1; p < kLobes; ++p) {
            const Mask<F> beyond = left >= share;
            left = select(beyond, left - share, left);
            share = select(beyond, fibre.share[p], share);
            variance = select(beyond, fibre.variance[p], variance);
            turn = select(beyond, fibre.turn[p], turn);
            sinTheta = select(beyond, fibre.sinTheta[p], sinTheta);
            cosTheta = select(beyond, fibre.cosTheta[p], cosTheta);
            if (p == kLobes - 1) isRest = beyond;
        }
        const F uTurn = clamp(left / max(share, F(1e-20f)), F(0.f), F(kOneMinusEpsilon));

        // M_p is a von Mises-Fisher lobe: t is one minus the cosine to its axis.
        const F t = clamp(-variance * log(max(u.x + (F(1.f) - u.x) * exp(F(-2.f) / variance), F(1e-37f))), F(0.f), F(2.f));
        const F sinLobe = sqrt(t * (F(2.f) - t));
        const F along = (t - F(1.f)) * sinTheta + sinLobe * cos(F(kTwoPi) * u.y) * cosTheta;
        const F sinThetaI = clamp(along, F(-1.f), F(1.f)), cosThetaI = safeSqrt(F(1.f) - sinThetaI * sinThetaI);
        const F phi = select(isRest, F(kTwoPi) * uTurn - F(kPi), wrapped(turn + sampleLogistic(uTurn)));

        // phi counts from wo.
        const F cosThetaO = sqrt(wo.y * wo.y + wo.z * wo.z), inverse = F(1.f) / max(cosThetaO, F(1e-20f));
        const Mask<F> onAxis = cosThetaO < F(1e-20f);
        const F y = select(onAxis, F(1.f), wo.y * inverse), z = select(onAxis, F(0.f), wo.z * inverse);
        F s, c;
        sinCos(phi, s, c);
        const Vec3<F> wi{sinThetaI, cosThetaI * (y * c - z * s), cosThetaI * (z * c + y * s)};
        const BsdfEval<F> value = fibre.value(*this, sinThetaI, cosThetaI, phi);
        const Mask<F> valid = value.pdf > F(1e-20f);
        return {wi, value.fCos * (F(1.f) / max(value.pdf, F(1e-20f))), value.pdf, F(1.f), Mask<F>(false), valid};
    }

    Mask<F> smoothOnly() const { return Mask<F>(false); }
    Spectrum<F> albedo(const Vec3<F>& wo) const {
        const Fibre fibre(*this, wo);
        return fibre.attenuation[0] + fibre.attenuation[1] + fibre.attenuation[2] + fibre.attenuation[3];
    }

private:
    /// x less whole turns: in [-pi, pi].
    static F wrapped(F x) { return x - F(kTwoPi) * roundToEven(x * F(kInvTwoPi)); }

    /// The logistic's distribution function at -pi.
    F logisticTail() const {
        const F e = exp(F(-kPi) / width);
        return e / (F(1.f) + e);
    }
    /// Logistic density about 0, trimmed to [-pi, pi].
    F logistic(F x) const {
        const F e = exp(-abs(x) / width);
        return e / (width * sqr(F(1.f) + e) * (F(1.f) - F(2.f) * logisticTail()));
    }
    F sampleLogistic(F u) const {
        const F tail = logisticTail(), within = F(1.f) - F(2.f) * tail;
        const F below = max(u * within + tail, F(1e-20f)), above = max((F(1.f) - u) * within + tail, F(1e-20f));
        return clamp(width * log(below / above), F(-kPi), F(kPi));
    }

    /// What follows from wo alone, for each lobe.
    struct Fibre {
        Spectrum<F> attenuation[kLobes];        ///< A
        F share[kLobes];                        ///< of A in the sum of all, mean over the channels
        F sinTheta[kLobes], cosTheta[kLobes];   ///< of theta_o, tilted
        F variance[kLobes];
        F turn[kLobes];                         ///< phi of the lobe's middle, less whole turns

        Fibre(const HairBsdf& hair, const Vec3<F>& wo) {
            const F sinO = wo.x, cosO = min(sqrt(wo.y * wo.y + wo.z * wo.z), F(1.f));
            attenuate(hair, sinO, cosO);

            // alpha's multiples by the addition theorems.
            const F s1 = hair.sinTilt, c1 = hair.cosTilt, s2 = F(2.f) * s1 * c1, c2 = c1 * c1 - s1 * s1;
            const F s4 = F(2.f) * s2 * c2, c4 = c2 * c2 - s2 * s2;
            const auto tilt = [&](int p, F s, F c) {
                sinTheta[p] = sinO * c + cosO * s;
                cosTheta[p] = abs(cosO * c - sinO * s);
            };
            tilt(0, -s2, c2);
            tilt(1, s1, c1);
            tilt(2, s4, c4);
            tilt(3, F(0.f), F(1.f));
            variance[0] = hair.variance;
            variance[1] = F(0.25f) * hair.variance;
            variance[2] = variance[3] = F(4.f) * hair.variance;
        }

        /// The sum of the lobes towards theta_i and phi: fCos, because the cosine of local z plays no part.
        BsdfEval<F> value(const HairBsdf& hair, F sinThetaI, F cosThetaI, F phi) const {
            BsdfEval<F> sum{Spectrum<F>::constant(F(0.f)), F(0.f)};
            for (int p = 0; p < kLobes; ++p) {
                const F around = p < kLobes - 1 ? hair.logistic(wrapped(phi - turn[p])) : F(kInvTwoPi);
                const F lobe = along(p, sinThetaI, cosThetaI) * around;
                sum.fCos += attenuation[p] * lobe;
                sum.pdf += share[p] * lobe;
            }
            return sum;
        }

    private:
        void attenuate(const HairBsdf& hair, F sinO, F cosO) {
            // Refraction along the fibre, then across it with the index that its plane sees.
            const F sinT = sinO / hair.eta, cosT = max(safeSqrt(F(1.f) - sinT * sinT), F(1e-3f));
            const F across = safeSqrt(hair.eta * hair.eta - sinO * sinO) / max(cosO, F(1e-6f));
            const F sinGammaT = clamp(hair.h / max(across, F(1e-6f)), F(-1.f), F(1.f));
            const F path = F(2.f) * safeSqrt(F(1.f) - sinGammaT * sinGammaT) / cosT;
            const Spectrum<F> through{exp(-hair.absorption.r * path), exp(-hair.absorption.g * path),
                                      exp(-hair.absorption.b * path)};
            const F fresnel =
                dielectricFresnel(cosO * safeSqrt(F(1.f) - hair.h * hair.h), hair.eta).reflectance;
            const Spectrum<F> again = through * fresnel;
            const auto rest = [](F x) { return x / max(F(1.f) - x, F(1e-6f)); };
            attenuation[0] = Spectrum<F>::constant(fresnel);
            attenuation[1] = through * sqr(F(1.f) - fresnel);
            attenuation[2] = attenuation[1] * again;
            attenuation[3] = attenuation[2] * Spectrum<F>{rest(again.r), rest(again.g), rest(again.b)};
            F mean[kLobes], sum(0.f);
            for (int p = 0; p < kLobes; ++p)
                sum += mean[p] = average(attenuation[p]);
            for (int p = 0; p < kLobes; ++p)
                share[p] = mean[p] / max(sum, F(1e-20f));

            const F gammaO = asin(hair.h), gammaT = asin(sinGammaT);
            for (int p = 0; p < kLobes; ++p)
                turn[p] = wrapped(F(2.f * float(p)) * gammaT - F(2.f) * gammaO + F(float(p) * kPi));
        }

        /// M_p. Its exponent (cos of the angle to the lobe's axis, less 1) is written without cancellation.
        F along(int p, F sinThetaI, F cosThetaI) const {
            const F inverse = F(1.f) / variance[p];
            const F exponent = F(-0.5f) * inverse * (sqr(sinThetaI + sinTheta[p]) + sqr(cosThetaI - cosTheta[p]));
            return besselI0Scaled(cosThetaI * cosTheta[p] * inverse) * exp(exponent) * inverse /
                   (F(1.f) - exp(F(-2.f) * inverse));
        }
    };
};

struct HairMaterial {
    static constexpr ParameterInfo kParameters[] = {
        {"spectrum", "sigma_a", "", "absorption of the core per radius of the fibre; texture or any spectrum"},
        {"spectrum", "reflectance", "", "or: the colour that a head of such hair has"},
        {"spectrum", "color", "", "the same under its old name"},
        {"float", "eumelanin", "1.3", "or: concentration of the brown pigment"},
        {"float", "pheomelanin", "0", "and of the red one"},
        {"float", "eta", "1.55", "index of refraction; texture or number"},
        {"float", "beta_m", "0.3", "roughness along the fibre, 0 to 1; texture or number"},
        {"float", "beta_n", "0.3", "roughness around the fibre, 0 to 1; texture or number"},
        {"float", "alpha", "2", "tilt of the scales in degrees; texture or number"},
    };
    static constexpr PluginInfo kInfo{"hair", "fibres: hair and fur (Chiang et al. 2016); v runs across them", kParameters};
    static constexpr bool kPassThrough = false;
    static constexpr bool kUsesLobe = true;
    static constexpr bool kReciprocal = false;
    static constexpr bool kNeedsUv = true;
    template <class F>
    using Bsdf = HairBsdf<F>;

    enum class Color : std::uint32_t { Absorption, Reflectance, Pigment };

    Color by = Color::Pigment;
    SpectrumInput color{};
    ScalarInput eumelanin{1.3f}, pheomelanin{}, eta{1.55f}, betaM{0.3f}, betaN{0.3f}, alpha{2.f};

    static HairMaterial make(MaterialInput& input);
    bool needsTangent() const { return true; }

    template <class F>
    static HairBsdf<F> bsdf(const Records<F, HairMaterial>& m, const ShadingContext<F>& at) {
        using M = HairMaterial;
        const auto roughness = [&](ScalarInput M::*input) { return clamp(at.scalar(m, input), F(0.01f), F(1.f)); };
        const F betaM = roughness(&M::betaM), betaN = roughness(&M::betaN);
        const F m2 = betaM * betaM, m4 = m2 * m2, m16 = sqr(sqr(m4));
        const F spread = F(0.726f) * betaM + F(0.812f) * m2 + F(3.7f) * m16 * m4;
        const F n2 = betaN * betaN, n4 = n2 * n2, n16 = sqr(sqr(n4));
        constexpr float kRootPiOver8 = 0.626657069f;
        const F width = F(kRootPiOver8) * (F(0.265f) * betaN + F(1.194f) * n2 + F(5.372f) * n16 * n4 * n2);
        F sinTilt, cosTilt;
        sinCos(clamp(at.scalar(m, &M::alpha), F(-90.f), F(90.f)) * F(kPi / 180.f), sinTilt, cosTilt);
        return {clamp(F(2.f) * at.at.uv.y - F(1.f), F(-1.f), F(1.f)),
                clamp(at.scalar(m, &M::eta), F(0.01f), F(100.f)),
                absorption(m, at, betaN),
                spread * spread,
                width,
                sinTilt,
                cosTilt};
    }

private:
    template <class F>
    static Spectrum<F> absorption(const Records<F, HairMaterial>& m, const ShadingContext<F>& at, F betaN) {
        using M = HairMaterial;
        const UInt<F> by = m(&M::by);
        const Mask<F> byPigment = by == UInt<F>(std::uint32_t(Color::Pigment)),
                      byReflectance = by == UInt<F>(std::uint32_t(Color::Reflectance));
        Spectrum<F> sigma = Spectrum<F>::constant(F(0.f));
        if (!all(byPigment)) sigma = at.spectrum(m, &M::color);
        if (any(byReflectance)) {
            // What multiple scattering makes of it, inverted by a fit (Chiang et al. 2016, eq. 9).
            const F fit =
                F(5.969f) +
                betaN * (F(-0.215f) + betaN * (F(2.532f) + betaN * (F(-10.73f) + betaN * (F(5.574f) + betaN * F(0.245f)))));
            const auto of = [&](F c) { return sqr(log(clamp(c, F(1e-6f), F(1.f))) / fit); };
            sigma = select(byReflectance, Spectrum<F>{of(sigma.r), of(sigma.g), of(sigma.b)}, sigma);
        }
        if (any(byPigment)) {
            const F brown = max(at.scalar(m, &M::eumelanin), F(0.f)), red = max(at.scalar(m, &M::pheomelanin), F(0.f));
            const Spectrum<F> pigments{F(0.419f) * brown + F(0.187f) * red, F(0.697f) * brown + F(0.4f) * red,
                                       F(1.37f) * brown + F(1.05f) * red};
            sigma = select(byPigment, pigments, sigma);
        }
        return sigma;
    }
};

}  // namespace penumbra
