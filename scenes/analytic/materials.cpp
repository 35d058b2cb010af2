// What materials do to light: Fresnel's formulas, glass slabs, coats, microfacets, absorption, mixes.
//
// Microfacet values are the directional albedo of single scattering by visible facets (height-correlated Smith), found
// by quadrature over the visible normals (Heitz 2018) and, for GGX with alpha = 1 at normal incidence, in closed form.
#include "scenes/analytic/quadrature.h"
#include "scenes/analytic/scene_text.h"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace penumbra {

using namespace analytic;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kIor = 1.5;

/// Unpolarised reflectance of a boundary of the given (complex) relative index.
double fresnel(double cosine, std::complex<double> index) {
    const std::complex<double> inside = std::sqrt(1. - (1 - cosine * cosine) / (index * index));
    const std::complex<double> rs = (cosine - index * inside) / (cosine + index * inside);
    const std::complex<double> rp = (index * cosine - inside) / (index * cosine + inside);
    return .5 * (std::norm(rs) + std::norm(rp));
}

/// Reflectance of a boundary for diffuse light from the thin side (Walsh 1926, Duntley 1942).
double diffuseFresnelOutside(double n) {
    const double n2 = n * n, n4 = n2 * n2;
    return .5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
           n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
           2 * n * n2 * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
           8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
}

/// The same from the dense side: what does not leave, by reciprocity.
double diffuseFresnelInside(double n) {
    return 1 - (1 - diffuseFresnelOutside(n)) / (n * n);
}

std::string dielectric(const std::string& more = {}) {
    return fmt::format("Material \"dielectric\" \"float eta\" [ {} ] {}\n", kIor, more);
}

/// A view of the origin whose rays make an angle of the given cosine with +z.
std::string slantedView(double cosine) {
    return orthographicView({.5 * std::sqrt(1 - cosine * cosine), 0, .5 * cosine}, {0, 0, 0}, {0, 1, 0}, 1e-3);
}

/// A plane of the material at z = 0 under a sky of radiance 1, seen under an angle.
AnalyticScene underSky(const std::string& id, const std::string& claim, const std::string& material, double cosine,
                       double value, int maxDepth = 1) {
    return {.id = id,
            .claim = claim,
            .text = sceneText({.camera = slantedView(cosine), .maxDepth = maxDepth},
                              constantSky(1) + material + floorSquare(10)),
            .expected = grey(value)};
}

AnalyticScene exactly(AnalyticScene scene) {
    scene.exact = true;
    scene.samplesPerPixel = 4;
    return scene;
}

/// R0 + (1 - R0) (1 - cos)^5.
double schlick(double cosine, double perpendicular) {
    return perpendicular + (1 - perpendicular) * std::pow(1 - cosine, 5);
}

void addConductors(std::vector<AnalyticScene>& scenes) {
    const std::string metal = "Material \"conductor\" \"rgb eta\" [ .2 .2 .2 ] \"rgb k\" [ 3 3 3 ]\n";
    scenes.push_back(
        exactly(underSky("F11", "smooth conductor of index .2 + 3i, normal incidence", metal, 1, fresnel(1, {.2, 3}))));
    scenes.push_back(exactly(underSky("F11 slanted", "the same at 75 degrees", metal, std::cos(75 * kPi / 180),
                                      fresnel(std::cos(75 * kPi / 180), {.2, 3}))));
    scenes.push_back(exactly(underSky("F11 Schlick", "the same by Schlick's approximation, at 60 degrees",
                                      "Material \"conductor\" \"rgb eta\" [ .2 .2 .2 ] \"rgb k\" [ 3 3 3 ] "
                                      "\"string fresnel\" \"schlick\"\n",
                                      .5, schlick(.5, fresnel(1, {.2, 3})))));
    AnalyticScene coloured =
        exactly(underSky("F12", "smooth conductor given by its reflectance (.3, .5, .7), normal incidence",
                         "Material \"conductor\" \"rgb reflectance\" [ .3 .5 .7 ]\n", 1, 0));
    coloured.expected = {.3, .5, .7};
    scenes.push_back(coloured);
}

