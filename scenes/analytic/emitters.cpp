// Direct light: the irradiance E under every kind of emitter, and form factors.
//
// A Lambert receiver shows rho E / pi; all lights have radiance 1 unless said. B: one receiver point (Howell's
// catalogue of configuration factors, and Lambert's formulas); C: the mean over a whole receiver, which is the form
// factor.
#include "scenes/analytic/quadrature.h"
#include "scenes/analytic/scene_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra {

using namespace analytic;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRho = .5;

/// What the receiver point at the origin shows under `lights`, given its irradiance.
AnalyticScene point(const std::string& id, const std::string& claim, const std::string& lights, double irradiance) {
    return {.id = id,
            .claim = claim,
            .text = sceneText({.camera = viewOfOrigin()}, diffuse(kRho) + floorSquare(.1) + lights),
            .expected = grey(kRho * irradiance / kPi)};
}

AnalyticScene with(AnalyticScene::Strategy strategy, AnalyticScene scene) {
    scene.id += strategy == AnalyticScene::Strategy::LightSampling ? " light sampling" : " scattering only";
    scene.strategy = strategy;
    return scene;
}

/// Configuration factors times pi.
double underDisk(double radius, double height, double offAxis) {
    const double s = offAxis * offAxis + height * height, a2 = radius * radius;
    return kPi / 2 * (1 - (s - a2) / std::sqrt((s + a2) * (s + a2) - 4 * a2 * offAxis * offAxis));
}

double underCorner(double a, double b) {  // parallel rectangle a x b at height 1, receiver under one corner
    const double ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
    return .5 * (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb));
}

/// The irradiance at the origin of that part of a convex polygon of radiance 1 that is above z = 0 (Lambert 1760).
double underPolygon(const std::vector<Point>& corners) {
    const auto dot = [](const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
    std::vector<Point> above;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point &a = corners[i], &b = corners[(i + 1) % corners.size()];
        if (a.z >= 0) above.push_back(a);
        const double t = a.z / (a.z - b.z);
        if ((a.z < 0) != (b.z < 0)) above.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), 0});
    }
    double sum = 0;
    for (std::size_t i = 0; i < above.size(); ++i) {
        const Point &a = above[i], &b = above[(i + 1) % above.size()];
        const Point normal{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
        sum += std::acos(dot(a, b) / std::sqrt(dot(a, a) * dot(b, b))) * normal.z / std::sqrt(dot(normal, normal));
    }
    return std::abs(sum) / 2;
}

void addPolygons(std::vector<AnalyticScene>& scenes) {
    const auto add = [&](const std::string& id, const std::string& claim, const std::vector<Point>& corners) {
        std::string points;
        for (const Point& p : corners)
            points += fmt::format(" {} {} {}", p.x, p.y, p.z);
        const std::string shape =
            fmt::format("Shape \"trianglemesh\" \"point3 P\" [{} ] \"integer indices\" [ 0 1 2{} ]\n", points,
                        corners.size() == 4 ? " 0 2 3" : "");
        const AnalyticScene scene =
            point(id, claim, emitter(1, shape, "\"bool twosided\" true"), underPolygon(corners));
        scenes.push_back(scene);
        scenes.push_back(with(AnalyticScene::Strategy::LightSampling, scene));
        scenes.push_back(with(AnalyticScene::Strategy::ScatteringOnly, scene));
        scenes.back().samplesPerPixel = 512;
    };
    add("B9 triangle", "a slanted triangle light, by Lambert's formula", {{-.5, -.3, 1}, {1.2, -.2, 1.6}, {.2, 1, .8}});
    add("B9 sinking triangle", "a triangle light, one corner of it above the receiver's horizon",
        {{1, -1, -.5}, {1.2, 1, -.4}, {.8, .1, 1.5}});
    add("B9 sinking rectangle", "a slanted rectangle light, cut by the receiver's horizon",
        {{1, -1, -.5}, {1, 1, -.5}, {.7, 1, 1}, {.7, -1, 1}});
}

