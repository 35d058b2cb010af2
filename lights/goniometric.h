// GoniometricLight: a point light whose intensity depends on the direction by an image, as lamp makers measure it;
// `LightSource "goniometric"`.
//
// The image is one number a pixel in the equal-area octahedral map with y and z swapped: the light's +y is its centre.
// All pixels cover the same solid angle, so the flux is 4 pi times their mean.
#pragma once

#include "core/math/equal_area.h"
#include "lights/light_image.h"
#include "lights/placed_light.h"

#include <span>

namespace penumbra {

inline constexpr ParameterInfo kGoniometricParameters[] = {
    {"spectrum", "I", "white", "radiant intensity where the image is 1"},
    {"string", "filename", "", "square image in the equal-area octahedral map, light-space +y in its centre"},
    {"float", "scale", "1", "factor on I"},
    {"float", "power", "0", "where positive, the flux in watts instead of I's size"},
};

struct GoniometricLight : PlacedLight {
    static constexpr PluginInfo kInfo = {"goniometric", "light from a point, its intensity from an image of directions",
                                         kGoniometricParameters};
    static constexpr bool kInfinite = false;
    static constexpr bool kDelta = true;

    std::uint32_t resolution;
    std::uint32_t pixels;  ///< first of resolution^2 numbers in LightTables::numbers
    float mean;            ///< of all pixels
    Spectrum<float> intensity;

    /// Appends the image (resolution^2 numbers, top row first) to the tables. Negative and non-finite values count as
    /// 0. Error(BadData) where the image is too large or the matrix is singular.
    static GoniometricLight make(const Matrix4& worldFromLight, std::span<const float> image, std::size_t resolution,
                                 const Spectrum<float>& intensity, LightTables& tables);

    float power(const LightTables&) const { return 4.f * kPi * mean * average(intensity); }

    std::optional<LightBounds> bounds(const LightTables&) const {
        return LightBounds::ofPoint(position, mean * average(intensity));
    }

    template <class F>
    static LightSample<F> sample(const Records<F, GoniometricLight>& light, const LightTables& tables, const Vec3<F>& p,
                                 const Vec2<F>&) {
        return sampleFromPoint(light(&GoniometricLight::position), p, [&](const Vec3<F>& w) {
            const Vec3<F> d = directionInLight(light, w);
            const Vec2<F> st = equalAreaSquare(Vec3<F>{d.x, d.z, d.y});
            const UInt<F> n = light(&GoniometricLight::resolution);
            const UInt<F> pixel = nearestPixel(st.y, n) * n + nearestPixel(st.x, n);
            return light(&GoniometricLight::intensity) *
                   gather(tables.numbers.data(), light(&GoniometricLight::pixels) + pixel);
        });
    }
};

}  // namespace penumbra
