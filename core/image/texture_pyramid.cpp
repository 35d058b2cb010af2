#include "core/image/texture_pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace penumbra {
namespace {

/// A level of linear floats, interleaved.
struct FloatLevel {
    int width = 0, height = 0, channels = 0;
    std::vector<float> values;
};

/// The texels i of n that texel j of m covers, and how much of it each makes up; exact but for the last division.
/// REQUIRES: m = ceil(n / 2), so that there are at most three.
struct Cover {
    int first = 0, count = 0;
    std::array<float, 3> weight{};
};
Cover coverOf(int j, int n, int m) {
    // In units of 1/m of a texel: texel i is [i m, (i+1) m), and j covers [j n, (j+1) n).
    const std::int64_t low = std::int64_t(j) * n, high = low + n;
    Cover cover;
    cover.first = int(low / m);
    for (std::int64_t i = cover.first; i * m < high; ++i) {
        const std::int64_t overlap = std::min((i + 1) * m, high) - std::max(i * m, low);
        cover.weight[std::size_t(cover.count++)] = float(double(overlap) / n);
    }
    return cover;
}

/// The next smaller level. `readRow(y, out)` gives a row of the present one, linear.
template <class ReadRow>
FloatLevel halve(int width, int height, int channels, const ReadRow& readRow) {
    FloatLevel half{(width + 1) / 2, (height + 1) / 2, channels, {}};
    half.values.assign(std::size_t(half.width) * half.height * channels, 0.f);
    std::vector<Cover> columns(std::size_t(half.width));
    for (int x = 0; x < half.width; ++x)
        columns[std::size_t(x)] = coverOf(x, width, half.width);
    std::vector<float> row(std::size_t(width) * channels);
    for (int y = 0; y < half.height; ++y) {
        const Cover rows = coverOf(y, height, half.height);
        float* const out = half.values.data() + std::size_t(y) * half.width * channels;
        for (int i = 0; i < rows.count; ++i) {
            readRow(rows.first + i, row.data());
            for (int x = 0; x < half.width; ++x) {
                const Cover& cover = columns[std::size_t(x)];
                for (int k = 0; k < cover.count; ++k) {
                    const float weight = rows.weight[std::size_t(i)] * cover.weight[std::size_t(k)];
                    const float* const in = row.data() + std::size_t(cover.first + k) * channels;
                    for (int c = 0; c < channels; ++c)
                        out[std::size_t(x) * channels + c] += weight * in[c];
                }
            }
        }
    }
    return half;
}

FloatLevel halve(const FloatLevel& level) {
    const std::size_t rowLength = std::size_t(level.width) * level.channels;
    return halve(level.width, level.height, level.channels, [&](int y, float* out) {
        std::copy_n(level.values.data() + std::size_t(y) * rowLength, rowLength, out);
    });
}

/// From linear values to the byte whose decoded value is nearest.
class ByteEncoder {
public:
    /// REQUIRES: the table rises (equal neighbours are all right).
    explicit ByteEncoder(const std::array<float, 256>& decode) {
        for (std::size_t i = 0; i < border_.size(); ++i)
            border_[i] = 0.5f * (decode[i] + decode[i + 1]);
        std::size_t code = 0;
        for (std::size_t i = 0; i < start_.size(); ++i) {
            while (code < border_.size() && border_[code] <= float(i) / float(start_.size()))
                ++code;
            start_[i] = std::uint8_t(code);
        }
    }
    std::uint8_t operator()(float value) const {
        const float inRange = std::clamp(value, 0.f, 1.f);
        const std::size_t bucket = std::min(std::size_t(inRange * float(start_.size())), start_.size() - 1);
        std::size_t code = start_[bucket];
        while (code < border_.size() && border_[code] <= inRange)
            ++code;
        return std::uint8_t(code);
    }

private:
    std::array<float, 255> border_{};  ///< half-way between the values of code i and i + 1
    std::array<std::uint8_t, 1024>
        start_{};  ///< the lowest code of values in a bucket: the search is then a step or two
};

bool isOpaque(const Image& image) {
    if (!image.hasAlpha()) return true;
    const auto opaque = [](auto values, auto one) {
        for (std::size_t i = 3; i < values.size(); i += 4)
            if (values[i] != one) return false;
        return true;
    };
    return image.isByte() ? opaque(image.bytes(), std::uint8_t(255)) : opaque(image.floats(), 1.f);
}

std::uint32_t packColor(const std::uint8_t* c, int channels) {
    const std::uint32_t alpha = channels == 4 ? c[3] : 255u;
    return std::uint32_t(c[0]) | std::uint32_t(c[1]) << 8 | std::uint32_t(c[2]) << 16 | alpha << 24;
}

}  // namespace

