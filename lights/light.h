// What a light is to an integrator, over lanes.
//
// Conventions: radiance in the film's linear RGB; wi points from the shading point to the light and is a unit vector;
// densities are per solid angle at the shading point. Both strategies return {L, pdf}, so multiple importance sampling
// is two lines in an integrator that never asks what kind of light it has. The probability of *picking* the light is
// not in `pdf`: the light sampler (light_sampler.h) owns it.
//
// All lanes are computed; where nothing arrives (back side, outside the cone, zero density) `valid` is false, L is
// black and the other fields are harmless (wi = +z, distance 0, pdf 1), so that an integrator's arithmetic stays
// finite.
//
// A light type is a plain struct of 32-bit words (one row of a table, read through Records) with
//   static constexpr PluginInfo kInfo;
//   static constexpr bool kInfinite;   // lives on the sphere of directions: met by rays that leave the scene
//   static constexpr bool kDelta;      // no ray meets it by chance
//   template <class F>
//   static LightSample<F> sample(const Records<F, T>&, const LightTables&, const Vec3<F>& p, const Vec2<F>& u);
//
//   template <class F>   // unless kDelta
//   static LightEval<F> evaluate(const Records<F, T>&, const LightTables&, const LightHit<F>&);
//
//   float power(const LightTables&) const;   // emitted flux, the mean of the channels; for light selection only
//   std::optional<LightBounds> bounds(const LightTables&) const;   // nothing for lights without a place; likewise
// See lights/registry.h.
// Thread safety: immutable once the scene is built.
#pragma once

#include "core/base/plugin.h"
#include "core/math/records.h"
#include "lights/light_bounds.h"

#include <optional>
#include <vector>

namespace penumbra {

template <class F>
struct LightSample {
    Vec3<F> wi;     ///< unit
    F distance;     ///< to the sampled point; kInfinity for infinite and distant lights
    Spectrum<F> L;  ///< radiance arriving; for delta lights the irradiance-like weight (I / d^2, or E), with pdf 1
    F pdf;          ///< per solid angle; 1 for delta lights
    Mask<F> delta;  ///< no ray meets this light by chance: the sample's weight is 1, there is no other strategy
    Mask<F> valid;
};

/// The sample with the fields of lanes that are not valid made harmless.
template <class F>
LightSample<F> lightSample(const Mask<F>& valid, const Vec3<F>& wi, F distance, const Spectrum<F>& L, F pdf,
                           const Mask<F>& delta) {
    return {select(valid, wi, Vec3<F>{F(0.f), F(0.f), F(1.f)}),
            select(valid, distance, F(0.f)),
            select(valid, L, Spectrum<F>::constant(F(0.f))),
            select(valid, pdf, F(1.f)),
            delta,
            valid};
}

template <class F>
LightSample<F> select(const Mask<F>& m, const LightSample<F>& a, const LightSample<F>& b) {
    return {select(m, a.wi, b.wi),   select(m, a.distance, b.distance), select(m, a.L, b.L),
            select(m, a.pdf, b.pdf), select(m, a.delta, b.delta),       select(m, a.valid, b.valid)};
}

/// What a ray that met a light knows. For infinite lights only `wi` matters. A light knows its own orientation, so that
/// both strategies agree on the side that emits.
template <class F>
struct LightHit {
    Vec3<F> from;  ///< the shading point that the ray left
    Vec3<F> p;     ///< the point met
    Vec3<F> wi;    ///< unit direction of the ray (from -> p)
};

template <class F>
struct LightEval {
    Spectrum<F> L;
    F pdf;  ///< density with which sample() would have chosen this direction; 0 where it never would
};

template <class F>
LightEval<F> select(const Mask<F>& m, const LightEval<F>& a, const LightEval<F>& b) {
    return {select(m, a.L, b.L), select(m, a.pdf, b.pdf)};
}

/// Black with density 0 where `valid` is false.
template <class F>
LightEval<F> lightEval(const Mask<F>& valid, const Spectrum<F>& L, F pdf) {
    return {select(valid, L, Spectrum<F>::constant(F(0.f))), select(valid, pdf, F(0.f))};
}

/// How a picture lies on an area light (emission_picture.h). A point goes by an affine map to the picture's own space:
/// x and y are how far u and v have moved from their start (flat shapes), or it is the shape's own with radius 1
/// (disks, cylinders, spheres).
struct EmissionPicture {
    enum Map : std::uint32_t { Flat, Disk, Cylinder, Sphere };

    Map map = Flat;
    Vec3<float> origin{}, toX{}, toY{}, toZ{};  ///< x = toX . (p - origin), and so on
    float uStart = 0, vStart = 0;               ///< flat: u = uStart + x, v = vStart + y
    float phiMax = 1, vPerUnit = 1;             ///< round: u = phi / phiMax, v = (vStart - t) vPerUnit, where t is the
                                                ///< radius on disks, z on cylinders, the angle from +z on
                                                ///< spheres
    std::uint32_t firstPixel = 0, width = 1, height = 1;  ///< rows of four (r, g, b, -) in LightTables::numbers
    float mean = 0;                                       ///< of all pixels and channels
};

/// What lights share: their variable-length data (images and distributions; lights hold offsets), the scene's size, and
/// the way of sampling.
struct LightTables {
    std::vector<float> numbers;
    std::vector<EmissionPicture> pictures;
    Vec3<float> sceneCenter{};  ///< bounding sphere of the scene
    float sceneRadius = 1.f;
    bool classicArea = false;  ///< --light-sampling area: uniform points on every area light
};

}  // namespace penumbra
