#include "core/image/exr_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <optional>

namespace penumbra {
namespace {

constexpr std::uint32_t kDeepFlag = 0x800, kMultiPartFlag = 0x1000;

/// Little-endian values from bytes in memory; a read beyond the end fails as a damaged header.
class Cursor {
public:
    Cursor(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}

    std::string_view take(std::size_t n) {
        if (n > bytes_.size() - at_) fail("the EXR header is cut short");
        at_ += n;
        return bytes_.substr(at_ - n, n);
    }
    template <class T>
    T number() {
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    /// Up to a NUL, which is passed.
    std::string_view text() {
        constexpr std::size_t kLongest = 255;
        const std::size_t end = bytes_.find('\0', at_);
        if (end == std::string_view::npos || end - at_ > kLongest) fail("a name in the EXR header has no end");
        const std::string_view word = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        return word;
    }
    bool atEnd() const { return at_ == bytes_.size(); }
    [[noreturn]] void fail(const std::string& reason) const { failImage(path_, reason); }

private:
    std::string_view bytes_;
    const std::string& path_;
    std::size_t at_ = 0;
};

struct Part {
    std::int64_t width = 0, height = 0;
    std::uint64_t bytesPerPixel = 0;
    std::uint8_t compression = 0;
    std::uint32_t tileWidth = 0, tileHeight = 0, levels = 0;  // levels: 0 one, 1 mip, 2 rip
};

/// Bytes of one pixel in all channels.
std::uint64_t readChannels(Cursor in) {
    constexpr std::uint32_t kHalf = 1;
    std::uint64_t bytes = 0;
    while (!in.text().empty()) {
        bytes += in.number<std::uint32_t>() == kHalf ? 2 : 4;
        in.take(12);  // linearity, sampling
    }
    return bytes;
}

void readAttribute(std::string_view name, std::string_view type, Cursor value, Part& part) {
    if (type == "preview") {
        const std::uint64_t w = value.number<std::uint32_t>(), h = value.number<std::uint32_t>();
        if (w > 8192 || h > 8192) value.fail("the preview in the EXR header is too large");
        value.take(4 * w * h);
    } else if (name == "dataWindow") {
        std::int64_t box[4];
        for (std::int64_t& edge : box)
            edge = value.number<std::int32_t>();
        part.width = box[2] - box[0] + 1;
        part.height = box[3] - box[1] + 1;
    } else if (name == "channels") {
        part.bytesPerPixel = readChannels(value);
    } else if (name == "compression") {
        part.compression = value.number<std::uint8_t>();
    } else if (name == "tiles") {
        part.tileWidth = value.number<std::uint32_t>();
        part.tileHeight = value.number<std::uint32_t>();
        part.levels = value.number<std::uint8_t>() & 0xf;
        if (part.tileWidth == 0 || part.tileHeight == 0) value.fail("the tiles of the EXR file are empty");
    }
}

/// One header; empty where there is none (the end of the headers of a multi-part file).
std::optional<Part> readHeader(Cursor& in, const std::string& path) {
    Part part;
    bool any = false;
    for (std::string_view name = in.text(); !name.empty(); name = in.text()) {
        any = true;
        const std::string_view type = in.text();
        readAttribute(name, type, Cursor(in.take(in.number<std::uint32_t>()), path), part);
    }
    return any ? std::optional(part) : std::nullopt;
}

void checkPart(const Part& part, const std::string& path, std::uint64_t fileBytes, const ImageLimits& limits) {
    constexpr int kDwaa = 8;
    const double expansion =
        part.compression >= kDwaa ? 64 * kMostExpansion : kMostExpansion;  // one value of 64 per block
    const auto check = [&](std::int64_t width, std::int64_t height) {
        checkImageSize(path, width, height, part.bytesPerPixel, fileBytes, limits, expansion);
    };
    check(part.width, part.height);
    if (part.tileWidth == 0) return;
    const std::int64_t across = (part.width + part.tileWidth - 1) / part.tileWidth;
    const std::int64_t down = (part.height + part.tileHeight - 1) / part.tileHeight;
    check(across * part.tileWidth, part.tileHeight);  // OpenEXR's buffer: a whole row of tiles
    const double tiles = double(across) * double(down) * (part.levels == 2 ? 4 : part.levels == 1 ? 2 : 1);
    if (tiles * 8 > double(fileBytes) * 2 + 65536)  // eight bytes each in the offset table; levels are counted too high
        failImage(path, fmt::format("the EXR file claims {:.0f} tiles in {} bytes", tiles, fileBytes));
}

}  // namespace

void checkExrHeaders(const std::string& path, std::uint64_t fileBytes, const ImageLimits& limits) {
    constexpr std::uint64_t kMostHeader = 16 << 20;
    constexpr int kMostParts = 1024;
    std::string bytes(std::min(fileBytes, kMostHeader), '\0');
    std::ifstream stream(path, std::ios::binary);
    stream.read(bytes.data(), std::streamsize(bytes.size()));
    bytes.resize(std::size_t(stream.gcount()));

    Cursor in(bytes, path);
    in.take(4);
    const std::uint32_t version = in.number<std::uint32_t>();
    if ((version & 0xff) != 2) in.fail(fmt::format("version {} of the EXR format is not known", version & 0xff));
    if (version & kDeepFlag) in.fail("deep EXR files are not supported");
    for (int count = 0; count < kMostParts; ++count) {
        const std::optional<Part> part = readHeader(in, path);
        if (!part) break;
        checkPart(*part, path, fileBytes, limits);
        if (!(version & kMultiPartFlag)) break;
    }
}

}  // namespace penumbra