ImagePyramid::ImagePyramid(const Image& image) : colorSpace_(&image.colorSpace()), readsAlpha_(!isOpaque(image)) {
    for (int width = image.width(), height = image.height();;) {
        addLevel(width, height);
        if (width == 1 && height == 1) break;
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    if (image.isByte()) {
        storeBytes(image);
    } else {
        storeFloats(image);
    }
}

void ImagePyramid::addLevel(int width, int height) {
    levels_.push_back({texelCount_, std::uint32_t(width), std::uint32_t(height)});
    texelCount_ += std::uint32_t(width) * std::uint32_t(height);
}

void ImagePyramid::storeBytes(const Image& image) {
    const int channels = image.channels();
    decode_ = image.decodeTable();
    format_ = channels == 1 ? Format::ByteGrey : Format::ByteColor;
    words_.assign(channels == 1 ? (std::size_t(texelCount_) + 3) / 4 : texelCount_, 0u);
    const auto storeLevel = [&](std::size_t level, const std::uint8_t* bytes) {
        const Level& l = levels_[level];
        const std::size_t texels = std::size_t(l.width) * l.height;
        if (channels == 1) {
            std::memcpy(reinterpret_cast<std::uint8_t*>(words_.data()) + l.offset, bytes, texels);
        } else {
            for (std::size_t i = 0; i < texels; ++i)
                words_[l.offset + i] = packColor(bytes + i * std::size_t(channels), channels);
        }
    };
    storeLevel(0, image.bytes().data());
    if (levels_.size() == 1) return;

    // Each level comes from the unrounded one before it, so that rounding does not add up.
    const ByteEncoder encode(decode_);
    const std::size_t rowLength = std::size_t(image.width()) * channels;
    FloatLevel level = halve(image.width(), image.height(), channels, [&](int y, float* out) {
        const std::uint8_t* const in = image.bytes().data() + std::size_t(y) * rowLength;
        for (std::size_t i = 0; i < rowLength; ++i)
            out[i] = decode_[in[i]];
    });
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 1;; ++i) {
        bytes.resize(level.values.size());
        std::transform(level.values.begin(), level.values.end(), bytes.begin(), encode);
        storeLevel(i, bytes.data());
        if (i + 1 == levels_.size()) break;
        level = halve(level);
    }
}

void ImagePyramid::storeFloats(const Image& image) {
    stride_ = std::uint32_t(image.channels());
    format_ = stride_ == 1 ? Format::FloatGrey : Format::FloatColor;
    floats_.assign(std::size_t(texelCount_) * stride_ + 1, 0.f);  // of three channels the last texel is read as four
    for (std::size_t i = 0; i < image.floats().size(); ++i) {
        const float v = image.floats()[i];
        if (std::isfinite(v)) {
            floats_[i] = v;
        } else {
            ++nonFiniteCount_;
        }
    }
    for (std::size_t i = 0; i + 1 < levels_.size(); ++i) {
        const Level &from = levels_[i], &to = levels_[i + 1];
        const std::size_t rowLength = std::size_t(from.width) * stride_;
        const float* const source = floats_.data() + std::size_t(from.offset) * stride_;
        const FloatLevel half = halve(int(from.width), int(from.height), int(stride_), [&](int y, float* out) {
            std::copy_n(source + std::size_t(y) * rowLength, rowLength, out);
        });
        std::copy(half.values.begin(), half.values.end(), floats_.data() + std::size_t(to.offset) * stride_);
    }
}

Spectrum<float> ImagePyramid::texel(int level, int x, int y) const {
    const Level& l = levels_[std::size_t(level)];
    const std::uint32_t index = l.offset + std::uint32_t(y) * l.width + std::uint32_t(x);
    return withTexels([&](const auto& texels) { return texels.template texel<Spectrum<float>, float>(index); });
}

}  // namespace penumbra
