// PortalInfiniteLight: the sky through a window: `LightSource "infinite"` with a portal.
//
// Sources: Bitterli, Novak, Jarosz 2015, "Portal-masked environment map sampling" (CGF 34(4)); Crow 1984, "Summed-area
// tables for texture mapping" (SIGGRAPH). The sky is resampled to an image over the two angles alpha = atan(x / z) and
// beta = atan(y / z) of the portal's frame, in which a rectangular portal is a rectangle as seen from anywhere. So that
// part of the image is what a place can see of the sky, and it is sampled in proportion to the radiance times solid
// angle of its pixels, cut pixels in part, by searching sums over rectangles.
//
// The sums are whole numbers, at least one for a pixel that is not black: their differences are exact however small the
// part is, and no light is missed. The density of a direction is that of its pixel.
//
// Invariants: axisX and axisY run along the portal's edges from its corner, axisZ out of the room, all orthonormal.
#pragma once

#include "core/math/matrix.h"
#include "lights/infinite_light.h"
#include "lights/light_image.h"

#include <array>
#include <functional>

namespace penumbra {

struct PortalInfiniteLight {
    static constexpr const PluginInfo& kInfo = kInfiniteInfo;
    static constexpr bool kInfinite = true;
    static constexpr bool kDelta = false;

    Vec3<float> corner, axisX, axisY, axisZ;
    float width, height;       ///< of the portal
    std::uint32_t resolution;  ///< of the image, both ways
    std::uint32_t pixels;      ///< first of resolution^2 rows of four (r, g, b, -) in LightTables::numbers
    std::uint32_t sums;        ///< first of (resolution + 1)^2 words: sums of the pixels before a row and column
    float normalRadiance;      ///< flux through the portal per area, over pi

    /// `corners` in the world, in order round the portal; `sky(w)` is the radiance of a unit direction w of the world.
    /// Error(BadData) where they are no rectangle or the image is too large.
    static PortalInfiniteLight make(const std::array<Vec3d, 4>& corners, std::size_t resolution,
                                    const std::function<Spectrum<float>(Vec3d)>& sky, LightTables& tables);

    float power(const LightTables&) const { return kPi * normalRadiance * width * height; }
    /// From where the room is, it is a window that shines.
    std::optional<LightBounds> bounds(const LightTables&) const {
        const Vec3<float> right = axisX * width, up = axisY * height;
        return LightBounds::ofFlat({corner, corner + right, corner + up, corner + right + up}, -axisZ,
                                   double(normalRadiance) * width * height, false);
    }

    template <class F>
    static LightSample<F> sample(const Records<F, PortalInfiniteLight>& light, const LightTables& tables,
                                 const Vec3<F>& p, const Vec2<F>& u);
    template <class F>
    static LightEval<F> evaluate(const Records<F, PortalInfiniteLight>& light, const LightTables& tables,
                                 const LightHit<F>& hit);
};

namespace detail {

/// A stretch of a row or column of pixels: of its first and last pixel a part, those between whole. One pixel is a
/// first one alone.
template <class F>
struct PixelRange {
    F begin;              ///< where it begins
    UInt<F> first, last;  ///< pixels
    UInt<F> between;      ///< one past the last whole pixel, or one past the first
    F firstPart, lastPart;

    PixelRange(F from, F to, const UInt<F>& n) : begin(from) {
        const UInt<F> most = n - UInt<F>(1u);
        first = min(toUInt(from), most);
        last = min(toUInt(to), most);
        const UInt<F> next = first + UInt<F>(1u);
        const Mask<F> several = first < last;
        between = select(several, last, next);
        firstPart = select(several, toFloat<F>(next) - from, to - from);
        lastPart = select(several, to - toFloat<F>(last), F(0.f));
    }

