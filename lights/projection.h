// ProjectionLight: a slide projector without a lens; `LightSource "projection"`.
//
// The intensity of a direction is the nearest pixel of an image on a screen before the light: the axis is +z, the
// image's top is towards +y, its left towards -x, and `fov` spans its shorter side. Nothing goes outside the frame. A
// piece of the screen at distance 1 covers cos^3 times its area in solid angle, so the flux is the screen's area times
// the mean of pixel cos^3.
#pragma once

#include "lights/light_image.h"
#include "lights/placed_light.h"

#include <span>

namespace penumbra {

inline constexpr ParameterInfo kProjectionParameters[] = {
    {"string", "filename", "", "the image"},
    {"float", "fov", "90", "degrees that the shorter side of the image spans"},
    {"float", "scale", "1", "factor on the image"},
    {"float", "power", "0", "where positive, the flux in watts instead of the image's size"},
};

struct ProjectionLight : PlacedLight {
    static constexpr PluginInfo kInfo = {"projection", "light from a point that projects an image",
                                         kProjectionParameters};
    static constexpr bool kInfinite = false;
    static constexpr bool kDelta = true;
    static constexpr float kNearest = 1e-3f;  ///< z of a unit direction that still meets the screen

    float perTangentX, perTangentY;  ///< 1 / twice the screen's half width and height at distance 1
    std::uint32_t width, height;
    std::uint32_t pixels;  ///< first of width x height rows of four (r, g, b, -) in LightTables::numbers
    float flux;            ///< of the mean of the channels

    /// Appends the image (`rgb`: width x height x 3, top row first) times `scale` to the tables. Negative and
    /// non-finite values count as black. 0 < fov < 180. Error(BadData) where the image is too large or the matrix is
    /// singular.
    static ProjectionLight make(const Matrix4& worldFromLight, std::span<const float> rgb, std::size_t width,
                                std::size_t height, double fov, float scale, LightTables& tables);

    float power(const LightTables&) const { return flux; }

    std::optional<LightBounds> bounds(const LightTables&) const;

    template <class F>
    static LightSample<F> sample(const Records<F, ProjectionLight>& light, const LightTables& tables, const Vec3<F>& p,
                                 const Vec2<F>&) {
        return sampleFromPoint(light(&ProjectionLight::position), p, [&](const Vec3<F>& w) {
            const Vec3<F> d = directionInLight(light, w);
            const F perZ = F(1.f) / d.z;
            const F u = F(0.5f) + d.x * perZ * light(&ProjectionLight::perTangentX);
            const F v = F(0.5f) - d.y * perZ * light(&ProjectionLight::perTangentY);
            const Mask<F> inside = (d.z > F(kNearest)) & (u >= F(0.f)) & (u <= F(1.f)) & (v >= F(0.f)) & (v <= F(1.f));
            const UInt<F> columns = light(&ProjectionLight::width), rows = light(&ProjectionLight::height);
            F pixel[4];
            loadRows4(tables.numbers.data(),
                      light(&ProjectionLight::pixels) +
                          (nearestPixel(v, rows) * columns + nearestPixel(u, columns)) * UInt<F>(4u),
                      pixel);
            return select(inside, Spectrum<F>{pixel[0], pixel[1], pixel[2]}, Spectrum<F>::constant(F(0.f)));
        });
    }
};

/// The screen of an image at distance 1: half its width and height, for a fov over the shorter side.
struct ProjectionScreen {
    double halfWidth, halfHeight;
    ProjectionScreen(std::size_t width, std::size_t height, double fov);
    double area() const { return 4 * halfWidth * halfHeight; }
    /// cos^3 of the angle between the axis and the point (u, v) in [0, 1]^2 of the image.
    double cosineCubed(double u, double v) const;
};

}  // namespace penumbra
