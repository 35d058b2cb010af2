// RectangleLight: a diffuse area light on a rectangle, sampled uniformly in solid angle.
//
// Source: Urena, Fajardo, King 2013, "An area-preserving parametrization for spherical rectangles" (CGF 32(4)): first x
// by the solid angle of the strip between the rectangle's left edge and x, then y by the sine of the elevation. The
// formulas here are re-derived so that they hold in single precision; the paper's sums of four arc cosines lose all
// digits of small or grazing rectangles. With the point at the origin, the rectangle [x0, x1] x [y0, y1] at height h,
// lengths relative to the farthest corner, and for an edge e_i = sqrt(y_i^2 + h^2), b_i = y_i / e_i, c_i = h / e_i:
//   - the solid angle is the sum over corners of +-arg(h l + i x y), l the distance, added by multiplying the complex
//     numbers; small ones, where the sum cancels, are those of two triangles (van Oosterom, Strackee 1983), whose
//     numerators are products of lengths;
//   - A(x), the signed solid angle between the planes x = 0 and x, has sin A = sin f cos f (b1 k0 - b0 k1) and
//     cos A = cos^2 f k0 k1 + sin^2 f b0 b1, with tan f = x / h and k_i = sqrt(x^2 + e_i^2) / e_i;
//   - its inverse is, with s = sin A/2, k = cos A/2, B = b1 - b0,
//     x = 2 h s k B / sqrt((k^2 B^2 - s^2 (c0 + c1)^2) (k^2 B^2 - s^2 (c1 - c0)^2)).
// Differences of b_i and k_i are expanded where y0 and y1 have one sign, so that nothing cancels.
//
// Invariants: axisX, axisY, normal are orthonormal; the normal is the side that emits (both where two-sided).
#pragma once

#include "lights/area_light.h"

#include <array>
#include <optional>

namespace penumbra {

struct RectangleLight {
    static constexpr const PluginInfo& kInfo = kDiffuseAreaInfo;
    static constexpr bool kInfinite = false;
    static constexpr bool kDelta = false;

    Vec3<float> corner, axisX, axisY, normal;
    float width, height;  ///< along axisX, axisY
    Spectrum<float> radiance;
    std::uint32_t flags;
    std::uint32_t picture = 0;  ///< where kLightPictured

    /// `edgeX` and `edgeY` leave the corner and make a right angle; `normal` says which side emits.
    static RectangleLight make(const Vec3<float>& corner, const Vec3<float>& edgeX, const Vec3<float>& edgeY,
                               const Vec3<float>& normal, const Spectrum<float>& radiance, std::uint32_t flags);

    float power(const LightTables& tables) const { return diffusePower(*this, tables, width * height); }

    std::optional<LightBounds> bounds(const LightTables& tables) const {
        const Vec3<float> right = corner + axisX * width, up = axisY * height;
        return diffuseBounds({corner, right, corner + up, right + up}, *this, tables, width * height);
    }

    template <class F>
    static LightSample<F> sample(const Records<F, RectangleLight>& light, const LightTables& tables, const Vec3<F>& p,
                                 const Vec2<F>& u);
    template <class F>
    static LightEval<F> evaluate(const Records<F, RectangleLight>& light, const LightTables& tables,
                                 const LightHit<F>& hit);
};

struct RectangleShape {
    Vec3<float> corner, edgeX, edgeY;
};

/// The rectangle that two triangles make, to a part in 1e5 of its shorter edge: they share a diagonal (equal
/// coordinates), are wound the same way, and the four corners make a parallelogram with right angles. Nothing
/// otherwise.
std::optional<RectangleShape> rectangleOfTriangles(const std::array<Vec3<float>, 3>& a,
                                                   const std::array<Vec3<float>, 3>& b);

namespace detail {

template <class F>
struct Complex {
    F re, im;
    friend Complex operator*(const Complex& a, const Complex& b) {
        return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    }
};

/// The rectangle as seen from a point: in its own axes, the point at the origin, in units of the farthest corner's
/// distance.
template <class F>
struct RectangleView {
    F z;     ///< offset along the normal (world units), negative on the side that emits
    F unit;  ///< distance of the farthest corner
    F x0, x1, y0, y1, h;
    F width, height;
    F l00, l01, l10, l11;  ///< distances to the corners (x index first)