    /// The sum of sums(a, b), of the whole pixels from a to b, over the range.
    template <class Sums>
    F total(Sums&& sums) const {
        return firstPart * sums(first, first + UInt<F>(1u)) + sums(first + UInt<F>(1u), between) +
               lastPart * sums(last, last + UInt<F>(1u));
    }
    /// The place within the range before which the fraction u of the total lies, and its pixel.
    template <class Sums>
    F invert(F u, F total, Sums&& sums, UInt<F> stride, UInt<F>& pixel) const {
        const UInt<F> one(1u), next = first + one;
        const F inFirst = firstPart * sums(first, next), wanted = u * total, beyond = wanted - inFirst;
        const Mask<F> isFirst = (wanted < inFirst) | !(first < last);
        UInt<F> at = next;
        for (; any(stride != UInt<F>(0u)); stride = stride >> 1) {
            const UInt<F> further = at + stride;
            const Mask<F> exists = !(last < further);
            const F below = sums(next, select(exists, further, next));
            at = select(exists & (below <= beyond), further, at);
        }
        pixel = select(isFirst, first, min(at, last));
        const F mass = sums(pixel, pixel + one);
        const F inside = (beyond - sums(next, select(isFirst, next, pixel))) / mass;
        const F place = select(isFirst, begin + firstPart * min(wanted / inFirst, F(1.f)),
                               toFloat<F>(pixel) + clamp(inside, F(0.f), F(kOneMinusEpsilon)));
        return place;
    }
};

/// What a place sees of the portal.
template <class F>
struct PortalView {
    const float* numbers;
    UInt<F> n, firstSum;
    F scale;        ///< pixels per radian
    Mask<F> front;  ///< the place is in the room
    PixelRange<F> columns, rows;
    F total;

    /// `toCorner`: from the place to the portal's corner.
    PortalView(const Records<F, PortalInfiniteLight>& light, const LightTables& tables, const Vec3<F>& toCorner)
        : numbers(tables.numbers.data()),
          n(light(&PortalInfiniteLight::resolution)),
          firstSum(light(&PortalInfiniteLight::sums)),
          scale(toFloat<F>(n) * F(kInvPi)),
          front(dot(toCorner, light(&PortalInfiniteLight::axisZ)) > F(0.f)),
          columns(range(dot(toCorner, light(&PortalInfiniteLight::axisX)), light(&PortalInfiniteLight::width),
                        dot(toCorner, light(&PortalInfiniteLight::axisZ)))),
          rows(range(dot(toCorner, light(&PortalInfiniteLight::axisY)), light(&PortalInfiniteLight::height),
                     dot(toCorner, light(&PortalInfiniteLight::axisZ)))) {
        total = columns.total([&](const UInt<F>& a, const UInt<F>& b) { return columnSum(a, b); });
        front = front & (total > F(0.f));
    }

