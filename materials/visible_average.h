// Quadrature over rough surfaces, when materials are made: means over the normals visible from a direction, by the very
// sampling that renders (u.x is the azimuth of the cap, periodic: equal steps; u.y its height: Gauss-Legendre), and means over
// directions. Thread safety: pure functions.
#pragma once

#include "materials/microfacet.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra {

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

inline double sumOfLanes(const Lanes8f& x) {
    double sum = 0;
    for (int i = 0; i < kLanes<Lanes8f>; ++i)
        sum += lane(x, i);
    return sum;
}

/// Calls function(ggx, w, m, weight), the first three over lanes, so that the sum of weight times something is its mean over
/// the normals m visible from w. More steps are for something that has edges.
template <int kHeights = 32, int kAzimuths = 32, class Function>
void averageOverVisible(const Ggx<float>& ggx, const Vec3<float>& w, Function&& function) {
    using F = Lanes8f;
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

/// (mu, phi) -> unit vector; phi by its sin^2.
inline Vec3<float> directionAt(double cosTheta, double sinSquaredPhi) {
    const double sinTheta = std::sqrt(std::max(0.0, 1 - cosTheta * cosTheta));
    return {float(sinTheta * std::sqrt(1 - sinSquaredPhi)), float(sinTheta * std::sqrt(sinSquaredPhi)),
            float(cosTheta)};
}

/// Calls function(w, weight) so that the sum of weight times something is its cosine-weighted mean over the directions above
/// a surface of that roughness. Nodes gather at the cosine `edge`, where functions may have a sharp one.
template <class Function>
void averageOverDirections(const Ggx<float>& ggx, double edge, Function&& function) {
    constexpr int kCosines = 24;
    static const GaussLegendre<kCosines> rule;
    const int azimuths = ggx.ax == ggx.ay ? 1 : 8;
    const auto add = [&](double mu, double weight) {
        for (int j = 0; j < azimuths; ++j) {
            const double s = std::sin(1.57079632679489662 * (j + 0.5) / azimuths);
            function(directionAt(mu, s * s), 2 * mu * weight / azimuths);
        }
    };
    for (int i = 0; i < kCosines; ++i) {
        const double t = rule.node[i], weight = 2 * t * rule.weight[i];
        add(edge * (1 - t * t), edge * weight);
        add(edge + (1 - edge) * t * t, (1 - edge) * weight);
    }
}

/// The cosine above which light from the denser side of an interface gets out.
inline double criticalCosine(double eta) {
    const double step = std::min(eta, 1 / eta);
    return std::sqrt(1 - step * step);
}

}  // namespace penumbra
