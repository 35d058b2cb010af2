// What must hold in hot code whatever the scene: denormals are flushed inside of the tasks and nowhere else; values
// that are not finite or beyond the film's range are counted, can be replayed, and poison nothing else.
#include "core/base/parallel.h"
#include "tests/integrators_fixture.h"

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <atomic>
#include <cstdio>

namespace penumbra {
namespace {

using namespace test;

constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040, kFlags = kFlushToZero | kDenormalsAreZero;

/// Reads the control word of the thread that traces.
class ControlWords final : public RayRecorder {
public:
    void nearest(const RayHitPacket&, unsigned, Coherence) override { note(); }
    void shadow(const RayPacket&, unsigned) override { note(); }
    int flushed() const { return flushed_; }
    int other() const { return other_; }

private:
    void note() { ++((_mm_getcsr() & kFlags) == kFlags ? flushed_ : other_); }
    std::atomic<int> flushed_{0}, other_{0};
};

/// The control word that this scope began with comes back at its end.
class RestoreControlWord {
public:
    RestoreControlWord() : saved_(_mm_getcsr()) {}
    ~RestoreControlWord() { _mm_setcsr(saved_); }
    RestoreControlWord(const RestoreControlWord&) = delete;
    RestoreControlWord& operator=(const RestoreControlWord&) = delete;

private:
    unsigned saved_;
};

TEST(Denormals, AreFlushedInsideTasksAndThereOnly) {
    const RestoreControlWord restore;
    _mm_setcsr(_mm_getcsr() & ~kFlags);  // whatever the program's main has set
    const ThreadLimit limit(2);
    const SceneFolder folder;
    ControlWords words;
    RenderOptions options;
    options.tileSize = 4;
    options.controls.recorder = &words;
    renderText(motionText("sobol", 2), options, folder.path());
    EXPECT_GT(words.flushed(), 100);
    EXPECT_EQ(words.other(), 0);
    EXPECT_EQ(_mm_getcsr() & kFlags, 0u);
    std::atomic<int> left{0};
    parallelFor(64, [&](std::size_t) { left += (_mm_getcsr() & kFlags) != 0; });
    EXPECT_EQ(left, 0);
}

/// A picture is the same with and without the flags in the thread that asks for it.
TEST(Denormals, TheCallersFlagsChangeNothing) {
    const RestoreControlWord restore;
    const ThreadLimit limit(1);
    const SceneFolder folder;
    _mm_setcsr(_mm_getcsr() & ~kFlags);
    const auto a = renderText(roomText("sobol", 2), {}, folder.path());
    _mm_setcsr(_mm_getcsr() | kFlags);
    const auto b = renderText(roomText("sobol", 2), {}, folder.path());
    EXPECT_TRUE(a->film() == b->film());
}

/// Two panels fill the picture, 16 x 8 pixels: the left one of radiance `left`, the right one of 1.
std::string panels(const std::string& left, int samples) {
    return "LookAt 0 0 -1  0 0 0  0 1 0\nCamera \"orthographic\"\n" + film(16, 8) +
           "PixelFilter \"box\"\nSampler \"independent\" \"integer pixelsamples\" " + std::to_string(samples) +
           "\nIntegrator \"path\" \"integer maxdepth\" 3\nWorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ 0 0 0 "
           "]\n" +
           scoped("AreaLightSource \"diffuse\" \"bool twosided\" true " + left +
                  "\nShape \"trianglemesh\" \"point3 P\" [ -9 -9 0  0 -9 0  0 9 0  -9 9 0 ] \"integer indices\" [ 0 1 "
                  "2 0 2 3 ]\n") +
           scoped(
               "AreaLightSource \"diffuse\" \"bool twosided\" true \"rgb L\" [ 1 1 1 ]\nShape \"trianglemesh\" "
               "\"point3 P\" "
               "[ 0 -9 0  9 -9 0  9 9 0  0 9 0 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n");
}

TEST(InvalidSamples, AreCountedAndPoisonNothing) {
    const auto plain = renderText(panels("\"rgb L\" [ 0 0 0 ]", 4));
    for (const char* radiance : {"\"rgb L\" [ 1e10 1 1 ]", "\"rgb L\" [ 1 1 1 ] \"float scale\" 1e30"}) {
        const auto job = renderText(panels(radiance, 4));
        EXPECT_EQ(job->counts().invalid, 8u * 8 * 4) << radiance;
        ASSERT_EQ(job->counts().firstInvalid.size(), RenderCounts::kMostInvalid);
        for (std::uint32_t i = 0; i < RenderCounts::kMostInvalid; ++i) {
            EXPECT_EQ(job->counts().firstInvalid[i].pixel, i / 4);
            EXPECT_EQ(job->counts().firstInvalid[i].sample, i % 4);
        }
        for (std::size_t i = 0; i < 128; ++i) {
            const PixelEstimate e = job->film().estimate(i);
            for (const double v : e.mean)
                EXPECT_EQ(v, i % 16 < 8 ? 0 : 1);
            EXPECT_EQ(e.samples, 4u);
            EXPECT_EQ(e.alpha, 1);
        }
        EXPECT_TRUE(std::isnan(job->replay(3, 2, 1).value.r));
        EXPECT_EQ(job->replay(12, 2, 1).value.r, 1);
    }
    EXPECT_EQ(plain->counts().invalid, 0u);
}

/// What a broken material makes of a path is no black sample, whichever way the path would have ended.
TEST(InvalidSamples, ComeFromThroughputThatIsNoNumber) {
    const std::string text = film(4, 4) +
                             "Sampler \"independent\" \"integer pixelsamples\" 4\nIntegrator \"path\" \"integer "
                             "maxdepth\" 12\nWorldBegin\nLightSource \"point\" \"point3 from\" [ 0 0 9 ]\n"
                             "Material \"diffuse\"\nShape \"sphere\" \"float radius\" 2\n";
    for (const float broken : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        for (const RouletteRule roulette : {RouletteRule::Late, RouletteRule::Pbrt, RouletteRule::Off}) {
            RenderOptions options;
            options.build.roulette = roulette;
            const auto sound = renderText(text, options), job = prepareText(text, options);
            for (const DiffuseMaterial& m : job->scene().materials.rows<DiffuseMaterial>())
                const_cast<DiffuseMaterial&>(m).reflectance.constant.g = broken;
            job->run();
            EXPECT_EQ(sound->counts().invalid, 0u);
            EXPECT_EQ(job->counts().invalid, 4u * 4 * 4) << broken;
        }
}

/// The largest sums that are allowed are exact.
TEST(InvalidSamples, LargeValuesAreValuesUpToTheLimit) {
    const auto job = renderText(panels("\"rgb L\" [ 8e9 1 1 ]", 16));
    EXPECT_EQ(job->counts().invalid, 0u);
    EXPECT_EQ(job->film().estimate(0).mean[0], 8e9);
}

/// Counts do not depend on how the work was cut.
TEST(InvalidSamples, AreTheSameHoweverTheWorkIsCut) {
    for (const int lanes : {1, 8})
        for (const int batchSize : {13, 1024}) {
            RenderOptions options;
            options.tileSize = 3;
            options.controls.lanes = lanes;
            options.controls.batchSize = batchSize;
            const auto job = renderText(panels("\"rgb L\" [ 1e20 0 0 ]", 2), options);
            EXPECT_EQ(job->counts().invalid, 8u * 8 * 2);
            EXPECT_EQ(job->counts().firstInvalid.front().pixel, 0u);
            EXPECT_EQ(job->counts().firstInvalid.back().pixel, 7u);
        }
}

/// Scenes at the limits of floats: whatever they show, it is finite, or counted.
TEST(InvalidSamples, ExtremeScenesStayFinite) {
    const std::string head =
        "LookAt 0 0 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\n" + film(16, 16) +
        "Sampler \"independent\" \"integer pixelsamples\" 4\nIntegrator \"path\" \"integer maxdepth\" 20\n"
        "WorldBegin\nLightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n";
    const std::string sphere = "Shape \"sphere\"\n";
    const std::string worlds[] = {
        "Material \"dielectric\" \"float eta\" 100\n" + sphere,
        "Material \"dielectric\" \"float eta\" .01\n" + sphere,
        "Material \"dielectric\" \"float eta\" 1\n" + sphere,
        "Material \"conductor\" \"rgb eta\" [ 0 0 0 ] \"rgb k\" [ 0 0 0 ] \"float roughness\" 0\n" + sphere,
        "Material \"conductor\" \"rgb eta\" [ 1e5 1e5 1e5 ] \"rgb k\" [ 1e5 1e5 1e5 ] \"float roughness\" 1e-6\n" +
            sphere,
        "Material \"coateddiffuse\" \"float thickness\" 1e6 \"float roughness\" 1e-5\n" + sphere,
        "LightSource \"point\" \"rgb I\" [ 1e9 1e9 1e9 ]\nMaterial \"diffuse\"\n" + sphere,
        "LightSource \"point\" \"rgb I\" [ 1 1 1 ]\nTranslate 0 0 1\nMaterial \"diffuse\"\n" +
            sphere,  // a light on the surface
        scoped("AreaLightSource \"diffuse\" \"rgb L\" [ 1e6 1e6 1e6 ]\nShape \"sphere\" \"float radius\" 1e-5\n") +
            "Translate 0 0 1.00001\nMaterial \"diffuse\"\n" + sphere,
        "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1e6 0 1e-30 ] \"rgb sigma_s\" [ 0 0 "
        "0 ]\n"
        "MediumInterface \"ink\" \"\"\nMaterial \"interface\"\n" +
            sphere,
        "Scale 1e6 1e6 1e-4\nMaterial \"diffuse\"\n" + sphere,
        "Translate 0 0 1e7\nScale 1e7 1e7 1e7\nMaterial \"dielectric\"\n" + sphere,
        "Material \"diffuse\"\nShape \"trianglemesh\" \"point3 P\" [ -1e9 -1e9 1  1e9 -1e9 1  0 1e9 1 ]\n",
        "Material \"diffuse\"\nShape \"trianglemesh\" \"point3 P\" [ -1 -1e-6 0  1 -1e-6 0  0 1e-6 0 ] \"normal N\" [ "
        "1 0 0  -1 0 0  0 "
        "1e-30 0 ]\n",
    };
    for (const std::string& world : worlds) {
        const auto job = renderText(head + world);
        EXPECT_EQ(job->counts().invalid, 0u) << world;
        double sum = 0;
        for (std::size_t i = 0; i < 256; ++i)
            for (const double v : job->film().estimate(i).mean) {
                EXPECT_TRUE(std::isfinite(v) && v >= 0) << world;
                sum += v;
            }
        EXPECT_GT(sum, 0) << world;
    }
}

std::string text(double x) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%g", x);
    return buffer;
}

TEST(HostileNumbers, RaysThatAreNotFiniteBecomeInvalidSamples) {
    // The library of rays aborts on them, so none may reach it.
    const std::string floor = "Shape \"sphere\"\n";
    for (const char* camera : {"Translate 1.5e18 0 0\nCamera \"perspective\"\n",
                               "Camera \"orthographic\" \"float screenwindow\" [ -1e30 1e30 -1e30 1e30 ]\n",
                               "Camera \"perspective\" \"float lensradius\" 1e30\n"}) {
        SCOPED_TRACE(camera);
        Warnings warnings;
        RenderJob job(readSceneText(camera + film(8, 8) + "Sampler \"sobol\" \"integer pixelsamples\" 4\nWorldBegin\n" + floor,
                                    "test.pbrt", ".", warnings),
                      {}, warnings);
        job.run();
        for (std::size_t i = 0; i < 64; ++i) {
            const PixelEstimate e = job.film().estimate(i);
            for (const double v : e.mean) EXPECT_TRUE(std::isfinite(v));
        }
    }
}

TEST(HostileNumbers, SurfacesOfEveryScaleAreLit) {
    // Squares of such normals leave the range of floats. Albedo 0.5 under a sky of radiance 1: every pixel is 0.5.
    for (const double scale : {1e-11, 1e-3, 1e10}) {
        SCOPED_TRACE(scale);
        const std::string size = text(scale), far = text(3 * scale);
        const auto job = renderText("LookAt 0 0 -" + far + " 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" 10\n" + film(8, 8) +
                                    "PixelFilter \"box\"\nIntegrator \"path\" \"integer maxdepth\" 1\nWorldBegin\n"
                                    "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\nMaterial \"diffuse\" \"rgb reflectance\" [ .5 .5 .5 ]\n"
                                    "Scale " + size + " " + size + " " + size + "\nShape \"sphere\"\n");
        EXPECT_EQ(job->counts().invalid, 0u);
        for (std::size_t i = 0; i < 64; ++i) EXPECT_NEAR(job->film().estimate(i).mean[1], 0.5, 1e-5);
    }
}

}  // namespace
}  // namespace penumbra
