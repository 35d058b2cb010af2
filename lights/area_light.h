// What the diffuse area lights (rectangle, triangle, sphere, disk: one file per shape) have in common.
//
// In a scene file they are one plug-in, `AreaLightSource "diffuse"`, put on a shape: it emits the same radiance from
// every point in every direction, on the side of the shape's geometric normal, or on both sides where it is two-sided.
//
// Sampling. By default a shape is sampled by the solid angle that it subtends, so that every sample weighs the same and
// the 1 / d^2 of near lights is gone. `--light-sampling area` (LightTables::classicArea) is the estimator of the
// textbooks instead: a point q uniform on the surface, its density 1 / A per area converted to solid angle by
// d^2 / cos(at the light), so
//     f(wo, wi) L V(p, q) cos(at the surface) cos(at the light) / d^2 * A.
// Both have the same expectation; the second varies more, without bound as the point nears the light.
#pragma once

#include "lights/emission_picture.h"

namespace penumbra {

inline constexpr ParameterInfo kDiffuseAreaParameters[] = {
    {"spectrum", "L", "white", "emitted radiance"},
    {"float", "scale", "1", "factor on L"},
    {"float", "power", "0", "where positive, the flux in watts that each primitive emits"},
    {"bool", "twosided", "false", "emit on both sides"},
    {"string", "filename", "", "image of the emission over the surface's uv, instead of L"},
};
inline constexpr PluginInfo kDiffuseAreaInfo = {
    "diffuse", "area light on a shape: constant radiance, or that of an image, on the normal's side",
    kDiffuseAreaParameters};

// Flags of an area light.
/// Emits on both sides.
inline constexpr std::uint32_t kLightTwoSided = 1;
/// Quadrics only: the outside is where the object-space normal does not point.
inline constexpr std::uint32_t kLightReversed = 2;
/// Rays pass through the shape (alpha 0), so that only sampling finds the light.
inline constexpr std::uint32_t kLightUnmet = 4;
/// The shape has holes, through which its far side can be seen.
inline constexpr std::uint32_t kLightPierced = 8;
/// Its radiance is multiplied by a picture: row `picture` of LightTables::pictures.
inline constexpr std::uint32_t kLightPictured = 16;

template <class F>
Mask<F> hasFlag(UInt<F> flags, std::uint32_t flag) {
    return (flags & UInt<F>(flag)) != UInt<F>(0u);
}

/// The radiance of an area light, the mean over its surface and channels.
template <class Light>
float meanRadiance(const Light& light, const LightTables& tables) {
    const float picture = light.flags & kLightPictured ? tables.pictures[light.picture].mean : 1.f;
    return average(light.radiance) * picture;
}

/// Flux of a surface of that area.
template <class Light>
float diffusePower(const Light& light, const LightTables& tables, float area) {
    return kPi * meanRadiance(light, tables) * area * ((light.flags & kLightTwoSided) ? 2.f : 1.f);
}

/// Of a flat surface with these corners.
template <class Light>
LightBounds diffuseBounds(std::initializer_list<Vec3<float>> corners, const Light& light, const LightTables& tables,
                          float area) {
    return LightBounds::ofFlat(corners, light.normal, double(meanRadiance(light, tables)) * area,
                               light.flags & kLightTwoSided);
}

/// The radiance that leaves the point p of the surface.
template <class F, class Light>
Spectrum<F> emittedRadiance(const Records<F, Light>& light, const LightTables& tables, const UInt<F>& flags,
                            const Vec3<F>& p) {
    const Spectrum<F> radiance = light(&Light::radiance);
    const Mask<F> pictured = hasFlag<F>(flags, kLightPictured);
    if (none(pictured)) return radiance;
    const UInt<F> picture = select(pictured, light(&Light::picture), UInt<F>(0u));
    return select(pictured, radiance * pictureAt(tables, picture, p), radiance);
}

/// Whether a flat light shines on a point. `z` is the light's offset from the point along the normal, negative in
/// front.
template <class F>
Mask<F> emitsTowards(F z, UInt<F> flags) {
    return (z < F(0.f)) | (hasFlag<F>(flags, kLightTwoSided) & (z > F(0.f)));
}

/// The plane that two edges span: computed in double, because corners far from the origin leave few digits to the
/// edges.
struct SpannedPlane {
    Vec3<float> normal;  ///< unit, on the side of `facing`
    float area;          ///< of the parallelogram
};
SpannedPlane spannedPlane(const Vec3<float>& edgeX, const Vec3<float>& edgeY, const Vec3<float>& facing);

/// Below this solid angle a planar light is sampled by area: it looks much the same size from everywhere on it, so
/// sampling by solid angle gains less than it costs (measured: at 0.15 a box lit by one lamp renders 3 % faster with no
/// more variance); and far below it single precision would no longer resolve positions inside it.
inline constexpr float kSmallestSolidAngle = 0.15f;

}  // namespace penumbra
