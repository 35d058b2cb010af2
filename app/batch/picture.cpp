// The files that a render leaves: RenderJob::writePicture.

#include "app/batch/pixels.h"
#include "app/batch/recipe.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/color/display.h"
#include "core/image/image_io.h"

#include <filesystem>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

/// A device or a pipe, whose name says nothing of the format.
bool isSpecialFile(const std::string& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// In the order in which a film gives them.
std::vector<std::string> aovChannels(const AovSet& set) {
    std::vector<std::string> names;
    for (const AovKind& kind : aovKinds()) {
        if (!set.has(kind.aov)) continue;
        const std::string name(kind.name);
        if (kind.suffixes.empty()) names.push_back(name);
        for (const char suffix : kind.suffixes)
            names.push_back(name + "." + suffix);
    }
    return names;
}

void writeExrPicture(const RenderJob& job, const std::string& path) {
    const CropWindow& crop = job.film().crop();
    const FilmSettings& settings = job.scene().film;
    using Type = ExrChannel::Type;
    ExrHeader header;
    header.dataWindow = {crop.x0, crop.y0, crop.x1, crop.y1};
    header.displayWindow = {0, 0, settings.width, settings.height};
    header.channels = {{"R", Type::Float},    {"G", Type::Float},    {"B", Type::Float},    {"A", Type::Float},
                       {"SE.R", Type::Float}, {"SE.G", Type::Float}, {"SE.B", Type::Float}, {"samples", Type::Uint}};
    const std::size_t firstAov = header.channels.size();
    for (const std::string& name : aovChannels(settings.aovs))
        header.channels.push_back({name, Type::Float});
    header.colorSpace = findColorSpace(settings.colorSpace);
    header.attributes = {{"penumbra", recipeJson(job)}, {"samplesPerPixel", job.scene().samplesPerPixel}};
    std::vector<float> aovs(header.channels.size() - firstAov);
    writeExr(path, header, [&](const ExrBlock& block) {
        const int firstRow = block.firstRow - crop.y0;
        visitPixels(job, {0, firstRow, crop.width(), firstRow + block.rows}, [&](std::size_t to, std::size_t pixel) {
            const PixelEstimate e = job.film().estimate(pixel);
            for (std::size_t c = 0; c < 3; ++c) {
                block.floats[c][to] = float(e.mean[c]);
                block.floats[4 + c][to] = float(e.standardError[c]);
            }
            block.floats[3][to] = float(e.alpha);
            block.uints[7][to] = e.samples;
            if (aovs.empty()) return;
            job.film().estimateAovs(pixel, aovs);
            for (std::size_t c = 0; c < aovs.size(); ++c)
                block.floats[firstAov + c][to] = aovs[c];
        });
    });
}

}  // namespace

bool isExrPath(const std::string& path) {
    if (imageFileKind(path) != ImageFileKind::Unknown) return false;
    return extensionOf(path) == "exr" || isSpecialFile(path);
}

std::string RenderJob::writePicture(const std::string& path) const {
    if (isExrPath(path)) {
        writeExrPicture(*this, path);
        return "";
    }
    std::vector<float> rgb(film_.pixelCount() * 3);
    visitPixels(*this, {0, 0, film_.crop().width(), film_.crop().height()}, [&](std::size_t to, std::size_t pixel) {
        const PixelEstimate e = film_.estimate(pixel);
        for (std::size_t c = 0; c < 3; ++c)
            rgb[3 * to + c] = float(e.mean[c]);
    });
    std::string through;
    if (imageFileKind(path) == ImageFileKind::DisplayEncoded) {
        const DisplayTransform display({}, *findColorSpace(scene_.film.colorSpace));
        display.apply(rgb);
        through = display.description();
    }
    writeImage(path, film_.crop().width(), film_.crop().height(), rgb);
    return through;
}

void checkPicturePath(const std::string& path) {
    std::error_code ignored;
    if (path.empty() || fs::is_directory(path, ignored))
        throw Error(ErrorKind::CannotCreate, quote(path) + ": a picture needs the name of a file");
    if (!isExrPath(path) && imageFileKind(path) == ImageFileKind::Unknown)
        throw Error(ErrorKind::Usage,
                    pathText(path) + ": unknown kind of picture; known extensions: exr, png, jpg, tif, hdr, pfm");
    const fs::path folder = fs::path(path).parent_path();
    if (!folder.empty() && !fs::is_directory(folder, ignored))
        throw Error(ErrorKind::CannotCreate,
                    pathText(path) + ": there is no folder " + quote(folder.string()));
    removeAbandonedTemporaries(path);
    const AtomicFile attempt(path);
    loadImageLibraryFor(path);  // the installation may be incomplete
    if (imageFileKind(path) == ImageFileKind::DisplayEncoded)
        DisplayTransform({}, srgbColorSpace());  // $OCIO may be wrong
}

void checkKeepsInputs(const std::string& path, const SceneInputs& inputs) {
    for (const std::vector<std::string>* files : {&inputs.texts, &inputs.assets})
        for (const std::string& file : *files) {
            std::error_code different;
            if (fs::equivalent(path, file, different))
                throw Error(ErrorKind::CannotCreate,
                            pathText(path) + ": is a file of the scene and is not overwritten");
        }
}

}  // namespace penumbra
