// SampledSpectrum: what scene files give as a spectrum, tabulated every nanometre, and its colour.
//
// Conventions: wavelengths in nm, 360 to 830 inclusive. Sums over wavelengths are plain sums of the 1 nm samples, as
// the pbrt format defines them: the constant 1 has Y = kYbarSum. Spectra given in a file or as numbers are zero outside
// their range; built-in tables are held constant beyond their measured ends.
//
// Thread safety: all immutable after construction; built-in spectra live as long as the program.
//
// Source: CIE 1931 2-degree observer (ISO/CIE 11664-1); illuminants CIE 015; the origin of each table is in data/.
#pragma once

#include "core/color/color_space.h"

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace penumbra {

inline constexpr int kFirstWavelength = 360, kLastWavelength = 830;
inline constexpr int kWavelengthCount = kLastWavelength - kFirstWavelength + 1;
/// The format's constant for the sum of ybar; the illuminant behind an rgb light is scaled to it.
inline constexpr double kYbarSum = 106.856895;

struct SampledSpectrum {
    std::array<double, kWavelengthCount> values{};
    double at(int nanometres) const { return values[nanometres - kFirstWavelength]; }
};

SampledSpectrum constantSpectrum(double value);

/// Planck's law, scaled so that its peak over all wavelengths (Wien) is 1. REQUIRES: kelvin > 0.
SampledSpectrum blackbodySpectrum(double kelvin);

/// CIE daylight of that correlated colour temperature, blackbody below 4000 K; relative power.
/// The temperature is that of the redefined scale (c2 = 1.4388e-2 m K), so that 6500 means D65.
SampledSpectrum daylightSpectrum(double kelvin);

/// Linear between (wavelength, value) pairs, zero outside. Throws Error(BadData), the message beginning with `what`,
/// unless the numbers are finite, in pairs, at least one, with strictly rising wavelengths above 0.
SampledSpectrum piecewiseLinearSpectrum(std::span<const float> pairs, std::string_view what);

/// A text file of such pairs: white space or commas between numbers, # comments. Throws Error(MissingInput) or
/// Error(BadData) with the path, line and column.
SampledSpectrum readSpectrumFile(const std::string& path);

/// metal-*-eta, metal-*-k, glass-*, stdillum-*, illum-acesD60 (exact case); null where there is none.
const SampledSpectrum* findBuiltinSpectrum(std::string_view name);
std::span<const std::string> builtinSpectrumNames();

/// Colour matching functions xbar, ybar, zbar at a sample index (0 is 360 nm).
Triple colorMatching(int index);

/// Sums of (xbar, ybar, zbar) times S.
Triple xyzSum(const SampledSpectrum& spectrum);

/// The spectrum as a light: its chromaticity at luminance 1; the magnitude is lost, as the format wants. Throws
/// Error(BadData), the message beginning with `what`, where it emits nothing visible.
Rgb illuminantToRgb(const SampledSpectrum& spectrum, const ColorSpace& space, std::string_view what);

/// The spectrum as a reflectance or coefficient, seen under the white of the space: the constant v gives (v, v, v).
/// Neither clamped nor inside the gamut by itself.
Rgb reflectanceToRgb(const SampledSpectrum& spectrum, const ColorSpace& space);

/// Row c holds, per wavelength, the weight of that wavelength in channel c under the white of the space; rows sum to 1.
/// reflectanceToRgb is the product of these weights with the spectrum.
struct ChannelWeights {
    std::array<std::array<double, kWavelengthCount>, 3> rows;
};
const ChannelWeights& channelWeights(const ColorSpace& space);

}  // namespace penumbra
