#include "core/color/conductor_fit.h"

#include <cmath>
#include <numbers>

namespace penumbra {
namespace {

constexpr int kAngles = 24;
using Curve = std::array<double, kAngles>;

/// Angles spread evenly over a quarter turn, so that grazing light counts as much as light along the normal.
const Curve& cosines() {
    static const Curve all = [] {
        Curve c;
        for (int i = 0; i < kAngles; ++i)
            c[i] = std::cos((i + 0.5) * std::numbers::pi / (2 * kAngles));
        return c;
    }();
    return all;
}

Curve fresnelCurve(double eta, double k) {
    Curve out;
    for (int a = 0; a < kAngles; ++a)
        out[a] = conductorFresnel(cosines()[a], eta, k);
    return out;
}

/// The colour of the spectral reflectance at each angle, in [0, 1], per channel.
std::array<Curve, 3> targetCurves(const SampledSpectrum& eta, const SampledSpectrum& k, const ColorSpace& space) {
    const ChannelWeights& weights = channelWeights(space);
    std::array<Curve, 3> target{};
    for (int i = 0; i < kWavelengthCount; ++i) {
        const Curve reflectance = fresnelCurve(eta.values[i], k.values[i]);
        for (int c = 0; c < 3; ++c)
            for (int a = 0; a < kAngles; ++a)
                target[c][a] += weights.rows[c][i] * reflectance[a];
    }
    for (Curve& curve : target)
        for (double& value : curve)
            value = std::clamp(value, 0.0, 1.0);
    return target;
}

/// A trial of the fit. The index is searched as (log eta, sqrt k), which keeps eta above and k not below zero.
struct Trial {
    double logEta = 0, rootK = 0;
    static Trial of(double eta, double k) { return {std::log(std::max(eta, 1e-2)), std::sqrt(std::max(k, 0.0))}; }
    double eta() const { return std::exp(logEta); }
    double k() const { return rootK * rootK; }
    Curve curve() const { return fresnelCurve(eta(), k()); }
};

double squaredError(const Curve& a, const Curve& b) {
    double sum = 0;
    for (int i = 0; i < kAngles; ++i)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

/// One damped Gauss-Newton step from `at`, whose curve is `curve`.
Trial dampedStep(const Trial& at, const Curve& curve, const Curve& target, double damping) {
    constexpr double kDelta = 1e-5;
    const Curve byEta = Trial{at.logEta + kDelta, at.rootK}.curve(), byK = Trial{at.logEta, at.rootK + kDelta}.curve();
    double a11 = 0, a12 = 0, a22 = 0, g1 = 0, g2 = 0;
    for (int i = 0; i < kAngles; ++i) {
        const double j1 = (byEta[i] - curve[i]) / kDelta, j2 = (byK[i] - curve[i]) / kDelta, r = target[i] - curve[i];
        a11 += j1 * j1;
        a12 += j1 * j2;
        a22 += j2 * j2;
        g1 += j1 * r;
        g2 += j2 * r;
    }
    a11 = a11 * (1 + damping) + 1e-12;
    a22 = a22 * (1 + damping) + 1e-12;
    const double determinant = a11 * a22 - a12 * a12;
    // Where the target is all but 1 the best index is without bounds: a step is kept short and the range finite.
    const double d1 = std::clamp((g1 * a22 - g2 * a12) / determinant, -1.0, 1.0);
    const double d2 = std::clamp((g2 * a11 - g1 * a12) / determinant, -1.0, 1.0);
    return {std::clamp(at.logEta + d1, std::log(1e-2), std::log(1e2)), std::clamp(at.rootK + d2, 0.0, 10.0)};
}

/// Levenberg-Marquardt from one start; returns the squared error that is left.
double refine(Trial& best, const Curve& target) {
    Curve curve = best.curve();
    double error = squaredError(curve, target), damping = 1e-3;
    for (int iteration = 0; iteration < 200 && damping < 1e9; ++iteration) {
        const Trial next = dampedStep(best, curve, target, damping);
        const Curve nextCurve = next.curve();
        const double nextError = squaredError(nextCurve, target);
        if (nextError < error) {
            const bool converged = error - nextError < 1e-14;
            best = next;
            curve = nextCurve;
            error = nextError;
            damping = std::max(damping / 10, 1e-12);
            if (converged) break;
        } else {
            damping *= 10;
        }
    }
    return error;
}

}  // namespace

double conductorFresnel(double cosTheta, double eta, double k) {
    if (eta == 0 && k == 0) return 0;
    const double cos2 = cosTheta * cosTheta, sin2 = 1 - cos2;
    const double t0 = eta * eta - k * k - sin2;
    const double a2plusb2 = std::sqrt(t0 * t0 + 4 * eta * eta * k * k);
    const double a = std::sqrt(std::max(0.0, (a2plusb2 + t0) / 2));
    const double s = (a2plusb2 + cos2 - 2 * a * cosTheta) / (a2plusb2 + cos2 + 2 * a * cosTheta);
    const double p = (cos2 * a2plusb2 + sin2 * sin2 - 2 * a * cosTheta * sin2) /
                     (cos2 * a2plusb2 + sin2 * sin2 + 2 * a * cosTheta * sin2);
    return (s + s * p) / 2;
}

ConductorIndex fitConductor(const SampledSpectrum& eta, const SampledSpectrum& k, const ColorSpace& space) {
    const std::array<Curve, 3> targets = targetCurves(eta, k, space);
    const Rgb meanEta = reflectanceToRgb(eta, space), meanK = reflectanceToRgb(k, space);
    const std::array<Trial, 3> means{Trial::of(meanEta.r, meanK.r), Trial::of(meanEta.g, meanK.g),
                                     Trial::of(meanEta.b, meanK.b)};
    std::array<Trial, 3> best;
    for (int c = 0; c < 3; ++c) {
        double least = INFINITY;
        // Good metals and near-dielectrics are two valleys: the second and third start stand in one each.
        for (Trial start : {means[c], Trial::of(0.3, 3), Trial::of(2, 0.3)}) {
            const double error = refine(start, targets[c]);
            if (error < least) {
                least = error;
                best[c] = start;
            }
        }
    }
    return {{float(best[0].eta()), float(best[1].eta()), float(best[2].eta())},
            {float(best[0].k()), float(best[1].k()), float(best[2].k())}};
}

}  // namespace penumbra
