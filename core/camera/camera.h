// Camera: from a point of the film to a ray in the world, over lanes: a camera of some type (registry.h), where it
// stands and moves, and its shutter.
//
// Conventions: camera space and raster as in camera_plugin.h. Rays are in world space with unit directions. Time is
// normalised to [0, 1] over the scene's transform times. Hot code reads a Camera by const reference; the type is
// dispatched once for all lanes.
#pragma once

#include "core/camera/registry.h"
#include "core/math/affine.h"

#include <vector>

namespace penumbra {

struct CameraPlacement {
    double shutterOpen = 0, shutterClose = 1;
    double transformTimes[2] = {0, 1};
    Matrix4 worldFromCameraStart, worldFromCameraEnd;
};

template <class F>
struct CameraRay {
    Vec3<F> origin, direction;
    F time;
    F weight;     ///< what its radiance counts; 0: the ray need not be traced, the sample is black
    F coneWidth;  ///< of the ray's cone at the origin; it gains coneSpread() per unit of distance
};

/// Camera space at some time, for what is known in the world.
template <class F>
struct CameraSpace {
    Affine<F> worldFromCamera;
    Vec3<F> point(const Vec3<F>& p) const { return worldFromCamera.preimage(p); }
    /// Of a unit normal a unit normal.
    Vec3<F> normal(const Vec3<F>& n) const {
        return normalize(Vec3<F>{dot(n, worldFromCamera.x), dot(n, worldFromCamera.y), dot(n, worldFromCamera.z)});
    }
};

class Camera {
public:
    Camera() : Camera(CameraModel{}, {}) {}
    /// `coneScale`: how much of a pixel the cone of a ray covers across.
    Camera(CameraModel model, const CameraPlacement& placement, float coneScale = 1);

    /// `raster`: the point of the film; `lens`, `shutter`: numbers in [0, 1).
    template <class F>
    CameraRay<F> ray(const Vec2<F>& raster, const Vec2<F>& lens, F shutter) const {
        const LensRay<F> local = dispatch(CameraTypes{}, unsigned(model_.index()), [&]<class T>() {
            return std::get_if<T>(&model_)->template ray<F>(raster, lens);
        });
        CameraRay<F> r;
        r.time = clamp(F(timeOpen_) + shutter * F(timeSpan_), F(0.f), F(1.f));
        const Affine<F> m = space(r.time).worldFromCamera;
        r.origin = m.point(local.origin);
        r.direction = normalize(m.vector(local.direction));
        r.weight = local.weight;
        r.coneWidth = F(cone_.width);
        return r;
    }

    /// `time` as rays have it.
    template <class F>
    CameraSpace<F> space(F time) const {
        return {affineAt<F>(matrices_.data(), UInt<F>(0u), UInt<F>(segments_), time)};
    }

    const PluginInfo& info() const;
    /// As in CameraRay; one for all rays.
    float coneSpread() const { return cone_.spread; }
    bool usesLens() const { return usesLens_; }
    /// There is no axis along which a depth could be measured.
    bool looksAllRound() const { return looksAllRound_; }
    bool moves() const { return segments_ > 0; }

private:
    CameraModel model_;
    bool usesLens_ = false, looksAllRound_ = false;
    PixelCone cone_;
    float timeOpen_ = 0, timeSpan_ = 0;
    std::uint32_t segments_ = 0;
    std::vector<AffineRecord> matrices_;
};

}  // namespace penumbra
