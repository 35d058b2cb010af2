// Scenes whose pixels have a closed form: what a renderer must show, known without rendering.
//
// Each is the text of a pbrt-v4 scene, read like any other, with the mean of its picture, per channel. The formulas are
// those of radiometry textbooks; each file names its own.
//
// Conventions: receivers lie at the origin in the plane z = 0 with the normal +z unless said; a "point" of a receiver
// is a picture of a square so small that the value's change over it is far below the tolerances (odd terms cancel,
// because the square is centred). Values are those of the estimator's expectation at the scene's own maxdepth, exactly,
// or with a remainder below 1e-6.
//
// Thread safety: pure functions.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace penumbra {

/// A file that the text refers to, to be put beside it.
struct AnalyticSceneFile {
    std::string name, bytes;
};

struct AnalyticScene {
    /// Which of the two estimators of a light's contribution the render may use.
    enum class Strategy { Both, LightSampling, ScatteringOnly };

    std::string id;     ///< short and unique
    std::string claim;  ///< what is seen, in one line
    std::string text;   ///< the pbrt-v4 scene
    std::vector<AnalyticSceneFile> files{};
    std::array<double, 3> expected{};  ///< mean linear RGB of the picture
    int samplesPerPixel = 64;  ///< a power of two; enough for a relative standard error near 0.1 % over 16 seeds
    Strategy strategy = Strategy::Both;
    bool roulette = true;
    /// The estimator has no variance: with these settings every sample equals the value up to the arithmetic of float.
    bool exact = false;
};

/// Appends the scene as it is, and once for each strategy alone; `scatteringSamples` a pixel where light is not sampled.
void addInAllStrategies(std::vector<AnalyticScene>& scenes, AnalyticScene scene, int scatteringSamples);

/// All of them, in the order cavities, emitters, cameras, materials, masks.
std::vector<AnalyticScene> analyticScenes();

std::vector<AnalyticScene> analyticCavities();   ///< closed and open furnaces, integrating spheres, interreflection
std::vector<AnalyticScene> analyticEmitters();   ///< irradiance of every light, form factors
std::vector<AnalyticScene> analyticCameras();    ///< filters, lenses, shutters, projections
std::vector<AnalyticScene> analyticMaterials();  ///< Fresnel, slabs, coats, microfacets
std::vector<AnalyticScene> analyticMasks();      ///< shapes with holes

}  // namespace penumbra
