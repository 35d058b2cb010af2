// penumbra convert: from a picture in linear light to one for a screen, through OpenColorIO.

#include "app/batch/render_job.h"
#include "app/commands/arguments.h"
#include "app/commands/commands.h"
#include "app/commands/console.h"
#include "core/base/text.h"
#include "core/color/display.h"
#include "core/image/image_io.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>

namespace penumbra {
namespace {

constexpr char kExamples[] =
    "Colours go through a display and a view of an OpenColorIO configuration: --ocio, else $OCIO, else a built-in\n"
    "one with the views Standard (the sRGB curve alone), ACES and Raw. HDR, PFM and 32-bit TIFF stay linear.\n"
    "\n"
    "Examples:\n"
    "  penumbra convert picture.exr picture.png --exposure 1.5 --view ACES\n"
    "  penumbra convert picture.exr error.png --layer SE --exposure 4\n"
    "  penumbra convert --list-views --ocio config.ocio\n";

struct ConvertRequest {
    std::string from, to, layer;
    DisplayOptions display;
    WriteImageOptions write;
    bool listViews = false, quiet = false;
};

/// Linear pixels, r g b.
struct Picture {
    int width = 0, height = 0;
    std::vector<float> rgb;
    const ColorSpace* space = &srgbColorSpace();
};

Picture readPicture(const std::string& path) {
    const Image image = readImage(path);
    Picture picture{image.width(), image.height(), {}, &image.colorSpace()};
    picture.rgb.reserve(std::size_t(image.width()) * std::size_t(image.height()) * 3);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Rgb c = image.rgb(x, y);
            picture.rgb.insert(picture.rgb.end(), {c.r, c.g, c.b});
        }
    return picture;
}

/// What --layer may name: channels, and what stands before the last point of several.
std::vector<std::string> layersOf(const ExrFile& file) {
    std::set<std::string> names;
    for (const ExrChannel& channel : file.header.channels) {
        names.insert(channel.name);
        if (const std::size_t point = channel.name.rfind('.'); point != std::string::npos)
            names.insert(channel.name.substr(0, point));
    }
    return {names.begin(), names.end()};
}

/// One channel of the file as floats; null where there is none of that name.
std::unique_ptr<std::vector<float>> channelOf(const ExrFile& file, const std::string& name) {
    for (std::size_t i = 0; i < file.header.channels.size(); ++i) {
        if (file.header.channels[i].name != name) continue;
        if (file.header.channels[i].type == ExrChannel::Type::Float)
            return std::make_unique<std::vector<float>>(file.floats[i]);
        return std::make_unique<std::vector<float>>(file.uints[i].begin(), file.uints[i].end());
    }
    return nullptr;
}

/// The channels LAYER.R, LAYER.G, LAYER.B (or X, Y, Z, or U, V and 0), or the one channel of that name as grey.
Picture readLayer(const std::string& path, const std::string& layer) {
    const ExrFile file = readExr(path);
    std::unique_ptr<std::vector<float>> planes[3];
    for (const char* suffixes : {"RGB", "XYZ", "UV"})
        for (int c = 0; c < 3 && suffixes[c]; ++c)
            if (!planes[c]) planes[c] = channelOf(file, layer + "." + suffixes[c]);
    if (planes[0] && planes[1] && !planes[2]) planes[2] = std::make_unique<std::vector<float>>(planes[0]->size(), 0.f);
    const auto grey = channelOf(file, layer);
    const bool whole = planes[0] && planes[1];
    if (!whole && !grey) {
        const std::vector<std::string> known = layersOf(file);
        throw Error(ErrorKind::Usage,
                    pathText(path) + ": no layer or channel " + quote(layer) + suggestion(layer, known));
    }
    Picture picture{file.header.dataWindow.width(), file.header.dataWindow.height(), {}, &srgbColorSpace()};
    if (file.header.colorSpace) picture.space = file.header.colorSpace;
    const std::size_t pixels = std::size_t(picture.width) * std::size_t(picture.height);
    picture.rgb.resize(pixels * 3);
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            picture.rgb[3 * i + c] = whole ? (*planes[c])[i] : (*grey)[i];
    return picture;
}

void listViews(const std::string& config) {
    std::string text;
    for (const DisplayList& display : listDisplays(config))
        text += fmt::format("{}: {}\n", display.display, fmt::join(display.views, ", "));
    printOut(text);
}

std::string toDisplay(Picture& picture, const DisplayOptions& options) {
    const std::size_t broken =
        std::size_t(std::count_if(picture.rgb.begin(), picture.rgb.end(), [](float v) { return !std::isfinite(v); }));
    if (broken) printWarning(fmt::format("{} values of the picture are not finite; they are shown as black", broken));
    const DisplayTransform transform(options, *picture.space);
    transform.apply(picture.rgb);
    return transform.description();
}

void checkPaths(const ConvertRequest& request) {
    if (request.to.empty()) throw Error(ErrorKind::Usage, "two pictures are needed: penumbra convert FROM TO");
    if (extensionOf(request.to) == "exr")
        throw Error(ErrorKind::Usage, pathText(request.to) +
                                          ": convert writes pictures for a screen (png, jpg, tif) and linear hdr, pfm");
    checkPicturePath(request.to);
    checkKeepsInputs(request.to, {.texts = {request.from}, .assets = {}, .hash = ""});
}

void runConvert(const ConvertRequest& request) {
    if (request.listViews) return listViews(request.display.config);
    checkPaths(request);
    Picture picture = request.layer.empty() ? readPicture(request.from) : readLayer(request.from, request.layer);
    std::string how = "linear";
    if (imageFileKind(request.to, request.write) == ImageFileKind::DisplayEncoded)
        how = "through " + toDisplay(picture, request.display);
    else
        for (float& v : picture.rgb)
            v *= std::exp2(request.display.exposure);
    writeImage(request.to, picture.width, picture.height, picture.rgb, request.write);
    if (!request.quiet)
        printNote(fmt::format("wrote {}: {}x{}, {}", pathText(request.to), picture.width, picture.height, how));
}

}  // namespace

