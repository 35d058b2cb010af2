// A sample is a function of the scene, the settings, the pixel and its number, of nothing else: threads, tiles,
// batches, lanes and the order of the work change no bit of the film or of the file.
#include "core/base/parallel.h"
#include "integrators/registry.h"
#include "tests/integrators_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <random>
#include <set>
#include <thread>

namespace penumbra {
namespace {

using namespace test;

/// Holds every thread at its first rays until as many as expected have come; so each of them has a share of the work.
class Workers final : public RayRecorder {
public:
    explicit Workers(std::size_t expected) : expected_(expected) {}
    void nearest(const RayHitPacket&, unsigned, Coherence) override {
        std::unique_lock lock(mutex_);
        if (!threads_.insert(std::this_thread::get_id()).second) return;
        changed_.notify_all();
        changed_.wait_for(lock, std::chrono::seconds(20), [&] { return threads_.size() >= expected_; });
    }
    void shadow(const RayPacket&, unsigned) override {}
    std::size_t count() const { return threads_.size(); }

private:
    std::size_t expected_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::set<std::thread::id> threads_;
};

class Determinism : public testing::TestWithParam<const char*> {
protected:
    std::string text(const std::string& sampler = "sobol") const {
        return std::string(GetParam()) == "Room" ? roomText(sampler) : motionText(sampler);
    }
    std::unique_ptr<RenderJob> render(const RenderOptions& options = {}) const {
        return renderText(text(), options, folder_.path());
    }
    const RenderJob& reference() {
        if (!reference_) reference_ = render();
        return *reference_;
    }

