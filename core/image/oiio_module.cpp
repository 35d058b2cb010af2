#include "core/image/oiio_module.h"

#include "core/base/version.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <new>

namespace penumbra {
namespace {

/// Runs `work`, which returns an OiioResult; what the library throws becomes one.
template <class Work>
OiioResult guarded(const Work& work) noexcept {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return OiioFailure{{}, true};
    } catch (const std::exception& e) {
        return OiioFailure{e.what()};
    } catch (...) {
        return OiioFailure{};
    }
}

OIIO::TypeDesc typeOf(OiioValues values) {
    switch (values) {
        case OiioValues::Bytes:
            return OIIO::TypeUInt8;
        case OiioValues::Words:
            return OIIO::TypeUInt16;
        case OiioValues::Floats:
            break;
    }
    return OIIO::TypeFloat;
}

OiioValues valuesOf(OIIO::TypeDesc type) {
    if (type == OIIO::TypeUInt8) return OiioValues::Bytes;
    return type.is_floating_point() ? OiioValues::Floats : OiioValues::Words;
}

class Reader final : public OiioReader {
public:
    OiioResult open(const OiioFile& file) {
        in_ = OIIO::ImageInput::create(file.format);
        if (!in_) return OiioFailure{OIIO::geterror()};
        if (!file.bytes.empty()) {
            memory_ = std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<char*>(file.bytes.data()),
                                                                      file.bytes.size());
            in_->set_ioproxy(memory_.get());
        }
        OIIO::ImageSpec spec, wishes;
        wishes.attribute("oiio:UnassociatedAlpha", 1);
        in_->threads(1);
        if (!in_->open(file.path, spec, wishes)) return OiioFailure{in_->geterror()};
        return std::nullopt;
    }

    OiioSpec spec() const noexcept override {
        const OIIO::ImageSpec& spec = in_->spec();
        return {.width = spec.width,
                .height = spec.height,
                .channels = spec.nchannels,
                .isFlat = spec.depth <= 1 && !spec.deep,
                .values = valuesOf(spec.format),
                .bytesPerPixel = spec.format.size() * std::size_t(spec.nchannels)};
    }

    OiioResult read(int channels, OiioValues type, void* to) noexcept override {
        return guarded([&]() -> OiioResult {
            if (!in_->read_image(0, 0, 0, channels, typeOf(type), to)) return OiioFailure{in_->geterror()};
            return std::nullopt;
        });
    }

private:
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;  // before in_, which uses it to its end
    std::unique_ptr<OIIO::ImageInput> in_;
};

class Module final : public OiioModule {
public:
    /// OpenImageIO works in the caller's thread.
    Module() { OIIO::attribute("threads", 1); }

    std::string version() const override {
        const int version = OIIO::openimageio_version();
        return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
               std::to_string(version % 100);
    }

    OiioResult open(const OiioFile& file, std::unique_ptr<OiioReader>& reader) const noexcept override {
        return guarded([&] {
            auto opened = std::make_unique<Reader>();
            OiioResult failure = opened->open(file);
            if (!failure) reader = std::move(opened);
            return failure;
        });
    }

    OiioResult encode(const OiioPicture& picture, std::vector<unsigned char>& bytes) const noexcept override {
        return guarded([&]() -> OiioResult {
            OIIO::ImageSpec spec(picture.width, picture.height, 3, typeOf(picture.type));
            spec.attribute("Compression", picture.compression);
            spec.attribute("jpeg:subsampling", "4:4:4");
            spec.attribute("DateTime", "    :  :     :  :  ");  // Exif's "unknown", or TIFF would get the clock's
            OIIO::Filesystem::IOVecOutput proxy(bytes);
            const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(picture.format);
            if (!out) return OiioFailure{OIIO::geterror()};
            out->threads(1);
            if (!out->set_ioproxy(&proxy)) return OiioFailure{"the library cannot encode to memory"};
            if (!out->open(picture.path, spec) || !out->write_image(spec.format, picture.values) || !out->close())
                return OiioFailure{out->geterror()};
            return std::nullopt;
        });
    }
};

}  // namespace
}  // namespace penumbra

extern "C" __attribute__((visibility("default"))) const penumbra::OiioModule* penumbraOiioModule(
    const char* programVersion) {
    static const penumbra::Module module;
    return std::string_view(programVersion) == penumbra::kVersion ? &module : nullptr;
}
