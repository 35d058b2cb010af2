// What of a PNG or JPEG file its picture needs, checked for wholeness, before a decoder sees it.
//
// Decoders print their warnings, fill what is missing with grey and unpack whatever a file carries along (profiles,
// texts, thumbnails, which may be bombs of their own). None of that is wanted here, and none of it is passed on. What
// is left: libpng says a line on stderr, besides its error, of picture data that do not inflate although their checksum
// is right.
//
// Source: PNG specification (W3C), sections 5 and 11; ITU-T T.81, annex B.
#pragma once

#include "core/image/file_format.h"

#include <string>

namespace penumbra {

/// The PNG with only its header, palette, transparency and picture data. Throws Error(BadData) where a chunk is cut
/// short, its checksum is wrong, the end is missing, or the header is not one of the specification's.
std::string pngEssentials(const std::string& path, const ImageLimits& limits);

/// The JPEG without its profiles, thumbnails and comments. Throws Error(BadData) where it ends before its end marker.
std::string jpegEssentials(const std::string& path, const ImageLimits& limits);

}  // namespace penumbra