void addMicrofacets(std::vector<AnalyticScene>& scenes) {
    const auto add = [&](double alphaX, double alphaY, double cosine, const std::string& frame, double value) {
        const std::string metal = fmt::format(
            "{}Material \"conductor\" \"rgb eta\" [ 1 1 1 ] \"rgb k\" [ 1000 1000 1000 ] \"bool remaproughness\" false "
            "\"float uroughness\" [ {} ] \"float vroughness\" [ {} ]\n",
            frame, alphaX, alphaY);
        scenes.push_back(underSky(fmt::format("G {} {} {}{}", alphaX, alphaY, cosine, frame.empty() ? "" : " turned"),
                                  "GGX mirror under a sky of radiance 1: directional albedo of single scattering",
                                  metal, cosine, value));
    };
    add(.1, .1, 1, "", .9883040565);
    add(.1, .1, .5, "", .9692049844);
    add(.1, .1, .1, "", .8834550019);
    add(.5, .5, 1, "", .6878485151);
    add(.5, .5, .5, "", .6982506969);
    add(.5, .5, .1, "", .8601050727);
    add(1, 1, 1, "", 1 - std::log(2.));
    add(1, 1, .5, "", .4506938557);
    add(1, 1, .1, "", .7602104727);
    // Anisotropic: the plane's uv run along x and y, so x is the rough direction; turned, it is the smooth one.
    add(.6, .2, 1, "", .740246);
    add(.6, .2, .5, "", .765985);
    add(.6, .2, .5, "Rotate 90 0 0 1\n", .710240);

    for (const double alpha : {.1, .5, 1.})
        scenes.push_back(underSky(fmt::format("G multiscatter {}", alpha),
                                  "GGX mirror with multiscatter under a sky of radiance 1: all of it",
                                  fmt::format("Material \"conductor\" \"rgb eta\" [ 1 1 1 ] \"rgb k\" [ 1000 1000 1000 ] "
                                              "\"bool remaproughness\" false \"float roughness\" [ {} ] "
                                              "\"bool multiscatter\" true\n",
                                              alpha),
                                  .5, 1));

    scenes.push_back(underSky("G glass", "rough glass boundary, alpha .5, at 60 degrees from outside: R + T / n^2",
                              dielectric("\"bool remaproughness\" false \"float roughness\" [ .5 ]"), .5, .421134));
    scenes.push_back(underSky(
        "G glass inside", "rough glass boundary, alpha .3, at 60 degrees from inside: R + T n^2",
        dielectric("\"bool remaproughness\" false \"float roughness\" [ .3 ]") + "ReverseOrientation\n", .5, .948672));
}

/// One boundary over a black floor: only what it reflects is seen.
void addBoundaries(std::vector<AnalyticScene>& scenes) {
    const std::string floor = scoped(black() + rectangleZ(-50, 50, -50, 50, -.5, Facing::Positive));
    const double brewster = 1 / std::sqrt(1 + kIor * kIor);
    for (const double cosine : {1., brewster, .2}) {
        AnalyticScene s = underSky(cosine == 1          ? "F1"
                                   : cosine == brewster ? "F2"
                                                        : "F2 grazing",
                                   fmt::format("reflectance of glass at cosine {:.3f}", cosine), floor + dielectric(),
                                   cosine, fresnel(cosine, kIor), 3);
        s.samplesPerPixel = 1024;
        scenes.push_back(s);
    }
}

/// Two mirrors face to face, and a lamp at the end: every reflection takes its part.
void addFacingMirrors(std::vector<AnalyticScene>& scenes) {
    const std::string metal = "Material \"conductor\" \"rgb eta\" [ .2 .2 .2 ] \"rgb k\" [ 3 3 3 ]\n";
    const std::string camera = orthographicView({0, 0, .5}, {1, 0, 1.5}, {0, 1, 0}, 1e-2);
    scenes.push_back(
        exactly({.id = "F7",
                 .claim = "a lamp of radiance 1 seen by five reflections at 45 degrees between two mirrors",
                 .text = sceneText({.camera = camera, .maxDepth = 5},
                                   metal + rectangleZ(-10, 10, -10, 10, 0, Facing::Positive) +
                                       rectangleZ(-10, 10, -10, 10, 1, Facing::Negative) +
                                       emitter(1, rectangleX(-1, 1, 0, 1, 5, Facing::Negative))),
                 .expected = grey(std::pow(fresnel(std::sqrt(.5), {.2, 3}), 5)),
                 .roulette = false}));
}

