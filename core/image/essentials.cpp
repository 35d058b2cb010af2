#include "core/image/essentials.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <iterator>
#include <string_view>

namespace penumbra {
namespace {

std::string readWhole(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (!in.good() && !in.eof()) failImage(path, "cannot be read", ErrorKind::MissingInput);
    return bytes;
}

/// The big-endian number of `count` bytes. REQUIRES: they are there.
std::uint32_t bigEndian(std::string_view bytes, std::size_t at, int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

/// The checksum of PNG chunks (PNG specification, annex D).
std::uint32_t checksum(std::string_view bytes) {
    static const std::array<std::uint32_t, 256> table = [] {
        std::array<std::uint32_t, 256> t;
        for (std::uint32_t n = 0; n < 256; ++n) {
            t[n] = n;
            for (int bit = 0; bit < 8; ++bit)
                t[n] = t[n] & 1 ? 0xedb88320u ^ t[n] >> 1 : t[n] >> 1;
        }
        return t;
    }();
    std::uint32_t sum = ~0u;
    for (const char c : bytes)
        sum = table[(sum ^ static_cast<unsigned char>(c)) & 0xff] ^ sum >> 8;
    return ~sum;
}

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

/// The values that the specification allows in a header (section 11.2.2), and a size within the limits.
void checkPngHeader(const std::string& path, std::string_view chunk, std::uint64_t fileBytes,
                    const ImageLimits& limits) {
    constexpr std::size_t kHeaderBytes = 13;
    const std::string_view data = chunk.substr(8, chunk.size() - 12);
    if (chunk.substr(4, 4) != "IHDR" || data.size() != kHeaderBytes) failImage(path, "the PNG has no header");
    checkImageSize(path, bigEndian(data, 0, 4), bigEndian(data, 4, 4), 1, fileBytes, limits);
    const int bits = data[8], kind = data[9];
    const bool isRight = kind == 0   ? bits == 1 || bits == 2 || bits == 4 || bits == 8 || bits == 16
                         : kind == 3 ? bits == 1 || bits == 2 || bits == 4 || bits == 8
                                     : (kind == 2 || kind == 4 || kind == 6) && (bits == 8 || bits == 16);
    if (!isRight || data[10] != 0 || data[11] != 0 || (data[12] & ~1) != 0)
        failImage(path, "the header of the PNG is damaged");
}

}  // namespace

std::string pngEssentials(const std::string& path, const ImageLimits& limits) {
    constexpr std::size_t kSignature = 8, kAround = 12;  // of a chunk: length, type, checksum
    const std::string whole = readWhole(path);
    const std::string_view bytes = whole;
    std::string kept(bytes.substr(0, kSignature));
    for (std::size_t at = kSignature; at + kAround <= bytes.size();) {
        const std::uint64_t size = kAround + std::uint64_t(bigEndian(bytes, at, 4));
        if (size > bytes.size() - at) break;
        const std::string_view chunk = bytes.substr(at, size), type = chunk.substr(4, 4);
        if (checksum(chunk.substr(4, size - 8)) != bigEndian(chunk, size - 4, 4))
            failImage(path, fmt::format("the PNG is damaged: wrong checksum of the chunk at byte {}", at));
        if (at == kSignature) checkPngHeader(path, chunk, bytes.size(), limits);
        if (type == "IHDR" || type == "PLTE" || type == "tRNS" || type == "IDAT" || type == "IEND") kept += chunk;
        if (type == "IEND") return kept;
        at += size;
    }
    failImage(path, "the PNG is cut short");
}

std::string jpegEssentials(const std::string& path, const ImageLimits& limits) {
    constexpr int kEnd = 0xd9, kScan = 0xda, kAdobe = 0xee, kFirstApp = 0xe0, kLastApp = 0xef, kComment = 0xfe;
    const std::string whole = readWhole(path);
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
