#include "core/image/file_format.h"

#include "core/base/text.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace penumbra {
namespace {

constexpr std::size_t kHeadBytes = 18;  // a TGA header, the longest that is looked at

struct Magic {
    std::string_view bytes;
    ImageFormat format;
};
using namespace std::string_view_literals;
constexpr std::array kMagics{
    Magic{"\x76\x2f\x31\x01"sv, ImageFormat::Exr},
    Magic{"\x89PNG\r\n\x1a\n"sv, ImageFormat::Png},
    Magic{"\xff\xd8\xff"sv, ImageFormat::Jpeg},
    Magic{"#?RADIANCE"sv, ImageFormat::Hdr},
    Magic{"#?RGBE"sv, ImageFormat::Hdr},
    Magic{"II*\0"sv, ImageFormat::Tiff},
    Magic{"MM\0*"sv, ImageFormat::Tiff},
    Magic{"II+\0"sv, ImageFormat::Tiff},
    Magic{"MM\0+"sv, ImageFormat::Tiff},
    Magic{"PF\n"sv, ImageFormat::Pfm},
    Magic{"PF\r"sv, ImageFormat::Pfm},
    Magic{"PF "sv, ImageFormat::Pfm},
    Magic{"Pf\n"sv, ImageFormat::Pfm},
    Magic{"Pf\r"sv, ImageFormat::Pfm},
    Magic{"Pf "sv, ImageFormat::Pfm},
};

/// Truevision TGA 2.0, section "TGA file header": the fields whose values are confined.
bool isTgaHeader(std::string_view head) {
    if (head.size() < kHeadBytes) return false;
    const auto byte = [&](int i) { return static_cast<unsigned char>(head[i]); };
    const int mapType = byte(1), type = byte(2), mapBits = byte(7), bits = byte(16);
    const int width = byte(12) | byte(13) << 8, height = byte(14) | byte(15) << 8;
    const int kind = type & 7;  // 1 palette, 2 colour, 3 grey; bit 3: run-length coded
    const bool mapIsRight =
        kind == 1 ? mapType == 1 && (mapBits == 15 || mapBits == 16 || mapBits == 24 || mapBits == 32) : mapType <= 1;
    const bool bitsAreRight =
        kind == 2 ? bits == 15 || bits == 16 || bits == 24 || bits == 32 : bits == 8 || bits == 16;
    return kind >= 1 && kind <= 3 && (type & ~0xb) == 0 && mapIsRight && bitsAreRight && width > 0 && height > 0;
}

}  // namespace

void failImage(const std::string& path, const std::string& reason, ErrorKind kind) {
    throw Error(kind, pathText(path) + ": " + reason);
}

std::string extensionOf(const std::string& path) {
    const std::string name = path.substr(path.find_last_of('/') + 1);
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos || dot == 0 ? "" : lowerCase(name.substr(dot + 1));
}

ImageFileInfo identifyImageFile(const std::string& path) {
    std::error_code status;
    if (path.find('\0') != std::string::npos || !std::filesystem::is_regular_file(path, status))
        failImage(path, "cannot be opened: " + (status ? status.message() : "it is no regular file"),
                  ErrorKind::MissingInput);
    std::ifstream in(path, std::ios::binary);
    if (!in) failImage(path, fmt::format("cannot be opened: {}", std::strerror(errno)), ErrorKind::MissingInput);
    std::string head(kHeadBytes, '\0');
    in.read(head.data(), std::streamsize(head.size()));
    head.resize(std::size_t(in.gcount()));
    const std::uint64_t bytes = std::filesystem::file_size(path, status);

    for (const Magic& magic : kMagics)
        if (std::string_view(head).starts_with(magic.bytes)) return {magic.format, bytes};
    if (extensionOf(path) == "tga" && isTgaHeader(head)) return {ImageFormat::Tga, bytes};
    failImage(path, fmt::format("{}; known are EXR, PNG, JPEG, HDR, TIFF, PFM and, by its extension, TGA",
                                head.empty() ? "the file is empty" : "its first bytes are of no known image format"));
}

void checkImageSize(const std::string& path, std::int64_t width, std::int64_t height, std::uint64_t bytesPerPixel,
                    std::uint64_t fileBytes, const ImageLimits& limits, double mostExpansion) {
    constexpr double kFree = 64.0 * 1024 * 1024;
    constexpr std::int64_t kLongestSide = 1'000'000;  // libpng's own limit, too
    const double pixels = double(width) * double(height), bytes = pixels * double(bytesPerPixel);
    const auto refuse = [&](const std::string& reason) {
        failImage(path, fmt::format("an image of {} x {} pixels {}", width, height, reason));
    };
    if (width < 1 || height < 1) refuse("is empty");
    if (width > kLongestSide || height > kLongestSide) refuse(fmt::format("has a side longer than {}", kLongestSide));
    if (pixels > double(limits.pixels)) refuse(fmt::format("is larger than the limit of {} pixels", limits.pixels));
    if (bytes > double(limits.bytes)) refuse(fmt::format("needs {:.0f} bytes; the limit is {}", bytes, limits.bytes));
    if (bytes > kFree + mostExpansion * double(fileBytes))
        refuse(fmt::format("needs {:.0f} bytes, more than a file of {} bytes can hold: it is cut short or damaged",
                           bytes, fileBytes));
}

}  // namespace penumbra
