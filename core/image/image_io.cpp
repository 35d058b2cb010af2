#include "core/image/image_io.h"

#include "core/base/atomic_file.h"
#include "core/image/essentials.h"
#include "core/image/pfm.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

const char* oiioName(ImageFormat format) {
    switch (format) {
        case ImageFormat::Png:
            return "png";
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
            break;  // read without OpenImageIO
    }
    return "";
}

/// OpenImageIO works in the caller's thread.
void configureLibrary() {
    static const bool once = OIIO::attribute("threads", 1);
    (void)once;
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

/// An open file. PNG and JPEG are read from memory, from which the parts that no picture needs have been taken away.
class Input {
public:
    Input(const std::string& path, ImageFormat format, const ImageLimits& limits) : path_(path) {
        if (format == ImageFormat::Png) bytes_ = pngEssentials(path, limits);
        if (format == ImageFormat::Jpeg) bytes_ = jpegEssentials(path, limits);
        // By format, never by path: open(path) would try other readers, whatever we have found the file to be.
        in_ = OIIO::ImageInput::create(oiioName(format));
        if (!in_) refuse(path, OIIO::geterror());
        if (!bytes_.empty()) {
            memory_ = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes_.data(), bytes_.size());
            in_->set_ioproxy(memory_.get());
        }
        OIIO::ImageSpec spec, wishes;
        wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored, not multiplied by alpha
        in_->threads(1);
        if (!in_->open(path, spec, wishes)) refuse(path, in_->geterror());
    }

    const OIIO::ImageSpec& spec() const { return in_->spec(); }

    /// The first channels of all pixels.
    template <class T>
    std::vector<T> pixels(OIIO::TypeDesc type, int channels) {
        std::vector<T> out(std::size_t(spec().width) * spec().height * channels);
        if (!in_->read_image(0, 0, 0, channels, type, out.data())) refuse(path_, in_->geterror());
        return out;
    }

private:
    const std::string& path_;
    std::string bytes_;
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;  // before in_, which uses it to its end
    std::unique_ptr<OIIO::ImageInput> in_;
};

/// How many of the file's channels make the image: grey with alpha gives grey, alpha is kept of PNG only.
int keptChannels(ImageFormat format, int inFile) {
    if (inFile <= 2) return 1;
    return inFile == 4 && format == ImageFormat::Png ? 4 : 3;
}

Image readWithLibrary(const std::string& path, const ImageFileInfo& file, const ReadImageOptions& options) {
    configureLibrary();
    Input in(path, file.format, options.limits);
    const OIIO::ImageSpec& spec = in.spec();
    if (spec.nchannels < 1 || spec.depth > 1 || spec.deep) refuse(path, "not a flat picture");

    const int channels = keptChannels(file.format, spec.nchannels);
    const bool isByte = spec.format == OIIO::TypeUInt8;
    const std::uint64_t fileBytes = spec.format.size() * spec.nchannels;
    checkImageSize(path, spec.width, spec.height,
                   std::max<std::uint64_t>(fileBytes, isByte ? 1 : channels * sizeof(float)), file.bytes,
                   options.limits, file.format == ImageFormat::Hdr ? 4 * kMostExpansion : kMostExpansion);

    const TransferFunction encoding = file.format == ImageFormat::Png ? options.pngEncoding : TransferFunction::srgb();
    if (isByte)
        return Image(spec.width, spec.height, channels, in.pixels<std::uint8_t>(OIIO::TypeUInt8, channels), encoding);
    const bool isLinear = spec.format.is_floating_point();
    std::vector<float> pixels = in.pixels<float>(OIIO::TypeFloat, channels);
    if (!isLinear)
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

std::vector<unsigned char> encode(const std::string& path, const Encoder& encoder, OIIO::ImageSpec spec,
                                  const void* pixels) {
    configureLibrary();
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput proxy(bytes);
    const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(encoder.format);
    const auto fail = [&](const std::string& reason) {
        failImage(path, "cannot encode: " + firstLine(reason), ErrorKind::CannotWrite);
    };
    if (!out) fail(OIIO::geterror());
    out->threads(1);
    if (!out->set_ioproxy(&proxy)) fail("the library cannot encode to memory");
    if (!out->open(path, spec)) fail(out->geterror());
    if (!out->write_image(spec.format, pixels) || !out->close()) fail(out->geterror());
    return bytes;
}

std::vector<unsigned char> encodeImage(const std::string& path, const Encoder& encoder, OIIO::ImageSpec spec,
                                       std::span<const float> rgb) {
    if (encoder.bits == 8) {
        spec.format = OIIO::TypeUInt8;
        return encode(path, encoder, spec, quantise<std::uint8_t>(rgb, 255).data());
    }
    if (encoder.bits == 16) {
        spec.format = OIIO::TypeUInt16;
        return encode(path, encoder, spec, quantise<std::uint16_t>(rgb, 65535).data());
    }
    if (std::string_view(encoder.format) != "hdr") return encode(path, encoder, spec, rgb.data());
    std::vector<float> positive(rgb.begin(), rgb.end());
    for (float& v : positive)
        v = v > 0 ? std::min(v, 1e30f) : 0;  // no sign, no infinity, no not-a-number in RGBE
    return encode(path, encoder, spec, positive.data());
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
        return readWithLibrary(path, file, options);
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
        OIIO::ImageSpec spec(width, height, 3, OIIO::TypeFloat);
        spec.attribute("Compression", encoder.format == std::string_view("jpeg")
                                          ? fmt::format("jpeg:{}", options.jpegQuality)
                                          : "zip");
        spec.attribute("jpeg:subsampling", "4:4:4");
        spec.attribute("DateTime", "    :  :     :  :  ");  // Exif's "unknown", or TIFF would get the clock's
        const std::vector<unsigned char> bytes =
            guardImage(path, ErrorKind::CannotWrite, [&] { return encodeImage(path, encoder, spec, rgb); });
        file.write(bytes.data(), bytes.size());
    }
    file.commit();
}

ImageFileKind imageFileKind(const std::string& path, const WriteImageOptions& options) {
    const Encoder encoder = encoderFor(extensionOf(path), options);
    if (*encoder.format == '\0') return ImageFileKind::Unknown;
    return encoder.bits == 32 ? ImageFileKind::Linear : ImageFileKind::DisplayEncoded;
}

std::string imageLibraryVersion() {
    const int version = OIIO::openimageio_version();
    return fmt::format("OpenImageIO {}.{}.{}", version / 10000, version / 100 % 100, version % 100);
}

}  // namespace penumbra
