// What the camera does to a picture of known radiance: filters, lenses, shutters, projections.
//
// Everything here looks straight at emitters (maxdepth 0), so that the pixel is an area, a solid angle or a time.
#include "scenes/analytic/quadrature.h"
#include "scenes/analytic/scene_text.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace penumbra {

using namespace analytic;

namespace {

constexpr double kPi = std::numbers::pi;

constexpr int kColumnHeight = 32;

/// The pixels x <= X < x + 1 of the grid of unit pixels, alone.
std::string pixelColumn(int x, const std::string& cameraParameters = {}) {
    return pixelGrid(x, 1, kColumnHeight, cameraParameters);
}

/// The box filter's coverage of a slanted edge, the same in every pixel.
AnalyticScene slantedEdges() {
    constexpr int kSide = 16;
    std::string points, indices;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            points += fmt::format("{} {} 0  {} {}.2 0  {} {}.7 0  {} {} 0\n", x, y, x, y, x + 1, y, x + 1, y);
            const int first = 4 * (y * kSide + x);
            indices += fmt::format("{} {} {} {} {} {}\n", first, first + 1, first + 2, first, first + 2, first + 3);
        }
    return {.id = "D1",
            .claim = "box filter over the edge y < .2 + .5 x of every pixel: .45",
            .text = sceneText({.camera = pixelGrid(0, kSide, kSide), .maxDepth = 0},
                              emitter(1, "Shape \"trianglemesh\" \"point3 P\" [ " + points +
                                             "] \"integer indices\" [ " + indices + "]\n")),
            .expected = grey(.45),
            .samplesPerPixel = 128};
}

/// A column of pixels, 4 <= x < 5, and a vertical edge a quarter of a pixel right of its centres, bright to the left.
AnalyticScene edge(const std::string& id, const std::string& filter, double value) {
    return {.id = id,
            .claim = "a vertical edge .25 pixels right of the centre, through the filter: " + filter,
            .text = sceneText({.camera = pixelColumn(4),
                               .maxDepth = 0,
                               .width = 1,
                               .height = kColumnHeight,
                               .filter = "PixelFilter " + filter},
                              emitter(1, rectangleZ(-50, 4.75, -50, 80, 0, Facing::Negative))),
            .expected = grey(value),
            .samplesPerPixel = 512};
}

double sinc(double x) {
    return x == 0 ? 1 : std::sin(kPi * x) / (kPi * x);
}

/// The cubic of Mitchell and Netravali (1988) with B = C = 1/3, for 0 <= x <= 1.
double mitchell(double x) {
    return (7 * x * x * x - 12 * x * x + 16. / 3) / 6;
}

void addFilters(std::vector<AnalyticScene>& scenes) {
    scenes.push_back(slantedEdges());
    scenes.push_back(edge("D0 box 1.5", R"("box" "float xradius" [ 1.5 ] "float yradius" [ 1.5 ])", 1.75 / 3));
    scenes.push_back(
        edge("D2 triangle", R"("triangle" "float xradius" [ 1 ] "float yradius" [ 1 ])", 1 - .75 * .75 / 2));

    const double sigma = .5, radius = 1.5, t = .25;
    const auto gaussian = [&](double x) {
        return std::exp(-x * x / (2 * sigma * sigma)) - std::exp(-radius * radius / (2 * sigma * sigma));
    };
    scenes.push_back(edge("D3 gaussian",
                          R"("gaussian" "float xradius" [ 1.5 ] "float yradius" [ 1.5 ] "float sigma" [ .5 ])",
                          .5 + integrate(0, t, gaussian) / (2 * integrate(0, radius, gaussian))));
    scenes.push_back(edge("D4 mitchell", R"("mitchell" "float xradius" [ 2 ] "float yradius" [ 2 ])",
                          .5 + integrate(0, t, mitchell)));
    const auto lanczos = [](double x) { return sinc(x) * sinc(x / 3); };
    scenes.push_back(edge("D4 sinc", R"("sinc" "float xradius" [ 4 ] "float yradius" [ 4 ] "float tau" [ 3 ])",
                          .5 + integrate(0, t, lanczos) / (2 * integrate(0, 4, lanczos))));
    scenes.back().samplesPerPixel = 1024;
}

/// A lens of radius .1 at the origin, focused at z = 2, looking along +z at a window of +-`halfWidth` at z = 1.
std::string lens(double halfWidth) {
    return fmt::format(
        "Camera \"perspective\" \"float fov\" [ 90 ] \"float screenwindow\" [ {} {} {} {} ] "
        "\"float lensradius\" [ .1 ] \"float focaldistance\" [ 2 ]\n",
        -halfWidth, halfWidth, -halfWidth, halfWidth);
}

