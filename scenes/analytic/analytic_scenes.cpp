#include "scenes/analytic/analytic_scene.h"

#include <iterator>

namespace penumbra {

std::vector<AnalyticScene> analyticScenes() {
    std::vector<AnalyticScene> all;
    for (std::vector<AnalyticScene>& part :
         std::array{analyticCavities(), analyticEmitters(), analyticCameras(), analyticMaterials(), analyticMasks()})
        all.insert(all.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
    return all;
}

}  // namespace penumbra
