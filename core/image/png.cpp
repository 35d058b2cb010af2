#include "core/image/png.h"

#include "core/base/byte_reader.h"
#include "core/image/file_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>
#include <string_view>

namespace penumbra {
namespace {

using Row = std::vector<std::uint8_t>;

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

enum class Kind { Grey = 0, Rgb = 2, Palette = 3, GreyAlpha = 4, Rgba = 6 };

/// What a picture needs of a file.
struct Parts {
    std::uint32_t width = 0, height = 0;
    int bits = 0;
    Kind kind = Kind::Grey;
    bool interlaced = false;
    std::string palette, transparency;
    std::string packed;  ///< the data of all IDAT chunks

    int samples() const {  ///< of a pixel in the file
        return kind == Kind::Rgb ? 3 : kind == Kind::GreyAlpha ? 2 : kind == Kind::Rgba ? 4 : 1;
    }
    bool isGrey() const { return kind == Kind::Grey || kind == Kind::GreyAlpha; }
    int channels() const { return isGrey() ? 1 : kind == Kind::Rgba || !transparency.empty() ? 4 : 3; }
    std::size_t rowBytes(std::size_t pixels) const { return (pixels * samples() * bits + 7) / 8; }
};

/// The values that the specification allows in a header (section 11.2.1).
void readHeader(const std::string& path, std::string_view type, std::string_view data, Parts& parts) {
    constexpr std::size_t kHeaderBytes = 13;
    if (type != "IHDR" || data.size() != kHeaderBytes) failImage(path, "the PNG has no header");
    const int bits = data[8], kind = data[9];
    const bool isRight = kind == 0   ? bits == 1 || bits == 2 || bits == 4 || bits == 8 || bits == 16
                         : kind == 3 ? bits == 1 || bits == 2 || bits == 4 || bits == 8
                                     : (kind == 2 || kind == 4 || kind == 6) && (bits == 8 || bits == 16);
    if (!isRight || data[10] != 0 || data[11] != 0 || (data[12] & ~1) != 0)
        failImage(path, "the header of the PNG is damaged");
    parts.width = bigEndian(data, 0, 4);
    parts.height = bigEndian(data, 4, 4);
    parts.bits = bits;
    parts.kind = Kind(kind);
    parts.interlaced = data[12] == 1;
}

void checkColors(const std::string& path, const Parts& parts) {
    const std::size_t entries = parts.palette.size() / 3, transparent = parts.transparency.size();
    if (parts.kind == Kind::Palette) {
        if (entries == 0 || parts.palette.size() % 3 != 0 || entries > std::size_t(1) << parts.bits)
            failImage(path, "the PNG is damaged: its palette is missing or of a wrong size");
        if (transparent > entries) failImage(path, "the PNG is damaged: it has more transparencies than colours");
    } else if (transparent != 0 && transparent != std::size_t(2 * parts.samples())) {
        failImage(path, "the PNG is damaged: its transparent colour is of a wrong size");
    }
}

Parts readParts(const std::string& path, const ImageLimits& limits, std::uint64_t& fileBytes) {
    constexpr std::size_t kSignature = 8, kAround = 12;  // of a chunk: length, type, checksum
    const std::string whole = readWholeImageFile(path);
    const std::string_view bytes = whole;
    fileBytes = bytes.size();
    Parts parts;
    for (std::size_t at = kSignature; at + kAround <= bytes.size();) {
        const std::uint64_t size = kAround + std::uint64_t(bigEndian(bytes, at, 4));
        if (size > bytes.size() - at) break;
        const std::string_view chunk = bytes.substr(at, size), type = chunk.substr(4, 4),
                               data = chunk.substr(8, size - kAround);
        if (checksum(chunk.substr(4, size - 8)) != bigEndian(chunk, size - 4, 4))
            failImage(path, fmt::format("the PNG is damaged: wrong checksum of the chunk at byte {}", at));
        if (at == kSignature) {
            readHeader(path, type, data, parts);
            checkImageSize(path, parts.width, parts.height, 1, fileBytes, limits);
        }
        if (type == "PLTE") parts.palette = data;
        // Where there is alpha anyway, or grey, whose alpha is dropped, nothing depends on it.
        if (type == "tRNS" && (parts.kind == Kind::Rgb || parts.kind == Kind::Palette)) parts.transparency = data;
        if (type == "IDAT") parts.packed += data;
        if (type == "IEND") {
            checkColors(path, parts);
            return parts;
        }
        at += size;
    }
    failImage(path, "the PNG is cut short");
}

/// Undoes the filter of a row of `bytes`, whose first byte names it (section 9). `above` has zeros before the first row.
bool unfilter(Row& row, const Row& above, std::size_t bytes, std::size_t step) {
    std::uint8_t* const x = row.data() + 1;
    const std::uint8_t* const up = above.data() + 1;
    const auto left = [&](std::size_t i) { return i < step ? 0 : int(x[i - step]); };
    const auto corner = [&](std::size_t i) { return i < step ? 0 : int(up[i - step]); };
    switch (row[0]) {
        case 0:
            return true;
        case 1:
            for (std::size_t i = step; i < bytes; ++i)
                x[i] = std::uint8_t(x[i] + x[i - step]);
            return true;
        case 2:
            for (std::size_t i = 0; i < bytes; ++i)
                x[i] = std::uint8_t(x[i] + up[i]);
            return true;
        case 3:
            for (std::size_t i = 0; i < bytes; ++i)
                x[i] = std::uint8_t(x[i] + (left(i) + up[i]) / 2);
            return true;
        case 4:  // Paeth: whichever neighbour is nearest to left + above - corner
            for (std::size_t i = 0; i < bytes; ++i) {
                const int a = left(i), b = up[i], c = corner(i);
                const int toA = std::abs(b - c), toB = std::abs(a - c), toC = std::abs(a + b - 2 * c);
                x[i] = std::uint8_t(x[i] + (toA <= toB && toA <= toC ? a : toB <= toC ? b : c));
            }
            return true;
        default:
            return false;
    }
}

/// Pixels of unfiltered rows as values of the picture.
class Decoder {
public:
    Decoder(const std::string& path, const Parts& parts) : path_(path), parts_(parts) {}

