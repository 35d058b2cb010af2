// PNG pictures, read by libpng itself: OpenImageIO would cost a process far more memory than most of them.
//
// Of every kind and depth, interlaced or not, with palettes and transparency. Profiles, texts, gamma and the like are
// skipped unseen. What comes out: grey stays one channel, its alpha is dropped; a colour or palette with transparency
// gives four channels. Depths up to 8 bits give bytes (fewer bits spread over 0 to 255), 16 bits linear floats.
//
// Hostile input: sizes are checked before memory is allocated, every chunk's checksum counts, and a file that ends early
// is refused. What is wrong only in the packed data is up to libpng, which says so or makes do.
#pragma once

#include "core/image/file_format.h"
#include "core/image/image.h"

#include <string>

namespace penumbra {

Image readPng(const std::string& path, TransferFunction encoding, const ImageLimits& limits);

}  // namespace penumbra
