#include "core/image/exr.h"

#include "core/base/atomic_file.h"
#include "core/image/exr_scan.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>

namespace penumbra {
namespace {

constexpr int kNoThreads = 0;   // OpenEXR works in the caller's thread
constexpr int kBlockRows = 16;  // rows that ZIP compresses together

Imath::Box2i boxOf(const PixelWindow& w) {
    return {{w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}};
}
PixelWindow windowOf(const Imath::Box2i& b) {
    return {b.min.x, b.min.y, b.max.x + 1, b.max.y + 1};
}
Chromaticity chromaticityOf(const Imath::V2f& v) {
    return {v.x, v.y};
}
Imath::V2f vectorOf(Chromaticity c) {
    return {float(c.x), float(c.y)};
}

/// OpenEXR's output, going into an AtomicFile. OpenEXR's destructors swallow exceptions, so the first failure is kept.
class AtomicStream : public Imf::OStream {
public:
    explicit AtomicStream(AtomicFile& file, const std::string& path) : Imf::OStream(path.c_str()), file_(file) {}
    void write(const char bytes[], int count) override {
        try {
            file_.write(bytes, std::size_t(count));
        } catch (...) {
            if (!failure_) failure_ = std::current_exception();
            throw;
        }
    }
    std::uint64_t tellp() override { return file_.position(); }
    void seekp(std::uint64_t position) override { file_.seek(position); }
    void rethrowFailure() const {
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    AtomicFile& file_;
    std::exception_ptr failure_;
};

Imf::PixelType pixelType(ExrChannel::Type type) {
    return type == ExrChannel::Type::Uint ? Imf::UINT : Imf::FLOAT;
}

void insertAttribute(Imf::Header& header, const std::string& name, const std::string& value) {
    header.insert(name, Imf::StringAttribute(value));
}
void insertAttribute(Imf::Header& header, const std::string& name, int value) {
    header.insert(name, Imf::IntAttribute(value));
}
void insertAttribute(Imf::Header& header, const std::string& name, float value) {
    header.insert(name, Imf::FloatAttribute(value));
}
void insertAttribute(Imf::Header& header, const std::string& name, const std::array<float, 16>& m) {
    Imath::M44f matrix;
    std::copy(m.begin(), m.end(), matrix.getValue());
    header.insert(name, Imf::M44fAttribute(matrix));
}

Imf::Header libraryHeader(const ExrHeader& header) {
    Imf::Header out(boxOf(header.displayWindow), boxOf(header.dataWindow));
    out.compression() = Imf::ZIP_COMPRESSION;
    for (const ExrChannel& channel : header.channels)
        out.channels().insert(channel.name, Imf::Channel(pixelType(channel.type)));
    if (const ColorSpace* s = header.colorSpace)
        Imf::addChromaticities(out, {vectorOf(s->red), vectorOf(s->green), vectorOf(s->blue), vectorOf(s->white)});
    for (const auto& [name, value] : header.attributes)
        std::visit([&, &n = name](const auto& v) { insertAttribute(out, n, v); }, value);
    return out;
}

/// The values of a block of rows: one plane per channel, and the views on it that the library and the caller want.
class BlockBuffer {
public:
    BlockBuffer(const std::vector<ExrChannel>& channels, const PixelWindow& window)
        : channels_(channels), window_(window) {
        for (const ExrChannel& c : channels) {
            const std::size_t count = std::size_t(window.width()) * kBlockRows;
            floats_.emplace_back(c.type == ExrChannel::Type::Float ? count : 0);
            uints_.emplace_back(c.type == ExrChannel::Type::Uint ? count : 0);
        }
    }

    ExrBlock view(int firstRow, int rows) {
        const std::size_t count = std::size_t(window_.width()) * rows;
        ExrBlock block{firstRow, rows, {}, {}};
        for (std::size_t i = 0; i < channels_.size(); ++i) {
            block.floats.push_back(std::span(floats_[i]).first(std::min(count, floats_[i].size())));
            block.uints.push_back(std::span(uints_[i]).first(std::min(count, uints_[i].size())));
        }
        return block;
    }

    Imf::FrameBuffer frameBuffer(int firstRow, int rows) {
        Imf::FrameBuffer out;
        for (std::size_t i = 0; i < channels_.size(); ++i) {
            const void* data = floats_[i].empty() ? static_cast<void*>(uints_[i].data()) : floats_[i].data();
            out.insert(channels_[i].name, Imf::Slice::Make(pixelType(channels_[i].type), data, {window_.x0, firstRow},
                                                           window_.width(), rows));
        }
        return out;
    }

private:
    const std::vector<ExrChannel>& channels_;
    PixelWindow window_;
    std::vector<std::vector<float>> floats_;
    std::vector<std::vector<std::uint32_t>> uints_;
};

void writeBlocks(Imf::OutputFile& file, const ExrHeader& header, const std::function<void(const ExrBlock&)>& fill) {
    const PixelWindow& window = header.dataWindow;
    BlockBuffer buffer(header.channels, window);
    for (int row = window.y0; row < window.y1; row += kBlockRows) {
        const int rows = std::min(kBlockRows, window.y1 - row);
        fill(buffer.view(row, rows));
        file.setFrameBuffer(buffer.frameBuffer(row, rows));
        file.writePixels(rows);
    }
}

/// The attributes whose types ExrAttribute has, but for those that the header's other members hold.
void readAttributes(const Imf::Header& from, ExrHeader& to) {
    for (auto a = from.begin(); a != from.end(); ++a) {
        const Imf::Attribute& attribute = a.attribute();
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute))
            to.attributes.emplace_back(a.name(), text->value());
        else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&attribute))
            to.attributes.emplace_back(a.name(), integer->value());
        else if (const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
            to.attributes.emplace_back(a.name(), number->value());
        else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute)) {
            std::array<float, 16> m;
            std::copy_n(matrix->value().getValue(), m.size(), m.begin());
            to.attributes.emplace_back(a.name(), m);
        }
    }
}

