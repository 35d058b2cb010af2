// EXR files: planes out in blocks, all channels in. exr.cpp is the only file that knows OpenEXR.
//
// Conventions, errors and thread safety as in image_io.h.
#pragma once

#include "core/image/file_format.h"
#include "core/image/image.h"

#include <array>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace penumbra {

/// A rectangle of pixels, upper ends exclusive.
struct PixelWindow {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
};

struct ExrChannel {
    std::string name;
    enum class Type { Float, Uint } type = Type::Float;  ///< both 32 bits
};
using ExrAttribute = std::variant<std::string, int, float, std::array<float, 16>>;  ///< the array: a matrix, by rows

struct ExrHeader {
    PixelWindow dataWindow, displayWindow;
    std::vector<ExrChannel> channels;
    const ColorSpace* colorSpace = nullptr;  ///< written as chromaticities where given
    std::vector<std::pair<std::string, ExrAttribute>> attributes;
};

/// Where the pixels of a block of rows go: one plane of `rows * width` 32-bit values per channel, in the order of
/// ExrHeader::channels.
struct ExrBlock {
    int firstRow = 0, rows = 0;                   ///< firstRow in the coordinates of the data window
    std::vector<std::span<float>> floats;         ///< indexed like the channels; empty for Uint channels
    std::vector<std::span<std::uint32_t>> uints;  ///< indexed like the channels; empty for Float channels
};

/// Writes a scan line EXR with lossless ZIP. `fill` is called for blocks of at most 16 rows, top to bottom, from this
/// thread; only one block is in memory at a time. The same input gives the same bytes.
void writeExr(const std::string& path, const ExrHeader& header, const std::function<void(const ExrBlock&)>& fill);

/// All channels of a single-part, flat EXR file, for tools and tests; half channels become floats.
struct ExrFile {
    ExrHeader header;                        ///< only attributes of the types of ExrAttribute
    std::vector<std::vector<float>> floats;  ///< indexed like header.channels, as in ExrBlock
    std::vector<std::vector<std::uint32_t>> uints;
    /// The plane of a float channel; null where there is none of that name.
    const std::vector<float>* find(std::string_view channel) const;
};
ExrFile readExr(const std::string& path, const ImageLimits& limits = {});

/// The picture in an EXR file: R, G, B and A where there is one (of the first layer that has them), or a single
/// channel.
Image readExrImage(const std::string& path, const ImageLimits& limits = {});

/// "OpenEXR 3.1.5", as compiled against.
std::string exrLibraryVersion();

}  // namespace penumbra
