#include "core/image/image_io.h"

#include "core/base/atomic_file.h"
#include "core/base/module.h"
#include "core/base/version.h"
#include "core/image/jpeg_essentials.h"
#include "core/image/oiio_module.h"
#include "core/image/pfm.h"
#include "core/image/png.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

const char* oiioName(ImageFormat format) {
    switch (format) {
        case ImageFormat::Jpeg:
            return "jpeg";
        case ImageFormat::Hdr:
            return "hdr";
        case ImageFormat::Tiff:
            return "tiff";
        case ImageFormat::Tga:
            return "targa";
        case ImageFormat::Exr:
        case ImageFormat::Pfm:
        case ImageFormat::Png:
            break;  // read without OpenImageIO
    }
    return "";
}

const OiioModule& loadOiio() {
    const auto interface =
        reinterpret_cast<OiioModuleFunction*>(loadModuleFunction(kOiioModuleFile, kOiioModuleFunction));
    const OiioModule* const module = interface(kVersion);
    if (!module)
        throw Error(ErrorKind::Configuration,
                    fmt::format("Penumbra's module {} is not of version {}", kOiioModuleFile, kVersion));
    return *module;
}

/// OpenImageIO, loaded when it is first asked for; where that fails, tried anew the next time.
const OiioModule& oiio() {
    static const OiioModule& module = loadOiio();
    return module;
}

/// The same for work on a file, whose path the message then begins with.
const OiioModule& oiioFor(const std::string& path) {
    try {
        return oiio();
    } catch (const Error& e) {
        failImage(path, e.what(), e.kind());
    }
}

std::string firstLine(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r'))
        text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
    failImage(path, reason.empty() ? "the image is damaged" : firstLine(reason));
}

void check(const std::string& path, const OiioResult& result) {
    if (!result) return;
    if (result->isMemory) throw std::bad_alloc();
    refuse(path, result->reason);
}

/// An open file. A JPEG is read from memory, from which the parts that no picture needs have been taken away.
class Input {
public:
    Input(const std::string& path, ImageFormat format, const ImageLimits& limits) : path_(path) {
        if (format == ImageFormat::Jpeg) bytes_ = jpegEssentials(path, limits);
        check(path, oiioFor(path).open({oiioName(format), path.c_str(), bytes_}, reader_));
    }

    OiioSpec spec() const { return reader_->spec(); }

    /// The first channels of all pixels.
    template <class T>
    std::vector<T> pixels(OiioValues type, int channels) {
        std::vector<T> out(std::size_t(spec().width) * spec().height * channels);
        check(path_, reader_->read(channels, type, out.data()));
        return out;
    }

private:
    const std::string& path_;
    std::string bytes_;  // before reader_, which uses it to its end
    std::unique_ptr<OiioReader> reader_;
};

Image readWithLibrary(const std::string& path, const ImageFileInfo& file, const ImageLimits& limits) {
    Input in(path, file.format, limits);
    const OiioSpec spec = in.spec();
    if (spec.channels < 1 || !spec.isFlat) refuse(path, "not a flat picture");

    const int channels = spec.channels <= 2 ? 1 : 3;  // alpha is kept of other formats only
    const bool isByte = spec.values == OiioValues::Bytes;
    checkImageSize(path, spec.width, spec.height,
                   std::max<std::uint64_t>(spec.bytesPerPixel, isByte ? 1 : channels * sizeof(float)), file.bytes,
                   limits, file.format == ImageFormat::Hdr ? 4 * kMostExpansion : kMostExpansion);

    const TransferFunction encoding = TransferFunction::srgb();
    if (isByte)
        return Image(spec.width, spec.height, channels, in.pixels<std::uint8_t>(OiioValues::Bytes, channels), encoding);
    std::vector<float> pixels = in.pixels<float>(OiioValues::Floats, channels);
    if (spec.values != OiioValues::Floats)
        for (float& v : pixels)
            v = encoding.decode(v);
    return Image(spec.width, spec.height, channels, std::move(pixels));
}

/// [0, 1] to [0, largest], rounded to nearest; not-a-number is 0.
template <class T>
std::vector<T> quantise(std::span<const float> values, float largest) {
    std::vector<T> out(values.size());
    std::transform(values.begin(), values.end(), out.begin(),
                   [&](float v) { return T(v > 0 ? std::floor(std::min(v, 1.f) * largest + 0.5f) : 0.f); });
    return out;
}

struct Encoder {
    const char* format;
    int bits;  ///< 32: float
};