const ColorSpace* colorSpaceIn(const Imf::Header& header) {
    if (!Imf::hasChromaticities(header)) return nullptr;
    const Imf::Chromaticities c = Imf::chromaticities(header);
    return findColorSpace(chromaticityOf(c.red), chromaticityOf(c.green), chromaticityOf(c.blue),
                          chromaticityOf(c.white));
}

/// Opens a file whose headers have been found plausible.
Imf::InputFile openExr(const std::string& path, const ImageLimits& limits) {
    checkExrHeaders(path, identifyImageFile(path).bytes, limits);
    return Imf::InputFile(path.c_str(), kNoThreads);
}

void refuseSubsampled(const std::string& path, const Imf::ChannelList& channels) {
    for (auto c = channels.begin(); c != channels.end(); ++c)
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
            failImage(path, fmt::format("channel {} is subsampled, which is not supported", quote(c.name())));
}

/// The channels that make a picture, in the order of Image: R G B [A], or one.
std::vector<std::string> pictureChannels(const Imf::ChannelList& channels, const std::string& path) {
    const auto has = [&](const std::string& name) { return channels.findChannel(name) != nullptr; };
    const auto colors = [&](const std::string& prefix) -> std::optional<std::vector<std::string>> {
        std::vector<std::string> names{prefix + "R", prefix + "G", prefix + "B"};
        if (!std::all_of(names.begin(), names.end(), has)) return std::nullopt;
        if (has(prefix + "A")) names.push_back(prefix + "A");
        return names;
    };
    if (const auto names = colors("")) return *names;
    if (has("Y")) return {"Y"};
    std::vector<std::string> all;
    for (auto c = channels.begin(); c != channels.end(); ++c) {
        all.emplace_back(c.name());
        const std::size_t dot = all.back().rfind('.');
        if (dot == std::string::npos) continue;
        if (const auto names = colors(all.back().substr(0, dot + 1))) return *names;
    }
    if (all.size() == 1) return all;
    failImage(path, fmt::format("among its {} channels are neither R, G and B nor Y", all.size()));
}

}  // namespace

void writeExr(const std::string& path, const ExrHeader& header, const std::function<void(const ExrBlock&)>& fill) {
    AtomicFile file(path);
    guardImage(path, ErrorKind::CannotWrite, [&] {
        AtomicStream stream(file, path);
        {
            Imf::OutputFile out(stream, libraryHeader(header), kNoThreads);
            writeBlocks(out, header, fill);
        }
        stream.rethrowFailure();
    });
    file.commit();
}

const std::vector<float>* ExrFile::find(std::string_view channel) const {
    for (std::size_t i = 0; i < header.channels.size(); ++i)
        if (header.channels[i].name == channel && header.channels[i].type == ExrChannel::Type::Float) return &floats[i];
    return nullptr;
}

ExrFile readExr(const std::string& path, const ImageLimits& limits) {
    return guardImage(path, ErrorKind::BadData, [&] {
        Imf::InputFile in = openExr(path, limits);
        const Imf::Header& header = in.header();
        refuseSubsampled(path, header.channels());
        ExrFile file;
        file.header.dataWindow = windowOf(header.dataWindow());
        file.header.displayWindow = windowOf(header.displayWindow());
        file.header.colorSpace = colorSpaceIn(header);
        readAttributes(header, file.header);

        const PixelWindow window = file.header.dataWindow;
        const std::size_t count = std::size_t(window.width()) * window.height();
        Imf::FrameBuffer frame;
        for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
            const bool isUint = c.channel().type == Imf::UINT;
            file.header.channels.push_back({c.name(), isUint ? ExrChannel::Type::Uint : ExrChannel::Type::Float});
            void* data = isUint ? static_cast<void*>(file.uints.emplace_back(count).data())
                                : file.floats.emplace_back(count).data();
            if (isUint)
                file.floats.emplace_back();
            else
                file.uints.emplace_back();
            frame.insert(c.name(), Imf::Slice::Make(isUint ? Imf::UINT : Imf::FLOAT, data, header.dataWindow()));
        }
        in.setFrameBuffer(frame);
        in.readPixels(window.y0, window.y1 - 1);
        return file;
    });
}

Image readExrImage(const std::string& path, const ImageLimits& limits) {
    return guardImage(path, ErrorKind::BadData, [&] {
        Imf::InputFile in = openExr(path, limits);
        const Imf::Header& header = in.header();
        refuseSubsampled(path, header.channels());
        const std::vector<std::string> names = pictureChannels(header.channels(), path);
        const PixelWindow window = windowOf(header.dataWindow());
        const std::uint64_t fileBytes = 0, pixelBytes = names.size() * sizeof(float);
        checkImageSize(path, window.width(), window.height(), pixelBytes, fileBytes, limits, 0);

        std::vector<float> pixels(std::size_t(window.width()) * window.height() * names.size());
        Imf::FrameBuffer frame;
        for (std::size_t c = 0; c < names.size(); ++c)
            frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, pixels.data() + c, header.dataWindow(), pixelBytes,
                                                    pixelBytes * window.width()));
        in.setFrameBuffer(frame);
        in.readPixels(window.y0, window.y1 - 1);
        const ColorSpace* space = colorSpaceIn(header);
        return Image(window.width(), window.height(), int(names.size()), std::move(pixels),
                     space ? *space : srgbColorSpace());
    });
}

std::string exrLibraryVersion() { return std::string("OpenEXR ") + OPENEXR_VERSION_STRING; }

}  // namespace penumbra
