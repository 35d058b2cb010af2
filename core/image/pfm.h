// Portable float maps: linear RGB or grey, 32-bit floats, bottom row first.
//
// Source: Debevec's description of the format. The sign of the scale gives the byte order (negative: little-endian),
// its size multiplies the values.
#pragma once

#include "core/image/file_format.h"
#include "core/image/image.h"

#include <span>
#include <string>

namespace penumbra {

Image readPfm(const std::string& path, std::uint64_t fileBytes, const ImageLimits& limits);

/// The whole file for interleaved RGB.
std::string encodePfm(int width, int height, std::span<const float> rgb);

}  // namespace penumbra
