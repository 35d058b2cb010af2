// The renderer against every closed form, through pbrt text.
//
// ClosedForm: 16 seeds a scene. A right renderer fails with probability <= 1e-3 over the choice of the seeds, which are
// fixed; every mean is known to 0.5 % (99.9 % interval), so that a bias of 1 % cannot pass, which is asserted.
// LongClosedForm (label long): 64 seeds, and every mean must be proved equal within 0.1 % (0.2 % for microfacets).
#include "core/statistics/distributions.h"
#include "tests/proof/closed_form_render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace penumbra {
namespace {

constexpr double kAlpha = 1e-3;

const std::vector<ClosedFormMeasurement>& measurements() {
    static const std::vector<ClosedFormMeasurement> all = [] {
        std::vector<ClosedFormMeasurement> list;
        for (const AnalyticScene& scene : analyticScenes())
            for (const ClosedFormMeasurement& m :
                 measureClosedForm(scene, pictureMeanOfRenders(), scene.samplesPerPixel, scene.exact ? 4 : 16, 1))
                list.push_back(m);
        return list;
    }();
    return all;
}

std::vector<ClosedFormVerdict> rejected(std::vector<ClosedFormVerdict> verdicts) {
    std::erase_if(verdicts, [](const ClosedFormVerdict& v) { return v.accepted; });
    return verdicts;
}

TEST(ClosedForm, NoPictureDiffers) {
    const std::vector<ClosedFormVerdict> bad = rejected(judgeDifference(measurements(), kAlpha));
    EXPECT_TRUE(bad.empty()) << closedFormTable(bad);
}

TEST(ClosedForm, EveryMeanIsKnownToHalfAPercent) {
    for (const ClosedFormMeasurement& m : measurements()) {
        if (m.exact) continue;
        EXPECT_LE(m.halfWidth(0.999), 0.005) << m.id << " channel " << m.channel;
    }
}

TEST(ClosedForm, ABiasOfOnePercentIsFoundInEveryPicture) {
    for (const double factor : {0.99, 1.01}) {
        std::vector<ClosedFormMeasurement> wrong = measurements();
        std::erase_if(wrong, [](const ClosedFormMeasurement& m) { return m.exact; });
        for (ClosedFormMeasurement& m : wrong)
            m.expected *= factor;
        std::vector<ClosedFormVerdict> missed = judgeDifference(wrong, kAlpha);
        std::erase_if(missed, [](const ClosedFormVerdict& v) { return !v.accepted; });
        EXPECT_TRUE(missed.empty()) << "factor " << factor << "\n" << closedFormTable(missed);
    }
}

double margin(const ClosedFormMeasurement& m) {
    return m.id.starts_with("G ") ? 2e-3 : 1e-3;
}

/// Samples a pixel so that 64 seeds prove a right renderer right: the margin then spans 8 standard errors, where
/// acceptance at 1e-3 takes 3.2, so the chance of a miss is below 1e-5 a scene. Variance is taken to fall as 1 / samples;
/// below what the scene asks for it would rise by more (good points are good only in numbers).
int samplesForProof(const AnalyticScene& scene, const ClosedFormMeasurement& m) {
    constexpr int kReplicates = 64;
    const double error = m.replicates.standardError() / m.expected, wanted = margin(m) / 8;
    const double factor = std::pow(error / wanted, 2) * static_cast<double>(m.replicates.count) / kReplicates;
    const double samples = std::clamp(scene.samplesPerPixel * std::max(factor, 1.0), 1.0, 65536.0);
    return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(samples))));
}

TEST(LongClosedForm, EveryPictureIsProvedRightWithinATenthOfAPercent) {
    const PictureMean render = pictureMeanOfRenders();
    std::vector<ClosedFormMeasurement> precise;
    for (const AnalyticScene& scene : analyticScenes()) {
        if (scene.exact) continue;
        int samples = 1;
        for (const ClosedFormMeasurement& m : measureClosedForm(scene, render, scene.samplesPerPixel, 16, 1001))
            samples = std::max(samples, samplesForProof(scene, m));
        for (const ClosedFormMeasurement& m : measureClosedForm(scene, render, samples, 64, 2001))
            precise.push_back(m);
    }
    const std::vector<ClosedFormVerdict> bad = rejected(judgeEquivalence(precise, margin, kAlpha));
    EXPECT_TRUE(bad.empty()) << closedFormTable(bad);
}

}  // namespace
}  // namespace penumbra
