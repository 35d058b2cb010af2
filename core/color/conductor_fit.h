// RGB conductors from spectral ones: per channel, the (eta, k) whose Fresnel reflectance curve is nearest to the colour
// of the spectral curve.
//
// Averaging eta and k over wavelengths gives wrong colours, because reflectance is far from linear in them (copper's
// red would lose several percent). So the reflectance itself is averaged: for each angle the colour of F(lambda, angle)
// under the white of the space, clamped to [0, 1]; then eta and k are fitted to that curve by least squares over
// angles. For the built-in metals the fitted curve stays within 0.002 of the target, but for channels whose colour lies
// outside the space (gold's red 0.01, copper's and brass's red 0.005).
#pragma once

#include "core/color/spectrum.h"

namespace penumbra {

/// The complex index of a conductor, one value per channel.
struct ConductorIndex {
    Rgb eta, k;
};

/// Unpolarised Fresnel reflectance at the border of vacuum and a conductor of index eta + i k (Born & Wolf, 14.2).
/// Where both are 0 (a spectrum outside the range of its file) there is no reflection.
double conductorFresnel(double cosTheta, double eta, double k);

ConductorIndex fitConductor(const SampledSpectrum& eta, const SampledSpectrum& k, const ColorSpace& space);

}  // namespace penumbra
