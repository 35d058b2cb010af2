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
// Blocks are laid out as roughness_table.h has it: rho and tau are a row's averages, T and R its functions. A smooth coat has
// no cells, for T and R have closed forms, and one row, {rho, rho, tau, tau}. Errors of T (tests/materials_coat_test.cpp):
// below 2e-4; where anisotropy or a texture moves alpha(w), at most 2e-3 at cosines below 0.1.
//
// Thread safety: pure functions.
#pragma once

#include "materials/roughness_table.h"

namespace penumbra {

struct Coat {
    float eta = 1.5f;
    float opticalThickness = 0.01f;  ///< of the gap, for a perpendicular crossing
};

/// Appends the block of a smooth coat.
void appendSmoothCoat(const Coat& coat, std::vector<float>& numbers);
/// Appends the block of a coat of constant roughness: one row, or where it is anisotropic one for every step of
/// alpha(w).
void appendConstantCoat(const Coat& coat, const Ggx<float>& ggx, std::vector<float>& numbers);
/// Appends the block for any isotropic alpha up to 1.
void appendTexturedCoat(const Coat& coat, std::vector<float>& numbers);

/// T and R of the top of this file for one direction, by quadrature: what the tables hold.
struct CoatAlbedo {
    double transmitted = 0, reflected = 0;
};
CoatAlbedo roughCoatAlbedo(const Coat& coat, const Ggx<float>& ggx, const Vec3<float>& w);

}  // namespace penumbra
