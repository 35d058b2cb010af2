// SphereLight: a diffuse area light on a sphere, an ellipsoid (a sphere under any affine map) or a part of one.
//
// All work is done in the object space of its place (quadric_place.h), where the sphere has radius 1 and its centre at
// the origin.
//   - The whole sphere from outside: uniform in the cone that it subtends. Nothing cancels for small angles, because
//     1 - cosMax = 1 / (d^2 (1 + cosMax)), nor near the surface, because cosMax^2 = (d - 1)(d + 1) / d^2.
//   - The whole sphere from inside (it emits there if two-sided or reversed): uniform directions.
//   - A part (zmin, zmax, phimax), whose inside may be seen through the opening, or any sphere with classicArea:
//     uniform in the area of the unit sphere's part.
#pragma once

#include "core/math/warps.h"
#include "lights/quadric_place.h"

namespace penumbra {

struct SphereLight : QuadricPlace {
    static constexpr const PluginInfo& kInfo = kDiffuseAreaInfo;
    static constexpr bool kInfinite = false;
    static constexpr bool kDelta = false;

    float zMin, zMax, phiMax;  ///< of the unit sphere; -1, 1, 2 pi where it is whole
    float area;                ///< in the world
    Spectrum<float> radiance;
    std::uint32_t flags;        ///< kLightReversed: the outside (the side that emits) is towards the centre
    std::uint32_t whole;        ///< 1 or 0
    std::uint32_t picture = 0;  ///< where kLightPictured

    /// The sphere of `radius` about the origin of object space, cut to zMin <= z <= zMax (in its units) and angles up
    /// to phiMax. False where the matrix is singular or not finite; `light` is then untouched.
    static bool make(const Matrix4& worldFromObject, double radius, double zMin, double zMax, double phiMax,
                     const Spectrum<float>& radiance, std::uint32_t flags, SphereLight& light);

    float power(const LightTables& tables) const { return diffusePower(*this, tables, area); }

    /// Of the box round the whole ellipsoid, which from afar is a disk of a quarter of its surface.
    std::optional<LightBounds> bounds(const LightTables& tables) const;

    template <class F>
    static LightSample<F> sample(const Records<F, SphereLight>& light, const LightTables& tables, const Vec3<F>& p,
                                 const Vec2<F>& u);
    template <class F>
    static LightEval<F> evaluate(const Records<F, SphereLight>& light, const LightTables& tables,
                                 const LightHit<F>& hit);
};

namespace detail {

/// The unit sphere as seen from a point of its object space.
template <class F>
struct SphereView {
    Vec3<F> o;  ///< the point
    F d;        ///< its distance from the centre
    F excess;   ///< d^2 - 1
    Mask<F> inside;
    Mask<F> whole;
    Mask<F> byArea;             ///< the light is sampled by area
    Mask<F> outwards, inwards;  ///< emits to the outside, the inside of the sphere (not of its orientation)

    SphereView(const Records<F, SphereLight>& light, const LightTables& tables, const Vec3<F>& p) {
        o = QuadricPlace::toObject(light, p - light(&SphereLight::center));
        d = length(o);
        excess = (d - F(1.f)) * (d + F(1.f));
        inside = d < F(1.f);
        whole = light(&SphereLight::whole) != UInt<F>(0u);
        byArea = select(whole, Mask<F>(tables.classicArea), Mask<F>(true));
        const UInt<F> flags = light(&SphereLight::flags);
        const Mask<F> twoSided = hasFlag<F>(flags, kLightTwoSided), reversed = hasFlag<F>(flags, kLightReversed);
        outwards = select(reversed, twoSided, Mask<F>(true));
        inwards = twoSided | reversed;
    }

    /// 1 - cosine of the cone's half angle.
    F coneVersine() const { return F(1.f) / (d * d + d * sqrt(max(excess, F(0.f)))); }
    F pdfDirection() const { return select(inside, F(kInvFourPi), F(kInvTwoPi) / coneVersine()); }
    /// `q` is a point of the sphere.
    F pdfArea(const Records<F, SphereLight>& light, const Vec3<F>& q) const {
        const F partArea = (light(&SphereLight::zMax) - light(&SphereLight::zMin)) * light(&SphereLight::phiMax);
        const Vec3<F> v = q - o;
        const F distance = length(v);
        return distance * distance * distance / (abs(dot(q, v)) * partArea);
    }
    /// Whether the sphere's point q shines on the point. From outside a whole sphere hides its far side.
    Mask<F> lit(const Vec3<F>& q) const {
        const Mask<F> behind = select(byArea, dot(q, q - o) >= F(0.f), inside);
        const Mask<F> hidden = whole & byArea & behind & !inside;
        return select(behind, inwards, outwards) & !hidden;
    }

