// The tables of compensation.h, by quadrature, when materials are made.
#include "materials/compensation.h"

#include "materials/visible_average.h"

namespace penumbra {
namespace {

using F = Lanes8f;

/// Kinds of blocks; they begin the keys.
enum Kind { Mirror = 100, Glass, MeanReflectance };

// Where reflections begin to end below the surface there is an edge, and total reflection is one: hence the many steps.

double mirrorEnergyOf(const Ggx<float>& ggx, const Vec3<float>& w) {
    double sum = 0;
    averageOverVisible<128>(ggx, w, [&](const Ggx<F>& wide, const Vec3<F>& from, const Vec3<F>& m, double weight) {
        const Vec3<F> to = m * (F(2.f) * max(dot(from, m), F(0.f))) - from;
        sum += weight * sumOfLanes(select(to.z > F(0.f), wide.shadowing(from, to), F(0.f)));
    });
    return sum;
}

/// Of an interface of the given index, relative to w's side.
double glassEnergyOf(const Ggx<float>& ggx, const Vec3<float>& w, float eta, bool schlick) {
    const DielectricRule<F> rule{Mask<F>(schlick)};
    double sum = 0;
    averageOverVisible<128, 64>(ggx, w, [&](const Ggx<F>& wide, const Vec3<F>& from, const Vec3<F>& m, double weight) {
        const F c = clamp(dot(from, m), F(0.f), F(1.f));
        const DielectricFresnel<F> fresnel = rule(c, F(eta));
        const Vec3<F> reflected = m * (F(2.f) * c) - from;
        const Vec3<F> refracted = (m * (c - fresnel.etaCosRefracted) - from) * F(1.f / eta);
        const F up = fresnel.reflectance * wide.shadowing(from, reflected);
        const F down = (F(1.f) - fresnel.reflectance) * wide.shadowing(from, refracted);
        sum += weight *
               sumOfLanes(select(reflected.z > F(0.f), up, F(0.f)) + select(refracted.z < F(0.f), down, F(0.f)));
    });
    return sum;
}

/// The block of that key: for a texture's roughness, or for the constant one. Nothing where the surface is smooth.
EnergyInputs energyTable(MaterialInput& input, const RoughnessInputs& roughness, std::vector<float> key,
                                 double edge, const TableFunctions& energies) {
    const TableAverages means = [&](const Ggx<float>& ggx) {
        TableValue mean;
        averageOverDirections(ggx, edge, [&](const Vec3<float>& w, double weight) {
            const TableValue energy = energies(ggx, w);
            mean.first += weight * energy.first;
            mean.second += weight * energy.second;
        });
        return mean;
    };
    EnergyInputs result;
    const bool textured = roughness.isTextured();
    const SurfaceRoughness<float> rough = RoughnessInputs::surface(roughness.uAlpha.constant, roughness.vAlpha.constant);
    if (!textured && rough.smooth) return result;
    if (!textured) key.insert(key.end(), {rough.ggx.ax, rough.ggx.ay});
    const std::uint32_t block = input.tables().block(key, [&](std::vector<float>& numbers) {
        if (textured)
            appendTexturedTable(means, energies, numbers);
        else
            appendConstantTable(rough.ggx, means, energies, numbers);
    });
    result.setBlock(block, textured ? kTexturedRows : constantRows(rough.ggx));
    result.multiscatter = 1;
    return result;
}

/// 2 int_0^1 mu f(mu) dmu
template <class Function>
auto cosineMean(Function&& f) {
    constexpr int kSteps = 256;
    auto sum = f(1.f) * 0.f;
    for (int i = 0; i < kSteps; ++i) {
        const float mu = (float(i) + 0.5f) / kSteps;
        sum += f(mu) * (2.f * mu / kSteps);
    }
    return sum;
}

}  // namespace

EnergyInputs mirrorEnergy(MaterialInput& input, const RoughnessInputs& roughness) {
    return energyTable(input, roughness, {Mirror}, 0.5, [](const Ggx<float>& ggx, const Vec3<float>& w) {
        const double energy = mirrorEnergyOf(ggx, w);
        return TableValue{energy, energy};
    });
}

EnergyInputs dielectricEnergy(MaterialInput& input, const RoughnessInputs& roughness, float eta, bool schlick) {
    return energyTable(input, roughness, {Glass, eta, float(schlick)}, criticalCosine(eta),
                       [eta, schlick](const Ggx<float>& ggx, const Vec3<float>& w) {
                           return TableValue{glassEnergyOf(ggx, w, eta, schlick), glassEnergyOf(ggx, w, 1.f / eta, schlick)};
                       });
}

float meanTransmittance(float eta, bool schlick) {
    const DielectricRule<float> rule{schlick};
    return cosineMean([&](float mu) { return 1.f - rule(mu, eta).reflectance; });
}

Spectrum<float> meanReflectance(const ConductorRule<float>& rule) {
    return cosineMean([&](float mu) { return rule(mu); });
}

std::uint32_t meanReflectanceTable(MaterialInput& input) {
    return input.tables().block({MeanReflectance}, [](std::vector<float>& numbers) {
        for (std::uint32_t i = 0; i <= kReflectanceSteps; ++i) {
            const float r = float(i) / kReflectanceSteps;
            numbers.push_back(cosineMean([&](float mu) {
                const auto [difference, product] = constantsOfReflectance(r);
                return conductorReflectance(mu, difference, product);
            }));
        }
    });
}

}  // namespace penumbra