    RectangleView(const Records<F, RectangleLight>& light, const Vec3<F>& p) {
        const Vec3<F> d = light(&RectangleLight::corner) - p;
        width = light(&RectangleLight::width);
        height = light(&RectangleLight::height);
        x0 = dot(d, light(&RectangleLight::axisX));
        y0 = dot(d, light(&RectangleLight::axisY));
        z = dot(d, light(&RectangleLight::normal));
        const F farX = max(abs(x0), abs(x0 + width)), farY = max(abs(y0), abs(y0 + height));
        unit = sqrt(farX * farX + farY * farY + z * z);
        const F scale = F(1.f) / unit;
        width *= scale;
        height *= scale;
        x0 *= scale;
        y0 *= scale;
        x1 = x0 + width;
        y1 = y0 + height;
        h = abs(z) * scale;
        l00 = sqrt(x0 * x0 + y0 * y0 + h * h);
        l01 = sqrt(x0 * x0 + y1 * y1 + h * h);
        l10 = sqrt(x1 * x1 + y0 * y0 + h * h);
        l11 = sqrt(x1 * x1 + y1 * y1 + h * h);
    }

    /// Half the solid angle, in [0, pi]; NaN where the point is a corner.
    F halfSolidAngle() const {
        const Complex<F> sum = (Complex<F>{h * l11, x1 * y1} * Complex<F>{h * l00, x0 * y0}) *
                               (Complex<F>{h * l01, -(x0 * y1)} * Complex<F>{h * l10, -(x1 * y0)});
        const F angle = atan2(sum.im, sum.re);
        // Above pi the sum has come round. Just below 0 that may be rounding: then two triangles decide.
        const F half = F(0.5f) * select(angle < F(-1e-3f), angle + F(kTwoPi), angle);
        const Mask<F> small = half < F(0.01f);
        return none(small) ? half : select(small, halfSolidAngleOfTriangles(), half);
    }
    F halfSolidAngleOfTriangles() const;

    F pdfArea(F distance) const { return distance * distance * distance / (abs(z) * (width * unit) * (height * unit)); }