    /// The sum of the pixels of columns a to b and rows c to d.
    F sum(const UInt<F>& a, const UInt<F>& b, const UInt<F>& c, const UInt<F>& d) const {
        const UInt<F> row = n + UInt<F>(1u);
        const auto at = [&](const UInt<F>& x, const UInt<F>& y) {
            return floatBits(gather(numbers, firstSum + y * row + x));
        };
        return toFloat<F>(at(b, d) - at(a, d) - at(b, c) + at(a, c));
    }
    /// Of whole columns, within the rows seen.
    F columnSum(const UInt<F>& a, const UInt<F>& b) const {
        return rows.total([&](const UInt<F>& c, const UInt<F>& d) { return sum(a, b, c, d); });
    }
    F pixel(const UInt<F>& x, const UInt<F>& y) const { return sum(x, x + UInt<F>(1u), y, y + UInt<F>(1u)); }

private:
    /// The pixels between two edges of the portal.
    PixelRange<F> range(F near, F extent, F z) const {
        const F size = toFloat<F>(n), away = max(z, F(0.f));
        const auto place = [&](F x) { return clamp(atan2(x, away) * scale + F(0.5f) * size, F(0.f), size); };
        return PixelRange<F>(place(near), place(near + extent), n);
    }
};

/// Solid angle over the angles' own measure, for a unit direction of the portal's frame.
template <class F>
F portalJacobian(const Vec3<F>& w) {
    return (F(1.f) - w.x * w.x) * (F(1.f) - w.y * w.y) / w.z;
}

template <class F>
LightEval<F> portalEval(const Records<F, PortalInfiniteLight>& light, const PortalView<F>& view, const Mask<F>& seen,
                        const UInt<F>& x, const UInt<F>& y, const Vec3<F>& w) {
    F row[4];
    loadRows4(view.numbers, light(&PortalInfiniteLight::pixels) + (y * view.n + x) * UInt<F>(4u), row);
    const F pdf = view.pixel(x, y) * (view.scale * view.scale) / (view.total * portalJacobian(w));
    return lightEval(seen & view.front & (pdf > F(0.f)) & isFinite(pdf), Spectrum<F>{row[0], row[1], row[2]}, pdf);
}

}  // namespace detail

template <class F>
LightSample<F> PortalInfiniteLight::sample(const Records<F, PortalInfiniteLight>& light, const LightTables& tables,
                                           const Vec3<F>& p, const Vec2<F>& u) {
    const detail::PortalView<F> view(light, tables, light(&PortalInfiniteLight::corner) - p);
    const UInt<F> stride(1u << 14);  // more than half of any resolution
    UInt<F> column, row;
    const auto columnSum = [&](const UInt<F>& a, const UInt<F>& b) { return view.columnSum(a, b); };
    const F x = view.columns.invert(u.x, view.total, columnSum, stride, column);
    const auto inColumn = [&](const UInt<F>& c, const UInt<F>& d) {
        return view.sum(column, column + UInt<F>(1u), c, d);
    };
    const F y = view.rows.invert(u.y, view.rows.total(inColumn), inColumn, stride, row);

    const F half = F(0.5f) * toFloat<F>(view.n), perPixel = F(1.f) / view.scale;
    F sinA, cosA, sinB, cosB;
    sinCos(clamp((x - half) * perPixel, F(-kHalfPi), F(kHalfPi)), sinA, cosA);
    sinCos(clamp((y - half) * perPixel, F(-kHalfPi), F(kHalfPi)), sinB, cosB);
    const Vec3<F> w = normalize(Vec3<F>{sinA * cosB, sinB * cosA, cosA * cosB});
    const LightEval<F> e = detail::portalEval(light, view, Mask<F>(true), column, row, w);
    const Vec3<F> wi = light(&PortalInfiniteLight::axisX) * w.x + light(&PortalInfiniteLight::axisY) * w.y +
                       light(&PortalInfiniteLight::axisZ) * w.z;
    return lightSample(e.pdf > F(0.f), wi, F(kInfinity), e.L, e.pdf, Mask<F>(false));
}

template <class F>
LightEval<F> PortalInfiniteLight::evaluate(const Records<F, PortalInfiniteLight>& light, const LightTables& tables,
                                           const LightHit<F>& hit) {
    const Vec3<F> w = {dot(light(&PortalInfiniteLight::axisX), hit.wi), dot(light(&PortalInfiniteLight::axisY), hit.wi),
                       dot(light(&PortalInfiniteLight::axisZ), hit.wi)};
    // Whether the ray goes through the portal.
    const Vec3<F> d = light(&PortalInfiniteLight::corner) - hit.from;
    const F t = dot(d, light(&PortalInfiniteLight::axisZ)) / w.z;
    const F x = w.x * t - dot(d, light(&PortalInfiniteLight::axisX));
    const F y = w.y * t - dot(d, light(&PortalInfiniteLight::axisY));
    const Mask<F> through = (w.z > F(0.f)) & (t > F(0.f)) & (x >= F(0.f)) & (y >= F(0.f)) &
                            (x <= light(&PortalInfiniteLight::width)) & (y <= light(&PortalInfiniteLight::height));
    if (none(through)) return lightEval(through, Spectrum<F>::constant(F(0.f)), F(0.f));
    const detail::PortalView<F> view(light, tables, d);
    const auto place = [&](F along) { return nearestPixel(atan2(along, w.z) * F(kInvPi) + F(0.5f), view.n); };
    return detail::portalEval(light, view, through, place(w.x), place(w.y), w);
}

}  // namespace penumbra
