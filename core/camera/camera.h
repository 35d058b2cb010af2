// Camera: from a point of the film to a ray, over lanes.
//
// Conventions (PBRT-v4's): camera space is left-handed, +x right, +y up, +z forward; raster (0, 0) is the top left corner
// of the picture and pixel (i, j) covers [i, i+1] x [j, j+1]. Rays are in world space with unit directions; their weight is
// one (no cos^4). Time is normalised to [0, 1] over the scene's transform times.
// A Camera is a small value; hot code reads it by const reference.
#pragma once

#include "core/math/affine.h"
#include "core/math/warps.h"

#include <vector>

namespace penumbra {

enum class CameraKind { Perspective, Orthographic };

struct CameraSettings {
    CameraKind kind = CameraKind::Perspective;
    int width = 1, height = 1;                     ///< pixels of the whole picture
    double fovDegrees = 90;                        ///< spanned by screen -1 to +1 (perspective)
    double screen[4] = {-1, 1, -1, 1};             ///< x0 x1 y0 y1
    double lensRadius = 0, focalDistance = 1e6;    ///< scene units; radius 0: everything is sharp
    double shutterOpen = 0, shutterClose = 1;
    double transformTimes[2] = {0, 1};
    Matrix4 worldFromCameraStart, worldFromCameraEnd;
};

template <class F>
struct CameraRay {
    Vec3<F> origin, direction;
    F time;
    F coneWidth;         ///< of the cone of one pixel at the origin; it gains coneSpread() per unit of distance
};

class Camera {
public:
    Camera() = default;
    explicit Camera(const CameraSettings& s);

    /// `raster`: the point of the film; `lens`, `shutter`: numbers in [0, 1).
    template <class F>
    CameraRay<F> ray(const Vec2<F>& raster, const Vec2<F>& lens, F shutter) const {
        CameraRay<F> r;
        const F x = F(screenX_) + raster.x * F(perPixelX_), y = F(screenY_) + raster.y * F(perPixelY_);
        Vec3<F> o, d;
        if (kind_ == CameraKind::Perspective) {
            o = {F(0.f), F(0.f), F(0.f)};
            d = {x, y, F(1.f)};
        } else {
            o = {x, y, F(0.f)};
            d = {F(0.f), F(0.f), F(1.f)};
        }
        if (lensRadius_ > 0.f) {
            // d.z is 1, so the point in focus is at o + d * focalDistance for both kinds.
            const Vec2<F> q = concentricDisk(lens) * F(lensRadius_);
            const Vec3<F> focus = o + d * F(focalDistance_);
            o = o + Vec3<F>{q.x, q.y, F(0.f)};
            d = focus - o;
        }
        r.time = clamp(F(timeOpen_) + shutter * F(timeSpan_), F(0.f), F(1.f));
        const Affine<F> m = affineAt<F>(matrices_.data(), UInt<F>(0u), UInt<F>(segments_), r.time);
        r.origin = m.point(o);
        r.direction = normalize(m.vector(d));
        r.coneWidth = F(coneWidth_);
        return r;
    }

    /// As in CameraRay; one for all rays.
    float coneSpread() const { return coneSpread_; }
    bool usesLens() const { return lensRadius_ > 0.f; }
    bool moves() const { return segments_ > 0; }

private:
    CameraKind kind_ = CameraKind::Perspective;
    float screenX_ = 0, screenY_ = 0, perPixelX_ = 0, perPixelY_ = 0;   ///< on the plane z = 1 for perspective
    float lensRadius_ = 0, focalDistance_ = 1e6f;
    float timeOpen_ = 0, timeSpan_ = 0;
    float coneSpread_ = 0, coneWidth_ = 0;
    std::uint32_t segments_ = 0;
    std::vector<AffineRecord> matrices_;
};

}  // namespace penumbra
