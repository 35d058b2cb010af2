// "measured": a surface as a gonio-photometer found it (RGL's ".bsdf" files), alike from both sides.
//
// The file holds, for each direction of view, the spectrum over the unit square; a map from the square to microfacet
// normals m, by the normals visible from there (vndf); how normals are distributed (ndf) and what area they show
// (sigma); and luminance over the square, by which to sample. With u = the point that the map takes to m,
//   f = spectra(u | wo) ndf(m) / (4 sigma(wo) cos wi),
// and directions are drawn by luminance, through the map, by reflection at m. Normals stand in the square at
// (sqrt(2 theta / pi), phi / 2 pi + 1/2); an isotropic file counts phi from wo.
//
// Spectra become the film's colours once, at the nodes: the sum of the file's wavelengths under the white of the film's
// space; what is negative there counts as 0. Measurements are reciprocal as far as their noise allows: the closure is
// not, exactly.
//
// Thread safety: plain values. Source: Dupuy & Jakob, SIGGRAPH Asia 2018 (parametrisation, eq. 8-11).
#pragma once

#include "materials/material.h"
#include "materials/measured_table.h"

namespace penumbra {

template <class F>
struct MeasuredBsdf {
    const float* numbers;
    Mask<F> isotropic;
    UInt<F> phis, thetas, phiGrid, thetaGrid;  ///< counts of the directions of view, and where their angles begin
    std::uint32_t mostViews;                   ///< of either, in any lane
    TableGrid<F> ndf, sigma;
    TableDensity<F> visible, luminance;        ///< luminance has the colour's channels behind each node

    BsdfEval<F> evaluate(const Vec3<F>& woGiven, const Vec3<F>& wiGiven) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        const Vec3<F> wi{wiGiven.x, wiGiven.y, flipSign(below, wiGiven.z)};
        const Mask<F> lit = (wo.z > F(0.f)) & (wi.z > F(0.f));
        const View view(*this, wo);
        const Vec3<F> h = wo + wi;
        const Vec3<F> m = h * (F(1.f) / sqrt(max(lengthSquared(h), F(1e-30f))));
        const Vec2<F> place = view.placeOf(m);
        const auto u = visible.gathered(view.slices, place);
        const F pdf = u.density * luminance.density(view.slices, u.p) / jacobian(wo, m, place.x);
        return {select(lit, value(view, u.p, place), Spectrum<F>::constant(F(0.f))), select(lit, pdf, F(0.f))};
    }

    BsdfSample<F> sample(const Vec3<F>& woGiven, F, const Vec2<F>& uGiven) const {
        const Mask<F> below = woGiven.z < F(0.f);
        const Vec3<F> wo{woGiven.x, woGiven.y, flipSign(below, woGiven.z)};
        const View view(*this, wo);
        const auto u = luminance.spread(view.slices, uGiven);
        const auto place = visible.spread(view.slices, u.p);
        const Vec3<F> m = view.normalAt(place.p);
        const F om = dot(wo, m);
        Vec3<F> wi = m * (F(2.f) * om) - wo;
        const F pdf = place.density * u.density / jacobian(wo, m, place.p.x);
        const Spectrum<F> weight = value(view, u.p, place.p) * (F(1.f) / max(pdf, F(1e-20f)));
        const Mask<F> valid = (wo.z > F(0.f)) & (wi.z > F(0.f)) & (om > F(0.f)) & (pdf > F(1e-20f));
        wi.z = flipSign(below, wi.z);
        return {wi, weight, pdf, F(1.f), Mask<F>(false), valid};
    }

    Mask<F> smoothOnly() const { return Mask<F>(false); }
    /// The mean over the square: spectra are what reflection is worth there.
    Spectrum<F> albedo(const Vec3<F>& wo) const {
        const View view(*this, {wo.x, wo.y, abs(wo.z)});
        Spectrum<F> sum = Spectrum<F>::constant(F(0.f));
        constexpr int kSteps = 4;
        for (int j = 0; j < kSteps; ++j)
            for (int i = 0; i < kSteps; ++i)
                sum += color(view, {F((float(i) + 0.5f) / kSteps), F((float(j) + 0.5f) / kSteps)});
        const auto unit = [](F x) { return min(x * F(1.f / (kSteps * kSteps)), F(1.f)); };
        return {unit(sum.r), unit(sum.g), unit(sum.b)};
    }

private:
    /// What follows from wo alone.
    struct View {
        TableSlices<F> slices;
        F phi;   ///< from which the file counts
        F area;  ///< sigma

        View(const MeasuredBsdf& bsdf, const Vec3<F>& wo) {
            const F across = sqrt(wo.x * wo.x + wo.y * wo.y), theta = atan2(across, wo.z), phiO = atan2(wo.y, wo.x);
            const auto t = placeInGrid<F>(bsdf.numbers, bsdf.thetaGrid, bsdf.thetas, bsdf.mostViews, theta);
            const auto p = placeInGrid<F>(bsdf.numbers, bsdf.phiGrid, bsdf.phis, bsdf.mostViews, phiO);
            const auto next = [](const UInt<F>& i, const UInt<F>& count) {
                return select(i + UInt<F>(1u) < count, i + UInt<F>(1u), i);
            };
            const UInt<F> row = p.below * bsdf.thetas, nextRow = next(p.below, bsdf.phis) * bsdf.thetas,
                          nextTheta = next(t.below, bsdf.thetas);
            slices.index = {row + t.below, row + nextTheta, nextRow + t.below, nextRow + nextTheta};
            const F one(1.f);
            slices.share = {(one - p.fraction) * (one - t.fraction), (one - p.fraction) * t.fraction,
                            p.fraction * (one - t.fraction), p.fraction * t.fraction};
            phi = select(bsdf.isotropic, phiO, F(0.f));
            area = bsdf.sigma.at(Vec2<F>{fromTheta(theta), fromPhi(phiO)});
        }

