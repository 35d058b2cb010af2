// Image: pixels in memory, as a file gave them.
//
// Conventions: interleaved, row 0 is the top, channels 1 (grey), 3 (RGB) or 4 (RGB and alpha; colours multiplied by
// alpha or not as the file has them). Eight-bit files stay bytes with the transfer function that decodes them, so that
// textures stay small; all else is float and already linear. Colours are in the image's own colour space.
//
// Thread safety: immutable use is safe from any number of threads.
#pragma once

#include "core/color/color_space.h"
#include "core/color/transfer.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra {

class Image {
public:
    Image() = default;
    /// An image of bytes; the channels are all encoded alike, alpha included (as the pbrt format has it).
    Image(int width, int height, int channels, std::vector<std::uint8_t> bytes, TransferFunction encoding);
    /// An image of linear floats.
    Image(int width, int height, int channels, std::vector<float> floats, const ColorSpace& space = srgbColorSpace());

    int width() const { return width_; }
    int height() const { return height_; }
    int channels() const { return channels_; }
    bool isEmpty() const { return width_ == 0; }
    bool isByte() const { return !bytes_.empty(); }
    bool hasAlpha() const { return channels_ == 4; }
    const ColorSpace& colorSpace() const { return *space_; }
    TransferFunction encoding() const { return encoding_; }  ///< of the bytes; linear for floats
    std::size_t memoryBytes() const { return bytes_.size() + floats_.size() * sizeof(float); }

    std::span<const std::uint8_t> bytes() const& { return bytes_; }  ///< empty for float images
    std::span<const float> floats() const& { return floats_; }       ///< empty for byte images
    void bytes() && = delete;                                        // views would outlive a temporary
    void floats() && = delete;

    /// The decoded, linear value. REQUIRES: inside the image.
    float value(int x, int y, int channel) const {
        const std::size_t i = (std::size_t(y) * width_ + x) * channels_ + channel;
        return isByte() ? decode_[bytes_[i]] : floats_[i];
    }
    /// Linear RGB, grey replicated.
    Rgb rgb(int x, int y) const {
        if (channels_ == 1) {
            const float v = value(x, y, 0);
            return {v, v, v};
        }
        return {value(x, y, 0), value(x, y, 1), value(x, y, 2)};
    }
    /// What byte v stands for. REQUIRES: isByte().
    const std::array<float, 256>& decodeTable() const { return decode_; }

private:
    int width_ = 0, height_ = 0, channels_ = 0;
    TransferFunction encoding_ = TransferFunction::linear();
    const ColorSpace* space_ = &srgbColorSpace();
    std::vector<std::uint8_t> bytes_;
    std::vector<float> floats_;
    std::array<float, 256> decode_{};
};

}  // namespace penumbra