    /// Writes the picture's channels of the pixel x of a row: bytes, or of 16 bits words.
    template <class T>
    void pixel(const Row& row, std::size_t x, T* out) const {
        const std::uint8_t* const data = row.data() + 1;
        const int samples = parts_.samples(), largest = (1 << std::min(parts_.bits, 8)) - 1;
        if (parts_.kind == Kind::Palette) {
            fromPalette(std::size_t(packed(data, x)), out);
            return;
        }
        if (parts_.bits < 8) {
            *out = T(packed(data, x) * 255 / largest);
            return;
        }
        const int channels = parts_.channels();
        const std::size_t bytes = sizeof(T);
        for (int c = 0; c < std::min(samples, channels); ++c) {
            const std::uint8_t* const v = data + (x * samples + c) * bytes;
            out[c] = bytes == 1 ? T(v[0]) : T(v[0] << 8 | v[1]);
        }
        if (channels > samples) out[3] = isTransparent(out) ? T(0) : T(~T(0));
    }

private:
    /// The pixel of one sample of at most 8 bits.
    int packed(const std::uint8_t* data, std::size_t x) const {
        const std::size_t bit = x * parts_.bits;
        return data[bit / 8] >> (8 - parts_.bits - bit % 8) & ((1 << parts_.bits) - 1);
    }

    template <class T>
    void fromPalette(std::size_t entry, T* out) const {
        if (3 * entry >= parts_.palette.size()) failImage(path_, "the PNG is damaged: a pixel is not in its palette");
        for (int c = 0; c < 3; ++c)
            out[c] = static_cast<std::uint8_t>(parts_.palette[3 * entry + c]);
        if (parts_.transparency.empty()) return;
        out[3] = entry < parts_.transparency.size() ? static_cast<std::uint8_t>(parts_.transparency[entry]) : 255;
    }

    template <class T>
    bool isTransparent(const T* rgb) const {
        for (int c = 0; c < 3; ++c)  // of the two bytes only the picture's bits count
            if (T(bigEndian(parts_.transparency, 2 * std::size_t(c), 2)) != rgb[c]) return false;
        return true;
    }

    const std::string& path_;
    const Parts& parts_;
};

/// Every `stepX`-th pixel of every `stepY`-th row, from (x, y) on.
struct Pass {
    std::uint32_t x, y, stepX, stepY;
};
constexpr Pass kAll[] = {{0, 0, 1, 1}};
constexpr Pass kAdam7[] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4}, {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};

template <class T>
std::vector<T> readPixels(const std::string& path, const Parts& parts) {
    const std::size_t channels = std::size_t(parts.channels()), width = parts.width;
    const std::size_t step = std::max<std::size_t>(1, std::size_t(parts.samples()) * parts.bits / 8);
    std::vector<T> out(width * parts.height * channels);
    ZlibReader reader(parts.packed);
    const Decoder decoder(path, parts);
    Row row(1 + parts.rowBytes(width)), above(row.size());
    for (const Pass& pass : parts.interlaced ? std::span<const Pass>(kAdam7) : std::span<const Pass>(kAll)) {
        if (pass.x >= parts.width) continue;  // a pass without pixels has no rows
        const std::size_t count = (width - pass.x + pass.stepX - 1) / pass.stepX, bytes = parts.rowBytes(count);
        std::fill(above.begin(), above.end(), std::uint8_t(0));
        for (std::size_t y = pass.y; y < parts.height; y += pass.stepY) {
            if (!reader.read(row.data(), 1 + bytes))
                failImage(path, "the PNG is damaged: its picture data end too early or do not inflate");
            if (!unfilter(row, above, bytes, step)) failImage(path, "the PNG is damaged: a row of an unknown filter");
            for (std::size_t i = 0; i < count; ++i)
                decoder.pixel(row, i, &out[(y * width + pass.x + i * pass.stepX) * channels]);
            row.swap(above);
        }
    }
    if (!reader.endsRight()) failImage(path, "the PNG is damaged: wrong checksum of the picture data");
    return out;
}

}  // namespace

Image readPng(const std::string& path, TransferFunction encoding, const ImageLimits& limits) {
    std::uint64_t fileBytes = 0;
    const Parts parts = readParts(path, limits, fileBytes);
    const int width = int(parts.width), height = int(parts.height), channels = parts.channels();
    const std::size_t perValue = parts.bits == 16 ? sizeof(float) : 1;
    checkImageSize(path, width, height, channels * perValue, fileBytes, limits);
    if (parts.bits <= 8) return Image(width, height, channels, readPixels<std::uint8_t>(path, parts), encoding);

    const std::vector<std::uint16_t> words = readPixels<std::uint16_t>(path, parts);
    std::vector<float> floats(words.size());
    for (std::size_t i = 0; i < words.size(); ++i)
        floats[i] = encoding.decode(float(words[i]) / 65535.f);
    return Image(width, height, channels, std::move(floats));
}

}  // namespace penumbra