    /// x such that the strip [x0, x] has the fraction u.x of the solid angle, and y likewise within x.
    Vec2<F> sampleSolidAngle(F halfAngle, const Vec2<F>& u) const;
    F sampleX(F halfAngle, F u) const;
    F sampleY(F x, F u) const;
};

template <class F>
F RectangleView<F>::halfSolidAngleOfTriangles() const {
    const F i00 = F(1.f) / l00, i01 = F(1.f) / l01, i10 = F(1.f) / l10, i11 = F(1.f) / l11;
    const F hh = h * h;
    // Cosines of the angles between the unit vectors to the corners.
    const F bottom = (x0 * x1 + y0 * y0 + hh) * i00 * i10, top = (x0 * x1 + y1 * y1 + hh) * i01 * i11;
    const F left = (x0 * x0 + y0 * y1 + hh) * i00 * i01, right = (x1 * x1 + y0 * y1 + hh) * i10 * i11;
    const F diagonal = (x0 * x1 + y0 * y1 + hh) * i00 * i11;
    const F common = (h * i00) * (width * i11) * height;
    const F n1 = common * i10, d1 = F(1.f) + bottom + right + diagonal;
    const F n2 = common * i01, d2 = F(1.f) + left + top + diagonal;
    return atan2(n1 * d2 + n2 * d1, d1 * d2 - n1 * n2);
}

template <class F>
F RectangleView<F>::sampleX(F halfAngle, F u) const {
    const F e0 = sqrt(y0 * y0 + h * h), e1 = sqrt(y1 * y1 + h * h), q = sqrt(x0 * x0 + h * h);
    const F i0 = F(1.f) / e0, i1 = F(1.f) / e1, iq = F(1.f) / q;
    const F b0 = y0 * i0, b1 = y1 * i1, c0 = h * i0, c1 = h * i1, k0 = l00 * i0, k1 = l01 * i1;
    const F sinF = x0 * iq, cosF = h * iq;
    // b1 - b0 and b1 k0 - b0 k1 by the difference of their squares where y0 and y1 have one sign.
    const Mask<F> oneSide = y0 * y1 > F(0.f);
    const F g = (height * i0) * ((y0 + y1) * i1);
    const F B = select(oneSide, g * c0 * c1 / (b0 + b1), b1 - b0);
    const F K = select(oneSide, g * (q * i0) * (q * i1) / (b1 * k0 + b0 * k1), b1 * k0 - b0 * k1);
    const F sinA = sinF * cosF * K, cosA = cosF * cosF * k0 * k1 + sinF * sinF * b0 * b1;
    // Half of A(x0): the larger of sine and cosine by a root, the other from sin A = 2 sin cos.
    const F large = sqrt(F(0.5f) * (F(1.f) + abs(cosA))), small = abs(sinA) / (large + large);
    const Mask<F> acute = cosA >= F(0.f);
    const F s0 = copySign(select(acute, small, large), sinA), t0 = select(acute, large, small);
    F su, cu;
    sinCos(u * halfAngle, su, cu);
    const F s = s0 * cu + t0 * su, k = t0 * cu - s0 * su;
    const F kB = k * B, sSum = s * (c0 + c1), sDifference = s * (c1 - c0);
    const F radicand = ((kB - sSum) * (kB + sSum)) * ((kB - sDifference) * (kB + sDifference));
    return clamp(h * (F(2.f) * s * kB) / sqrt(max(radicand, F(1e-37f))), x0, x1);
}

template <class F>
F RectangleView<F>::sampleY(F x, F u) const {
    // t = y / sqrt(y^2 + d^2) is uniform. It is 1 to all digits where y is far beyond d: so turn the side with the
    // farther end to the positive, and interpolate 1 - t.
    const F dd = x * x + h * h;
    const Mask<F> turned = y0 + y1 < F(0.f);
    const F a = select(turned, -y1, y0), b = select(turned, -y0, y1);
    const F ra = sqrt(a * a + dd), rb = sqrt(b * b + dd);
    const F from = select(a > F(0.f), dd / (ra * (ra + a)), F(1.f) - a / ra), to = dd / (rb * (rb + b));
    const F versine = lerp(select(turned, F(1.f) - u, u), from, to);
    const F y = (F(1.f) - versine) * sqrt(dd / max(versine * (F(2.f) - versine), F(1e-37f)));
    return clamp(flipSign(turned, y), y0, y1);
}

template <class F>
Vec2<F> RectangleView<F>::sampleSolidAngle(F halfAngle, const Vec2<F>& u) const {
    const F x = sampleX(halfAngle, u.x);
    return {x, sampleY(x, u.y)};
}

}  // namespace detail

template <class F>
LightSample<F> RectangleLight::sample(const Records<F, RectangleLight>& light, const LightTables& tables,
                                      const Vec3<F>& p, const Vec2<F>& u) {
    const detail::RectangleView<F> view(light, p);
    const UInt<F> flags = light(&RectangleLight::flags);

    Vec2<F> q = {lerp(u.x, view.x0, view.x1), lerp(u.y, view.y0, view.y1)};
    Mask<F> spherical = Mask<F>(false);
    F pdf = F(0.f);
    if (!tables.classicArea) {
        const F half = view.halfSolidAngle();
        spherical = half >= F(0.5f * kSmallestSolidAngle);
        if (any(spherical)) {
            const Vec2<F> s = view.sampleSolidAngle(select(spherical, half, F(0.f)), u);
            q = {select(spherical, s.x, q.x), select(spherical, s.y, q.y)};
            pdf = F(0.5f) / half;
        }
    }
    q = q * view.unit;
    const F distance = sqrt(q.x * q.x + q.y * q.y + view.z * view.z);
    pdf = select(spherical, pdf, view.pdfArea(distance));
    const Vec3<F> d = light(&RectangleLight::axisX) * q.x + light(&RectangleLight::axisY) * q.y +
                      light(&RectangleLight::normal) * view.z;
    return lightSample(emitsTowards<F>(view.z, flags) & isFinite(pdf), d * (F(1.f) / distance), distance,
                       emittedRadiance(light, tables, flags, p + d), pdf, hasFlag<F>(flags, kLightUnmet));
}

template <class F>
LightEval<F> RectangleLight::evaluate(const Records<F, RectangleLight>& light, const LightTables& tables,
                                      const LightHit<F>& hit) {
    const detail::RectangleView<F> view(light, hit.from);
    F pdf = view.pdfArea(length(hit.p - hit.from));
    if (!tables.classicArea) {
        const F half = view.halfSolidAngle();
        pdf = select(half >= F(0.5f * kSmallestSolidAngle), F(0.5f) / half, pdf);
    }
    const UInt<F> flags = light(&RectangleLight::flags);
    return lightEval(emitsTowards<F>(view.z, flags) & isFinite(pdf), emittedRadiance(light, tables, flags, hit.p), pdf);
}

}  // namespace penumbra
