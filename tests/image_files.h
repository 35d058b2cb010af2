// Image files of every kind that the project itself does not write, made byte by byte for tests.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra {

/// A PNG of any kind (PNG specification, W3C): rows are bytes as packed in the file, without the filter byte.
struct PngFile {
    enum Kind { Grey = 0, Rgb = 2, Palette = 3, GreyAlpha = 4, Rgba = 6 };
    std::uint32_t width = 0, height = 0;
    int bits = 8;
    Kind kind = Grey;
    std::vector<std::vector<std::uint8_t>> rows;
    std::vector<std::uint8_t> palette{};

    std::string encoded() const {
        std::string header = bigEndian(width) + bigEndian(height);
        header += {char(bits), char(kind), 0, 0, 0};
        std::string raw;
        for (const auto& row : rows) {
            raw.push_back(0);  // no filter
            raw.append(row.begin(), row.end());
        }
        std::string packed(compressBound(raw.size()), 0);
        uLongf size = packed.size();
        compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
                 raw.size());
        packed.resize(size);
        std::string file = "\x89PNG\r\n\x1a\n" + chunk("IHDR", header);
        if (!palette.empty()) file += chunk("PLTE", std::string(palette.begin(), palette.end()));
        return file + chunk("IDAT", packed) + chunk("IEND", "");
    }

    static std::string bigEndian(std::uint32_t v) { return {char(v >> 24), char(v >> 16), char(v >> 8), char(v)}; }
    static std::string chunk(const std::string& type, const std::string& data) {
        const std::string body = type + data;
        const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size()));
        return bigEndian(std::uint32_t(data.size())) + body + bigEndian(std::uint32_t(sum));
    }
};

}  // namespace penumbra
