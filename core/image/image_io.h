// Image files in and out. image_io.cpp is the only file that knows OpenImageIO and OpenEXR.
//
// Reading: a file is what its first bytes say (EXR, PNG, JPEG, HDR, TIFF, PFM), never what its name says; TGA, which has no
// magic, by its extension and a valid header. All else is refused. Sizes are checked before memory is allocated.
// Writing: every file appears whole or not at all (core/base/atomic_file.h).
// Errors: Error(MissingInput, BadData, CannotCreate, CannotWrite), the message beginning with the path; the exceptions of the
// libraries end here, and they neither print nor start threads.
// Thread safety: all functions may be called from several threads at once.
#pragma once

#include "core/image/image.h"

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace penumbra {

struct ReadImageOptions {
    /// How PNG values decode (8 and 16 bit, alpha included). Other 8-bit formats are always sRGB, EXR, PFM and HDR linear.
    TransferFunction pngEncoding = TransferFunction::srgb();
    std::size_t pixelLimit = std::size_t(16384) * 16384;
    std::size_t byteLimit = std::size_t(1) << 30;   ///< of the decoded image
};
Image readImage(const std::string& path, const ReadImageOptions& options = {});

/// A rectangle of pixels, upper ends exclusive.
struct PixelWindow {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
};

struct ExrChannel {
    std::string name;
    enum class Type { Float, Uint } type = Type::Float;   ///< both 32 bits
};
using ExrAttribute = std::variant<std::string, int, float, std::array<float, 16>>;   ///< the array: a matrix, by rows

struct ExrHeader {
    PixelWindow dataWindow, displayWindow;
    std::vector<ExrChannel> channels;
    const ColorSpace* colorSpace = nullptr;   ///< written as chromaticities where given
    std::vector<std::pair<std::string, ExrAttribute>> attributes;
};

/// Where the pixels of a block of rows go: one plane of `rows * width` 32-bit values per channel, in the order of
/// ExrHeader::channels.
struct ExrBlock {
    int firstRow = 0, rows = 0;                 ///< firstRow in the coordinates of the data window
    std::vector<std::span<float>> floats;       ///< indexed like the channels; empty for Uint channels
    std::vector<std::span<std::uint32_t>> uints;   ///< indexed like the channels; empty for Float channels
};

/// Writes a scan line EXR with lossless ZIP. `fill` is called for blocks of at most 16 rows, top to bottom, from this thread;
/// no more than one block and what OpenEXR compresses is in memory at a time. The same input gives the same bytes.
void writeExr(const std::string& path, const ExrHeader& header, const std::function<void(const ExrBlock&)>& fill);

/// All channels of a single-part, flat EXR file, for tools and tests; half channels become floats.
struct ExrFile {
    ExrHeader header;                        ///< only attributes of the types of ExrAttribute
    std::vector<std::vector<float>> floats;  ///< indexed like header.channels, as in ExrBlock
    std::vector<std::vector<std::uint32_t>> uints;
    /// The plane of a float channel; null where there is none of that name.
    const std::vector<float>* find(std::string_view channel) const;
};
ExrFile readExr(const std::string& path, const ReadImageOptions& options = {});

struct WriteImageOptions {
    int bits = 8;             ///< of PNG and TIFF: 8 or 16; TIFF also 32 (float)
    int jpegQuality = 95;     ///< 1 to 100
};

/// Writes interleaved RGB in the format that the extension names: png, jpg, jpeg, hdr, pfm, tif, tiff. PNG, JPEG and integer
/// TIFF take values already encoded for display, in [0, 1], which are clamped and rounded; HDR, PFM and float TIFF take
/// linear values (HDR has no negative ones: they become 0). Throws Error(Usage) for another extension.
void writeImage(const std::string& path, int width, int height, std::span<const float> rgb,
                const WriteImageOptions& options = {});

/// What writeImage would take for the path; Unknown where it does not know the extension.
enum class ImageFileKind { Unknown, DisplayEncoded, Linear };
ImageFileKind imageFileKind(const std::string& path, const WriteImageOptions& options = {});

}  // namespace penumbra