    Vec3<F> samplePoint(const Records<F, SphereLight>& light, const Vec2<F>& u) const;
    /// Unit direction and, by reference, the distance to the point met.
    Vec3<F> sampleDirection(const Vec2<F>& u, F& distance) const;
};

template <class F>
Vec3<F> SphereView<F>::samplePoint(const Records<F, SphereLight>& light, const Vec2<F>& u) const {
    const F z = lerp(u.x, light(&SphereLight::zMin), light(&SphereLight::zMax));
    const F r = sqrt(max((F(1.f) - z) * (F(1.f) + z), F(0.f)));
    F s, c;
    sinCos(light(&SphereLight::phiMax) * u.y, s, c);
    return {r * c, r * s, z};
}

template <class F>
Vec3<F> SphereView<F>::sampleDirection(const Vec2<F>& u, F& distance) const {
    // Outside: the concentric map of the disk to the cone, r^2 = (1 - cos) / (1 - cosMax).
    const Vec2<F> q = concentricDisk(u);
    const F coneMax = coneVersine();
    const F versine = (q.x * q.x + q.y * q.y) * coneMax;
    const F spread = safeSqrt(coneMax * (F(2.f) - versine));
    const Frame<F> frame = Frame<F>::fromNormal(o * (F(-1.f) / d));
    const F cosine = F(1.f) - versine;
    const Vec3<F> inCone = frame.toWorld({q.x * spread, q.y * spread, cosine});
    const F sine2 = versine * (F(2.f) - versine);
    const F near = excess / max(d * cosine + safeSqrt(F(1.f) - d * d * sine2), F(1e-20f));  // 0 / 0 on the horizon
    if (none(inside)) {
        distance = near;
        return inCone;
    }
    const Vec3<F> anywhere = uniformSphere(u);
    const F b = dot(o, anywhere), root = sqrt(max(b * b - excess, F(0.f)));
    distance = select(inside, select(b > F(0.f), -excess / (b + root), root - b), near);
    return select(inside, anywhere, inCone);
}

}  // namespace detail

template <class F>
LightSample<F> SphereLight::sample(const Records<F, SphereLight>& light, const LightTables& tables, const Vec3<F>& p,
                                   const Vec2<F>& u) {
    const detail::SphereView<F> view(light, tables, p);
    Vec3<F> direction = {F(0.f), F(0.f), F(1.f)};
    F distance = F(0.f), pdf = F(0.f);
    Mask<F> valid = Mask<F>(true);
    if (!all(view.byArea)) {
        direction = view.sampleDirection(u, distance);
        pdf = view.pdfDirection();
        valid = select(view.inside, view.inwards, view.outwards);
    }
    if (any(view.byArea)) {
        const Vec3<F> q = view.samplePoint(light, u), v = q - view.o;
        const F far = length(v);
        direction = select(view.byArea, v * (F(1.f) / far), direction);
        distance = select(view.byArea, far, distance);
        pdf = select(view.byArea, view.pdfArea(light, q), pdf);
        valid = select(view.byArea, view.lit(q), valid);
    }
    return QuadricPlace::toWorld(light, tables, p, valid, direction, distance, pdf);
}

template <class F>
LightEval<F> SphereLight::evaluate(const Records<F, SphereLight>& light, const LightTables& tables,
                                   const LightHit<F>& hit) {
    const detail::SphereView<F> view(light, tables, hit.from);
    const Vec3<F> q = QuadricPlace::toObject(light, hit.p - light(&SphereLight::center));
    const F pdf =
        select(view.byArea, view.pdfArea(light, q), view.pdfDirection()) * QuadricPlace::densityInWorld(light, hit.wi);
    const Spectrum<F> L = emittedRadiance(light, tables, light(&SphereLight::flags), hit.p);
    return lightEval(view.lit(q) & isFinite(pdf), L, pdf);
}

}  // namespace penumbra
