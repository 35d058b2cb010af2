// Quadrature of rough and smooth coats. Directions average over the normals visible from them, by the very sampling
// that renders: u.x is the azimuth of the cap (periodic: equal steps), u.y its height (Gauss-Legendre).
#include "materials/coat_table.h"

#include "materials/fresnel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra {
namespace {

using F = Lanes8f;

/// Nodes and weights on [0, 1].
template <int n>
struct GaussLegendre {
    std::array<double, n> node, weight;
    GaussLegendre() {
        // Newton's method on the Legendre polynomial, from the Chebyshev-like estimate of its roots.
        for (int i = 0; i < n; ++i) {
            double x = std::cos(3.14159265358979323846 * (i + 0.75) / (n + 0.5)), slope = 1;
            for (int step = 0; step < 8; ++step) {
                double p = 1, previous = 0;
                for (int k = 1; k <= n; ++k) {
                    const double next = ((2 * k - 1) * x * p - (k - 1) * previous) / k;
                    previous = p;
                    p = next;
                }
                slope = n * (x * p - previous) / (x * x - 1);
                x -= p / slope;
            }
            node[i] = 0.5 * (1 - x);
            weight[i] = 1 / ((1 - x * x) * slope * slope);
        }
    }
};

constexpr int kHeights = 32, kAzimuths = 32, kCosines = 24;

double sumOfLanes(const F& x) {
    double sum = 0;
    for (int i = 0; i < kLanes<F>; ++i)
        sum += lane(x, i);
    return sum;
}

/// Mean over the normals m visible from w of function(m), both over lanes; the function gets the weight of each.
template <class Function>
void averageOverVisible(const Ggx<float>& ggx, const Vec3<float>& w, Function&& function) {
    static const GaussLegendre<kHeights> rule;
    const Ggx<F> wide{F(ggx.ax), F(ggx.ay)};
    const Vec3<F> from = broadcast<F>(w);
    for (int j = 0; j < kHeights; ++j) {
        // The substitution y = t^2 (3 - 2t) tames the square roots at both ends of u.y.
        const double t = rule.node[j], y = t * t * (3 - 2 * t), dy = 6 * t * (1 - t);
        for (int i = 0; i < kAzimuths; i += kLanes<F>) {
            const F x = (toFloat<F>(laneIndices<F>()) + F(float(i) + 0.5f)) * F(1.f / kAzimuths);
            const Vec3<F> m = wide.sampleVisible(from, {x, F(float(y))});
            function(wide, from, m, rule.weight[j] * dy / kAzimuths);
        }
    }
}

/// The fraction of light from w, inside the coat, that the interface sends back to the base: attenuated on both ways.
double innerReflection(const Coat& coat, const Ggx<float>& ggx, const Vec3<float>& w) {
    const F inverseEta(1.f / coat.eta), thickness(coat.opticalThickness);
    double sum = 0;
    averageOverVisible(ggx, w, [&](const Ggx<F>& wide, const Vec3<F>& from, const Vec3<F>& m, double weight) {
        const F c = clamp(dot(from, m), F(0.f), F(1.f));
        const Vec3<F> back = m * (F(2.f) * c) - from;
        const F path = F(1.f) / max(from.z, F(1e-6f)) + F(1.f) / max(back.z, F(1e-6f));
        const F value =
            dielectricFresnel(c, inverseEta).reflectance * wide.shadowing(from, back) * exp(-thickness * path);
        sum += weight * sumOfLanes(select(back.z > F(0.f), value, F(0.f)));
    });
    return sum;
}

/// (mu, phi) -> unit vector; phi by its sin^2.
Vec3<float> direction(double cosTheta, double sinSquaredPhi) {
    const double sinTheta = std::sqrt(std::max(0.0, 1 - cosTheta * cosTheta));
    return {float(sinTheta * std::sqrt(1 - sinSquaredPhi)), float(sinTheta * std::sqrt(sinSquaredPhi)),
            float(cosTheta)};
}

/// rho and tau.
struct BaseFractions {
    double back = 0, out = 0;
};

BaseFractions roughBaseFractions(const Coat& coat, const Ggx<float>& ggx) {
    static const GaussLegendre<kCosines> rule;
    const int azimuths = ggx.ax == ggx.ay ? 1 : 8;
    BaseFractions result;
    const auto add = [&](double mu, double weight) {
        for (int j = 0; j < azimuths; ++j) {
            const double s = std::sin(1.57079632679489662 * (j + 0.5) / azimuths);
            const Vec3<float> w = direction(mu, s * s);
            result.back += 2 * mu * weight / azimuths * innerReflection(coat, ggx, w);
            result.out += 2 * mu * weight / azimuths * roughCoatAlbedo(coat, ggx, w).transmitted;
        }
    };
    // Nodes gather at the cosine of the critical angle, where a nearly smooth interface has a sharp edge.
    const double step = std::min(double(coat.eta), 1 / double(coat.eta)), critical = std::sqrt(1 - step * step);
    for (int i = 0; i < kCosines; ++i) {
        const double t = rule.node[i], weight = 2 * t * rule.weight[i];
        add(critical * (1 - t * t), critical * weight);
        add(critical + (1 - critical) * t * t, (1 - critical) * weight);
    }
    result.out /= double(coat.eta) * coat.eta;
    return result;
}

void appendBase(const BaseFractions& base, std::vector<float>& numbers) {
    const float back = float(base.back), out = float(base.out);
    numbers.insert(numbers.end(), {back, back, out, out});
}

void appendRow(const Coat& coat, const Ggx<float>& ggx, double sinSquaredPhi, const BaseFractions& base,
               std::vector<float>& numbers) {
    appendBase(base, numbers);
    CoatAlbedo previous;
    for (std::uint32_t i = 0; i <= kCoatCells; ++i) {
        const double x = double(i) / kCoatCells;
        const CoatAlbedo albedo = roughCoatAlbedo(coat, ggx, direction(std::max(x * x, 1e-6), sinSquaredPhi));
        if (i > 0)
            numbers.insert(numbers.end(), {float(previous.transmitted), float(albedo.transmitted),
                                           float(previous.reflected), float(albedo.reflected)});
        previous = albedo;
    }
}

double coordinateOf(const CoatRows& rows, std::uint32_t row) {
    return rows.count > 1 ? rows.first + (double(rows.last) - rows.first) * row / (rows.count - 1) : rows.first;
}

}  // namespace

