// Cavities and furnaces: what many bounces add up to.
//
// In a closed cavity whose walls all emit Le and reflect rho, the radiance is everywhere L = Le + rho L, so Le / (1 -
// rho) (with at most n scattering events Le (1 - rho^(n+1)) / (1 - rho)). In a sphere every wall point is equally lit
// by every other, whatever the distance. In an open furnace of radiance 1 a convex body shows its albedo, and nothing
// else.
#include "scenes/analytic/scene_text.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace penumbra {

using namespace analytic;

namespace {

constexpr double kPi = std::numbers::pi;

const std::string kSphereInside = "ReverseOrientation\nShape \"sphere\" \"float radius\" [ 1 ]\n";

/// A view into the cavity [-1, 1]^3 when that is scaled and then moved by `offset` along each axis.
std::string viewInside(double scale = 1, double offset = 0) {
    const auto at = [&](double x) { return offset + scale * x; };
    return fmt::format("LookAt {} {} {}  {} {} {}  0 0 1\nCamera \"perspective\" \"float fov\" [ 60 ]\n", at(.3),
                       at(-.2), at(.1), at(.8), at(.6), at(-.5));
}

std::string wallsThatEmit(const std::string& material, double radiance, const std::string& shape) {
    return scoped(material + fmt::format("AreaLightSource \"diffuse\" \"rgb L\" {}\n", spectrumOf(radiance)) + shape);
}

AnalyticScene furnace(const std::string& id, const std::string& shape, double rho, double radiance, int maxDepth) {
    return {
        .id = id,
        .claim = fmt::format("closed cavity, every wall emits {} and reflects {}: Le / (1 - rho)", radiance, rho),
        .text = sceneText({.camera = viewInside(), .maxDepth = maxDepth}, wallsThatEmit(diffuse(rho), radiance, shape)),
        .expected = grey(radiance * (1 - std::pow(rho, maxDepth + 1)) / (1 - rho))};
}

/// The same without variance: light is found by the scattered rays alone, and none of them is ended by chance.
AnalyticScene exactly(AnalyticScene scene) {
    scene.id += " exact";
    scene.strategy = AnalyticScene::Strategy::ScatteringOnly;
    scene.roulette = false;
    scene.exact = true;
    scene.samplesPerPixel = 4;
    return scene;
}

void addFurnaces(std::vector<AnalyticScene>& scenes) {
    for (const AnalyticScene& s :
         {furnace("A1 box .5", cubeInside(), .5, .5, 60), furnace("A1 sphere .5", kSphereInside, .5, 1, 60),
          furnace("A2 eight bounces", cubeInside(), .5, .5, 8)}) {
        scenes.push_back(s);
        scenes.push_back(exactly(s));
    }
    scenes.push_back(exactly(furnace("A2 no bounce", cubeInside(), .5, .5, 0)));
    scenes.push_back(exactly(furnace("A2 one bounce", kSphereInside, .5, .5, 1)));
    scenes.push_back(furnace("A1 box .8", cubeInside(), .8, 1, 120));
    scenes.push_back(furnace("A1 sphere .95", kSphereInside, .95, 1, 400));
    scenes.back().samplesPerPixel = 128;

    AnalyticScene coloured = furnace("A1 coloured", cubeInside(), .8, 1, 120);
    coloured.claim = "closed cavity, every wall emits 1 and reflects (.2, .5, .8): 1 / (1 - rho) per channel";
    coloured.text =
        sceneText({.camera = viewInside(), .maxDepth = 120}, wallsThatEmit(diffuse(.2, .5, .8), 1, cubeInside()));
    coloured.expected = {1 / .8, 1 / .5, 1 / .2};
    scenes.push_back(coloured);

    AnalyticScene mixed = furnace("A1 mixed", cubeInside(), .55, .5, 60);
    mixed.claim = "closed cavity, every wall emits .5 and is a mix of reflectances .2 and .9: as if all reflected .55";
    mixed.text = sceneText({.camera = viewInside(), .maxDepth = 60},
                           "MakeNamedMaterial \"dark\" \"string type\" \"diffuse\" \"rgb reflectance\" [ .2 .2 .2 ]\n"
                           "MakeNamedMaterial \"light\" \"string type\" \"diffuse\" \"rgb reflectance\" [ .9 .9 .9 ]\n" +
                               wallsThatEmit("Material \"mix\" \"string materials\" [ \"dark\" \"light\" ]\n", .5,
                                             cubeInside()));
    scenes.push_back(mixed);

    AnalyticScene ply = furnace("A1 ply", "Shape \"plymesh\" \"string filename\" \"cube.ply\"\n", .5, .5, 60);
    ply.files = {{"cube.ply", cubeInsidePly()}};
    scenes.push_back(ply);
}

/// Rays neither leak out of a closed room nor stick to its walls: tiny, huge, and far from the origin.
void addFurnacesAtScales(std::vector<AnalyticScene>& scenes) {
    const auto add = [&](const std::string& id, double scale, double offset) {
        AnalyticScene s = furnace(id, "", .5, .5, 60);
        const std::string place = fmt::format("Translate {0} {0} {0}  Scale {1} {1} {1}\n", offset, scale);
        s.text = sceneText({.camera = viewInside(scale, offset), .maxDepth = 60},
                           wallsThatEmit(diffuse(.5), .5, place + cubeInside()));
        scenes.push_back(exactly(s));
    };
    add("A1 tiny", 1e-4, 0);
    add("A1 huge", 1e6, 0);
    add("A1 far away", 1, 1e5);
}

void addOpenFurnaces(std::vector<AnalyticScene>& scenes) {
    const auto add = [&](const std::string& id, const std::string& claim, const std::string& body) {
        scenes.push_back(
            {.id = id,
             .claim = claim,
             .text = sceneText({.camera = orthographicView({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, .35), .maxDepth = 5},
                               constantSky(1) + diffuse(.5) + body),
             .expected = grey(.5)});
    };
    add("A3 sphere", "a convex Lambert body of albedo .5 under a sky of radiance 1: .5", sphere(1));
    add("A3 instance", "the same, an instance turned and scaled unevenly into an ellipsoid",
        "ObjectBegin \"body\"\n" + sphere(1) + "ObjectEnd\n" +
            scoped("Rotate 35 1 2 3\nScale 1 .5 2\nObjectInstance \"body\"\n"));
    add("A3 mirrored mesh", "the same, an instance of a cube under a mirroring transform",
        "ObjectBegin \"body\"\nReverseOrientation\n" + cubeInside() + "ObjectEnd\n" +
            scoped("Rotate 35 1 2 3\nScale -1 1 1\nObjectInstance \"body\"\n"));
}

void addIntegratingSpheres(std::vector<AnalyticScene>& scenes) {
    AnalyticScene lamp{
        .id = "A4",
        .claim = "point light I = pi at the centre of a Lambert sphere of radius 1, rho .5: rho / (1 - rho)",
        .text = sceneText(
            {.camera = viewInside(), .maxDepth = 60},
            fmt::format("LightSource \"point\" \"rgb I\" {}\n", spectrumOf(kPi)) + diffuse(.5) + kSphereInside),
        .expected = grey(1),
        .samplesPerPixel = 16};
    scenes.push_back(lamp);
    lamp.id = "A4 exact";
    lamp.samplesPerPixel = 4;
    lamp.roulette = false;
    lamp.exact = true;
    scenes.push_back(lamp);

    // Zones of a unit sphere have areas in proportion to their heights: the cap takes .05 of it, the port .02.
    const auto zone = [](double low, double high) {
        return fmt::format("Shape \"sphere\" \"float radius\" [ 1 ] \"float zmin\" [ {} ] \"float zmax\" [ {} ]\n", low,
                           high);
    };
    const double rho = .9, cap = .05, port = .02, radiance = 10;
    scenes.push_back(
        {.id = "A6",
         .claim = "integrating sphere: emitting cap of area fraction f, open port of fraction p; the wall shows "
                  "rho f Le / (1 - rho (1 - p))",
         .text = sceneText(
             {.camera = "LookAt 0 0 0  1 .2 0  0 0 1\nCamera \"perspective\" \"float fov\" [ 30 ]\n", .maxDepth = 250},
             "ReverseOrientation\n" + diffuse(rho) + zone(-.96, .9) + wallsThatEmit("", radiance, zone(.9, 1))),
         .expected = grey(rho * cap * radiance / (1 - rho * (1 - port))),
         .samplesPerPixel = 256});
}

/// A lamp in a sphere, off its centre: what the wall scatters lights all of it alike, whatever it gets from the lamp.
void addLampOffCentre(std::vector<AnalyticScene>& scenes) {
    const double rho = .5, offset = .5;
    for (const int side : {-1, 1}) {
        const double distance = 1 + side * offset;
        const std::string camera = orthographicView({0, 0, 0}, {0, 0, double(side)}, {0, 1, 0}, 1e-3);
        const std::string lamp = fmt::format("LightSource \"point\" \"rgb I\" {} \"point3 from\" [ 0 0 {} ]\n",
                                             spectrumOf(kPi), -offset);
        scenes.push_back({.id = side < 0 ? "A5 near" : "A5 far",
                          .claim = "wall of a Lambert sphere, point light I = pi at the distance d, off its centre: "
                                   "I rho / (pi d^2) + I rho^2 / (pi (1 - rho))",
                          .text = sceneText({.camera = camera, .maxDepth = 60}, lamp + diffuse(rho) + kSphereInside),
                          .expected = grey(rho / (distance * distance) + rho * rho / (1 - rho))});
    }
}

/// A shining ball in the middle of a hollow one: of what leaves the wall the part (r / R)^2 meets the ball.
void addConcentricSpheres(std::vector<AnalyticScene>& scenes) {
    const double wall = .6, ball = .3, part = .25;
    const std::string camera = "LookAt 0 0 .75  1 0 .75  0 0 1\nCamera \"perspective\" \"float fov\" [ 30 ]\n";
    const std::string world =
        scoped(diffuse(wall) + kSphereInside) + wallsThatEmit(diffuse(ball), 1, sphere(.5));
    scenes.push_back({.id = "A7",
                      .claim = "wall around a ball that emits 1 and reflects, radii 1 and .5",
                      .text = sceneText({.camera = camera, .maxDepth = 60}, world),
                      .expected = grey(wall * part / (1 - wall * (1 - part) - ball * wall * part))});
}

/// Non-absorbing glass in a furnace cannot be seen at all.
void addInvisibleGlass(std::vector<AnalyticScene>& scenes) {
    const std::string glass = constantSky(1) + "Material \"dielectric\" \"float eta\" [ 1.5 ]\n" + sphere(1);
    scenes.push_back(
        {.id = "A8",
         .claim = "a smooth glass sphere under a sky of radiance 1: 1 at every impact",
         .text = sceneText({.camera = orthographicView({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1.05), .maxDepth = 300}, glass),
         .expected = grey(1),
         .roulette = false,
         .exact = true});
    scenes.push_back({.id = "A9",
                      .claim = "from within that sphere, nearer to its centre than R / n: n^2",
                      .text = sceneText({.camera = "LookAt .2 .1 .3  .7 -.4 1  0 1 0\n"
                                                   "Camera \"perspective\" \"float fov\" [ 100 ]\n",
                                         .maxDepth = 300},
                                        glass),
                      .expected = grey(2.25),
                      .roulette = false,
                      .exact = true});
}

/// White fibres under a white sky lose nothing, however often light passes between them.
void addWhiteCurves(std::vector<AnalyticScene>& scenes) {
    const std::string points =
        " \"float width0\" [ .3 ] \"float width1\" [ .1 ] \"point3 P\" [ -1 0 -.6  -.4 .9 -.2  .4 -.9 .2  1 0 .6 ]\n";
    std::string fibres;
    for (const char* type : {R"("flat")", R"("cylinder")", R"("ribbon" "normal N" [ 0 -.4 1  .5 -1 .2 ])"})
        for (const int turn : {0, 35, 70})
            fibres += scoped(fmt::format("Rotate {} 1 2 3\nTranslate 0 0 .2\nShape \"curve\" \"string type\" ", turn) +
                             type + points);
    scenes.push_back(
        exactly({.id = "A10 fibres",
                 .claim = "white curves of every type under a sky of radiance 1: invisible",
                 .text = sceneText({.camera = orthographicView({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1), .maxDepth = 200},
                                   constantSky(1) + diffuse(1) + fibres),
                 .expected = grey(1)}));
}

}  // namespace

std::vector<AnalyticScene> analyticCavities() {
    std::vector<AnalyticScene> scenes;
    addFurnaces(scenes);
    addFurnacesAtScales(scenes);
    addOpenFurnaces(scenes);
    addIntegratingSpheres(scenes);
    addLampOffCentre(scenes);
    addConcentricSpheres(scenes);
    addInvisibleGlass(scenes);
    addWhiteCurves(scenes);
    return scenes;
}

}  // namespace penumbra
