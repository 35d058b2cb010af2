#include "core/camera/camera.h"

#include <cmath>

namespace penumbra {

Camera::Camera(const CameraSettings& s) : kind_(s.kind) {
    const double scale = s.kind == CameraKind::Perspective ? std::tan(s.fovDegrees * 3.14159265358979323846 / 360) : 1.0;
    screenX_ = float(s.screen[0] * scale);
    screenY_ = float(s.screen[3] * scale);
    perPixelX_ = float((s.screen[1] - s.screen[0]) * scale / s.width);
    perPixelY_ = float(-(s.screen[3] - s.screen[2]) * scale / s.height);
    lensRadius_ = float(s.lensRadius);
    focalDistance_ = float(s.focalDistance);
    const double span = s.transformTimes[1] - s.transformTimes[0];
    timeOpen_ = float((s.shutterOpen - s.transformTimes[0]) / span);
    timeSpan_ = float((s.shutterClose - s.shutterOpen) / span);
    const float pixel = 0.5f * (std::fabs(perPixelX_) + std::fabs(perPixelY_));
    (kind_ == CameraKind::Perspective ? coneSpread_ : coneWidth_) = pixel;
    for (const Matrix4& m : motionMatrices(s.worldFromCameraStart, s.worldFromCameraEnd)) matrices_.push_back(toRecord(m));
    segments_ = std::uint32_t(matrices_.size() - 1);
}

}  // namespace penumbra