void addSpheres(std::vector<AnalyticScene>& scenes) {
    const AnalyticScene above = point("B1", "sphere light of radius 1 at distance 2 along the normal: E = pi (r/d)^2",
                                      emitter(1, sphere(1, {0, 0, 2})), kPi / 4);
    scenes.push_back(above);
    scenes.push_back(with(AnalyticScene::Strategy::LightSampling, above));
    scenes.push_back(with(AnalyticScene::Strategy::ScatteringOnly, above));
    scenes.push_back(point("B2",
                           "sphere light of radius 1 at distance 3, 60 degrees off the normal: E = pi (r/d)^2 cos",
                           emitter(1, sphere(1, {3 * std::sqrt(.75), 0, 1.5})), kPi / 18));
    scenes.push_back(point("B3", "sphere light of radius 1 at distance 2, its centre on the horizon",
                           emitter(1, sphere(1, {2, 0, 0})), std::atan(1 / std::sqrt(3.)) - std::sqrt(3.) / 4));
    scenes.back().samplesPerPixel = 256;
    const double sigma = .2666 * kPi / 180;
    scenes.push_back(point("B15", "the sun: a sphere of .2666 degrees half angle and radiance 1e4 in the zenith",
                           emitter(1e4, sphere(1000 * std::sin(sigma), {0, 0, 1000})),
                           1e4 * kPi * std::pow(std::sin(sigma), 2)));
}

void addDisks(std::vector<AnalyticScene>& scenes) {
    const AnalyticScene above = point("B4", "disk light of radius 1 at height 1 on the axis: E = pi a^2 / (a^2 + h^2)",
                                      emitter(1, disk(1, {0, 0, 1}, Facing::Negative)), kPi / 2);
    scenes.push_back(above);
    scenes.push_back(with(AnalyticScene::Strategy::LightSampling, above));
    scenes.push_back(with(AnalyticScene::Strategy::ScatteringOnly, above));
    scenes.push_back(point("B4 two-sided", "the same disk turned away, but two-sided",
                           emitter(1, disk(1, {0, 0, 1}, Facing::Positive), R"("bool twosided" true)"), kPi / 2));
    scenes.push_back(point(
        "B4 power", "the same disk with a power of pi^2 given: radiance power / (pi area) = 1",
        emitter(1, disk(1, {0, 0, 1}, Facing::Negative), fmt::format("\"float power\" [ {} ]", kPi * kPi)), kPi / 2));
    scenes.push_back(point("B5", "disk light of radius 1 at height 1, the receiver 1 off its axis",
                           emitter(1, disk(1, {1, 0, 1}, Facing::Negative)), underDisk(1, 1, 1)));

    // Howell B-14: receiver turned by 90 degrees, here in the plane x = 0 with the normal +x.
    const double h = .5, r = .5, z = 1 + h * h + r * r;
    AnalyticScene beside =
        point("B6", "disk light of radius 1 facing down, its axis at 2, 1 above a receiver that faces the axis", "",
              kPi * h / 2 * (z / std::sqrt(z * z - 4 * r * r) - 1));
    beside.text = sceneText({.camera = orthographicView({.5, 0, 0}, {0, 0, 0}, {0, 0, 1}, 1e-3)},
                            diffuse(kRho) + rectangleX(-.1, .1, -.1, .1, 0, Facing::Positive) +
                                emitter(1, disk(1, {2, 0, 1}, Facing::Negative)));
    scenes.push_back(beside);
}

void addCylinders(std::vector<AnalyticScene>& scenes) {
    // Howell B-31: an element and a right cylinder whose axis is parallel to it, over one end; here over the middle.
    const double r = .5, height = 1.5, half = 1, l = half / r, d = height / r, a = (d + 1) * (d + 1) + l * l,
                 b = (d - 1) * (d - 1) + l * l;
    const double towardsOneEnd =
        std::atan(l / std::sqrt(d * d - 1)) / d +
        l * ((a - 2 * d) / (d * std::sqrt(a * b)) * std::atan(std::sqrt(a * (d - 1) / (b * (d + 1)))) -
             std::atan(std::sqrt((d - 1) / (d + 1))) / d);
    const AnalyticScene lying =
        point("B22", "cylinder light of radius .5 and length 2 lying 1.5 over the receiver",
              emitter(1, cylinder(r, 2 * half, "Translate 0 0 1.5 Rotate 90 1 0 0")), 2 * towardsOneEnd);
    scenes.push_back(lying);
    scenes.push_back(with(AnalyticScene::Strategy::LightSampling, lying));
    scenes.push_back(with(AnalyticScene::Strategy::ScatteringOnly, lying));
    scenes.back().samplesPerPixel = 256;  // it fills a small part of the view
    // From below, the inside of a tube covers what is between the cones of its ends.
    scenes.push_back(
        point("B23", "the inside of a tube of radius 1 that stands upright, from 1 to 3 above the receiver",
              emitter(1, "ReverseOrientation\n" + cylinder(1, 2, "Translate 0 0 2")), kPi * (1. / 2 - 1. / 10)));
    scenes.push_back(point("B23 half", "half of its girth: half of that",
                           emitter(1, "ReverseOrientation\n" + cylinder(1, 2, "Translate 0 0 2", 180)),
                           kPi / 2 * (1. / 2 - 1. / 10)));
}

