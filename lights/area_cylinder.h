// CylinderLight: a diffuse area light on an open cylinder, or the part of one up to phimax, under any affine map.
//
// Sampled uniformly in area: all of it in the object space of its place (quadric_place.h), where the cylinder is that
// of radius 1 about the z axis from z = 0 to 1. (The map from there to a round cylinder keeps "uniform in area".)
// Inside and outside are both seen, through the open ends, so it is for the shadow ray to say what hides a point.
#pragma once

#include "lights/quadric_place.h"

namespace penumbra {

struct CylinderLight : QuadricPlace {
    static constexpr const PluginInfo& kInfo = kDiffuseAreaInfo;
    static constexpr bool kInfinite = false;
    static constexpr bool kDelta = false;

    float phiMax;
    float area;  ///< in the world
    Spectrum<float> radiance;
    std::uint32_t flags;        ///< kLightReversed: the outside (the side that emits) is towards the axis
    std::uint32_t picture = 0;  ///< where kLightPictured

    /// The cylinder of `radius` about the z axis of object space from zMin to zMax, for angles up to phiMax. False
    /// where the matrix is singular or not finite; `light` is then untouched.
    static bool make(const Matrix4& worldFromObject, double radius, double zMin, double zMax, double phiMax,
                     const Spectrum<float>& radiance, std::uint32_t flags, CylinderLight& light);

    float power(const LightTables& tables) const { return diffusePower(*this, tables, area); }

    /// From afar about as bright as a sphere of its surface.
    std::optional<LightBounds> bounds(const LightTables& tables) const;

    template <class F>
    static LightSample<F> sample(const Records<F, CylinderLight>& light, const LightTables&, const Vec3<F>& p,
                                 const Vec2<F>& u);
    template <class F>
    static LightEval<F> evaluate(const Records<F, CylinderLight>& light, const LightTables&, const LightHit<F>& hit);
};

namespace detail {

/// A point q of the unit cylinder as seen from a point of its object space.
template <class F>
struct CylinderView {
    Vec3<F> toPoint;
    F distance, pdf;
    Mask<F> lit;

    CylinderView(const Records<F, CylinderLight>& light, const Vec3<F>& from, const Vec3<F>& q) {
        toPoint = q - QuadricPlace::toObject(light, from - light(&CylinderLight::center));
        distance = length(toPoint);
        const F facing = q.x * toPoint.x + q.y * toPoint.y;  // the outward normal is (x, y, 0)
        pdf = distance * distance * distance / (abs(facing) * light(&CylinderLight::phiMax));
        const UInt<F> flags = light(&CylinderLight::flags);
        lit = emitsTowards<F>(flipSign(hasFlag<F>(flags, kLightReversed), facing), flags) & isFinite(pdf);
    }
};

}  // namespace detail

template <class F>
LightSample<F> CylinderLight::sample(const Records<F, CylinderLight>& light, const LightTables& tables,
                                     const Vec3<F>& p, const Vec2<F>& u) {
    F s, c;
    sinCos(light(&CylinderLight::phiMax) * u.x, s, c);
    const detail::CylinderView<F> view(light, p, {c, s, u.y});
    return QuadricPlace::toWorld(light, tables, p, view.lit, view.toPoint * (F(1.f) / view.distance), view.distance,
                                 view.pdf);
}

template <class F>
LightEval<F> CylinderLight::evaluate(const Records<F, CylinderLight>& light, const LightTables& tables,
                                     const LightHit<F>& hit) {
    const detail::CylinderView<F> view(light, hit.from,
                                       QuadricPlace::toObject(light, hit.p - light(&CylinderLight::center)));
    const F pdf = view.pdf * QuadricPlace::densityInWorld(light, hit.wi);
    return lightEval(view.lit, emittedRadiance(light, tables, light(&CylinderLight::flags), hit.p), pdf);
}

}  // namespace penumbra
