#include "core/camera/camera.h"

namespace penumbra {

bool makeCamera(std::string_view name, CameraInput& input, CameraModel& out) {
    bool found = false;
    forEachType(CameraTypes{}, [&]<class T>() {
        if (T::kInfo.name != name) return;
        out = T::make(input);
        found = true;
    });
    return found;
}

Camera::Camera(CameraModel model, const CameraPlacement& p, float coneScale) : model_(std::move(model)) {
    std::visit(
        [&]<class T>(const T& camera) {
            usesLens_ = camera.usesLens();
            cone_ = camera.cone();
            looksAllRound_ = T::kLooksAllRound;
        },
        model_);
    cone_ = {cone_.width * coneScale, cone_.spread * coneScale};
    const double span = p.transformTimes[1] - p.transformTimes[0];
    timeOpen_ = float((p.shutterOpen - p.transformTimes[0]) / span);
    timeSpan_ = float((p.shutterClose - p.shutterOpen) / span);
    for (const Matrix4& m : motionMatrices(p.worldFromCameraStart, p.worldFromCameraEnd))
        matrices_.push_back(toRecord(m));
    segments_ = std::uint32_t(matrices_.size() - 1);
}

const PluginInfo& Camera::info() const {
    return dispatch(CameraTypes{}, unsigned(model_.index()), []<class T>() -> const PluginInfo& { return T::kInfo; });
}

}  // namespace penumbra
