#include "core/color/color_space.h"

#include "core/base/text.h"

#include <vector>

namespace penumbra {
namespace {

ColorSpace makeSpace(std::string name, Chromaticity red, Chromaticity green, Chromaticity blue, Chromaticity white,
                     std::string illuminant) {
    const Matrix3 xyzFromRgb = xyzFromPrimaries(red, green, blue, white);
    return {std::move(name), red, green, blue, white, std::move(illuminant), xyzFromRgb, inverse(xyzFromRgb)};
}

const std::array<ColorSpace, 4>& spaces() {
    // The whites are the illuminants integrated over their tables, a little off the rounded figures of the standards.
    constexpr Chromaticity kD65{0.312727, 0.329023}, kAcesD60{0.321679, 0.337672};
    static const std::array<ColorSpace, 4> all{
        makeSpace("srgb", {0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, kD65, "stdillum-D65"),
        makeSpace("dci-p3", {0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, kD65, "stdillum-D65"),
        makeSpace("rec2020", {0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kD65, "stdillum-D65"),
        makeSpace("aces2065-1", {0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}, kAcesD60, "illum-acesD60")};
    return all;
}

}  // namespace

Rgb ColorSpace::fromXyz(const Triple& xyz) const {
    const Triple c = rgbFromXyz * xyz;
    return {float(c[0]), float(c[1]), float(c[2])};
}

Triple ColorSpace::toXyz(Rgb c) const {
    return xyzFromRgb * Triple{c.r, c.g, c.b};
}

double ColorSpace::luminance(Rgb c) const {
    return toXyz(c)[1];
}

const ColorSpace* findColorSpace(std::string_view name) {
    const std::string lower = lowerCase(name);
    for (const ColorSpace& space : spaces())
        if (lower == space.name) return &space;
    return nullptr;
}

std::span<const std::string> colorSpaceNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const ColorSpace& space : spaces())
            list.push_back(space.name);
        return list;
    }();
    return names;
}

const ColorSpace& srgbColorSpace() {
    return spaces()[0];
}

const ColorSpace* findColorSpace(Chromaticity red, Chromaticity green, Chromaticity blue, Chromaticity white) {
    const auto near = [](Chromaticity a, Chromaticity b) {
        return std::abs(a.x - b.x) <= 0.002 && std::abs(a.y - b.y) <= 0.002;
    };
    for (const ColorSpace& s : spaces())
        if (near(s.red, red) && near(s.green, green) && near(s.blue, blue) && near(s.white, white)) return &s;
    return nullptr;
}

Matrix3 xyzFromPrimaries(Chromaticity red, Chromaticity green, Chromaticity blue, Chromaticity white) {
    const auto column = [](Chromaticity c) { return Triple{c.x, c.y, 1 - c.x - c.y}; };
    const Triple r = column(red), g = column(green), b = column(blue);
    const Matrix3 primaries{{{{r[0], g[0], b[0]}, {r[1], g[1], b[1]}, {r[2], g[2], b[2]}}}};
    return primaries * diagonal(inverse(primaries) * xyzOf(white));
}

Matrix3 lightConversion(const ColorSpace& from, const ColorSpace& to) {
    return &from == &to ? Matrix3{} : to.rgbFromXyz * from.xyzFromRgb;
}

Matrix3 reflectanceConversion(const ColorSpace& from, const ColorSpace& to) {
    return &from == &to ? Matrix3{} : to.rgbFromXyz * bradfordAdaptation(from.white, to.white) * from.xyzFromRgb;
}

Matrix3 bradfordAdaptation(Chromaticity from, Chromaticity to) {
    constexpr Matrix3 kBradford{{{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}}};
    const Triple source = kBradford * xyzOf(from), target = kBradford * xyzOf(to);
    const Triple gain{target[0] / source[0], target[1] / source[1], target[2] / source[2]};
    return inverse(kBradford) * diagonal(gain) * kBradford;
}

Triple xyzOf(Chromaticity c) {
    return {c.x / c.y, 1, (1 - c.x - c.y) / c.y};
}

Chromaticity chromaticityOf(const Triple& xyz) {
    const double sum = xyz[0] + xyz[1] + xyz[2];
    return {xyz[0] / sum, xyz[1] / sum};
}

Rgb apply(const Matrix3& m, Rgb c) {
    if (m == Matrix3{}) return c;  // exactly
    const Triple v = m * Triple{c.r, c.g, c.b};
    return {float(v[0]), float(v[1]), float(v[2])};
}

}  // namespace penumbra
