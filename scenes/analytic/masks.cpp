// Shapes with holes (alpha): what they let through, what they hide, and what they emit.
//
// A sheet of alpha a passes 1 - a of any light, independent sheets the product, a sphere its square, for it is crossed twice;
// an emitter of radiance L shows a L and what is behind it times 1 - a. Strategies must agree, for each sees a light with
// holes in its own way.
#include "scenes/analytic/scene_text.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace penumbra {

using namespace analytic;

namespace {

constexpr double kPi = std::numbers::pi;

std::string withAlpha(double alpha, const std::string& shapes) {
    return scoped(fmt::format("Attribute \"shape\" \"float alpha\" [ {} ]\n", alpha) + shapes);
}

AnalyticScene mask(const std::string& id, const std::string& claim, const std::string& camera, const std::string& world,
                   double value) {
    return {.id = id,
            .claim = claim,
            .text = sceneText({.camera = camera}, world),
            .expected = grey(value),
            .samplesPerPixel = 512};
}

/// Straight down, from z = 3 to the origin.
std::string viewDown() {
    return orthographicView({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, .2);
}

/// Three black sheets of alpha .25, .2 and .1, which pass .54 together: one of triangles, one a disk, one placed twice over.
std::string sheets() {
    return black() + withAlpha(.25, rectangleZ(-9, 9, -9, 9, .6, Facing::Positive)) +
           withAlpha(.2, disk(9, {0, 0, .7}, Facing::Positive)) + "ObjectBegin \"sheet\"\n" +
           withAlpha(.1, rectangleZ(-4, 4, -4, 4, 0, Facing::Negative)) +
           "ObjectEnd\nAttributeBegin\nTranslate 0 0 .8\nScale 2 2 -1\nObjectInstance \"sheet\"\nAttributeEnd\n";
}
constexpr double kThroughSheets = .75 * .8 * .9;

void addSheets(std::vector<AnalyticScene>& scenes) {
    scenes.push_back(mask("alpha 1", "through three black sheets of alpha .25, .2, .1 on a sky of radiance 1", viewDown(),
                          constantSky(1) + sheets(), kThroughSheets));
    scenes.push_back(mask("alpha 1 sphere", "through a black sphere of alpha .2, whose wall is crossed twice: .64", viewDown(),
                          constantSky(1) + black() + withAlpha(.2, sphere(1)), .64));
    scenes.push_back(mask("alpha 1 mirror", "black behind a mirror of alpha .7 that shows a sky of radiance 1", viewDown(),
                          constantSky(1) + black() + floorSquare(9) + "Material \"conductor\" \"rgb reflectance\" [ 1 1 1 ]\n" +
                              withAlpha(.7, disk(9, {0, 0, .5}, Facing::Positive)),
                          .7 * .9999));   // the format's largest reflectance
    // The irradiance of B4 (pi / 2) behind the sheets, by shadow rays, by scattered rays, and by both.
    addInAllStrategies(scenes,
                       mask("alpha 2", "disk light of radius 1 at height 1 behind the sheets: E = .54 pi / 2", viewOfOrigin(),
                            sheets() + diffuse(.5) + floorSquare(.1) + emitter(1, disk(1, {0, 0, 1}, Facing::Negative)),
                            .5 * kThroughSheets / 2),
                       1024);
}

/// The scene under each strategy and under both.
void addLight(std::vector<AnalyticScene>& scenes, const std::string& id, const std::string& claim, const std::string& light,
              double irradiance) {
    addInAllStrategies(scenes, mask(id, claim, viewOfOrigin(), diffuse(.5) + floorSquare(.1) + light, .5 * irradiance / kPi), 1024);
}

void addLights(std::vector<AnalyticScene>& scenes) {
    scenes.push_back(mask("alpha 3", "an emitter of radiance 1 and alpha .4 before one of radiance .5: .4 + .6 x .5", viewDown(),
                          emitter(.5, rectangleZ(-9, 9, -9, 9, 0, Facing::Positive)) +
                              withAlpha(.4, emitter(1, rectangleZ(-9, 9, -9, 9, .5, Facing::Positive))),
                          .7));
    addLight(scenes, "alpha 4", "disk light of radius 1 at height 1 with alpha .6: E = .6 pi / 2",
             withAlpha(.6, emitter(1, disk(1, {0, 0, 1}, Facing::Negative))), .6 * kPi / 2);
    // From below a point of the near side is there with .5, else the far side's inside with .5.
    addLight(scenes, "alpha 5", "two-sided sphere light of radius 1 at distance 2 with alpha .5: E = (.5 + .25) pi / 4",
             withAlpha(.5, emitter(1, sphere(1, {0, 0, 2}), R"("bool twosided" true)")), .75 * kPi / 4);
    // Two opposite quarters of B7b's square, of which each corner light gives B7.
    const double corner = std::atan(1 / std::sqrt(2.)) / std::sqrt(2.);
    addLight(scenes, "alpha 6", "square light 2 x 2 at height 1, of which a checkerboard leaves two opposite quarters",
             "Texture \"quarters\" \"float\" \"checkerboard\" \"float uscale\" 2 \"float vscale\" 2 \"float tex1\" 1 "
             "\"float tex2\" 0\n" +
                 scoped("Attribute \"shape\" \"texture alpha\" \"quarters\"\n" +
                        emitter(1, rectangleZ(-1, 1, -1, 1, 1, Facing::Negative))),
             2 * corner);
    AnalyticScene unseen = mask("alpha 7", "disk light of radius 1 at height 1 with alpha 0: E = pi / 2, by light sampling alone", viewOfOrigin(),
                                diffuse(.5) + floorSquare(.1) + withAlpha(0, emitter(1, disk(1, {0, 0, 1}, Facing::Negative))), .25);
    scenes.push_back(unseen);
}

}  // namespace

std::vector<AnalyticScene> analyticMasks() {
    std::vector<AnalyticScene> scenes;
    addSheets(scenes);
    addLights(scenes);
    return scenes;
}

}  // namespace penumbra