void addRectangles(std::vector<AnalyticScene>& scenes) {
    scenes.push_back(point("B7", "square light 1 x 1 at height 1, the receiver under one corner",
                           emitter(1, rectangleZ(0, 1, 0, 1, 1, Facing::Negative)), underCorner(1, 1)));
    const AnalyticScene centred =
        point("B7b", "square light 2 x 2 at height 1, centred over the receiver",
              emitter(1, rectangleZ(-1, 1, -1, 1, 1, Facing::Negative)), 4 * underCorner(1, 1));
    scenes.push_back(centred);
    scenes.push_back(with(AnalyticScene::Strategy::LightSampling, centred));
    scenes.push_back(with(AnalyticScene::Strategy::ScatteringOnly, centred));

    AnalyticScene direct = centred;
    direct.id = "B7b direct";
    direct.text =
        sceneText({.camera = viewOfOrigin(), .maxDepth = kNoDepth, .integrator = "direct"},
                  diffuse(kRho) + floorSquare(.1) + emitter(1, rectangleZ(-1, 1, -1, 1, 1, Facing::Negative)));
    scenes.push_back(direct);

    scenes.push_back(point("B8",
                           "wall light 1 x 1 standing on the floor's plane at distance 1, opposite one lower corner",
                           emitter(1, rectangleX(0, 1, 0, 1, 1, Facing::Negative)),
                           .5 * (std::atan(1.) - 1 / std::sqrt(2.) * std::atan(1 / std::sqrt(2.)))));

    // Seen in the mirror x = 0 the light continues on the other side. The receiver touches the mirror.
    AnalyticScene mirror =
        point("B21", "as B7, with a mirror wall in the plane of the light's edge: twice B7", "", 2 * underCorner(1, 1));
    const std::string wall = scoped("Material \"conductor\" \"rgb eta\" [ 1 1 1 ] \"rgb k\" [ 1000 1000 1000 ]\n" +
                                    rectangleX(-50, 50, -1, 50, 0, Facing::Positive));
    mirror.text = sceneText({.camera = orthographicView({1e-3, 0, .5}, {1e-3, 0, 0}, {0, 1, 0}, 1e-3), .maxDepth = 2},
                            diffuse(kRho) + rectangleZ(-.1, .1, -.1, .1, 0, Facing::Positive) + wall +
                                emitter(1, rectangleZ(0, 1, 0, 1, 1, Facing::Negative)));
    mirror.samplesPerPixel = 128;
    scenes.push_back(mirror);

    // The same solid angle at every size, so the same irradiance.
    for (const double scale : {1e-4, 1e6}) {
        AnalyticScene scaled = centred;
        scaled.id = scale < 1 ? "B7b tiny" : "B7b huge";
        scaled.claim = fmt::format("as B7b, all lengths times {}", scale);
        scaled.text = sceneText({.camera = orthographicView({0, 0, .5 * scale}, {0, 0, 0}, {0, 1, 0}, 1e-3 * scale)},
                                diffuse(kRho) + floorSquare(.1 * scale) +
                                    emitter(1, rectangleZ(-scale, scale, -scale, scale, scale, Facing::Negative)));
        scenes.push_back(scaled);
    }
}

