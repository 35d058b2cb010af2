// What a rough coat over a Lambertian base lets through: tables made with the material, read by its closure.
//
// A coat is a dielectric interface (GGX) over a gap that absorbs. For a direction w outside,
//   T(w)   the fraction of light from w that arrives at the base for the first time (refracted, attenuated in the gap),
//   R(w)   the fraction that the interface reflects;
// and of the interface as the base sees it
//   rho    the fraction of the base's (diffuse) light that comes back to the base,
//   tau    the fraction that leaves through the interface,
// both attenuated by their ways through the gap. By reciprocity tau = (1 / eta^2) 2 int T(mu) mu dmu.
//
// Layout of a block: rows of kCoatRowFloats floats. A row is {rho, rho, tau, tau}, then kCoatCells cells {T, T', R,
// R'}, the values at both ends of the cell, so that one load of four floats interpolates both functions. The cell's
// coordinate is sqrt(cos theta): near grazing T is linear in the cosine. The rows' coordinate is the square root of
//   alpha(w) = sqrt((ax x)^2 + (ay y)^2) / sqrt(x^2 + y^2),  the roughness that counts in w's plane,
// because that, and not the azimuth, is what T varies smoothly with. A smooth coat has no cells, for T and R have
// closed forms, and one row, {rho, rho, tau, tau}. Errors of T (tests/materials_coat_test.cpp): below 2e-4; where
// anisotropy or a texture moves alpha(w), at most 2e-3 at cosines below 0.1.
//
// Thread safety: pure functions.
#pragma once

#include "materials/microfacet.h"

namespace penumbra {

inline constexpr std::uint32_t kCoatCells = 256;
inline constexpr std::uint32_t kCoatRowFloats = 4 * (kCoatCells + 1);

struct Coat {
    float eta = 1.5f;
    float opticalThickness = 0.01f;  ///< of the gap, for a perpendicular crossing
};

/// The rows of a block: `count` steps of sqrt(alpha(w)) from `first` to `last`; one row where alpha is the same for
/// all.
struct CoatRows {
    float first = 0, last = 0;
    std::uint32_t count = 1;
};

/// Appends the block of a smooth coat.
void appendSmoothCoat(const Coat& coat, std::vector<float>& numbers);
/// Appends the block of a coat of constant roughness: one row, or where it is anisotropic one for every step of
/// alpha(w).
CoatRows constantCoatRows(const Ggx<float>& ggx);
void appendConstantCoat(const Coat& coat, const Ggx<float>& ggx, std::vector<float>& numbers);
/// Appends the block for any isotropic alpha up to 1.
inline constexpr CoatRows kTexturedCoatRows{0.f, 1.f, 65};
void appendTexturedCoat(const Coat& coat, std::vector<float>& numbers);

/// T and R of the top of this file for one direction, by quadrature: what the tables hold.
struct CoatAlbedo {
    double transmitted = 0, reflected = 0;
};
CoatAlbedo roughCoatAlbedo(const Coat& coat, const Ggx<float>& ggx, const Vec3<float>& w);

}  // namespace penumbra