/// Sheets without thickness.
void addSheets(std::vector<AnalyticScene>& scenes) {
    const std::string floor = scoped(black() + rectangleZ(-50, 50, -50, 50, -.5, Facing::Positive));
    const double r = fresnel(.5, kIor);
    scenes.push_back(underSky("F5", "reflectance of a thin pane at 60 degrees, all interreflections: 2 R / (1 + R)",
                              floor + fmt::format("Material \"thindielectric\" \"float eta\" [ {} ]\n", kIor), .5,
                              2 * r / (1 + r), 3));
    scenes.back().samplesPerPixel = 1024;
    // Below the sheet a lamp so near that nothing else is to be seen from there. (The sheet is much larger than that
    // distance, so rays leave it where rounding has a say.)
    const std::string lamp = emitter(2, rectangleZ(-100, 100, -100, 100, -.1, Facing::Positive));
    const AnalyticScene paper =
        underSky("F6", "paper between a sky of radiance 1 and a lamp of radiance 2: rho + 2 tau",
                 lamp + "Material \"diffusetransmission\" \"rgb reflectance\" [ .2 .2 .2 ] "
                        "\"rgb transmittance\" [ .7 .7 .7 ]\n",
                 1, .2 + 2 * .7);
    addInAllStrategies(scenes, paper, paper.samplesPerPixel);
}

/// Schlick's approximation, from outside and, at the angle inside that belongs to it, from inside.
void addSchlickBoundaries(std::vector<AnalyticScene>& scenes) {
    const std::string floor = scoped(black() + rectangleZ(-50, 50, -50, 50, -.5, Facing::Positive));
    const double outside = .4, inside = std::sqrt(1 - (1 - outside * outside) / (kIor * kIor));
    for (const bool fromInside : {false, true}) {
        scenes.push_back(underSky(fromInside ? "F1 Schlick inside" : "F1 Schlick", "reflectance of glass by Schlick's approximation",
                                  floor + dielectric("\"string fresnel\" \"schlick\"") +
                                      (fromInside ? "ReverseOrientation\n" : ""),
                                  fromInside ? inside : outside, schlick(outside, fresnel(1, kIor)), 3));
        scenes.back().samplesPerPixel = 1024;
    }
}