/// A lamp whose radiance is an image.
void addPicture(std::vector<AnalyticScene>& scenes) {
    // Over y from 0 to 2, u = y / 2: .5 below u = 1/4, 2 above 3/4, linear between; times a scale of 2. At height 1 the
    // form factor's integrand is 1 / (pi d^4), whose integral over x is elementary.
    const auto radiance = [](double y) { return 2 * (.5 + 1.5 * std::clamp(y - .5, 0., 1.)); };
    const auto acrossX = [](double y) {
        const double c2 = y * y + 1, c = std::sqrt(c2);
        return 1 / (c2 * (1 + c2)) + std::atan(1 / c) / (c2 * c);
    };
    double irradiance = 0;
    for (const auto& [from, to] : {std::pair{0., .5}, {.5, 1.5}, {1.5, 2.}})
        irradiance += integrate(from, to, [&](double y) { return radiance(y) * acrossX(y); });
    AnalyticScene s =
        point("B7p",
              "lamp 2 x 2 at height 1, its edge over the receiver, whose radiance is an image: two pixels, "
              "and a ramp between them",
              scoped(black() +
                     "AreaLightSource \"diffuse\" \"string filename\" \"ramp.pfm\" \"float scale\" "
                     "[ 2 ]\n" +
                     rectangleZ(-1, 1, 0, 2, 1, Facing::Negative)),
              irradiance);
    s.files = {{"ramp.pfm", pfmImage(2, 1, {{.5f, .5f, .5f}, {2.f, 2.f, 2.f}})}};
    s.samplesPerPixel = 128;
    scenes.push_back(s);
    scenes.push_back(with(AnalyticScene::Strategy::LightSampling, s));
    scenes.push_back(with(AnalyticScene::Strategy::ScatteringOnly, s));
}

/// Many lights: each must be picked as often as its pick probability says.
void addManyLights(std::vector<AnalyticScene>& scenes) {
    const std::string lights = emitter(1, rectangleZ(0, 1, 0, 1, 1, Facing::Negative)) +
                               emitter(2, rectangleZ(-1, 0, 0, 1, 1, Facing::Negative)) +
                               emitter(3, rectangleZ(-1, 0, -1, 0, 1, Facing::Negative)) +
                               emitter(10, rectangleZ(0, 1, -1, 0, 1, Facing::Negative));
    for (const char* picks : {"uniform", "power", "bvh"}) {
        AnalyticScene s =
            point(fmt::format("B7 four lights, {}", picks),
                  "four corner lights of radiances 1, 2, 3 and 10: sixteen times B7", lights, 16 * underCorner(1, 1));
        s.text = sceneText(
            {.camera = viewOfOrigin(), .integratorParameters = fmt::format("\"string lightsampler\" \"{}\"", picks)},
            diffuse(kRho) + floorSquare(.1) + lights);
        s.samplesPerPixel = 128;
        scenes.push_back(s);
    }
}

void addSky(std::vector<AnalyticScene>& scenes) {
    const std::string wall = scoped(black() + rectangleX(-1000, 1000, -1, 1, 1, Facing::Negative));
    const AnalyticScene beside =
        point("B12", "sky of radiance 1, beside a black wall without end whose top stands at 45 degrees",
              constantSky(1) + wall, kPi * (1 + std::cos(kPi / 4)) / 2);
    scenes.push_back(beside);

    AnalyticScene occlusion = beside;
    occlusion.id = "B12 occlusion";
    occlusion.claim = "the same by the ambient occlusion integrator: the open part, cosine-weighted";
    occlusion.text = sceneText({.camera = viewOfOrigin(), .maxDepth = kNoDepth, .integrator = "ambientocclusion"},
                               floorSquare(.1) + wall);
    occlusion.expected = grey((1 + std::cos(kPi / 4)) / 2);
    scenes.push_back(occlusion);

    AnalyticScene limited = occlusion;
    limited.id = "B12 occlusion within 2";
    limited.claim =
        "a ceiling at height 1 occludes within a distance of 2 what is steeper than 60 degrees: 1/4 stays open";
    limited.text = sceneText({.camera = viewOfOrigin(),
                              .maxDepth = kNoDepth,
                              .integrator = "ambientocclusion",
                              .integratorParameters = "\"float maxdistance\" [ 2 ]"},
                             floorSquare(.1) + rectangleZ(-10, 10, -10, 10, 1, Facing::Negative));
    limited.expected = grey(.25);
    limited.samplesPerPixel = 256;
    scenes.push_back(limited);
}

