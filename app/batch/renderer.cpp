#include "app/batch/renderer.h"

#include "app/batch/render_job.h"
#include "core/base/parallel.h"
#include "core/base/ticker.h"

#include <optional>

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

constexpr Ticker::Pause kProgressPause{100};

}  // namespace

struct Renderer::State {
    State(const std::string& scene, const RendererSettings& settings)
        : threads(settings.threads), warnings(settings.strict), job(optionsOf(scene, settings), warnings) {}

    int threads;
    Warnings warnings;
    RenderJob job;
    bool hasRun = false;
};

Renderer::Renderer(const std::string& scene, const RendererSettings& settings) {
    const ThreadLimit limit(settings.threads);  // building has loops, too
    state_ = std::make_unique<State>(scene, settings);
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

bool Renderer::render(const Progress& progress) {
    RenderJob& job = state_->job;
    if (state_->hasRun) return job.isWhole();
    state_->hasRun = true;
    const ThreadLimit limit(state_->threads);
    std::atomic<bool> stop{false};
    std::optional<Ticker> ticker;
    if (progress)
        ticker.emplace(Ticker::Pause(0), [&] {
            const RenderProgress& p = job.progress();
            if (!progress(double(p.samplesDone) / double(p.samples))) stop = true;
            return kProgressPause;
        });
    return job.run(&stop);
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