/// Glass between z = 0 and z = -1, all interreflections, seen along the normal. (No wider than need be: rays leave a wall
/// at a distance in proportion to its corners' coordinates, which the absorbing slab would lack.)
void addSlabs(std::vector<AnalyticScene>& scenes) {
    const std::string slab =
        rectangleZ(-5, 5, -5, 5, 0, Facing::Positive) + rectangleZ(-5, 5, -5, 5, -1, Facing::Negative);
    const std::string behind = emitter(1, rectangleZ(-5, 5, -5, 5, -2, Facing::Positive));
    const std::string before = emitter(1, rectangleZ(-5, 5, -5, 5, 2, Facing::Negative));
    const double r = fresnel(1, kIor), a = std::exp(-1.);
    const auto add = [&](const std::string& id, const std::string& claim, const std::string& integrator,
                         const std::string& world, double value) {
        scenes.push_back(
            {.id = id,
             .claim = claim,
             .text = sceneText({.camera = viewOfOrigin(), .maxDepth = 40, .integrator = integrator}, world),
             .expected = grey(value),
             .samplesPerPixel = 256});
    };
    add("F3", "clear glass slab: transmission (1 - R) / (1 + R)", "path", behind + dielectric() + slab,
        (1 - r) / (1 + r));
    add("F3b", "clear glass slab: reflection 2 R / (1 + R)", "path", before + dielectric() + slab, 2 * r / (1 + r));
    scenes.back().samplesPerPixel = 1024;

    const std::string fog =
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 1 1 ] "
        "\"rgb sigma_s\" [ 0 0 0 ]\n";
    const std::string filled = "MediumInterface \"fog\" \"\"\n" + slab;
    add("F4", "glass slab with an optical depth of 1: (1 - R)^2 a / (1 - R^2 a^2), a = 1/e", "volpath",
        fog + behind + scoped(dielectric() + filled), (1 - r) * (1 - r) * a / (1 - r * r * a * a));
    add("E1", "absorbing slab without a boundary, optical depth 1: 1/e", "volpath",
        fog + behind + scoped("Material \"interface\"\n" + filled), a);
    scenes.back() = exactly(scenes.back());

    AnalyticScene ball =
        underSky("E1 ball", "absorbing ball of index 1 and optical depths (1, 2, 3) along its diameter", "", 1, 0);
    ball.text = sceneText(
        {.camera = orthographicView({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1e-3), .maxDepth = 10, .integrator = "volpath"},
        "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ .5 1 1.5 ] "
        "\"rgb sigma_s\" [ 0 0 0 ]\n" +
            constantSky(1) +
            scoped("MediumInterface \"ink\" \"\"\nMaterial \"dielectric\" \"float eta\" [ 1 ]\n" + sphere(1)));
    ball.expected = {std::exp(-1.), std::exp(-2.), std::exp(-3.)};
    scenes.push_back(exactly(ball));
}

/// Diffuse light on a boundary. A small white receiver in a plate that emits 1 sees the plate again in a boundary above
/// it; or it sees a sky through that boundary, the plate being black. The plates are so large that their ends do not
/// matter.
void addDiffuseFresnel(std::vector<AnalyticScene>& scenes) {
    const std::string plateShape = rectangleZ(-1e4, 1e4, -1e4, 1e4, -1e-3, Facing::Positive);
    const std::string plate = emitter(1, plateShape), blackPlate = scoped(black() + plateShape);
    const std::string receiver = diffuse(1) + floorSquare(.005);
    const auto add = [&](const std::string& id, const std::string& claim, const std::string& lights, Facing outside,
                         double value) {
        scenes.push_back(
            {.id = id,
             .claim = claim,
             .text = sceneText({.camera = viewOfOrigin(), .maxDepth = 4},
                               lights + receiver + dielectric() + rectangleZ(-1e4, 1e4, -1e4, 1e4, 1, outside)),
             .expected = grey(value)});
    };
    add("F8", "diffuse reflectance of glass from outside (Walsh)", plate, Facing::Negative,
        diffuseFresnelOutside(kIor));
    scenes.back().samplesPerPixel = 2048;
    add("F8 transmitted", "diffuse transmittance of glass from outside, sky beyond: (1 - F) / n^2",
        constantSky(1) + blackPlate, Facing::Negative, (1 - diffuseFresnelOutside(kIor)) / (kIor * kIor));
    add("F9", "diffuse reflectance of glass from inside", plate, Facing::Positive, diffuseFresnelInside(kIor));
    scenes.back().samplesPerPixel = 256;
}

/// Directional reflectance of a smooth coat of index 1.5 and optical thickness t over a Lambert base, at most five
/// times at the base: what the random walk of the layered model comes to (the format's "coateddiffuse").
double coated(double cosine, double base, double thickness, int baseBounces) {
    // Kubelka-like averages over the directions below the coat; the reflectance has a kink at the critical angle.
    const double critical = std::sqrt(1 - 1 / (kIor * kIor));
    const auto reflected = [&](double mu) { return 2 * mu * fresnel(mu, 1 / kIor) * std::exp(-2 * thickness / mu); };
    const auto leaving = [&](double mu) { return 2 * mu * (1 - fresnel(mu, 1 / kIor)) * std::exp(-thickness / mu); };
    const double again = integrate(1e-6, critical, reflected) + integrate(critical, 1, reflected);
    const double out = integrate(critical, 1, leaving);
    const double below = std::sqrt(1 - (1 - cosine * cosine) / (kIor * kIor)), top = fresnel(cosine, kIor);
    double series = 0;
    for (int k = 0; k < baseBounces; ++k)
        series += base * std::pow(base * again, k) * out;
    return top + (1 - top) * std::exp(-thickness / below) * series;
}

