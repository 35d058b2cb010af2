#include "core/image/jpeg_essentials.h"

#include "core/image/file_bytes.h"

#include <fmt/format.h>

#include <string_view>

namespace penumbra {
namespace {

/// Whether a marker begins a frame, which has the size of the picture (T.81, table B.1).
bool isFrame(int code) {
    return code >= 0xc0 && code <= 0xcf && code != 0xc4 && code != 0xc8 && code != 0xcc;
}

/// libjpeg keeps the whole of a progressive picture in memory from the start, so its size is checked before.
void checkJpegFrame(const std::string& path, std::string_view segment, std::uint64_t fileBytes,
                    const ImageLimits& limits) {
    constexpr std::size_t kLeast = 10;  // marker, length, precision, height, width, components
    if (segment.size() < kLeast) failImage(path, "the JPEG is damaged: its frame header is too short");
    const std::uint32_t height = bigEndian(segment, 5, 2), width = bigEndian(segment, 7, 2);
    checkImageSize(path, width, height, bigEndian(segment, 9, 1), fileBytes, limits);
}

/// The end of the entropy-coded data that begins at `at`: the next marker that is no restart and no stuffed 0xff.
std::size_t endOfScan(std::string_view bytes, std::size_t at) {
    for (; at + 1 < bytes.size(); ++at) {
        if (bytes[at] != '\xff') continue;
        const int code = static_cast<unsigned char>(bytes[at + 1]);
        const bool isData = code == 0 || code == 0xff || (code >= 0xd0 && code <= 0xd7);
        if (!isData) return at;
    }
    return bytes.size();
}

}  // namespace

std::string jpegEssentials(const std::string& path, const ImageLimits& limits) {
    constexpr int kEnd = 0xd9, kScan = 0xda, kAdobe = 0xee, kFirstApp = 0xe0, kLastApp = 0xef, kComment = 0xfe;
    const std::string whole = readWholeImageFile(path);
    const std::string_view bytes = whole;
    std::string kept(bytes.substr(0, 2));
    for (std::size_t at = 2; at + 2 <= bytes.size();) {
        if (bytes[at] != '\xff') failImage(path, fmt::format("the JPEG is damaged: no marker at byte {}", at));
        const int code = static_cast<unsigned char>(bytes[at + 1]);
        if (code == 0xff) {  // fill
            ++at;
            continue;
        }
        if (code == kEnd) return kept.append("\xff\xd9", 2);
        if (at + 4 > bytes.size()) break;
        const std::size_t next = at + 2 + bigEndian(bytes, at + 2, 2),
                          end = code == kScan ? endOfScan(bytes, next) : next;
        if (next < at + 4 || end > bytes.size()) break;
        if (isFrame(code)) checkJpegFrame(path, bytes.substr(at, end - at), bytes.size(), limits);
        // Of the application segments JFIF and Adobe's say what the colours are.
        const bool isExtra = (code > kFirstApp && code <= kLastApp && code != kAdobe) || code == kComment;
        if (!isExtra) kept += bytes.substr(at, end - at);
        at = end;
    }
    failImage(path, "the JPEG is cut short");
}

}  // namespace penumbra
