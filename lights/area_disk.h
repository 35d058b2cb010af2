// DiskLight: a diffuse area light on a disk, ring or sector, sampled uniformly in area.
//
// The disk is the image of the unit disk under an affine map, so that scaled disks (ellipses) are right too: a map of
// one plane to another keeps "uniform in area".
//
// Invariants: the sampled point is center + radiusX x + radiusY y with (x, y) in the unit disk, inner <= |(x, y)|, and
// the angle of (x, y) from +x towards +y in [0, phiMax]; area is that of the part.
#pragma once

#include "core/math/warps.h"
#include "lights/area_light.h"

namespace penumbra {

struct DiskLight {
    static constexpr const PluginInfo& kInfo = kDiffuseAreaInfo;
    static constexpr bool kInfinite = false;
    static constexpr bool kDelta = false;

    Vec3<float> center, radiusX, radiusY, normal;
    float inner, phiMax, area;
    Spectrum<float> radiance;
    std::uint32_t flags;
    std::uint32_t picture = 0;  ///< where kLightPictured

    /// `radiusX`, `radiusY`: images of the disk's axes times its radius; `inner`: inner radius over radius, in [0, 1);
    /// phiMax in (0, 2 pi]; `normal` says which side emits.
    static DiskLight make(const Vec3<float>& center, const Vec3<float>& radiusX, const Vec3<float>& radiusY,
                          float inner, float phiMax, const Vec3<float>& normal, const Spectrum<float>& radiance,
                          std::uint32_t flags);

    float power(const LightTables& tables) const { return diffusePower(*this, tables, area); }

    /// Of the parallelogram round it.
    std::optional<LightBounds> bounds(const LightTables& tables) const {
        const Vec3<float> sum = radiusX + radiusY, difference = radiusX - radiusY;
        return diffuseBounds({center + sum, center - sum, center + difference, center - difference}, *this, tables,
                             area);
    }

    template <class F>
    static LightSample<F> sample(const Records<F, DiskLight>& light, const LightTables&, const Vec3<F>& p,
                                 const Vec2<F>& u);
    template <class F>
    static LightEval<F> evaluate(const Records<F, DiskLight>& light, const LightTables&, const LightHit<F>& hit);
};

namespace detail {

/// Uniform on the part of the unit disk. The whole disk by the concentric map, its parts in polar coordinates.
template <class F>
Vec2<F> diskPoint(const Vec2<F>& u, F inner, F phiMax) {
    Vec2<F> q = concentricDisk(u);
    const Mask<F> part = (inner > F(0.f)) | (phiMax < F(kTwoPi));
    if (any(part)) {
        const F r = sqrt(lerp(u.x, inner * inner, F(1.f)));
        F s, c;
        sinCos(phiMax * u.y, s, c);
        q = {select(part, r * c, q.x), select(part, r * s, q.y)};
    }
    return q;
}

}  // namespace detail

template <class F>
LightSample<F> DiskLight::sample(const Records<F, DiskLight>& light, const LightTables& tables, const Vec3<F>& p,
                                 const Vec2<F>& u) {
    const Vec2<F> q = detail::diskPoint(u, light(&DiskLight::inner), light(&DiskLight::phiMax));
    const Vec3<F> center = light(&DiskLight::center) - p;
    const Vec3<F> d = center + light(&DiskLight::radiusX) * q.x + light(&DiskLight::radiusY) * q.y;
    const F z = dot(center, light(&DiskLight::normal)), distance = length(d);
    const F pdf = distance * distance * distance / (abs(z) * light(&DiskLight::area));
    const UInt<F> flags = light(&DiskLight::flags);
    return lightSample(emitsTowards<F>(z, flags) & isFinite(pdf), d * (F(1.f) / distance), distance,
                       emittedRadiance(light, tables, flags, p + d), pdf, hasFlag<F>(flags, kLightUnmet));
}

template <class F>
LightEval<F> DiskLight::evaluate(const Records<F, DiskLight>& light, const LightTables& tables,
                                 const LightHit<F>& hit) {
    const F z = dot(light(&DiskLight::center) - hit.from, light(&DiskLight::normal));
    const F distance = length(hit.p - hit.from);
    const F pdf = distance * distance * distance / (abs(z) * light(&DiskLight::area));
    const UInt<F> flags = light(&DiskLight::flags);
    return lightEval(emitsTowards<F>(z, flags) & isFinite(pdf), emittedRadiance(light, tables, flags, hit.p), pdf);
}

}  // namespace penumbra