/// The same over a mirror of metal: nothing is scattered, and the sum is over one direction.
double coatedMirror(double cosine, std::complex<double> index, double thickness, int baseBounces) {
    const double below = std::sqrt(1 - (1 - cosine * cosine) / (kIor * kIor)), top = fresnel(cosine, kIor);
    const double metal = fresnel(below, index / kIor) * std::exp(-2 * thickness / below);
    double sum = top;
    for (int k = 0; k < baseBounces; ++k)
        sum += (1 - top) * (1 - top) * metal * std::pow(metal * top, k);
    return sum;
}

void addCoats(std::vector<AnalyticScene>& scenes) {
    const double fi = diffuseFresnelInside(kIor), r = fresnel(1, kIor), base = .8;
    const double ideal = r + (1 - r) * base * (1 - fi) / (1 - base * fi);
    AnalyticScene layered =
        underSky("F10", "smooth glass over a Lambert base of .8, as two surfaces, normal view", "", 1, ideal);
    layered.text = sceneText({.camera = viewOfOrigin(), .maxDepth = 100},
                             constantSky(1) + diffuse(base) + rectangleZ(-1e4, 1e4, -1e4, 1e4, -.01, Facing::Positive) +
                                 dielectric() + rectangleZ(-1e4, 1e4, -1e4, 1e4, 0, Facing::Positive));
    layered.samplesPerPixel = 128;
    scenes.push_back(layered);

    scenes.push_back(
        underSky("F10 coat", "the same as a coated material without thickness",
                 "Material \"coateddiffuse\" \"rgb reflectance\" [ .8 .8 .8 ] \"float thickness\" [ 1e-7 ] "
                 "\"integer maxdepth\" [ 200 ]\n",
                 1, ideal));
    for (const double degrees : {0., 45., 60., 75.}) {
        const double cosine = std::cos(degrees * kPi / 180);
        scenes.push_back(
            underSky(fmt::format("F13 {}", degrees),
                     "the coated diffuse material with its defaults: thickness .01, five bounces of the base",
                     "Material \"coateddiffuse\"\n", cosine, coated(cosine, .5, .01, 5)));
        scenes.push_back(
            exactly(underSky(fmt::format("F13 metal {}", degrees),
                             "a smooth coat over a smooth metal: two mirrors, five meetings with the second",
                             "Material \"coatedconductor\" \"rgb conductor.eta\" [ .2 .2 .2 ] "
                             "\"rgb conductor.k\" [ 3 3 3 ]\n",
                             cosine, coatedMirror(cosine, {.2, 3}, .01, 5))));
    }
}

