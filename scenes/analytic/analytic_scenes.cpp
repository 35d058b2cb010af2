#include "scenes/analytic/analytic_scene.h"

#include <iterator>
#include <utility>

namespace penumbra {

void addInAllStrategies(std::vector<AnalyticScene>& scenes, AnalyticScene scene, int scatteringSamples) {
    const std::string id = scene.id;
    scenes.push_back(scene);
    scene.id = id + " light sampling";
    scene.strategy = AnalyticScene::Strategy::LightSampling;
    scenes.push_back(scene);
    scene.id = id + " scattering only";
    scene.strategy = AnalyticScene::Strategy::ScatteringOnly;
    scene.samplesPerPixel = scatteringSamples;
    scenes.push_back(std::move(scene));
}

std::vector<AnalyticScene> analyticScenes() {
    std::vector<AnalyticScene> all;
    for (std::vector<AnalyticScene>& part :
         std::array{analyticCavities(), analyticEmitters(), analyticCameras(), analyticMaterials(), analyticMasks()})
        all.insert(all.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
    return all;
}

}  // namespace penumbra