std::vector<unsigned char> encode(OiioPicture picture, OiioValues type, const void* values) {
    picture.type = type;
    picture.values = values;
    std::vector<unsigned char> bytes;
    const OiioResult failure = oiioFor(picture.path).encode(picture, bytes);
    if (failure && failure->isMemory) throw std::bad_alloc();
    if (failure) failImage(picture.path, "cannot encode: " + firstLine(failure->reason), ErrorKind::CannotWrite);
    return bytes;
}

std::vector<unsigned char> encodeImage(const OiioPicture& picture, int bits, std::span<const float> rgb) {
    if (bits == 8) return encode(picture, OiioValues::Bytes, quantise<std::uint8_t>(rgb, 255).data());
    if (bits == 16) return encode(picture, OiioValues::Words, quantise<std::uint16_t>(rgb, 65535).data());
    if (std::string_view(picture.format) != "hdr") return encode(picture, OiioValues::Floats, rgb.data());
    std::vector<float> positive(rgb.begin(), rgb.end());
    for (float& v : positive)
        v = v > 0 ? std::min(v, 1e30f) : 0;  // no sign, no infinity, no not-a-number in RGBE
    return encode(picture, OiioValues::Floats, positive.data());
}

Encoder encoderFor(const std::string& extension, const WriteImageOptions& options) {
    if (extension == "png") return {"png", options.bits};
    if (extension == "jpg" || extension == "jpeg") return {"jpeg", 8};
    if (extension == "tif" || extension == "tiff") return {"tiff", options.bits};
    if (extension == "hdr") return {"hdr", 32};
    return {extension == "pfm" ? "pfm" : "", 32};
}

}  // namespace

Image readImage(const std::string& path, const ReadImageOptions& options) {
    return guardImage(path, ErrorKind::BadData, [&] {
        const ImageFileInfo file = identifyImageFile(path);
        if (file.format == ImageFormat::Exr) return readExrImage(path, options.limits);
        if (file.format == ImageFormat::Pfm) return readPfm(path, file.bytes, options.limits);
        if (file.format == ImageFormat::Png) return readPng(path, options.pngEncoding, options.limits);
        return readWithLibrary(path, file, options.limits);
    });
}

void writeImage(const std::string& path, int width, int height, std::span<const float> rgb,
                const WriteImageOptions& options) {
    const std::string extension = extensionOf(path);
    const Encoder encoder = encoderFor(extension, options);
    if (*encoder.format == '\0')
        failImage(path,
                  fmt::format("cannot write images of extension {}; known: png, jpg, jpeg, hdr, pfm, tif, tiff",
                              quote(extension)),
                  ErrorKind::Usage);
    if (encoder.bits != 8 && encoder.bits != 16 && (encoder.bits != 32 || extension == "png"))
        failImage(path, fmt::format("cannot write {} bits to a {} file", encoder.bits, extension), ErrorKind::Usage);
    AtomicFile file(path);  // first, so that a path that cannot be written is known before the work
    if (extension == "pfm") {
        file.write(encodePfm(width, height, rgb));
    } else {
        const bool isJpeg = encoder.format == std::string_view("jpeg");
        const OiioPicture picture{.format = encoder.format,
                                  .path = path.c_str(),
                                  .width = width,
                                  .height = height,
                                  .type = OiioValues::Floats,
                                  .values = rgb.data(),
                                  .compression = isJpeg ? fmt::format("jpeg:{}", options.jpegQuality) : "zip"};
        const std::vector<unsigned char> bytes =
            guardImage(path, ErrorKind::CannotWrite, [&] { return encodeImage(picture, encoder.bits, rgb); });
        file.write(bytes.data(), bytes.size());
    }
    file.commit();
}

void loadImageLibraryFor(const std::string& path) {
    const std::string extension = extensionOf(path);
    if (extension != "exr" && extension != "pfm") oiioFor(path);
}

ImageFileKind imageFileKind(const std::string& path, const WriteImageOptions& options) {
    const Encoder encoder = encoderFor(extensionOf(path), options);
    if (*encoder.format == '\0') return ImageFileKind::Unknown;
    return encoder.bits == 32 ? ImageFileKind::Linear : ImageFileKind::DisplayEncoded;
}

std::string imageLibraryVersion() {
    try {
        return "OpenImageIO " + oiio().version();
    } catch (const Error& e) {
        return fmt::format("OpenImageIO is not to be had: {}", e.what());
    }
}

}  // namespace penumbra