/// Light direction -> pixel -> radiance of a 16 x 16 equal-area octahedral map; coloured, smooth, and nowhere
/// symmetric.
std::array<float, 3> mapPixel(int column, int row) {
    const double s = (column + .5) / 16, t = (row + .5) / 16;
    return {static_cast<float>(.2 + s), static_cast<float>(.1 + 3 * t * t), static_cast<float>(std::exp(3 * s * t))};
}

/// The direction of the point (s, t) of an equal-area octahedral map (Clarberg 2008).
Point mapDirection(double s, double t) {
    const double u = 2 * s - 1, v = 2 * t - 1, sigma = 1 - std::abs(u) - std::abs(v), r = 1 - std::abs(sigma);
    const double phi = kPi / 4 * (r == 0 ? 1 : 1 + (std::abs(v) - std::abs(u)) / r), rho = r * std::sqrt(2 - r * r);
    return {std::copysign(rho * std::cos(phi), u), std::copysign(rho * std::sin(phi), v),
            std::copysign(1 - r * r, sigma)};
}

/// A receiver turned so that its normal in the map's frame is -y (the map's "up" z stands along the world's y).
AnalyticScene mapScene() {
    std::vector<std::array<float, 3>> pixels;
    for (int row = 0; row < 16; ++row)
        for (int column = 0; column < 16; ++column)
            pixels.push_back(mapPixel(column, row));

    constexpr int kFine = 1024;  // points of the map a side; every pixel has the same solid angle
    std::array<double, 3> irradiance{};
    for (int j = 0; j < kFine; ++j)
        for (int i = 0; i < kFine; ++i) {
            const double cosine = -mapDirection((i + .5) / kFine, (j + .5) / kFine).y;
            const std::array<float, 3>& radiance =
                pixels[static_cast<std::size_t>(j / (kFine / 16) * 16 + i / (kFine / 16))];
            for (std::size_t c = 0; c < 3; ++c)
                irradiance[c] += std::max(0., cosine) * radiance[c];
        }
    AnalyticScene s =
        point("L6", "image sky, equal-area, standing upright: the sum over its pixels of radiance times cosine", "", 0);
    s.text = sceneText({.camera = viewOfOrigin()},
                       diffuse(kRho) + floorSquare(.1) +
                           scoped("Rotate -90 1 0 0\nLightSource \"infinite\" \"string filename\" \"sky.pfm\"\n"));
    s.files = {{"sky.pfm", pfmImage(16, 16, pixels)}};
    for (std::size_t c = 0; c < 3; ++c)
        s.expected[c] = kRho / kPi * irradiance[c] * 4 * kPi / (kFine * kFine);
    s.samplesPerPixel = 128;
    return s;
}

/// The top row of an image by latitude and longitude: a cap of pi / 8 round the zenith.
AnalyticScene latLongScene() {
    std::vector<std::array<float, 3>> pixels(16 * 8, {0.f, 0.f, 0.f});
    std::fill_n(pixels.begin(), 16, std::array{1.f, 1.f, 1.f});
    AnalyticScene s = point("L6 latitude", "image sky by latitude and longitude: a cap of 22.5 degrees, E = pi sin^2",
                            "LightSource \"infinite\" \"string filename\" \"cap.pfm\" \"string mapping\" \"latlong\"\n",
                            kPi * std::pow(std::sin(kPi / 8), 2));
    s.files = {{"cap.pfm", pfmImage(16, 8, pixels)}};
    return s;
}

/// A sky that comes through a window alone is a lamp of the window's size.
void addPortal(std::vector<AnalyticScene>& scenes) {
    const AnalyticScene window =
        point("L10", "constant sky through a portal 2 x 2 at height 1: as B7b",
              "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ] \"point3 portal\" [ -1 -1 1  -1 1 1  1 1 1  1 -1 1 ]\n",
              4 * underCorner(1, 1));
    scenes.push_back(window);
    scenes.push_back(with(AnalyticScene::Strategy::LightSampling, window));
    scenes.push_back(with(AnalyticScene::Strategy::ScatteringOnly, window));
}

