// What the lights that shine from a point (point, spot, goniometric, projection) have in common: the way from the point
// to what it lights, and from the world's directions to the light's own.
#pragma once

#include "core/math/matrix.h"
#include "lights/light.h"

namespace penumbra {

/// A light that has a place and directions of its own. Invariant: the rows are those of the inverse of the light's
/// linear map, up to a positive factor.
struct PlacedLight {
    Vec3<float> position;
    Vec3<float> toLightX, toLightY, toLightZ;

    /// At the point `at` of the light's space. Error(BadData) where the matrix is singular.
    void place(const Matrix4& worldFromLight, Vec3d at);

    /// Of a light that shines, with all its intensity up to the inner angle (radians), within the outer one round
    /// `axis` (a unit vector of the light's space). Where the matrix stretches, of one that shines in all directions.
    LightBounds coneBounds(const Vec3<float>& axis, double inner, double outer, double intensity) const;
};

/// The unit direction w of the world, in the light's space and again of unit length.
template <class F, class T>
Vec3<F> directionInLight(const Records<F, T>& light, const Vec3<F>& w) {
    return normalize(Vec3<F>{dot(light(&T::toLightX), w), dot(light(&T::toLightY), w), dot(light(&T::toLightZ), w)});
}

/// The sample of a light at `position` whose intensity towards the unit direction w is `intensity(w)`. (At the point
/// itself w is not a number, and the sample not valid.)
template <class F, class Intensity>
LightSample<F> sampleFromPoint(const Vec3<F>& position, const Vec3<F>& p, Intensity&& intensity) {
    const Vec3<F> d = position - p;
    const F distance = length(d), inverse = F(1.f) / distance;
    const Vec3<F> wi = d * inverse;
    const Spectrum<F> L = intensity(-wi) * (inverse * inverse);
    const Mask<F> valid = isFinite(inverse * inverse) & isFinite(distance) & !isBlack(L);
    return lightSample(valid, wi, distance, L, F(1.f), Mask<F>(true));
}

}  // namespace penumbra
