// ImageInfiniteLight: light from all directions by an image in the equal-area octahedral map; `LightSource "infinite"`
// with a filename.
//
// The radiance of a direction is that of the nearest pixel (as the pbrt format has it), and a pixel is chosen with
// probability proportional to the mean of its channels, then a direction uniformly in it. All pixels cover the same
// solid angle, so there is no sine of a latitude. A row of four floats a pixel (r, g, b, density) answers a look-up by
// one load.
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

struct ImageInfiniteLight {
    static constexpr const PluginInfo& kInfo = kInfiniteInfo;
    static constexpr bool kInfinite = true;
    static constexpr bool kDelta = false;
    static constexpr std::size_t kMaxResolution = 16384;  ///< the numbers of one image stay below 2^31

    Vec3<float> axisX, axisY, axisZ;
    std::uint32_t resolution, stride;
    std::uint32_t pixels;        ///< first of resolution^2 rows of four in LightTables::numbers
    std::uint32_t distribution;  ///< the grid's table there
    float mean;                  ///< of all pixels and channels

    /// Appends the image (`rgb`: resolution^2 x 3, top row first) times `scale` to the tables. Negative and non-finite
    /// values count as black. Of the matrix only the rotation (or reflection) is used: its columns are made
    /// orthonormal. Error(BadData) where the image is too large for the tables or the matrix is singular.
    static ImageInfiniteLight make(std::span<const float> rgb, std::size_t resolution, const Spectrum<float>& scale,
                                   const Matrix4& worldFromLight, LightTables& tables);

    float power(const LightTables& tables) const { return infinitePower(mean, tables); }

    std::optional<LightBounds> bounds(const LightTables&) const { return {}; }

    template <class F>
    static LightSample<F> sample(const Records<F, ImageInfiniteLight>& light, const LightTables& tables, const Vec3<F>&,
                                 const Vec2<F>& u) {
        const UInt<F> n = light(&ImageInfiniteLight::resolution), stride = light(&ImageInfiniteLight::stride);
        const GridCell<F> cell =
            sampleGrid(tables.numbers.data(), light(&ImageInfiniteLight::distribution), n, n, stride, stride, u);
        const F pixelSize = F(1.f) / toFloat<F>(n);
        const Vec2<F> st = {(toFloat<F>(cell.x) + cell.inside.x) * pixelSize,
                            (toFloat<F>(cell.y) + cell.inside.y) * pixelSize};
        const Vec3<F> d = equalAreaDirection(st);
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
        const Vec2<F> st = equalAreaSquare(d);
        const UInt<F> n = light(&ImageInfiniteLight::resolution);
        return at(light, tables, nearestPixel(st.x, n), nearestPixel(st.y, n));
    }

private:
    void fillDensities(std::span<const float> weights, LightTables& tables) const;

    template <class F>
    static LightEval<F> at(const Records<F, ImageInfiniteLight>& light, const LightTables& tables, const UInt<F>& x,
                           const UInt<F>& y) {
        F row[4];
        loadRows4(tables.numbers.data(),
                  light(&ImageInfiniteLight::pixels) + (y * light(&ImageInfiniteLight::resolution) + x) * UInt<F>(4u),
                  row);
        return {{row[0], row[1], row[2]}, row[3]};
    }
};

}  // namespace penumbra