/// Point, distant and infinite lights: one direction or none to choose, so nothing is random.
void addLightsOfOneDirection(std::vector<AnalyticScene>& scenes) {
    const auto add = [&](AnalyticScene s) {
        s.exact = true;
        s.samplesPerPixel = 4;
        scenes.push_back(std::move(s));
    };
    const std::string parallel =
        "LightSource \"distant\" \"rgb L\" [ 3 2 1 ] \"point3 from\" [ {} 0 {} ] \"point3 to\" [ 0 0 0 ]\n";
    AnalyticScene sun = point("L1", "distant light of irradiance (3, 2, 1) from the zenith",
                              fmt::format(fmt::runtime(parallel), 0, 1), 0);
    sun.expected = {3 * kRho / kPi, 2 * kRho / kPi, kRho / kPi};
    add(sun);
    sun.id = "L1 slanted";
    sun.claim = "the same, 60 degrees from the zenith: half of it";
    sun.text = sceneText({.camera = viewOfOrigin()},
                         diffuse(kRho) + floorSquare(.1) + fmt::format(fmt::runtime(parallel), std::sqrt(.75), .5));
    for (double& e : sun.expected)
        e *= .5;
    add(sun);
    add(point("L2", "point light of intensity 4 at height 2: E = I / d^2",
              "LightSource \"point\" \"rgb I\" [ 4 4 4 ] \"point3 from\" [ 0 0 2 ]\n", 1));
    add(point("L3", "point light of power 16 pi at height 2: intensity power / (4 pi)",
              fmt::format("LightSource \"point\" \"float power\" [ {} ] \"point3 from\" [ 0 0 2 ]\n", 16 * kPi), 1));
    add(point("L4", "distant light of illuminance 2",
              "LightSource \"distant\" \"float illuminance\" [ 2 ] \"point3 from\" [ 0 0 1 ] \"point3 to\" [ 0 0 0 ]\n",
              2));
    scenes.push_back(
        point("L5", "constant sky of illuminance 1", "LightSource \"infinite\" \"float illuminance\" [ 1 ]\n", 1));
    scenes.push_back(mapScene());
    scenes.push_back(latLongScene());

    AnalyticScene floor = point("B19",
                                "point light of intensity 1 at height 1 over the centre of a 2 x 2 floor: mean E = "
                                "I Omega / A, Omega = 2 pi / 3",
                                "", 2 * kPi / 3 / 4);
    floor.text = sceneText(
        {.camera = orthographicView({0, 0, .5}, {0, 0, 0}, {0, 1, 0}, 1)},
        diffuse(kRho) + floorSquare(2) + "LightSource \"point\" \"rgb I\" [ 1 1 1 ] \"point3 from\" [ 0 0 1 ]\n");
    scenes.push_back(floor);

    const auto overTheFloor = [&](const std::string& id, const std::string& claim, const std::string& light,
                                  double mean) {
        AnalyticScene s = floor;
        s.id = id;
        s.claim = claim;
        s.text = sceneText({.camera = orthographicView({0, 0, .5}, {0, 0, 0}, {0, 1, 0}, 1)},
                           diffuse(kRho) + floorSquare(2) + light);
        s.expected = grey(kRho / kPi * mean);
        return s;
    };
    scenes.push_back(overTheFloor(
        "L7", "spotlight of power 4 pi, whose cone and falloff the floor catches whole: mean E = power / A",
        fmt::format("LightSource \"spot\" \"float power\" [ {} ] \"point3 from\" [ 0 0 1 ] \"point3 to\" [ .1 .1 0 ] "
                    "\"float coneangle\" [ 30 ] \"float conedeltaangle\" [ 20 ]\n",
                    4 * kPi),
        kPi));

    // Of a screen of one pixel the power is taken at its centre: intensity power / (4 tan^2). Its light fills a
    // pyramid.
    const double half = kPi / 6, tangent = std::tan(half);
    AnalyticScene slide = overTheFloor(
        "L8",
        "projector of one pixel, power 12 and fov 60 at height 1: mean E = power / (4 tan^2) Omega / A, Omega = 4 asin "
        "sin^2(fov / 2)",
        scoped(
            "Translate 0 0 1\nRotate 180 1 0 0\nLightSource \"projection\" \"string filename\" \"slide.pfm\" \"float "
            "fov\" [ 60 ] \"float power\" [ 12 ]\n"),
        12 / (4 * tangent * tangent) * 4 * std::asin(std::sin(half) * std::sin(half)) / 4);
    slide.files = {{"slide.pfm", pfmImage(1, 1, {{.25f, .25f, .25f}})}};
    scenes.push_back(slide);

    // The lamp's -y, the outer half of its map, shines downwards.
    AnalyticScene lamp = overTheFloor(
        "L9", "measured lamp of intensity 3 downwards, 1 upwards, hung at height 1 over the floor: three times B19",
        scoped(
            "Translate 0 0 1\nRotate 90 1 0 0\nLightSource \"goniometric\" \"string filename\" \"lamp.pfm\" \"rgb I\" "
            "[ 10 10 10 ]\n"),
        3 * 2 * kPi / 3 / 4);
    std::vector<std::array<float, 3>> values;
    for (int row = 0; row < 16; ++row)
        for (int column = 0; column < 16; ++column) {
            const bool up = mapDirection((column + .5) / 16, (row + .5) / 16).z > 0;
            values.push_back(up ? std::array{.1f, .1f, .1f} : std::array{.3f, .3f, .3f});
        }
    lamp.files = {{"lamp.pfm", pfmImage(16, 16, values)}};
    scenes.push_back(lamp);

    AnalyticScene textured = floor;
    textured.id = "T1";
    textured.claim =
        "a 2 x 2 image of reflectances .1 .3 .5 .7 over a square in parallel light of irradiance pi: their mean";
    textured.text = sceneText(
        {.camera = orthographicView({.5, .5, .5}, {.5, .5, 0}, {0, 1, 0}, .5)},
        fmt::format("Texture \"image\" \"spectrum\" \"imagemap\" \"string filename\" \"reflectance.pfm\"\n"
                    "Material \"diffuse\" \"texture reflectance\" \"image\"\n"
                    "LightSource \"distant\" \"rgb L\" {} \"point3 from\" [ 0 0 1 ] \"point3 to\" [ 0 0 0 ]\n",
                    spectrumOf(kPi)) +
            rectangleZ(0, 1, 0, 1, 0, Facing::Positive));
    textured.files = {
        {"reflectance.pfm", pfmImage(2, 2, {{.1f, .1f, .1f}, {.3f, .3f, .3f}, {.5f, .5f, .5f}, {.7f, .7f, .7f}})}};
    textured.expected = grey(.4);
    scenes.push_back(textured);
}

