#include "app/batch/renderer.h"

#include "app/batch/render_job.h"
#include "core/base/parallel.h"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace penumbra {
namespace {

RenderOptions optionsOf(const std::string& scene, const RendererSettings& s) {
    RenderOptions o;
    o.scene = scene;
    o.overrides = s.overrides;
    o.root = s.root;
    o.replicates = s.replicates;
    o.build.samplesOverride = s.samples;
    o.build.width = s.width;
    o.build.height = s.height;
    o.build.seed = s.seed;
    o.build.sampler = s.sampler;
    o.build.integrator = s.integrator;
    o.build.maxDepth = s.maxDepth;
    return o;
}

/// Tells `progress` how far the job is until it goes out of scope, and sets `stop` when the answer is no.
class ProgressCaller {
public:
    ProgressCaller(const RenderJob& job, const Renderer::Progress& progress, std::atomic<bool>& stop) {
        if (!progress) return;
        thread_ = std::thread([this, &job, &progress, &stop] {
            std::unique_lock lock(mutex_);
            do {
                const RenderProgress& p = job.progress();
                if (!progress(double(p.samplesDone) / double(p.samples))) stop = true;
            } while (!over_.wait_for(lock, kPause, [this] { return isOver_; }));
        });
    }
    ~ProgressCaller() {
        if (!thread_.joinable()) return;
        {
            const std::lock_guard lock(mutex_);
            isOver_ = true;
        }
        over_.notify_one();
        thread_.join();
    }
    ProgressCaller(const ProgressCaller&) = delete;
    ProgressCaller& operator=(const ProgressCaller&) = delete;

private:
    static constexpr std::chrono::milliseconds kPause{100};
    std::mutex mutex_;
    std::condition_variable over_;
    bool isOver_ = false;
    std::thread thread_;
};

}  // namespace

struct Renderer::State {
    State(const std::string& scene, const RendererSettings& settings)
        : threads(settings.threads), warnings(settings.strict), job(optionsOf(scene, settings), warnings) {}

    int threads;
    Warnings warnings;
    RenderJob job;
    bool isDone = false;
};

Renderer::Renderer(const std::string& scene, const RendererSettings& settings) {
    const ThreadLimit limit(settings.threads);  // building has loops, too
    state_ = std::make_unique<State>(scene, settings);
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

bool Renderer::render(const Progress& progress) {
    if (state_->isDone) return true;
    const ThreadLimit limit(state_->threads);
    std::atomic<bool> stop{false};
    const ProgressCaller caller(state_->job, progress, stop);
    state_->isDone = state_->job.run(&stop);
    return state_->isDone;
}

Picture Renderer::picture() const {
    const Film& film = state_->job.film();
    const CropWindow& crop = film.crop();
    Picture p{crop.x0, crop.y0, crop.width(), crop.height(), {}, {}, {}, {}};
    for (std::size_t i = 0; i < film.pixelCount(); ++i) {
        const PixelEstimate e = film.estimate(i);
        for (const double mean : e.mean)
            p.color.push_back(float(mean));
        for (const double error : e.standardError)
            p.standardError.push_back(float(error));
        p.alpha.push_back(float(e.alpha));
        p.samples.push_back(e.samples);
    }
    return p;
}

void Renderer::write(const std::string& path) const { state_->job.writePicture(path); }

std::array<float, 3> Renderer::sample(int x, int y, std::uint32_t index) const {
    const Spectrum<float> s = state_->job.replay(x, y, index).value;
    return {s.r, s.g, s.b};
}

const std::vector<std::string>& Renderer::warnings() const { return state_->warnings.all(); }
std::uint64_t Renderer::invalidSamples() const { return state_->job.counts().invalid; }

}  // namespace penumbra
