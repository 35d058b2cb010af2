// ImageInfiniteLight: light from all directions by an image, in the equal-area octahedral map or by latitude and
// longitude; `LightSource "infinite"` with a filename.
//
// The radiance of a direction is that of the nearest pixel (as the pbrt format has it), and a pixel is chosen with
// probability proportional to the mean of its channels times its solid angle, then a direction uniformly in it. A row
// of four floats a pixel (r, g, b, density) answers a look-up by one load. By latitude and longitude, row 0 is at +z,
// and columns go round from +x by +y: what the equal-area map is made of.
//
// Invariants: axisX, axisY, axisZ are the light's axes in the world, orthonormal; a pixel that is not black has a
// density.
#pragma once

#include "core/math/distribution.h"
#include "core/math/equal_area.h"
#include "core/math/matrix.h"
#include "lights/infinite_light.h"
#include "lights/light_image.h"

#include <span>

namespace penumbra {

enum class SkyMap : std::uint32_t { EqualArea, LatLong };

struct ImageInfiniteLight {
    static constexpr const PluginInfo& kInfo = kInfiniteInfo;
    static constexpr bool kInfinite = true;
    static constexpr bool kDelta = false;
    static constexpr std::size_t kMaxResolution = 16384;  ///< the numbers of one image stay below 2^31

    Vec3<float> axisX, axisY, axisZ;
    SkyMap map;
    std::uint32_t width, height, strideX, strideY;
    std::uint32_t pixels;        ///< first of width x height rows of four in LightTables::numbers
    std::uint32_t distribution;  ///< the grid's table there
    float mean;                  ///< over all directions and channels

    /// Appends the image (`rgb`: width x height x 3, top row first) times `scale` to the tables. Negative and
    /// non-finite values count as black. Of the matrix only the rotation (or reflection) is used: its columns are made
    /// orthonormal. Error(BadData) where the image is too large for the tables or the matrix is singular.
    static ImageInfiniteLight make(SkyMap map, std::span<const float> rgb, std::size_t width, std::size_t height,
                                   const Spectrum<float>& scale, const Matrix4& worldFromLight, LightTables& tables);

    float power(const LightTables& tables) const { return infinitePower(mean, tables); }

    std::optional<LightBounds> bounds(const LightTables&) const { return {}; }

    template <class F>
    static LightSample<F> sample(const Records<F, ImageInfiniteLight>& light, const LightTables& tables, const Vec3<F>&,
                                 const Vec2<F>& u) {
        const UInt<F> columns = light(&ImageInfiniteLight::width), rows = light(&ImageInfiniteLight::height);
        const GridCell<F> cell =
            sampleGrid(tables.numbers.data(), light(&ImageInfiniteLight::distribution), columns, rows,
                       light(&ImageInfiniteLight::strideX), light(&ImageInfiniteLight::strideY), u);
        const Mask<F> latLong = isLatLong(light);
        Vec3<F> d = {F(0.f), F(0.f), F(1.f)};
        if (!all(latLong)) {
            d = equalAreaDirection(Vec2<F>{(toFloat<F>(cell.x) + cell.inside.x) * (F(1.f) / toFloat<F>(columns)),
                                           (toFloat<F>(cell.y) + cell.inside.y) * (F(1.f) / toFloat<F>(rows))});
        }
        if (any(latLong)) d = select(latLong, latLongDirection(cell, columns, rows), d);
        const Vec3<F> wi = light(&ImageInfiniteLight::axisX) * d.x + light(&ImageInfiniteLight::axisY) * d.y +
                           light(&ImageInfiniteLight::axisZ) * d.z;
        const LightEval<F> pixel = at(light, tables, cell.x, cell.y);
        return lightSample(pixel.pdf > F(0.f), wi, F(kInfinity), pixel.L, pixel.pdf, Mask<F>(false));
    }

    template <class F>
    static LightEval<F> evaluate(const Records<F, ImageInfiniteLight>& light, const LightTables& tables,
                                 const LightHit<F>& hit) {
        const Vec3<F> d = {dot(light(&ImageInfiniteLight::axisX), hit.wi),
                           dot(light(&ImageInfiniteLight::axisY), hit.wi),
                           dot(light(&ImageInfiniteLight::axisZ), hit.wi)};
        const Mask<F> latLong = isLatLong(light);
        Vec2<F> st = {F(0.f), F(0.f)};
        if (!all(latLong)) st = equalAreaSquare(d);
        if (any(latLong)) {
            const Vec2<F> angles = latLongPlace(d);
            st = {select(latLong, angles.x, st.x), select(latLong, angles.y, st.y)};
        }
        return at(light, tables, nearestPixel(st.x, light(&ImageInfiniteLight::width)),
                  nearestPixel(st.y, light(&ImageInfiniteLight::height)));
    }

    /// Where a unit direction is in an image by latitude and longitude, as fractions of its width and height.
    template <class F>
    static Vec2<F> latLongPlace(const Vec3<F>& d) {
        const F phi = atan2(d.y, d.x) * F(kInvTwoPi);
        return {select(phi < F(0.f), phi + F(1.f), phi), atan2(sqrt(d.x * d.x + d.y * d.y), d.z) * F(kInvPi)};
    }

private:
    /// Of each pixel of a row.
    double solidAngle(std::size_t row) const;
    void fillDensities(std::span<const float> weights, LightTables& tables) const;

    template <class F>
    static Mask<F> isLatLong(const Records<F, ImageInfiniteLight>& light) {
        return light(&ImageInfiniteLight::map) == UInt<F>(std::uint32_t(SkyMap::LatLong));
    }
    /// The point of the cell, uniform in solid angle: the square of the sine of half the angle from the nearer pole is
    /// uniform, and keeps its digits there.
    template <class F>
    static Vec3<F> latLongDirection(const GridCell<F>& cell, const UInt<F>& columns, const UInt<F>& rows) {
        const F perRow = F(kHalfPi) / toFloat<F>(rows);
        const Mask<F> south = !(cell.y + cell.y + UInt<F>(1u) < rows);
        const UInt<F> row = select(south, rows - UInt<F>(1u) - cell.y, cell.y);
        const F inside = select(south, F(1.f) - cell.inside.y, cell.inside.y);
        const F low = sin(toFloat<F>(row) * perRow), high = sin(toFloat<F>(row + UInt<F>(1u)) * perRow);
        const F half2 = lerp(inside, low * low, high * high);
        const F r = F(2.f) * safeSqrt(half2 * (F(1.f) - half2));
        F s, c;
        sinCos((toFloat<F>(cell.x) + cell.inside.x) * (F(kTwoPi) / toFloat<F>(columns)), s, c);
        return {r * c, r * s, flipSign(south, F(1.f) - F(2.f) * half2)};
    }
    template <class F>
    static LightEval<F> at(const Records<F, ImageInfiniteLight>& light, const LightTables& tables, const UInt<F>& x,
                           const UInt<F>& y) {
        F row[4];
        loadRows4(tables.numbers.data(),
                  light(&ImageInfiniteLight::pixels) + (y * light(&ImageInfiniteLight::width) + x) * UInt<F>(4u), row);
        return {{row[0], row[1], row[2]}, row[3]};
    }
};

}  // namespace penumbra