Command addConvertCommand(CLI::App& program) {
    CLI::App& command = *program.add_subcommand("convert", "make a picture for a screen, or show a layer of an EXR");
    command.footer(kExamples);
    const auto request = std::make_shared<ConvertRequest>();
    Arguments arguments(command);
    ConvertRequest& r = *request;
    arguments.positional("FROM", r.from, "an EXR, HDR, PFM, TIFF, PNG, JPEG or TGA picture");
    arguments.positional("TO", r.to, "the picture to write: .png .jpg .tif .hdr .pfm");
    arguments.group("Colour");
    arguments.real("--exposure", "STOPS", -100, 100, r.display.exposure, "brighten by 2^STOPS first (default: 0)");
    arguments.text("--display", "NAME", "the display (default: the configuration's)",
                   [&r](const std::string& t) { r.display.display = t; });
    arguments.text("--view", "NAME", "the view (default: the display's; built in: Standard)",
                   [&r](const std::string& t) { r.display.view = t; });
    arguments.text("--ocio", "FILE", "the OpenColorIO configuration (default: $OCIO, else built in)",
                   [&r](const std::string& t) { r.display.config = t; });
    arguments.text("--input-space", "NAME",
                   "the colour space of the pixels, as the configuration names it (default: as the picture says)",
                   [&r](const std::string& t) { r.display.inputSpace = t; });
    arguments.flag("--list-views", r.listViews, "print the displays and their views, and do nothing else");
    arguments.group("Picture");
    arguments.text("--layer", "NAME",
                   "a layer (SE: the standard error) or one channel (samples) of an EXR, instead of its colours",
                   [&r](const std::string& t) { r.layer = t; });
    arguments.whole("--bits", "N", {8, 32}, r.write.bits,
                    "of PNG and TIFF: 8 or 16; of TIFF also 32, linear floats (default: 8)");
    arguments.whole("--quality", "N", {1, 100}, r.write.jpegQuality, "of JPEG, 1 to 100 (default: 95)");
    arguments.flag("--quiet", r.quiet, "say nothing but warnings and errors");
    arguments.help();
    return {&command, [request] { runConvert(*request); }};
}

}  // namespace penumbra
