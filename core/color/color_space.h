// ColorSpace: the RGB primaries that scene files, films and images name.
//
// Conventions: XYZ are the CIE 1931 2-degree values; a space's white (1, 1, 1) has Y = 1. The four spaces are those of
// the pbrt format: srgb, dci-p3 (with the D65 white of P3 displays), rec2020, aces2065-1. Emitted light goes from one
// space to another through XYZ, without chromatic adaptation: light is light. Reflectances (and coefficients) are
// ratios, so a neutral one must stay neutral: these are adapted from white to white (Bradford).
//
// Thread safety: all immutable; the spaces live as long as the program.
//
// Source: IEC 61966-2-1, SMPTE EG 432-1, ITU-R BT.2020, SMPTE ST 2065-1; Bradford: Lam 1985, as in CIE 160.
#pragma once

#include "core/color/matrix3.h"
#include "core/color/rgb.h"

#include <span>
#include <string>
#include <string_view>

namespace penumbra {

struct Chromaticity {
    double x = 0, y = 0;
};

struct ColorSpace {
    std::string name;  ///< as scene files write it: "srgb", "dci-p3", "rec2020", "aces2065-1"
    Chromaticity red, green, blue, white;
    std::string illuminant;  ///< name of the built-in spectrum of its white: "stdillum-D65", "illum-acesD60"
    Matrix3 xyzFromRgb, rgbFromXyz;

    Rgb fromXyz(const Triple& xyz) const;
    Triple toXyz(Rgb c) const;
    double luminance(Rgb c) const;  ///< Y
};

/// The space of that name, in any case; null where there is none.
const ColorSpace* findColorSpace(std::string_view name);
std::span<const std::string> colorSpaceNames();
const ColorSpace& srgbColorSpace();

/// The known space with these primaries and white, each within 0.002 (files round them); null where there is none.
const ColorSpace* findColorSpace(Chromaticity red, Chromaticity green, Chromaticity blue, Chromaticity white);

/// RGB to XYZ such that each primary has its chromaticity and (1, 1, 1) is the white at Y = 1.
Matrix3 xyzFromPrimaries(Chromaticity red, Chromaticity green, Chromaticity blue, Chromaticity white);

/// Takes light (radiance, pixels) from one space to another; the identity, exactly, where they are the same.
Matrix3 lightConversion(const ColorSpace& from, const ColorSpace& to);
/// Takes reflectances and coefficients from one space to another: white stays (1, 1, 1).
Matrix3 reflectanceConversion(const ColorSpace& from, const ColorSpace& to);

/// Bradford adaptation of XYZ values from one white to another, both of Y = 1.
Matrix3 bradfordAdaptation(Chromaticity from, Chromaticity to);

/// XYZ of Y = 1.
Triple xyzOf(Chromaticity c);
Chromaticity chromaticityOf(const Triple& xyz);

Rgb apply(const Matrix3& m, Rgb c);

}  // namespace penumbra