/// A mix shows the mean of its members, weighed by the amount, under whatever light.
void addMixes(std::vector<AnalyticScene>& scenes) {
    const std::string members =
        "MakeNamedMaterial \"red\" \"string type\" \"diffuse\" \"rgb reflectance\" [ .8 .4 .1 ]\n"
        "MakeNamedMaterial \"blue\" \"string type\" \"diffuse\" \"rgb reflectance\" [ .1 .2 .6 ]\n"
        "MakeNamedMaterial \"black\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
        "MakeNamedMaterial \"nothing\" \"string type\" \"interface\"\n";
    const auto mixed = [](double redShare, double blueShare) {
        return std::array{.8 * redShare + .1 * blueShare, .4 * redShare + .2 * blueShare, .1 * redShare + .6 * blueShare};
    };
    const auto add = [&](const std::string& id, const std::string& claim, const std::string& text,
                         const std::array<double, 3>& expected) {
        scenes.push_back(underSky(id, claim, members + text, 1, 0));
        scenes.back().expected = expected;
    };
    const std::string ofBoth = "Material \"mix\" \"string materials\" [ \"red\" \"blue\" ] ";
    add("M1", "mix of two paints, amount .3", ofBoth + "\"float amount\" .3\n", mixed(.7, .3));
    add("M1 nested", "a mix of that mix with black, amount .5",
        "MakeNamedMaterial \"both\" \"string type\" \"mix\" \"string materials\" [ \"red\" \"blue\" ] "
        "\"float amount\" .3\nMaterial \"mix\" \"string materials\" [ \"both\" \"black\" ]\n",
        mixed(.35, .15));
    // The four squares of the board meet in the middle of the picture.
    add("M2", "mix of two paints, amount .1 and .7 on the squares of a board",
        "Texture \"board\" \"float\" \"checkerboard\" \"float uscale\" 2 \"float vscale\" 2 \"float tex1\" .1 "
        "\"float tex2\" .7\n" +
            ofBoth + "\"texture amount\" \"board\"\n",
        mixed(.6, .4));

    const auto veil = [&](const std::string& solid, double holes) {
        return members + fmt::format("Material \"mix\" \"string materials\" [ \"{}\" \"nothing\" ] \"float amount\" {}\n",
                                     solid, holes);
    };
    scenes.push_back(underSky("M3", "a veil with a quarter of holes before a lamp of radiance 3",
                              emitter(3, rectangleZ(-9, 9, -9, 9, -1, Facing::Positive)) + veil("red", .25), 1, 0));
    scenes.back().expected = {.75 * .8 + .75, .75 * .4 + .75, .75 * .1 + .75};
    // Light sampling cannot see through the holes, so this is all that scattered rays find.
    scenes.push_back({.id = "M3 below",
                      .claim = "sphere light of radius 1 at distance 1.25 through a veil with three quarters of holes",
                      .text = sceneText({.camera = orthographicView({0, 0, .05}, {0, 0, 0}, {0, 1, 0}, 1e-3)},
                                        emitter(1, sphere(1, {0, 0, 1.25})) + diffuse(.5) + floorSquare(10) +
                                            veil("black", .75) + rectangleZ(-9, 9, -9, 9, .1, Facing::Positive)),
                      .expected = grey(.75 * .5 / (1.25 * 1.25)),
                      .samplesPerPixel = 256});
}

/// Powers of a cosine under a disk that covers 30 degrees about the normal: its share of the lobe, whose closed forms are those
/// of int cos^n(t) cos t sin t dt (Phong) and int cos^n(t / 2) cos t sin t dt (Blinn).
void addCosineLobes(std::vector<AnalyticScene>& scenes) {
    const double n = 10, sigma = kPi / 6;
    const auto blinn = [&](double angle) {
        const double c = std::cos(angle / 2);
        return 8 * std::pow(c, n + 4) / (n + 4) - 4 * std::pow(c, n + 2) / (n + 2);
    };
    const auto add = [&](const std::string& type, double value) {
        scenes.push_back({.id = "B16 " + type,
                          .claim = type + " lobe of exponent 10, normal view, light within 30 degrees",
                          .text = sceneText({.camera = viewOfOrigin()},
                                            emitter(1, disk(std::tan(sigma), {0, 0, 1}, Facing::Negative)) +
                                                fmt::format("Material \"{}\" \"rgb kd\" [ 0 0 0 ] \"rgb ks\" [ 1 1 1 ] "
                                                            "\"float exponent\" {}\n",
                                                            type, n) +
                                                floorSquare(10)),
                          .expected = grey(value)});
    };
    add("phong", 1 - std::pow(std::cos(sigma), n + 2));
    add("blinn", (blinn(0) - blinn(sigma)) / (blinn(0) - blinn(kPi / 2)));
}

}  // namespace

std::vector<AnalyticScene> analyticMaterials() {
    std::vector<AnalyticScene> scenes;
    addConductors(scenes);
    addMicrofacets(scenes);
    addBoundaries(scenes);
    addFacingMirrors(scenes);
    addSheets(scenes);
    addSchlickBoundaries(scenes);
    addSlabs(scenes);
    addDiffuseFresnel(scenes);
    addCoats(scenes);
    addMixes(scenes);
    addCosineLobes(scenes);
    return scenes;
}

}  // namespace penumbra