void addFormFactors(std::vector<AnalyticScene>& scenes) {
    // Seen from straight above, the picture's mean is the mean over the receiver: rho times the form factor.
    const auto square = [&](const std::string& id, const std::string& claim, const std::string& lights,
                            double formFactor) {
        AnalyticScene s = point(id, claim, "", kPi * formFactor);
        s.text = sceneText({.camera = orthographicView({.5, .5, .5}, {.5, .5, 0}, {0, 1, 0}, .5)},
                           diffuse(kRho) + rectangleZ(0, 1, 0, 1, 0, Facing::Positive) + lights);
        scenes.push_back(s);
    };
    const double r2 = std::sqrt(2.);
    const double opposite = 2 / kPi * (std::log(std::sqrt(4. / 3)) + 2 * r2 * std::atan(1 / r2) - 2 * std::atan(1.));
    const double adjacent = 1 / kPi * (2 * std::atan(1.) - r2 * std::atan(1 / r2) + .25 * std::log(3. / 4));
    const std::string ceiling = emitter(1, rectangleZ(0, 1, 0, 1, 1, Facing::Negative));
    const std::string wall = emitter(1, rectangleX(0, 1, 0, 1, 0, Facing::Positive));
    square("C1", "two parallel unit squares 1 apart: form factor (Howell C-11)", ceiling, opposite);
    square("C2", "two unit squares that share an edge at 90 degrees: form factor (Howell C-14)", wall, adjacent);
    std::string sides = ceiling;
    for (const int turn : {0, 90, 180, 270})
        sides += scoped(fmt::format("Translate .5 .5 0\nRotate {} 0 0 1\nTranslate -.5 -.5 0\n", turn) + wall);
    square("C3", "the floor of a cube whose other five sides emit 1: the form factors add to 1", sides, 1);

    const std::string above = orthographicView({0, 0, .5}, {0, 0, 0}, {0, 1, 0}, 1);
    AnalyticScene disks = point("C4", "coaxial unit disks 1 apart: form factor; the disk fills pi/4 of the picture", "",
                                kPi * (3 - std::sqrt(5.)) / 2 * kPi / 4);
    disks.text = sceneText({.camera = above}, diffuse(kRho) + disk(1, {}, Facing::Positive) +
                                                  emitter(1, disk(1, {0, 0, 1}, Facing::Negative)));
    scenes.push_back(disks);

    // Of the sphere's flux 4 pi^2 r^2 a disk of radius 2 at distance 2 takes the fraction (1 - 1/sqrt 2) / 2.
    AnalyticScene under = point("C5", "unit sphere light, its centre 2 above a coaxial disk of radius 2: form factor",
                                "", 4 * kPi * kPi * (1 - 1 / r2) / 2 / (4 * kPi) * kPi / 4);
    under.text = sceneText({.camera = orthographicView({0, 0, .5}, {0, 0, 0}, {0, 1, 0}, 2)},
                           diffuse(kRho) + disk(2, {}, Facing::Positive) + emitter(1, sphere(1, {0, 0, 2})));
    scenes.push_back(under);
}

