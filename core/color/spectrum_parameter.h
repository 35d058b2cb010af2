// From the ways a scene file gives a spectrum (rgb, blackbody, spectrum) to linear RGB in the film's colour space.
//
// What the numbers become depends on the role that the consumer gives them:
//
// - Albedo (reflectance, transmittance): values in [0, 1]. An rgb outside is an error, a spectrum's colour is clamped.
// - Unbounded (eta, k, sigma_a, sigma_s, mean free paths): values >= 0.
// - Illuminant (L, I, Le): rgb is the radiance itself; a blackbody or spectrum gives only its colour, at luminance 1.
//
// An rgb written under another ColorSpace than the film's is converted, as light or as a reflectance (color_space.h).
//
// Errors: every failure is an Error that begins with the parameter's file:line:column. A spectrum with negative values
// warns and counts as zero there.
//
// Thread safety: pure functions but for the warnings of the context.
#pragma once

#include "core/base/parameters.h"
#include "core/color/conductor_fit.h"
#include "core/color/spectrum.h"

#include <functional>

namespace penumbra {

enum class SpectrumRole { Albedo, Unbounded, Illuminant };

/// What is needed to read a spectrum parameter of a scene. Refers to things that must outlive it.
struct SpectrumContext {
    const ColorSpace& film;
    std::span<const std::string> files;                          ///< the file names that source positions index
    std::function<std::string(const std::string&)> resolvePath;  ///< where a spectrum file of the scene lies
    Warnings& warnings;
};

/// REQUIRES: p.type is rgb, blackbody or spectrum (any other type is reported as an error of the file).
/// `owner` says whose parameter it is in messages: "material 'wall'".
Rgb readSpectrumParameter(const Parameter& p, SpectrumRole role, const SpectrumContext& context,
                          std::string_view owner);

/// The index of refraction of a dielectric given as float, rgb or spectrum: the number; the mean of the three; the mean
/// of the curve weighted by ybar times D65. No dispersion. 0 counts as 1, as the format has it.
float readIndexOfRefraction(const Parameter& p, const SpectrumContext& context, std::string_view owner);

/// From the parameters eta and k, each null where absent (then copper's). Two rgb values are taken as they are. Two
/// spectra become the three (eta, k) whose Fresnel curves come nearest to the colour of the spectral curve at every
/// angle (conductor_fit.h). A mixture takes the spectrum's mean per channel.
ConductorIndex readConductorIndex(const Parameter* eta, const Parameter* k, const SpectrumContext& context,
                                  std::string_view owner);

}  // namespace penumbra
