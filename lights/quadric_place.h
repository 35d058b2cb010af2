// QuadricPlace: what the lights on spheres and cylinders share, the affine map M between the world and an object space
// in which the quadric has unit size.
//
// They are sampled in object space: a direction w there becomes M w in the world, and densities per solid angle change
// by |M w|^3 / |det M|. So quadrics under any scaling are sampled rightly.
//
// Invariants: toWorld has the columns of M, toObject the rows of its inverse; |det M| inverseScale^3 = 1.
#pragma once

#include "core/math/matrix.h"
#include "lights/area_light.h"

namespace penumbra {

struct QuadricPlace {
    Vec3<float> center;
    Vec3<float> toWorldX, toWorldY, toWorldZ;
    Vec3<float> toObjectX, toObjectY, toObjectZ;
    float inverseScale;

    /// False, and nothing changed, where the matrix is singular or far from what floats hold.
    bool set(const Matrix4& worldFromObject);

    /// A vector of the world, in object space.
    template <class F, class Light>
    static Vec3<F> toObject(const Records<F, Light>& light, const Vec3<F>& v) {
        return {dot(light(&Light::toObjectX), v), dot(light(&Light::toObjectY), v), dot(light(&Light::toObjectZ), v)};
    }
    /// The sample for the point p whose unit direction, distance and density are given in object space.
    template <class F, class Light>
    static LightSample<F> toWorld(const Records<F, Light>& light, const LightTables& tables, const Vec3<F>& p,
                                  const Mask<F>& valid, const Vec3<F>& direction, F distance, F pdf) {
        const Vec3<F> w = light(&Light::toWorldX) * direction.x + light(&Light::toWorldY) * direction.y +
                          light(&Light::toWorldZ) * direction.z;
        const F stretch = length(w), relative = stretch * light(&Light::inverseScale);
        const F inWorld = pdf * (relative * relative * relative);
        const Vec3<F> wi = w * (F(1.f) / stretch);
        const F far = distance * stretch;
        const UInt<F> flags = light(&Light::flags);
        return lightSample(valid & isFinite(inWorld), wi, far, emittedRadiance(light, tables, flags, p + wi * far),
                           inWorld, hasFlag<F>(flags, kLightUnmet));
    }
    /// What a density of object space is multiplied by in the world, for the unit direction w of the world: M^-1 w is
    /// there, so the unit vector along it is stretched by 1 / |M^-1 w|.
    template <class F, class Light>
    static F densityInWorld(const Records<F, Light>& light, const Vec3<F>& w) {
        const F relative = light(&Light::inverseScale) / length(toObject(light, w));
        return relative * relative * relative;
    }
};

/// By how much the area of a surface element with the unit normal n grows under M: |det M| |M^-T n|.
class AreaStretch {
public:
    /// REQUIRES: the matrix has an inverse.
    explicit AreaStretch(const Matrix4& worldFromObject);
    double operator()(Vec3d normal) const;

private:
    Matrix4 inverseTranspose_;
    double determinant_;
};

}  // namespace penumbra
