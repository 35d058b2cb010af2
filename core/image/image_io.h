// Image files in and out. OpenImageIO is loaded with the first file that needs it (core/image/oiio_module.h); EXR, PFM
// and PNG that are read do without.
//
// Reading: a file is what its first bytes say (EXR, PNG, JPEG, HDR, TIFF, PFM), never what its name says; TGA, which
// has no magic, by its extension and a valid header. All else is refused. Sizes are checked before memory is allocated,
// also against what a file of its size could hold at all.
//
// Writing: every file appears whole or not at all (core/base/atomic_file.h); the same input gives the same bytes.
//
// Errors: Error(MissingInput, BadData, CannotCreate, CannotWrite; Configuration where OpenImageIO cannot be loaded),
// the message beginning with the path; the exceptions of the libraries end here, and they neither print nor decode in
// threads of their own.
//
// Thread safety: all functions may be called from several threads at once.
#pragma once

#include "core/image/exr.h"
#include "core/image/image.h"

namespace penumbra {

struct ReadImageOptions {
    /// How PNG values decode (8 and 16 bit, alpha included). Other 8-bit formats are always sRGB; EXR, PFM and HDR
    /// linear.
    TransferFunction pngEncoding = TransferFunction::srgb();
    ImageLimits limits;
};

/// Reads a picture or texture. Grey with alpha becomes grey; of more than four channels the first three are taken;
/// alpha is kept of PNG and EXR only, as the pbrt format has it. TIFF integers are sRGB, TIFF floats linear.
Image readImage(const std::string& path, const ReadImageOptions& options = {});

struct WriteImageOptions {
    int bits = 8;          ///< of PNG and TIFF: 8 or 16; TIFF also 32 (float)
    int jpegQuality = 95;  ///< 1 to 100
};

/// Writes interleaved RGB in the format that the extension names: png, jpg, jpeg, hdr, pfm, tif, tiff. PNG, JPEG and
/// integer TIFF take values already encoded for display, in [0, 1], which are clamped and rounded; HDR, PFM and float
/// TIFF take linear values (HDR has no negative ones: they become 0). Throws Error(Usage) for another extension.
void writeImage(const std::string& path, int width, int height, std::span<const float> rgb,
                const WriteImageOptions& options = {});

/// Loads what writeImage would need for the path, so that a broken installation is known before long work. Throws
/// Error(Configuration).
void loadImageLibraryFor(const std::string& path);

/// What writeImage would take for the path; Unknown where it does not know the extension.
enum class ImageFileKind { Unknown, DisplayEncoded, Linear };
ImageFileKind imageFileKind(const std::string& path, const WriteImageOptions& options = {});

/// "OpenImageIO 2.4.7", as the library says at run time (it is loaded for that); where it cannot be loaded, why.
std::string imageLibraryVersion();

}  // namespace penumbra
