// What kind of image a file holds, by its first bytes, and how large a claim of its header is believed.
#pragma once

#include "core/base/error.h"

#include <cstdint>
#include <new>
#include <string>

namespace penumbra {

enum class ImageFormat { Exr, Png, Jpeg, Hdr, Tiff, Pfm, Tga };

struct ImageFileInfo {
    ImageFormat format;
    std::uint64_t bytes = 0;  ///< of the file
};

/// Throws Error(MissingInput) where the path is no regular file that can be opened, Error(BadData) where its first
/// bytes are of no known format. TGA, which has no magic, is believed by its extension and a valid header.
ImageFileInfo identifyImageFile(const std::string& path);

struct ImageLimits {
    std::uint64_t pixels = std::uint64_t(16384) * 16384;
    std::uint64_t bytes = std::uint64_t(1) << 30;  ///< of the decoded image
};

/// The most that a byte of a compressed file can decode to: deflate's 1032, a little more than which no format's own
/// coding reaches either.
inline constexpr double kMostExpansion = 1100;

/// Throws Error(BadData) where a header's claim is not plausible: a side below 1 or beyond a million, more than the
/// limits, or more than a file of `fileBytes` could hold (with 64 MiB for nothing, as small pictures may be compressed
/// by any factor).
void checkImageSize(const std::string& path, std::int64_t width, std::int64_t height, std::uint64_t bytesPerPixel,
                    std::uint64_t fileBytes, const ImageLimits& limits, double mostExpansion = kMostExpansion);

/// Throws Error of that kind whose message begins with the path.
[[noreturn]] void failImage(const std::string& path, const std::string& reason, ErrorKind kind = ErrorKind::BadData);

/// Runs `work`; what a library throws becomes an Error of that kind (OutOfMemory where memory ran out).
template <class Work>
auto guardImage(const std::string& path, ErrorKind kind, const Work& work) {
    try {
        return work();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        failImage(path, "not enough memory for the image", ErrorKind::OutOfMemory);
    } catch (const std::exception& e) {
        failImage(path, e.what(), kind);
    }
}

/// The extension in lower case without its dot; empty where there is none.
std::string extensionOf(const std::string& path);

}  // namespace penumbra
