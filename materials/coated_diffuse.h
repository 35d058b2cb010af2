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
// Scattering in the gap (`albedo` > 0) is not simulated: gaps are optically thin, and light that scatters mostly goes
// on to where it went anyway, so only the absorbed part of the extinction, (1 - albedo) thickness, counts. A warning
// says so. Sampling: the coat's reflection or the cosine lobe, in proportion to what each reflects from wo. Thread
// safety: plain values. Sources: Guo, Hasan & Zhao, SIGGRAPH Asia 2018 (the walk); Saunderson 1942 (the series).
#pragma once

#include "core/math/warps.h"
#include "materials/coat_table.h"
#include "materials/dielectric.h"

namespace penumbra {

/// Where a lane's T and R come from.
template <class F>
struct CoatReader {
    F eta, opticalThickness;
    Mask<F> smooth;
    Ggx<F> ggx;
    const float* tables;
    UInt<F> offset;  ///< of the lane's block
    F firstRow, rowsPerRoot, lastRow;

    struct Value {
        F transmitted, reflected;
    };

    /// T and R of a direction with z > 0.
    Value operator()(const Vec3<F>& w) const {
        const F cosine = min(w.z, F(1.f));
        Value smoothValue{F(0.f), F(0.f)};
        if (any(smooth)) {
            const DielectricFresnel<F> fresnel = dielectricFresnel(cosine, eta);
            const F path = opticalThickness * eta / max(fresnel.etaCosRefracted, F(1e-6f));
            smoothValue = {(F(1.f) - fresnel.reflectance) * exp(-path), fresnel.reflectance};
        }
        if (all(smooth)) return smoothValue;
        const Value roughValue = lookUp(cosine, rowCoordinate(w));
        return {select(smooth, smoothValue.transmitted, roughValue.transmitted),
                select(smooth, smoothValue.reflected, roughValue.reflected)};
    }

    /// rho and tau of coat_table.h, in this order, for lanes with several rows.
    Value base() const { return betweenRows(rowAt(sqrt(ggx.ax * ggx.ay)), UInt<F>(0u), F(0.f)); }
    Mask<F> hasRows() const { return lastRow > F(0.f); }

private:
    F rowAt(F alpha) const {
        const F row = (sqrt(alpha) - firstRow) * rowsPerRoot;
        return select(smooth, F(0.f), clamp(row, F(0.f), lastRow));
    }
    F rowCoordinate(const Vec3<F>& w) const {
        if (none(hasRows())) return F(0.f);
        const F planar = max(w.x * w.x + w.y * w.y, F(1e-20f));
        const F alpha = sqrt((sqr(ggx.ax * w.x) + sqr(ggx.ay * w.y)) / planar);
        return rowAt(select(ggx.ax == ggx.ay, ggx.ax, alpha));
    }
    Value lookUp(F cosine, F row) const {
        const F coordinate = sqrt(max(cosine, F(0.f))) * F(float(kCoatCells));
        const F cell = min(floor(coordinate), F(float(kCoatCells - 1)));
        const F fraction = coordinate - cell;
        // Smooth lanes have no cells: they read the head of their block and drop it.
        const UInt<F> word = select(smooth, UInt<F>(0u), toUInt(cell) * UInt<F>(4u) + UInt<F>(4u));
        return betweenRows(row, word, fraction);
    }
    /// The two functions of the four floats at `word`, each interpolated within its cell and between two rows.
    Value betweenRows(F row, const UInt<F>& word, F fraction) const {
        const F below = floor(row), rowFraction = row - below;
        const auto inRow = [&](F r) {
            F v[4];
            loadRows4(tables, offset + toUInt(r) * UInt<F>(kCoatRowFloats) + word, v);
            return Value{lerp(fraction, v[0], v[1]), lerp(fraction, v[2], v[3])};
        };
        const Value first = inRow(below);
        if (none(rowFraction > F(0.f))) return first;
        const Value second = inRow(min(below + F(1.f), lastRow));
        return {lerp(rowFraction, first.transmitted, second.transmitted),
                lerp(rowFraction, first.reflected, second.reflected)};
    }
};

/// sum_{k < count} x^k per channel, by Horner's scheme; stops early where more terms change nothing.
template <class F>
Spectrum<F> geometricSum(const Spectrum<F>& x, const UInt<F>& count) {
    const Spectrum<F> one = Spectrum<F>::constant(F(1.f));
    Spectrum<F> sum = Spectrum<F>::constant(F(0.f));
    for (std::uint32_t k = 0;; ++k) {
        const Spectrum<F> next = select(UInt<F>(k) < count, sum * x + one, sum);
        if (all((next.r == sum.r) & (next.g == sum.g) & (next.b == sum.b))) return sum;
        sum = next;
    }
}

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
        const Mask<F> takesTop = uLobe < top, delta = takesTop & coat.smooth;

        Vec3<F> m{F(0.f), F(0.f), F(1.f)};
        if (any(takesTop & !coat.smooth)) m = select(coat.smooth, m, coat.ggx.sampleVisible(wo, u));
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
        if (any(!coat.smooth)) {
            const Vec3<F> h = wo + wi;
            const F h2 = lengthSquared(h);
            const GgxReflection<F> r = coat.ggx.reflection(wo, wi, coat.ggx.density(h, h2));
            const F fresnel = dielectricFresnel(min(F(0.5f) * sqrt(h2), F(1.f)), coat.eta).reflectance;
            topCos = select(coat.smooth, F(0.f), r.fCos * fresnel);
            topPdf = select(coat.smooth, F(0.f), r.pdf * top);
        }
        const F both = fromWo.transmitted * coat(wi).transmitted * wi.z;
        return {base * both + Spectrum<F>::constant(topCos), topPdf + (F(1.f) - top) * wi.z * F(kInvPi)};
    }
};

struct CoatedDiffuseMaterial : RoughnessInputs {
    static constexpr ParameterInfo kParameters[] = {
        {"spectrum", "reflectance", "0.5", "of the base; texture or any spectrum"},
        {"float", "eta", "1.5", "index of the coat; a spectrum counts with its mean"},
        {"float", "thickness", "0.01", "of the gap, which absorbs one e-fold a unit"},
        {"spectrum", "albedo", "0", "of scattering in the gap (lessens its absorption)"},
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
    std::uint32_t table = 0;                                 ///< offset of the block of coat_table.h
    float rho = 0.f, tau = 0.f;                              ///< of the block's first row
    float firstRow = 0.f, rowsPerRoot = 0.f, lastRow = 0.f;  ///< CoatRows

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
        const CoatReader<F> coat{eta,          m(&M::opticalThickness), rough.smooth,       rough.ggx,     tables,
                                 m(&M::table), m(&M::firstRow),         m(&M::rowsPerRoot), m(&M::lastRow)};
        F rho = m(&M::rho), tau = m(&M::tau);
        if (any(coat.hasRows())) {
            const auto [rowRho, rowTau] = coat.base();
            rho = select(coat.hasRows(), rowRho, rho);
            tau = select(coat.hasRows(), rowTau, tau);
        }
        const Spectrum<F> series = geometricSum(reflectance * rho, m(&M::baseBounces));
        return {coat, reflectance * series * (F(kInvPi) / etaSquared), F(kPi) * etaSquared * tau};
    }

    void setBlock(std::uint32_t offset, const CoatRows& rows, const float* tables);
};

}  // namespace penumbra
