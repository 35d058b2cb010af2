// Pictures on area lights: an image whose colours are the radiance, over the surface; `filename` of
// `AreaLightSource "diffuse"`.
//
// The image is looked up at (u, 1 - v) of the shape's own uv, bilinearly, clamped at its borders, as the pbrt format
// has it. Both strategies find u and v from the point alone (EmissionPicture), so they see one picture.
//
// Thread safety: pictures are made before the tables are used.
#pragma once

#include "core/math/matrix.h"
#include "lights/light_image.h"

#include <array>
#include <span>

namespace penumbra {

/// Appends the pixels (width x height x 3 numbers, top row first) to the tables. Negative and non-finite values count
/// as black. The place on a shape is still to be given. Error(BadData) where the image is too large.
EmissionPicture makePicture(std::span<const float> rgb, std::size_t width, std::size_t height, LightTables& tables);

/// Lays the picture on a triangle with these corners and their uv. REQUIRES: an area that is not 0.
EmissionPicture onTriangle(EmissionPicture picture, const std::array<Vec3<float>, 3>& corners,
                           const std::array<Vec2<float>, 3>& uv);
/// Lays it on a disk, cylinder or sphere (or a part of one); `worldFromUnit` takes the one of radius 1 to the world
/// (where it is singular, nothing is to be seen of the light, nor of its picture). `vStart` and `vEnd` are the radius,
/// z, or the angle from +z, where v is 0 and 1.
EmissionPicture onRound(EmissionPicture picture, EmissionPicture::Map map, const Matrix4& worldFromUnit, double phiMax,
                        double vStart, double vEnd);

/// u and v of a point of the surface.
template <class F>
Vec2<F> pictureUv(const Records<F, EmissionPicture>& picture, const Vec3<F>& p) {
    const Vec3<F> d = p - picture(&EmissionPicture::origin);
    const F x = dot(picture(&EmissionPicture::toX), d), y = dot(picture(&EmissionPicture::toY), d);
    const F uStart = picture(&EmissionPicture::uStart), vStart = picture(&EmissionPicture::vStart);
    const UInt<F> map = picture(&EmissionPicture::map);
    const Mask<F> flat = map == UInt<F>(std::uint32_t(EmissionPicture::Flat));
    if (all(flat)) return {uStart + x, vStart + y};
    const F z = dot(picture(&EmissionPicture::toZ), d), rho = sqrt(x * x + y * y);
    F phi = atan2(y, x);
    phi = select(phi < F(0.f), phi + F(kTwoPi), phi);
    const Mask<F> sphere = map == UInt<F>(std::uint32_t(EmissionPicture::Sphere));
    const Mask<F> cylinder = map == UInt<F>(std::uint32_t(EmissionPicture::Cylinder));
    const F along = select(sphere, atan2(rho, z), select(cylinder, z, rho));
    const F v = (vStart - along) * picture(&EmissionPicture::vPerUnit);
    return {select(flat, uStart + x, phi / picture(&EmissionPicture::phiMax)), select(flat, vStart + y, v)};
}

/// The picture's colour at a point of the surface.
template <class F>
Spectrum<F> pictureAt(const LightTables& tables, const UInt<F>& index, const Vec3<F>& p) {
    const Records<F, EmissionPicture> picture(tables.pictures.data(), index);
    const Vec2<F> st = pictureUv(picture, p);
    const UInt<F> first = picture(&EmissionPicture::firstPixel), columns = picture(&EmissionPicture::width),
                  rows = picture(&EmissionPicture::height);
    // Between which pixels, and how far: centres are at halves.
    const auto place = [](F t, const UInt<F>& n, UInt<F>& low, UInt<F>& high, F& between) {
        const F last = toFloat<F>(n) - F(1.f);
        const F x = clamp(t * toFloat<F>(n) - F(0.5f), F(0.f), last);
        low = toUInt(x);
        high = min(low + UInt<F>(1u), n - UInt<F>(1u));
        between = x - toFloat<F>(low);
    };
    UInt<F> x0, x1, y0, y1;
    F fx, fy;
    place(st.x, columns, x0, x1, fx);
    place(F(1.f) - st.y, rows, y0, y1, fy);
    const auto pixel = [&](const UInt<F>& x, const UInt<F>& y) {
        F c[4];
        loadRows4(tables.numbers.data(), first + (y * columns + x) * UInt<F>(4u), c);
        return Spectrum<F>{c[0], c[1], c[2]};
    };
    const auto mix = [](const Spectrum<F>& a, const Spectrum<F>& b, F t) { return a * (F(1.f) - t) + b * t; };
    return mix(mix(pixel(x0, y0), pixel(x1, y0), fx), mix(pixel(x0, y1), pixel(x1, y1), fx), fy);
}

}  // namespace penumbra
