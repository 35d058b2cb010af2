// TriangleLight: a diffuse area light on a triangle, sampled uniformly in solid angle.
//
// Source: Peters 2021, "BRDF importance sampling for polygonal lights" (ACM TOG 40(4), section 3.2), a form of Arvo's
// spherical triangle sampling (1995) without inverse cosines: with unit vectors a, b, c to the corners and
// G0 = |det(a, b, c)|, G1 = (a + b) . c, G2 = 1 + a . b, the solid angle is 2 atan2(G0, G1 + G2) (van Oosterom,
// Strackee 1983), and the part u.x of it ends at the reflection c' of a about (G0 cos - G1 sin) a + G2 sin c, where sin
// and cos are of the part's half angle; then a point of the arc from b to c', by the cosine.
// So that nothing cancels for small triangles, G0 is twice the area times the height over the three distances, and the
// arc is parametrised by its versine (1 - cosine).
//
// Small triangles, where positions would not be resolved, are sampled by area (Heitz 2019, "A low-distortion map
// between triangle and square": continuous, no root).
//
// Invariants: normal is a unit vector, on the side that emits (both where two-sided).
#pragma once

#include "lights/area_light.h"

namespace penumbra {

struct TriangleLight {
    static constexpr const PluginInfo& kInfo = kDiffuseAreaInfo;
    static constexpr bool kInfinite = false;
    static constexpr bool kDelta = false;

    Vec3<float> corner, edgeB, edgeC;  ///< edges from the corner to the other two
    Vec3<float> normal;
    float area;
    Spectrum<float> radiance;
    std::uint32_t flags;
    std::uint32_t picture = 0;  ///< where kLightPictured

    /// `normal` says which side emits; only its side of the triangle matters. REQUIRES: an area that is not 0.
    static TriangleLight make(const Vec3<float>& a, const Vec3<float>& b, const Vec3<float>& c,
                              const Vec3<float>& normal, const Spectrum<float>& radiance, std::uint32_t flags);

    float power(const LightTables& tables) const { return diffusePower(*this, tables, area); }

    std::optional<LightBounds> bounds(const LightTables& tables) const {
        return diffuseBounds({corner, corner + edgeB, corner + edgeC}, *this, tables, area);
    }

    template <class F>
    static LightSample<F> sample(const Records<F, TriangleLight>& light, const LightTables& tables, const Vec3<F>& p,
                                 const Vec2<F>& u);
    template <class F>
    static LightEval<F> evaluate(const Records<F, TriangleLight>& light, const LightTables& tables,
                                 const LightHit<F>& hit);
};

namespace detail {

/// The triangle as seen from a point at the origin.
template <class F>
struct TriangleView {
    Vec3<F> corner, edgeB, edgeC;  ///< corner relative to the point
    F z, h;                        ///< offset along the normal, negative on the side that emits; its size
    F area;
    Vec3<F> a, b, c;  ///< unit vectors to the corners
    F g0, g1, g2;
    F farthest;  ///< distance of the farthest corner, hence of any point

    TriangleView(const Records<F, TriangleLight>& light, const Vec3<F>& p)
        : corner(light(&TriangleLight::corner) - p),
          edgeB(light(&TriangleLight::edgeB)),
          edgeC(light(&TriangleLight::edgeC)) {
        z = dot(corner, light(&TriangleLight::normal));
        h = abs(z);
        area = light(&TriangleLight::area);
    }

    F halfSolidAngle() {
        const Vec3<F> toB = corner + edgeB, toC = corner + edgeC;
        const F la = length(corner), lb = length(toB), lc = length(toC);
        const F ia = F(1.f) / la, ib = F(1.f) / lb, ic = F(1.f) / lc;
        a = corner * ia;
        b = toB * ib;
        c = toC * ic;
        farthest = max(la, max(lb, lc));
        g0 = ((h * ia) * F(2.f)) * ((area * ib) * ic);
        g1 = dot(a, c) + dot(b, c);
        g2 = F(1.f) + dot(a, b);
        return atan2(g0, g1 + g2);
    }

    F pdfArea(F distance) const { return distance * distance * distance / (h * area); }

    /// The direction of u, of about unit length. REQUIRES: halfSolidAngle() was called.
    Vec3<F> sampleSolidAngle(F halfAngle, const Vec2<F>& u) const;
};

template <class F>
Vec3<F> TriangleView<F>::sampleSolidAngle(F halfAngle, const Vec2<F>& u) const {
    F s, k;
    sinCos(u.x * halfAngle, s, k);
    const Vec3<F> axis = a * (g0 * k - g1 * s) + c * (g2 * s);
    const Vec3<F> end = axis * (F(2.f) * dot(a, axis) / dot(axis, axis)) - a;
    const F versine = F(0.5f) * lengthSquared(b - end);  // 1 - cos of the arc from b to its end
    const F part = u.y * versine;
    const F t = sqrt(u.y * (F(2.f) - part) / (F(2.f) - versine));
    return b * ((F(1.f) - part) - t * (F(1.f) - versine)) + end * t;
}

/// Uniform on the triangle: the weights of the edges.
template <class F>
Vec2<F> triangleWeights(const Vec2<F>& u) {
    const Mask<F> upper = u.y > u.x;
    const F half = F(0.5f) * min(u.x, u.y);
    return {select(upper, half, u.x - half), select(upper, u.y - half, half)};
}

}  // namespace detail

template <class F>
LightSample<F> TriangleLight::sample(const Records<F, TriangleLight>& light, const LightTables& tables,
                                     const Vec3<F>& p, const Vec2<F>& u) {
    detail::TriangleView<F> view(light, p);
    const UInt<F> flags = light(&TriangleLight::flags);
    Mask<F> valid = emitsTowards<F>(view.z, flags);

    const Vec2<F> w = detail::triangleWeights(u);
    Vec3<F> d = view.corner + view.edgeB * w.x + view.edgeC * w.y;
    F distance = length(d), pdf = view.pdfArea(distance);
    if (!tables.classicArea) {
        const F half = view.halfSolidAngle();
        const Mask<F> spherical = half >= F(0.5f * kSmallestSolidAngle);
        if (any(spherical)) {
            const Vec3<F> direction = view.sampleSolidAngle(select(spherical, half, F(0.f)), u);
            const F scale = length(direction);
            const F along = view.z * scale / dot(direction, light(&TriangleLight::normal));
            valid = valid & select(spherical, along > F(0.f), Mask<F>(true));
            distance = select(spherical, min(along, view.farthest), distance);
            d = select(spherical, direction * (distance / scale), d);
            pdf = select(spherical, F(0.5f) / half, pdf);
        }
    }
    return lightSample(valid & isFinite(pdf), d * (F(1.f) / distance), distance,
                       emittedRadiance(light, tables, flags, p + d), pdf, hasFlag<F>(flags, kLightUnmet));
}

template <class F>
LightEval<F> TriangleLight::evaluate(const Records<F, TriangleLight>& light, const LightTables& tables,
                                     const LightHit<F>& hit) {
    detail::TriangleView<F> view(light, hit.from);
    F pdf = view.pdfArea(length(hit.p - hit.from));
    if (!tables.classicArea) {
        const F half = view.halfSolidAngle();
        pdf = select(half >= F(0.5f * kSmallestSolidAngle), F(0.5f) / half, pdf);
    }
    const UInt<F> flags = light(&TriangleLight::flags);
    return lightEval(emitsTowards<F>(view.z, flags) & isFinite(pdf), emittedRadiance(light, tables, flags, hit.p), pdf);
}

}  // namespace penumbra
