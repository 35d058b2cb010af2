// Quadrature of rough and smooth coats.
#include "materials/coat_table.h"

#include "materials/coat_interface.h"
#include "materials/visible_average.h"

namespace penumbra {
namespace {

using F = Lanes8f;

/// The fraction of light from w, inside the coat, that the interface sends back to the base: attenuated on both ways.
double innerReflection(const Coat& coat, const Ggx<float>& ggx, const Vec3<float>& w) {
    const F eta(coat.eta), inverseEta(1.f / coat.eta), thickness(coat.opticalThickness);
    double sum = 0;
    averageOverVisible(ggx, w, [&](const Ggx<F>& wide, const Vec3<F>& from, const Vec3<F>& m, double weight) {
        const FacetMeeting<F> met = meetFacet(wide, from, m, inverseEta, eta);
        const F path = F(1.f) / max(from.z, F(1e-6f)) + F(1.f) / max(met.reflected.z, F(1e-6f));
        sum += weight * sumOfLanes(select(met.reflected.z > F(0.f), met.up * exp(-thickness * path), F(0.f)));
    });
    return sum;
}

/// rho and tau.
TableValue roughBase(const Coat& coat, const Ggx<float>& ggx) {
    TableValue base;
    averageOverDirections(ggx, criticalCosine(coat.eta), [&](const Vec3<float>& w, double weight) {
        base.first += weight * innerReflection(coat, ggx, w);
        base.second += weight * roughCoatAlbedo(coat, ggx, w).transmitted;
    });
    base.second /= double(coat.eta) * coat.eta;
    return base;
}

TableFunctions albedosOf(const Coat& coat) {
    return [coat](const Ggx<float>& ggx, const Vec3<float>& w) {
        const CoatAlbedo albedo = roughCoatAlbedo(coat, ggx, w);
        return TableValue{albedo.transmitted, albedo.reflected};
    };
}
TableAverages basesOf(const Coat& coat) {
    return [coat](const Ggx<float>& ggx) { return roughBase(coat, ggx); };
}

}  // namespace

CoatAlbedo roughCoatAlbedo(const Coat& coat, const Ggx<float>& ggx, const Vec3<float>& w) {
    const F eta(coat.eta), inverseEta = F(1.f) / eta, thickness(coat.opticalThickness);
    CoatAlbedo result;
    averageOverVisible(ggx, w, [&](const Ggx<F>& wide, const Vec3<F>& from, const Vec3<F>& m, double weight) {
        const FacetMeeting<F> met = meetFacet(wide, from, m, eta, inverseEta);
        const F down = met.down * exp(-thickness / max(-met.refracted.z, F(1e-6f)));
        result.reflected += weight * sumOfLanes(select(met.reflected.z > F(0.f), met.up, F(0.f)));
        result.transmitted += weight * sumOfLanes(select(met.refracted.z < F(0.f), down, F(0.f)));
    });
    return result;
}

void appendSmoothCoat(const Coat& coat, std::vector<float>& numbers) {
    // Equal steps, many, because at the critical angle the integrand has a square root's edge.
    constexpr int kSteps = 1 << 14;
    double back = 0, out = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double mu = (i + 0.5) / kSteps;
        const double fresnel = dielectricFresnel(float(mu), 1.f / coat.eta).reflectance;
        const double crossing = std::exp(-coat.opticalThickness / mu);
        back += 2 * mu * fresnel * crossing * crossing / kSteps;
        out += 2 * mu * (1 - fresnel) * crossing / kSteps;
    }
    numbers.insert(numbers.end(), {float(back), float(back), float(out), float(out)});
}

void appendConstantCoat(const Coat& coat, const Ggx<float>& ggx, std::vector<float>& numbers) {
    appendConstantTable(ggx, basesOf(coat), albedosOf(coat), numbers);
}

void appendTexturedCoat(const Coat& coat, std::vector<float>& numbers) {
    appendTexturedTable(basesOf(coat), albedosOf(coat), numbers);
}

}  // namespace penumbra