/// Surfaces that shine and scatter too: what goes through one of them starts beyond it, and cannot be lit by it.
void addShiningSheets(std::vector<AnalyticScene>& scenes) {
    const auto add = [&](AnalyticScene scene) {
        scenes.push_back(scene);
        scenes.push_back(with(AnalyticScene::Strategy::LightSampling, scene));
        scenes.push_back(with(AnalyticScene::Strategy::ScatteringOnly, scene));
    };
    const std::string lamp = "AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ] \"bool twosided\" true\n";
    const std::string paper = lamp + "Material \"diffusetransmission\" \"rgb reflectance\" [ .1 .1 .1 ] "
                                     "\"rgb transmittance\" [ .8 .8 .8 ]\n";
    const std::string triangle = "Shape \"trianglemesh\" \"point3 P\" [ -3 -2 0  3 -2 0  0 4 0 ]";
    const auto alone = [&](const std::string& id, const std::string& claim, const std::string& world) {
        const std::string camera = orthographicView({1, 2, 3}, {0, 0, 0}, {0, 1, 0}, .3);
        add({.id = id,
             .claim = claim,
             .text = sceneText({.camera = camera, .maxDepth = 3}, world),
             .expected = grey(1),
             .exact = true});
    };
    alone("B24 sheet", "a lone sheet that shines 1 on both sides and lets light through: 1", paper + floorSquare(1));
    alone("B24 triangle", "the same, a triangle", paper + triangle + "\n");
    alone("B24 bent", "a lone triangle whose smooth normals send much of what it scatters into itself shines 1",
          lamp + diffuse(.5) + triangle + " \"normal N\" [ -4 -3 1  4 -3 1  0 5 1 ]\n");

    constexpr double kReflected = .1, kTransmitted = .8;
    const std::string camera = orthographicView({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, .6);
    add({.id = "B24 globe",
         .claim = "a paper globe that shines 1 on both sides: inside 1 / (1 - rho), outside 1 + tau times that",
         .text = sceneText({.camera = camera, .maxDepth = 12}, paper + sphere(1)),
         .expected = grey(1 + kTransmitted * (1 - std::pow(kReflected, 12)) / (1 - kReflected))});
}

}  // namespace

std::vector<AnalyticScene> analyticEmitters() {
    std::vector<AnalyticScene> scenes;
    addSpheres(scenes);
    addDisks(scenes);
    addCylinders(scenes);
    addRectangles(scenes);
    addPolygons(scenes);
    addPicture(scenes);
    addManyLights(scenes);
    addSky(scenes);
    addPortal(scenes);
    addLightsOfOneDirection(scenes);
    addFormFactors(scenes);
    addShiningSheets(scenes);
    return scenes;
}

}  // namespace penumbra
