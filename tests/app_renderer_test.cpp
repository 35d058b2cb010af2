// Renderer, the public face of the library: what it gives is what the job behind it gives, to the bit.

#include "app/batch/renderer.h"

#include "app/batch/render_job.h"
#include "tests/expect_error.h"

#include <cmath>

namespace penumbra {
namespace {

const std::string kCornell = PENUMBRA_SOURCE_DIR "/scenes/gallery/cornell.pbrt";

RendererSettings small() {
    RendererSettings s;
    s.samples = 8;
    s.width = 20;
    s.height = 12;
    s.seed = 3;
    s.sampler = "stratified";
    s.overrides = {"Film.iso=200"};
    s.replicates = 2;
    s.threads = 2;
    return s;
}

TEST(Renderer, GivesTheBitsOfTheJob) {
    Renderer renderer(kCornell, small());
    ASSERT_TRUE(renderer.render());
    EXPECT_TRUE(renderer.warnings().empty());
    EXPECT_EQ(renderer.invalidSamples(), 0u);
    const Picture picture = renderer.picture();

    RenderOptions options;
    options.scene = kCornell;
    options.overrides = small().overrides;
    options.replicates = 2;
    options.build.samplesOverride = 8;
    options.build.width = 20;
    options.build.height = 12;
    options.build.seed = 3;
    options.build.sampler = "stratified";
    Warnings warnings;
    RenderJob job(options, warnings);
    ASSERT_TRUE(job.run());

    ASSERT_EQ(picture.width, 20);
    ASSERT_EQ(picture.height, 12);
    ASSERT_EQ(picture.color.size(), 3u * 20 * 12);
    double light = 0;
    for (std::size_t i = 0; i < job.film().pixelCount(); ++i) {
        const PixelEstimate e = job.film().estimate(i);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(picture.color[3 * i + c], float(e.mean[c]));
            EXPECT_EQ(picture.standardError[3 * i + c], float(e.standardError[c]));
            light += e.mean[c];
        }
        EXPECT_EQ(picture.alpha[i], float(e.alpha));
        EXPECT_EQ(picture.samples[i], 8u);
    }
    EXPECT_GT(light, 0);
    const Spectrum<float> replayed = job.replay(7, 5, 3).value;
    EXPECT_EQ(renderer.sample(7, 5, 3), (std::array<float, 3>{replayed.r, replayed.g, replayed.b}));
}

TEST(Renderer, TellsItsProgressAndStops) {
    Renderer renderer(kCornell, small());
    double last = -1;  // a quick render may end before the first call
    EXPECT_TRUE(renderer.render([&](double done) {
        EXPECT_GE(done, last);
        EXPECT_LE(done, 1);
        last = done;
        return true;
    }));

    RendererSettings endless = small();
    endless.samples = 1 << 28;
    Renderer other(kCornell, endless);
    EXPECT_FALSE(other.render([](double) { return false; }));
    EXPECT_FALSE(other.render());
}

TEST(Renderer, ThrowsWithThePlace) {
    EXPECT_NE(messageOf([] { Renderer("no such scene.pbrt"); }, ErrorKind::MissingInput).find("no such scene.pbrt"),
              std::string::npos);
    RendererSettings unknown = small();
    unknown.sampler = "sobel";
    EXPECT_NE(messageOf([&] { Renderer(kCornell, unknown); }, ErrorKind::Usage).find("sobol"), std::string::npos);
}

}  // namespace
}  // namespace penumbra
