#include "lights/light_bounds.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

Vec3<double> widened(const Vec3<float>& v) {
    return {v.x, v.y, v.z};
}

Vec3<double> least(const Vec3<double>& a, const Vec3<double>& b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

Vec3<double> most(const Vec3<double>& a, const Vec3<double>& b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

}  // namespace

LightBounds LightBounds::ofFlat(std::initializer_list<Vec3<float>> corners, const Vec3<float>& normal, double intensity,
                                bool isTwoSided) {
    LightBounds b = ofPoint(*corners.begin(), 0);
    for (const Vec3<float>& corner : corners) {
        b.lower = least(b.lower, widened(corner));
        b.upper = most(b.upper, widened(corner));
    }
    b.axis = widened(normal);
    b.spread = 0;
    b.flat = intensity;
    b.flow = b.axis * intensity;
    b.isTwoSided = isTwoSided;
    return b;
}

LightBounds LightBounds::ofRound(const Vec3<double>& lower, const Vec3<double>& upper, double intensity) {
    LightBounds b;
    b.lower = lower;
    b.upper = upper;
    b.even = intensity;
    return b;
}

LightBounds LightBounds::ofPoint(const Vec3<float>& position, double intensity) {
    return ofRound(widened(position), widened(position), intensity);
}

void LightBounds::add(const LightBounds& other) {
    lower = least(lower, other.lower);
    upper = most(upper, other.upper);
    addCone(other);
    falloff = std::max(falloff, other.falloff);
    even += other.even;
    flat += other.flat;
    // The normal of a lamp that shines to both sides may be taken either way.
    const bool turns = (isTwoSided || other.isTwoSided) && dot(flow, other.flow) < 0;
    flow = flow + other.flow * (turns ? -1. : 1.);
    isTwoSided = isTwoSided || other.isTwoSided;
}

/// The least cone about both (Conty Estevez, Kulla, algorithm 1).
void LightBounds::addCone(const LightBounds& other) {
    constexpr double kAll = std::numbers::pi;
    if (spread >= kAll) return;
    const double between = std::acos(std::clamp(dot(axis, other.axis), -1., 1.));
    if (between + other.spread <= spread) return;
    if (between + spread <= other.spread) {
        axis = other.axis;
        spread = other.spread;
        return;
    }
    const double wide = 0.5 * (spread + between + other.spread), turn = wide - spread;
    Vec3<double> towards = other.axis - axis * dot(axis, other.axis);
    const double size = std::sqrt(dot(towards, towards));
    spread = wide;
    if (wide >= kAll || !(size > 0)) {  // opposite axes leave no plane to turn in
        spread = kAll;
        return;
    }
    axis = axis * std::cos(turn) + towards * (std::sin(turn) / size);
    axis = axis * (1 / std::sqrt(dot(axis, axis)));
}

}  // namespace penumbra