CoatAlbedo roughCoatAlbedo(const Coat& coat, const Ggx<float>& ggx, const Vec3<float>& w) {
    const F eta(coat.eta), thickness(coat.opticalThickness);
    CoatAlbedo result;
    averageOverVisible(ggx, w, [&](const Ggx<F>& wide, const Vec3<F>& from, const Vec3<F>& m, double weight) {
        const F c = clamp(dot(from, m), F(0.f), F(1.f));
        const DielectricFresnel<F> fresnel = dielectricFresnel(c, eta);
        const Vec3<F> reflected = m * (F(2.f) * c) - from;
        const Vec3<F> refracted = (m * (c - fresnel.etaCosRefracted) - from) * (F(1.f) / eta);
        const F up = fresnel.reflectance * wide.shadowing(from, reflected);
        const F down = (F(1.f) - fresnel.reflectance) * wide.shadowing(from, refracted) *
                       exp(-thickness / max(-refracted.z, F(1e-6f)));
        result.reflected += weight * sumOfLanes(select(reflected.z > F(0.f), up, F(0.f)));
        result.transmitted += weight * sumOfLanes(select(refracted.z < F(0.f), down, F(0.f)));
    });
    return result;
}

void appendSmoothCoat(const Coat& coat, std::vector<float>& numbers) {
    // Equal steps, many, because at the critical angle the integrand has a square root's edge.
    constexpr int kSteps = 1 << 14;
    BaseFractions base;
    for (int i = 0; i < kSteps; ++i) {
        const double mu = (i + 0.5) / kSteps;
        const double fresnel = dielectricFresnel(float(mu), 1.f / coat.eta).reflectance;
        const double crossing = std::exp(-coat.opticalThickness / mu);
        base.back += 2 * mu * fresnel * crossing * crossing / kSteps;
        base.out += 2 * mu * (1 - fresnel) * crossing / kSteps;
    }
    appendBase(base, numbers);
}

CoatRows constantCoatRows(const Ggx<float>& ggx) {
    const double low = std::min(ggx.ax, ggx.ay), high = std::max(ggx.ax, ggx.ay);
    return {float(std::sqrt(low)), float(std::sqrt(high)), low == high ? 1u : 33u};
}

void appendConstantCoat(const Coat& coat, const Ggx<float>& ggx, std::vector<float>& numbers) {
    const CoatRows rows = constantCoatRows(ggx);
    const BaseFractions base = roughBaseFractions(coat, ggx);
    const double x2 = double(ggx.ax) * ggx.ax, y2 = double(ggx.ay) * ggx.ay;
    for (std::uint32_t row = 0; row < rows.count; ++row) {
        const double alpha2 = std::pow(coordinateOf(rows, row), 4);
        const double sinSquaredPhi = rows.count > 1 ? std::clamp((alpha2 - x2) / (y2 - x2), 0.0, 1.0) : 0;
        appendRow(coat, ggx, sinSquaredPhi, base, numbers);
    }
}

void appendTexturedCoat(const Coat& coat, std::vector<float>& numbers) {
    for (std::uint32_t row = 0; row < kTexturedCoatRows.count; ++row) {
        const double root = coordinateOf(kTexturedCoatRows, row);
        const float alpha = std::max(float(root * root), kSmoothAlpha);
        const Ggx<float> ggx{alpha, alpha};
        appendRow(coat, ggx, 0, roughBaseFractions(coat, ggx), numbers);
    }
}

}  // namespace penumbra
