#include "core/image/pfm.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>

namespace penumbra {
namespace {

/// A word of the header and the single white space after it.
std::string readWord(std::istream& in, const std::string& path) {
    constexpr std::size_t kLongest = 32;
    std::string word;
    for (int c = in.get(); in; c = in.get()) {
        const bool space = c == ' ' || c == '\t' || c == '\n' || c == '\r';
        if (space && !word.empty()) {
            if (c == '\r' && in.peek() == '\n') in.get();
            return word;
        }
        if (!space) word.push_back(char(c));
        if (word.size() > kLongest) break;
    }
    failImage(path, "the PFM header is cut short or damaged");
}

template <class T>
T readNumber(std::istream& in, const std::string& path, const char* what) {
    const std::string word = readWord(in, path);
    T value{};
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (status != std::errc() || end != word.data() + word.size())
        failImage(path, fmt::format("the {} in the PFM header is {}", what, quote(word)));
    return value;
}

void swapBytes(std::span<float> values) {
    for (float& v : values)
        v = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(v)));
}

}  // namespace

Image readPfm(const std::string& path, std::uint64_t fileBytes, const ImageLimits& limits) {
    std::ifstream in(path, std::ios::binary);
    const int channels = readWord(in, path) == "PF" ? 3 : 1;
    const int width = readNumber<int>(in, path, "width"), height = readNumber<int>(in, path, "height");
    const float scale = readNumber<float>(in, path, "scale");
    if (!std::isfinite(scale) || scale == 0) failImage(path, fmt::format("the scale in the PFM header is {}", scale));
    checkImageSize(path, width, height, channels * sizeof(float), fileBytes, limits, 1);

    const std::size_t rowValues = std::size_t(width) * channels;
    if (fileBytes - std::uint64_t(in.tellg()) < rowValues * height * sizeof(float))
        failImage(path, "the PFM file is cut short");
    std::vector<float> values(rowValues * height);
    for (int y = height - 1; y >= 0; --y)
        in.read(reinterpret_cast<char*>(values.data() + y * rowValues), std::streamsize(rowValues * sizeof(float)));
    if (!in) failImage(path, "the PFM file is cut short");
    if (scale > 0) swapBytes(values);
    if (const float factor = std::abs(scale); factor != 1)
        for (float& v : values)
            v *= factor;
    return Image(width, height, channels, std::move(values));
}

std::string encodePfm(int width, int height, std::span<const float> rgb) {
    static_assert(std::endian::native == std::endian::little);
    std::string out = fmt::format("PF\n{} {}\n-1\n", width, height);
    const std::size_t rowValues = std::size_t(width) * 3;
    for (int y = height - 1; y >= 0; --y)
        out.append(reinterpret_cast<const char*>(rgb.data() + y * rowValues), rowValues * sizeof(float));
    return out;
}

}  // namespace penumbra
