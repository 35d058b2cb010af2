#include "tests/proof/closed_form_render.h"

#include "app/batch/render_job.h"
#include "core/base/error.h"
#include "scenes/readers.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

namespace penumbra {

namespace {

/// A new folder that goes with its contents at the end of its scope.
class TemporaryFolder {
public:
    TemporaryFolder() {
        path_ = (std::filesystem::temp_directory_path() / "penumbra-closed-form-XXXXXX").string();
        if (!mkdtemp(path_.data())) throw Error(ErrorKind::CannotCreate, "cannot make the folder " + path_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::string& path() const { return path_; }

    void write(const AnalyticSceneFile& file) const {
        const std::string name = path_ + "/" + file.name;
        std::ofstream stream(name, std::ios::binary);
        stream.write(file.bytes.data(), static_cast<std::streamsize>(file.bytes.size()));
        if (!stream.flush()) throw Error(ErrorKind::CannotWrite, "cannot write " + name);
    }

private:
    std::string path_;
};

Strategy strategyOf(const AnalyticScene& scene) {
    switch (scene.strategy) {
        case AnalyticScene::Strategy::LightSampling:
            return Strategy::LightOnly;
        case AnalyticScene::Strategy::ScatteringOnly:
            return Strategy::BsdfOnly;
        case AnalyticScene::Strategy::Both:
            break;
    }
    return Strategy::Mis;
}

std::array<double, 3> meanOf(const RenderJob& job) {
    std::array<double, 3> mean{};
    if (job.counts().invalid) {
        mean.fill(std::numeric_limits<double>::quiet_NaN());
        return mean;
    }
    const std::size_t pixels = job.film().pixelCount();
    for (std::size_t p = 0; p < pixels; ++p)
        for (std::size_t c = 0; c < 3; ++c)
            mean[c] += job.film().estimate(p).mean[c];
    for (double& m : mean)
        m /= static_cast<double>(pixels);
    return mean;
}

}  // namespace

PictureMean pictureMeanOfRenders() {
    return [](const AnalyticScene& scene, int samplesPerPixel, std::uint32_t seed) {
        const TemporaryFolder folder;
        for (const AnalyticSceneFile& file : scene.files)
            folder.write(file);
        RenderOptions options;
        options.build.samplesOverride = samplesPerPixel;
        options.build.seed = seed;
        options.build.strategy = strategyOf(scene);
        options.build.roulette = scene.roulette ? RouletteRule::Late : RouletteRule::Off;
        options.tileSize = 4;  // the pictures are small: enough tiles for every thread
        Warnings warnings(true);
        RenderJob job(readSceneText(scene.text, scene.id, folder.path(), warnings), options, warnings);
        job.run();
        return meanOf(job);
    };
}

}  // namespace penumbra
