// Rays neither leak out of closed shapes nor stick to surfaces: at scales 1e-4, 1 and 1e6 and at 1e5 units from the
// origin, for meshes, spheres, instances and moving instances, at grazing light and on planes through the origin.
//
// Nothing here is random to the eye: light is found by scattered rays alone and roulette is off, so every single sample
// has its closed value, and one that has not is a ray gone astray.
#include "tests/geometry_fixture.h"
#include "tests/integrators_fixture.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace penumbra {
namespace {

using namespace test;

struct Place {
    const char* name;
    double scale, offset;
};
constexpr Place kPlaces[] = {{"Unit", 1, 0},      {"Tiny", 1e-4, 0},         {"Huge", 1e6, 0},
                             {"FarAway", 1, 1e5}, {"HugeFarAway", 1e3, 1e5}, {"Thousand", 1, 1e3}};

std::string meshText(const TriangleMesh& mesh) {
    std::string text = "Shape \"trianglemesh\" \"point3 P\" [";
    for (const float x : mesh.positions)
        text += fmt::format(" {}", x);
    text += " ] \"integer indices\" [";
    for (const std::uint32_t i : mesh.indices)
        text += fmt::format(" {}", i);
    return text + " ]\n";
}

/// About as large as the unit sphere, in object space, facing outwards.
const std::vector<std::pair<std::string, std::string>>& bodies() {
    static const std::vector<std::pair<std::string, std::string>> list = {
        {"box", "ReverseOrientation\n" + analytic::cubeInside()},
        {"icosphere", meshText(icosphere(3))},
        {"sphere", "Shape \"sphere\" \"float radius\" 1\n"},
    };
    return list;
}

std::string placeText(const Place& p) {
    return fmt::format("Translate {0} {0} {0}\nScale {1} {1} {1}\n", p.offset, p.scale);
}

/// A view from `eye` to `look`, both in the body's own units.
std::string viewText(const Place& p, Vec3d eye, Vec3d look, double fov) {
    const auto at = [&](double x) { return fmt::format("{} ", p.offset + p.scale * x); };
    return "LookAt " + at(eye.x) + at(eye.y) + at(eye.z) + at(look.x) + at(look.y) + at(look.z) + "0 0 1\n" +
           fmt::format("Camera \"perspective\" \"float fov\" {}\n", fov);
}

std::string sceneOf(const std::string& view, int maxDepth, const std::string& world) {
    return view + film(64, 64) +
           fmt::format(
               "PixelFilter \"box\"\nSampler \"independent\" \"integer pixelsamples\" 1\n"
               "Integrator \"path\" \"integer maxdepth\" {}\nWorldBegin\n",
               maxDepth) +
           world;
}

std::unique_ptr<RenderJob> renderIn(IntersectionMode mode, const std::string& text, Strategy strategy) {
    RenderOptions options;
    options.build.intersection = mode;
    options.build.strategy = strategy;
    options.build.roulette = RouletteRule::Off;
    return renderText(text, options);
}

/// Samples (one a pixel) that differ from every one of the allowed values.
std::size_t strays(const RenderJob& job, std::initializer_list<double> allowed, double tolerance = 1e-5) {
    std::size_t count = job.counts().invalid;
    for (std::size_t i = 0; i < job.film().pixelCount(); ++i) {
        const double value = job.film().estimate(i).mean[0];
        count += std::ranges::none_of(allowed, [&](double a) { return std::abs(value - a) <= tolerance; });
    }
    return count;
}

/// Small scenes are traced by a list of their faces, and by Embree where that is asked for.
class Offsets : public testing::TestWithParam<std::tuple<Place, IntersectionMode>> {
protected:
    static const Place& place() { return std::get<Place>(GetParam()); }
    static std::unique_ptr<RenderJob> render(const std::string& text, Strategy strategy = Strategy::BsdfOnly) {
        return renderIn(std::get<IntersectionMode>(GetParam()), text, strategy);
    }
};

/// Every wall emits .5 and reflects .5: 1, after up to 60 bounces of 4096 paths, where no ray leaves.
TEST_P(Offsets, ClosedFurnace) {
    for (const auto& [name, shape] : bodies()) {
        const auto job =
            render(sceneOf(viewText(place(), {.3, -.2, .1}, {.8, .6, -.5}, 70), 60,
                           scoped("Material \"diffuse\" \"rgb reflectance\" [ .5 .5 .5 ]\n"
                                  "AreaLightSource \"diffuse\" \"rgb L\" [ .5 .5 .5 ] \"bool twosided\" true\n" +
                                  placeText(place()) + shape)));
        EXPECT_EQ(strays(*job, {1}), 0u) << name;
        EXPECT_GT(job->counts().rays, 60u * 4096) << name;
    }
}

/// White walls under a bright sky: inside it is dark, for scattered and for shadow rays.
TEST_P(Offsets, NoLightGetsIn) {
    const std::string sky =
        "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\nMaterial \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]\n";
    const std::string view = viewText(place(), {.3, -.2, .1}, {.8, .6, -.5}, 70);
    for (const auto& [name, shape] : bodies()) {
        const std::string object = "ObjectBegin \"body\"\n" + shape + "ObjectEnd\n";
        const std::string turning =
            "ActiveTransform EndTime\nTranslate .1 0 .05\nRotate 40 1 2 3\nActiveTransform All\n";
        for (const std::string& world :
             {scoped(placeText(place()) + shape),
              object + scoped(placeText(place()) + "ObjectInstance \"body\"\n"),
              object + scoped(placeText(place()) + turning + "ObjectInstance \"body\"\n")})
            for (const Strategy strategy : {Strategy::BsdfOnly, Strategy::LightOnly}) {
                const auto job = render(sceneOf(view, 30, sky + world), strategy);
                EXPECT_EQ(strays(*job, {0}), 0u) << name << " " << strategyName(strategy) << "\n"
                                                 << world.substr(world.size() - 200);
            }
    }
}

/// A convex body of albedo .5 under a sky of 1 shows .5: a ray that met its own surface again would make it .25.
TEST_P(Offsets, ConvexBodiesDoNotShadowThemselves) {
    const std::string sky =
        "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\nMaterial \"diffuse\" \"rgb reflectance\" [ .5 .5 .5 ]\n";
    for (const auto& [name, shape] : bodies()) {
        const std::string object = "ObjectBegin \"body\"\n" + shape + "ObjectEnd\n";
        for (const std::string& world : {scoped(placeText(place()) + shape),
                                         object + scoped(placeText(place()) + "ObjectInstance \"body\"\n")}) {
            const auto job = render(sceneOf(viewText(place(), {2.5, -2, 1.5}, {0, 0, 0}, 40), 8, sky + world));
            EXPECT_EQ(strays(*job, {0.5, 1}), 0u) << name;
            EXPECT_LT(strays(*job, {1}), 4096u);
            EXPECT_GT(strays(*job, {1}), 1000u);
        }
    }
}

/// A floor through the place's origin, turned by any angles, under light that grazes it at an angle of down to 0.06
/// degrees: every sample shows the same irradiance, seen from above and seen as grazingly.
TEST_P(Offsets, GrazingLight) {
    const Place& p = place();
    const double rounding = p.offset * 0x1p-24 / p.scale;  // of the corners: it tilts the floor
    Random random(1);
    for (int i = 0; i < 6; ++i) {
        const std::string axis = i == 0 ? "0 0 1" : fmt::format("{} {} 1", random(), random());
        const double degrees = 360 * random(), sine = std::max(i % 2 ? 1e-3 : 0.02, 20 * rounding);
        const std::string world =
            placeText(p) + fmt::format("Rotate {} {}\n", degrees, axis) +
            fmt::format(
                "LightSource \"distant\" \"point3 from\" [ {} 0 {} ] \"point3 to\" [ 0 0 0 ] \"rgb L\" [ 1 1 1 ]\n",
                std::sqrt(1 - sine * sine), sine) +
            "Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]\n"
            "Shape \"trianglemesh\" \"point3 P\" [ -4 -4 0  4 -4 0  4 4 0  -4 4 0 ] \"integer indices\" [ 0 1 2 0 2 3 "
            "]\n";
        struct View {
            Vec3d eye;
            double fov;
        };
        for (const View view : {View{{0, -2, 3}, 30}, View{{0, -3, 0.02 + 40 * rounding}, 0.1}}) {
            // From the world into the floor's frame, and from there into the camera's.
            const std::string camera = viewText({"", p.scale, 0}, view.eye, {0, 0, 0}, view.fov);
            const std::size_t end = camera.find("Camera");
            const std::string placed = camera.substr(0, end) + fmt::format("Rotate {} {}\n", -degrees, axis) +
                                       fmt::format("Translate {0} {0} {0}\n", -p.offset) + camera.substr(end);
            const auto job = render(sceneOf(placed, 1, world));
            const double value = sine / std::numbers::pi;
            EXPECT_EQ(strays(*job, {value}, value * (2e-3 + 4 * rounding / sine)), 0u)
                << "turn " << i << " sine " << sine;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Places, Offsets,
                         testing::Combine(testing::ValuesIn(kPlaces),
                                          testing::Values(IntersectionMode::Robust, IntersectionMode::Embree)),
                         [](const auto& info) {
                             const bool byEmbree = std::get<1>(info.param) == IntersectionMode::Embree;
                             return std::string(std::get<0>(info.param).name) + (byEmbree ? "ByEmbree" : "");
                         });

}  // namespace
}  // namespace penumbra
