// Compares renders of the analytic scenes with their closed forms, and says how sure that comparison is.
//
// A scene is rendered R times with different seeds; the R means of its picture are independent whatever the sampler, so
// Student's t on them is honest. Two questions are asked of the same numbers:
//   - difference: is any mean wrong? Student tests, Holm's correction over the whole family;
//   - equivalence: is every mean proved right within a margin? Two one-sided tests each. (A difference test alone
//     rewards rendering few samples.)
// Scenes marked exact have no variance: every single render must equal the closed form to the arithmetic of float.
//
// Conventions: one measurement a scene and channel; channels whose renders are all equal (grey scenes) count once.
// Widths, margins and deviations are relative to the closed form.
//
// Thread safety: pure functions, as far as the renderer that is passed in.
#pragma once

#include "core/statistics/moments.h"
#include "scenes/analytic/analytic_scene.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

/// Renders the scene and returns the mean linear RGB of its picture.
using PictureMean = std::function<std::array<double, 3>(const AnalyticScene&, int samplesPerPixel, std::uint32_t seed)>;

/// What float arithmetic, a "point" of finite size and a quadrature's last digits may cost: differences below it are
/// not held against the renderer.
inline constexpr double kArithmeticTolerance = 1e-5;

struct ClosedFormMeasurement {
    std::string id;
    int channel = 0;
    bool exact = false;
    double expected = 0;
    Moments replicates;
    double worst = 0;  ///< the largest relative deviation of one replicate

    double deviation() const;  ///< of the mean, relative, signed
    /// Half the width of the confidence interval, relative.
    double halfWidth(double confidence = 0.999) const;
};

/// Renders with the seeds firstSeed, firstSeed + 1, ...
std::vector<ClosedFormMeasurement> measureClosedForm(const AnalyticScene& scene, const PictureMean& render,
                                                     int samplesPerPixel, int replicates, std::uint32_t firstSeed);

struct ClosedFormVerdict {
    ClosedFormMeasurement measurement;
    double pValue = 1;  ///< difference: adjusted for the family; equivalence: of this test alone
    bool accepted = false;
};

/// Accepts what is not proved different; a right renderer has any rejection at all with probability <= alpha.
std::vector<ClosedFormVerdict> judgeDifference(std::span<const ClosedFormMeasurement> measurements, double alpha);

/// Accepts what is proved equal within the margin; a wrong one is accepted with probability <= alpha.
std::vector<ClosedFormVerdict> judgeEquivalence(std::span<const ClosedFormMeasurement> measurements,
                                                const std::function<double(const ClosedFormMeasurement&)>& margin,
                                                double alpha);

/// One line a verdict: id, channel, expected, measured, deviation, half width, p.
std::string closedFormTable(std::span<const ClosedFormVerdict> verdicts);

}  // namespace penumbra