        Vec2<F> placeOf(const Vec3<F>& m) const {
            const F v = fromPhi(atan2(m.y, m.x) - phi);
            return {fromTheta(atan2(sqrt(m.x * m.x + m.y * m.y), m.z)), v - floor(v)};
        }
        Vec3<F> normalAt(const Vec2<F>& place) const {
            F sinTheta, cosTheta, sinPhi, cosPhi;
            sinCos(place.x * place.x * F(kHalfPi), sinTheta, cosTheta);
            sinCos((place.y - F(0.5f)) * F(kTwoPi) + phi, sinPhi, cosPhi);
            return {sinTheta * cosPhi, sinTheta * sinPhi, cosTheta};
        }
    };

    static F fromTheta(F theta) { return sqrt(max(theta, F(0.f)) * F(2.f * kInvPi)); }
    static F fromPhi(F phi) { return phi * F(kInvTwoPi) + F(0.5f); }

    /// d(wi) / d(place of m).
    static F jacobian(const Vec3<F>& wo, const Vec3<F>& m, F x) {
        const F sinTheta = sqrt(m.x * m.x + m.y * m.y);
        return F(4.f) * max(dot(wo, m), F(1e-6f)) * max(F(2.f * kPi * kPi) * x * sinTheta, F(1e-6f));
    }
    Spectrum<F> color(const View& view, const Vec2<F>& u) const {
        const auto cell = luminance.cell(u);
        return {luminance.at(view.slices, cell, 1), luminance.at(view.slices, cell, 2), luminance.at(view.slices, cell, 3)};
    }
    Spectrum<F> value(const View& view, const Vec2<F>& u, const Vec2<F>& place) const {
        return color(view, u) * (ndf.at(place) / max(F(4.f) * view.area, F(1e-10f)));
    }
};

struct MeasuredMaterial {
    static constexpr ParameterInfo kParameters[] = {
        {"string", "filename", "", "of the measurement: a tensor file (.bsdf) as RGL gives them away"},
    };
    static constexpr PluginInfo kInfo{"measured", "a measured surface (Dupuy & Jakob 2018), two-sided", kParameters};
    static constexpr bool kPassThrough = false;
    static constexpr bool kUsesLobe = false;
    static constexpr bool kReciprocal = false;
    template <class F>
    using Bsdf = MeasuredBsdf<F>;

    std::uint32_t isotropic = 1;
    std::uint32_t block = 0;  ///< of the table: angles phi, theta, then ndf, sigma, visible, luminance
    std::uint32_t phis = 1, thetas = 1;
    std::uint32_t ndfWidth = 2, ndfHeight = 2, sigmaWidth = 2, sigmaHeight = 2;
    std::uint32_t visibleWidth = 2, visibleHeight = 2, colorWidth = 2, colorHeight = 2;

    static MeasuredMaterial make(MaterialInput& input);
    bool needsTangent() const { return isotropic == 0; }

    static constexpr std::uint32_t kColorStride = 4;  ///< luminance, r, g, b

    template <class F>
    static MeasuredBsdf<F> bsdf(const Records<F, MeasuredMaterial>& m, const ShadingContext<F>& at) {
        using M = MeasuredMaterial;
        MeasuredBsdf<F> out;
        out.numbers = at.tables;
        out.isotropic = m(&M::isotropic) != UInt<F>(0u);
        out.phis = m(&M::phis);
        out.thetas = m(&M::thetas);
        out.phiGrid = m(&M::block);
        out.thetaGrid = out.phiGrid + out.phis;
        const UInt<F> views = out.phis * out.thetas;
        const auto grid = [&](const UInt<F>& begin, std::uint32_t M::*width, std::uint32_t M::*height) {
            return TableGrid<F>{at.tables, begin, m(width), m(height)};
        };
        const auto density = [&](const UInt<F>& begin, std::uint32_t M::*width, std::uint32_t M::*height,
                                 std::uint32_t stride) {
            TableDensity<F> d{grid(begin, width, height)};
            d.stride = stride;
            d.alongRows = begin + views * d.size() * UInt<F>(stride);
            d.overRows = d.alongRows + views * d.size();
            d.mostNodes = std::max(largest<F>(d.width), largest<F>(d.height));
            return d;
        };
        out.mostViews = std::max(largest<F>(out.phis), largest<F>(out.thetas));
        out.ndf = grid(out.thetaGrid + out.thetas, &M::ndfWidth, &M::ndfHeight);
        out.sigma = grid(out.ndf.begin + out.ndf.size(), &M::sigmaWidth, &M::sigmaHeight);
        out.visible = density(out.sigma.begin + out.sigma.size(), &M::visibleWidth, &M::visibleHeight, 1);
        out.luminance = density(out.visible.overRows + views * out.visible.height, &M::colorWidth, &M::colorHeight,
                                kColorStride);
        return out;
    }

private:
    template <class F>
    static std::uint32_t largest(const UInt<F>& x) {
        std::uint32_t most = 0;
        for (int i = 0; i < kLanes<F>; ++i)
            most = std::max(most, lane(x, i));
        return most;
    }
};

}  // namespace penumbra
