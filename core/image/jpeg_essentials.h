// What of a JPEG file its picture needs, checked for wholeness, before a decoder sees it.
//
// Decoders print their warnings, fill what is missing with grey and unpack whatever a file carries along (profiles,
// texts, thumbnails, which may be bombs of their own). None of that is wanted here, and none of it is passed on.
//
// Source: ITU-T T.81, annex B.
#pragma once

#include "core/image/file_format.h"

#include <string>

namespace penumbra {

/// The JPEG without its profiles, thumbnails and comments. Throws Error(BadData) where it ends before its end marker.
std::string jpegEssentials(const std::string& path, const ImageLimits& limits);

}  // namespace penumbra
