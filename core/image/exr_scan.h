// A look at the headers of an EXR file before OpenEXR sees it.
//
// OpenEXR allocates what a header claims (offset tables, tile buffers, attributes), so 3 KB of hostile bytes can cost
// gigabytes. This walks the headers with nothing allocated and refuses what the file cannot hold.
// Source: the OpenEXR file layout (openexr.com, "OpenEXR File Layout").
#pragma once

#include "core/image/file_format.h"

#include <string>

namespace penumbra {

/// Throws Error(BadData) where a header is damaged or claims too much. REQUIRES: the file begins with the EXR magic.
void checkExrHeaders(const std::string& path, std::uint64_t fileBytes, const ImageLimits& limits);

}  // namespace penumbra
