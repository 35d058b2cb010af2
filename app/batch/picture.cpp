// The files that a render leaves: RenderJob::writePicture.

#include "app/batch/render_job.h"
#include "core/base/error.h"
#include "core/base/version.h"
#include "core/color/display.h"
#include "core/image/image_io.h"

#include <nlohmann/json.hpp>

#include <filesystem>

namespace penumbra {
namespace {

bool isExr(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension == ".exr";
}

std::size_t pixelNumber(const CropWindow& crop, int x, int row) {
    return std::size_t(row) * std::size_t(crop.width()) + std::size_t(x);
}

/// Everything that it takes to render the same bits again.
nlohmann::json recipe(const RenderJob& job) {
    const Scene& s = job.scene();
    const RenderOptions& o = job.options();
    return {
        {"schema", 1},
        {"program", std::string("penumbra ") + kVersion},
        {"command", o.command},
        {"scene", o.scene},
        {"samples", {0, s.samplesPerPixel}},
        {"seed", s.seed},
        {"replicates", o.replicates},
        {"sampler", s.sampler.info().name},
        {"integrator", s.integrator.name},
        {"maxdepth", s.integrator.maxDepth},
        {"roulette", rouletteName(s.integrator.roulette)},
        {"strategy", strategyName(s.integrator.strategy)},
        {"intersection", o.build.intersection == IntersectionMode::Robust ? "robust" : "fast"},
        {"embree", Accelerator::libraryVersion()},
        {"native", kNativeBuild},
        {"invalid_samples", job.counts().invalid},
        {"error", o.replicates == 1 ? "independent-sample estimate" : "spread of replicates"},
    };
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
    header.colorSpace = findColorSpace(settings.colorSpace);
    header.attributes = {{"penumbra", recipe(job).dump()}, {"samplesPerPixel", job.scene().samplesPerPixel}};
    writeExr(path, header, [&](const ExrBlock& block) {
        std::size_t to = 0;
        for (int row = block.firstRow; row < block.firstRow + block.rows; ++row)
            for (int x = 0; x < crop.width(); ++x, ++to) {
                const PixelEstimate e = job.film().estimate(pixelNumber(crop, x, row - crop.y0));
                for (std::size_t c = 0; c < 3; ++c) {
                    block.floats[c][to] = float(e.mean[c]);
                    block.floats[4 + c][to] = float(e.standardError[c]);
                }
                block.floats[3][to] = float(e.alpha);
                block.uints[7][to] = e.samples;
            }
    });
}

}  // namespace

void RenderJob::writePicture(const std::string& path) const {
    if (isExr(path)) return writeExrPicture(*this, path);
    const CropWindow& crop = film_.crop();
    std::vector<float> rgb;
    rgb.reserve(film_.pixelCount() * 3);
    for (std::size_t i = 0; i < film_.pixelCount(); ++i) {
        const PixelEstimate e = film_.estimate(i);
        for (double v : e.mean) rgb.push_back(float(v));
    }
    if (imageFileKind(path) == ImageFileKind::DisplayEncoded)
        DisplayTransform({}, *findColorSpace(scene_.film.colorSpace)).apply(rgb);
    writeImage(path, crop.width(), crop.height(), rgb);
}

void checkPicturePath(const std::string& path) {
    namespace fs = std::filesystem;
    if (!isExr(path) && imageFileKind(path) == ImageFileKind::Unknown)
        throw Error(ErrorKind::Usage, path + ": unknown kind of picture; known: exr, png, jpg, tif, hdr, pfm");
    const fs::path folder = fs::path(path).parent_path();
    std::error_code failed;
    if (!folder.empty() && !fs::is_directory(folder, failed))
        throw Error(ErrorKind::CannotCreate, path + ": there is no folder '" + folder.string() + "'");
}

}  // namespace penumbra