    SceneFolder folder_;
    std::unique_ptr<RenderJob> reference_;
};

/// The tests below would be worth little in a scene where nothing happens.
TEST_P(Determinism, TheSceneHasEverything) {
    const Scene& scene = reference().scene();
    EXPECT_GE(scene.geometry.instances.size(), 2u);
    EXPECT_GE(scene.geometry.quadrics.size(), 3u);
    EXPECT_TRUE(scene.camera.usesLens());
    EXPECT_EQ(reference().counts().invalid, 0u);
    if (std::string(GetParam()) == "Room") {
        std::set<std::uint32_t> lightTypes;
        for (std::uint32_t id = 0; id < scene.lights.size(); ++id)
            lightTypes.insert(scene.lights.tag(id));
        EXPECT_EQ(lightTypes.size(), LightTypes::size);
        EXPECT_FALSE(scene.lightMasks.empty());
        std::set<std::uint32_t> materialTypes;
        for (std::uint32_t id = 0; id < scene.materials.size(); ++id)
            materialTypes.insert(scene.materials.tag(id));
        EXPECT_EQ(materialTypes.size(), MaterialTable::kTags);
        EXPECT_EQ(scene.materials.mixes().size(), 2u);
    } else {
        EXPECT_TRUE(scene.hasMotion);
        EXPECT_TRUE(scene.camera.moves());
        EXPECT_GE(std::ranges::count_if(scene.geometry.instances, [](const auto& i) { return i.segments > 1; }), 4);
    }
    RenderOptions other;
    other.build.seed = 1;
    EXPECT_FALSE(render(other)->film() == reference().film());
}

TEST_P(Determinism, OneTwoAndFourThreads) {
    const std::string path = folder_.path("reference.exr");
    reference().writePicture(path);
    const std::string bytes = readBytes(path);
    ASSERT_GT(bytes.size(), 10000u);
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        // On a machine that is busy with other things a thread may not come in time, or not at all: then once more.
        std::unique_ptr<RenderJob> job;
        std::size_t seen = 0;
        for (int attempt = 0; attempt < 15 && seen != std::size_t(threads); ++attempt) {
            Workers workers(static_cast<std::size_t>(threads));
            RenderOptions options;
            options.tileSize = 4;
            options.controls.recorder = &workers;
            job = render(options);
            seen = workers.count();
        }
        EXPECT_EQ(seen, std::size_t(threads));
        EXPECT_TRUE(job->film() == reference().film()) << threads << " threads";
        const std::string file = folder_.path(std::to_string(threads) + ".exr");
        job->writePicture(file);
        EXPECT_TRUE(readBytes(file) == bytes) << threads << " threads";
    }
}

TEST_P(Determinism, TilesBatchesAndLanes) {
    for (const int tileSize : {3, 64}) {
        RenderOptions options;
        options.tileSize = tileSize;
        EXPECT_TRUE(render(options)->film() == reference().film()) << "tiles of " << tileSize;
    }
    for (const int batchSize : {1, 7, 37, 64, 1000, 4096}) {
        RenderOptions options;
        options.controls.batchSize = batchSize;
        const auto job = render(options);
        EXPECT_TRUE(job->film() == reference().film()) << "batches of " << batchSize;
        EXPECT_EQ(job->counts().rays, reference().counts().rays);
        EXPECT_EQ(job->counts().shadowRays, reference().counts().shadowRays);
    }
    for (const int batchSize : {1024, 37}) {
        RenderOptions options;
        options.controls.lanes = 1;
        options.controls.batchSize = batchSize;
        const auto job = render(options);
        EXPECT_TRUE(job->film() == reference().film()) << "one lane, batches of " << batchSize;
        EXPECT_EQ(job->counts().groups, job->counts().liveLanes);
        EXPECT_EQ(job->counts().rays, reference().counts().rays);
    }
    EXPECT_GT(reference().counts().liveLanes, 4 * reference().counts().groups);
}

/// Each sampler draws by address alone.
TEST_P(Determinism, EverySampler) {
    for (const std::string& name : pluginNames(SamplerTypes{})) {
        RenderOptions narrow;
        narrow.controls.lanes = 1;
        narrow.controls.batchSize = 100;
        narrow.tileSize = 5;
        const auto a = renderText(text(name), {}, folder_.path()), b = renderText(text(name), narrow, folder_.path());
        EXPECT_EQ(a->scene().sampler.info().name, name);
        EXPECT_TRUE(a->film() == b->film()) << name;
    }
}

/// Groups of other paths, and partly filled ones: single pixels in random order, their samples in odd pieces.
TEST_P(Determinism, AnyOrderOfPixelsAndSamples) {
    const Scene& scene = reference().scene();
    const CropWindow& crop = reference().film().crop();
    struct Piece {
        int x, y;
        SampleRange samples;
    };
    std::vector<Piece> pieces;
    for (int y = 0; y < crop.height(); ++y)
        for (int x = 0; x < crop.width(); ++x)
            for (const SampleRange& s : {SampleRange{0, 3}, SampleRange{3, 4}, SampleRange{4, 8}})
                pieces.push_back({x, y, s});
    std::mt19937 generator(1);
    std::shuffle(pieces.begin(), pieces.end(), generator);
    for (const int lanes : {1, 8}) {
        Film shuffled(crop, 1, scene.filter.normalization());
        RenderCounts counts;
        RenderControls controls;
        controls.lanes = lanes;
        const auto integrator = makeIntegrator(scene);
        for (const Piece& p : pieces)
            integrator->render(scene, {p.x, p.y, p.x + 1, p.y + 1}, p.samples, controls, shuffled, counts);
        EXPECT_TRUE(shuffled == reference().film()) << lanes << " lanes";
    }
}

TEST_P(Determinism, ReplayedSamplesAddUpToTheFilm) {
    const Film& film = reference().film();
    const double normalization = reference().scene().filter.normalization();
    const std::uint32_t samples = std::uint32_t(reference().scene().samplesPerPixel);
    for (std::size_t pixel = 5; pixel < film.pixelCount(); pixel += 97) {
        const int x = int(pixel) % film.crop().width(), y = int(pixel) / film.crop().width();
        for (const int lanes : {1, 8}) {
            __int128 sum[3] = {};
            for (std::uint32_t s = 0; s < samples; ++s) {
                const Spectrum<float> value = reference().replay(x, y, s, lanes).value;
                sum[0] += toFixed(value.r);
                sum[1] += toFixed(value.g);
                sum[2] += toFixed(value.b);
            }
            const PixelEstimate e = film.estimate(pixel);
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(fromFixed(sum[c]) / samples * normalization, e.mean[c])
                    << x << "," << y << " lanes " << lanes;
        }
    }
}

/// A crop shows the same samples as the whole picture.
TEST_P(Determinism, ACropIsAPartOfThePicture) {
    std::string cropped = text();
    cropped.insert(cropped.find("\"integer xresolution\""), "\"integer pixelbounds\" [ 5 19 7 18 ] ");
    const auto part = renderText(cropped, {}, folder_.path());
    const CropWindow& crop = part->film().crop();
    ASSERT_EQ(crop.width() * crop.height(), 14 * 11);
    for (std::size_t i = 0; i < part->film().pixelCount(); ++i) {
        const std::size_t x = i % 14 + 5, y = i / 14 + 7;
        const PixelEstimate a = part->film().estimate(i);
        const PixelEstimate b = reference().film().estimate(y * std::size_t(reference().film().crop().width()) + x);
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(a.mean[c], b.mean[c]);
            EXPECT_EQ(a.standardError[c], b.standardError[c]);
        }
    }
}

TEST_P(Determinism, ReplicatePlanesToo) {
    RenderOptions planes, other;
    planes.replicates = other.replicates = 4;
    other.controls.lanes = 1;
    other.controls.batchSize = 37;
    other.tileSize = 5;
    const auto a = render(planes), b = render(other);
    EXPECT_TRUE(a->film() == b->film());
    EXPECT_FALSE(a->film() == reference().film());
}

INSTANTIATE_TEST_SUITE_P(Scenes, Determinism, testing::Values("Room", "Motion"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace penumbra
