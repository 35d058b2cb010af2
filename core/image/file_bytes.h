// The bytes of an image file, for readers that parse them.
#pragma once

#include "core/image/file_format.h"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace penumbra {

/// The whole file. Throws Error(MissingInput) where it cannot be read.
inline std::string readWholeImageFile(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (!in.good() && !in.eof()) failImage(path, "cannot be read", ErrorKind::MissingInput);
    return bytes;
}

/// The big-endian number of `count` bytes. REQUIRES: they are there.
inline std::uint32_t bigEndian(std::string_view bytes, std::size_t at, int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

}  // namespace penumbra
