// FilmSensor: what the film's exposure and white balance do to radiance before it is summed.
//
// Radiance in the film's linear RGB is multiplied by `imagingRatio` and by `matrix`. Then follow the film's own clamp
// (maxcomponentvalue) and filter weight. The matrix adapts (Bradford) from the daylight of `whitebalance` kelvin to the
// white of the film's colour space; it is the exact identity where white balance is off.
// A named camera sensor measures, in this RGB renderer, like cie1931 with its default white balance of 6500 K: its
// fitted matrix aims at just that.
#pragma once

#include "core/base/parameters.h"
#include "core/color/color_space.h"

namespace penumbra {

struct FilmSensor {
    double imagingRatio = 1;  ///< (shutter close - shutter open) * iso / 100; time in the units of the shutter
    Matrix3 matrix;           ///< film RGB from radiance RGB, without the imaging ratio
    bool isIdentity() const { return imagingRatio == 1 && matrix == Matrix3{}; }
};

/// White balance for a scene lit by daylight of that temperature, in the RGB of the space.
Matrix3 whiteBalanceMatrix(double kelvin, const ColorSpace& space);

/// Reads sensor, iso and whitebalance from the film's parameters. An unknown sensor warns, naming the nearest, and
/// counts as cie1931. Throws Error(BadData), with the place in `files`, on values out of range. REQUIRES: shutterOpen <
/// shutterClose.
FilmSensor readFilmSensor(const ParameterSet& film, double shutterOpen, double shutterClose, const ColorSpace& space,
                          std::span<const std::string> files, Warnings& warnings);

}  // namespace penumbra
