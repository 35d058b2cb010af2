// PNG pictures, read without OpenImageIO, which would cost a process far more memory than most of them.
//
// Of every kind and depth, interlaced or not, with palettes and transparency. Profiles, texts, gamma and the like are
// skipped unseen. What comes out: grey stays one channel, its alpha is dropped; a colour or palette with transparency
// gives four channels. Depths up to 8 bits give bytes (fewer bits spread over 0 to 255), 16 bits linear floats.
//
// Hostile input: every chunk's checksum is looked at, sizes are checked before memory is allocated, and a picture whose
// data end early, whose rows have unknown filters or whose pixels are not in the palette is refused. Besides file and
// picture two rows are held.
//
// Source: PNG specification (W3C, third edition), sections 7 to 11.
#pragma once

#include "core/image/file_format.h"
#include "core/image/image.h"

#include <string>

namespace penumbra {

Image readPng(const std::string& path, TransferFunction encoding, const ImageLimits& limits);

}  // namespace penumbra