/// Seen through the point f of the plane of focus, the lens at depth 4 is the disk of radius .1 around 2 f.
void addLenses(std::vector<AnalyticScene>& scenes) {
    const double t = .5;
    scenes.push_back({.id = "D5",
                      .claim = "a straight edge at twice the focal distance, half a blur radius into the bright side",
                      .text = sceneText({.camera = lens(5e-5), .maxDepth = 0},
                                        emitter(1, rectangleZ(-10, .05, -10, 10, 4, Facing::Negative))),
                      .expected = grey(.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / kPi)});
    scenes.push_back(
        {.id = "D6",
         .claim = "a disk light of .2 of the blur's radius: (.2)^2 all over the middle of its blur",
         .text = sceneText({.camera = lens(.014), .maxDepth = 0}, emitter(1, disk(.02, {0, 0, 4}, Facing::Negative))),
         .expected = grey(.04),
         .samplesPerPixel = 1024});
    scenes.push_back(
        {.id = "D12",
         .claim = "defocus keeps the sum of the picture of a flat emitter: area / 4 over the window in focus",
         .text = sceneText({.camera = lens(.05), .maxDepth = 0}, emitter(1, disk(.05, {0, 0, 4}, Facing::Negative))),
         .expected = grey(kPi * .05 * .05 / 4 / (.2 * .2)),
         .samplesPerPixel = 512});
}

const std::string kMoveByTen = "ActiveTransform EndTime\nTranslate 10 0 0\nActiveTransform All\n";
const std::string kShade = rectangleZ(-100, 0, -100, 100, -.5, Facing::Negative);

/// A dark edge runs over a bright ground, from x = 0 to 10 while the shutter is open; a column of pixels
/// stays bright until it comes.
AnalyticScene moving(const std::string& id, const std::string& claim, double value, const std::string& shade,
                     const std::string& camera = pixelColumn(3), const std::string& film = {}) {
    const std::string ground = emitter(1, rectangleZ(-50, 80, -50, 80, 0, Facing::Negative));
    return {.id = id,
            .claim = claim,
            .text = sceneText(
                {.camera = camera, .maxDepth = 0, .width = 1, .height = kColumnHeight, .filmParameters = film},
                ground + black() + shade),
            .expected = grey(value),
            .samplesPerPixel = 512};
}

void addShutters(std::vector<AnalyticScene>& scenes) {
    const std::string shade = scoped(kMoveByTen + kShade);
    scenes.push_back(moving("D7", "an edge moves 10 pixels while the shutter is open; pixel 3..4: .35", .35, shade));
    scenes.push_back(moving("D8", "the same, pixel 0..1: .05", .05, shade, pixelColumn(0)));
    scenes.back().samplesPerPixel = 2048;
    scenes.push_back(
        moving("D7 instance", "the same, the moving thing an instance", .35,
               "ObjectBegin \"shade\"\n" + kShade + "ObjectEnd\n" + scoped(kMoveByTen + "ObjectInstance \"shade\"\n")));
    scenes.push_back(
        moving("D7 camera", "the same, the camera moving the other way", .35, kShade, kMoveByTen + pixelColumn(3)));
    scenes.push_back(moving("D7 half shutter", "open for the middle half of the motion, exposure made up by iso 200",
                            .2, shade, pixelColumn(3, "\"float shutteropen\" [ .25 ] \"float shutterclose\" [ .75 ]"),
                            "\"float iso\" [ 200 ]"));

    // Slerp is uniform in angle: the shade's edge passes the pixel at 30 of its 90 degrees after a third of the time.
    scenes.push_back({.id = "D9 turning",
                      .claim = "a half-plane turns by 90 degrees over a pixel that its edge reaches after 30: 1/3",
                      .text = sceneText({.camera = orthographicView({std::sqrt(.75), .5, 1}, {std::sqrt(.75), .5, 0},
                                                                    {0, 1, 0}, 1e-4),
                                         .maxDepth = 0},
                                        emitter(1, rectangleZ(-50, 50, -50, 50, 0, Facing::Positive)) + black() +
                                            scoped("ActiveTransform EndTime\nRotate 90 0 0 1\nActiveTransform All\n" +
                                                   rectangleZ(-50, 50, -50, 0, .5, Facing::Positive))),
                      .expected = grey(1. / 3)});
}

void addProjections(std::vector<AnalyticScene>& scenes) {
    scenes.push_back(
        {.id = "D10",
         .claim = "perspective picture of a unit sphere at distance 3: area pi / 8 of the 2 x 2 window at distance 1",
         .text = sceneText({.camera = "Camera \"perspective\" \"float fov\" [ 90 ]\n", .maxDepth = 0},
                           emitter(1, sphere(1, {0, 0, 3}))),
         .expected = grey(kPi / 8 / 4),
         .samplesPerPixel = 256});
    scenes.push_back({.id = "D11",
                      .claim = "parallel picture of a disk of radius 1 in a 4 x 4 window: pi / 16",
                      .text = sceneText({.camera = orthographicView({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 2), .maxDepth = 0},
                                        emitter(1, disk(1, {}, Facing::Positive))),
                      .expected = grey(kPi / 16),
                      .samplesPerPixel = 256});
}

}  // namespace

std::vector<AnalyticScene> analyticCameras() {
    std::vector<AnalyticScene> scenes;
    addFilters(scenes);
    addLenses(scenes);
    addShutters(scenes);
    addProjections(scenes);
    return scenes;
}

}  // namespace penumbra
