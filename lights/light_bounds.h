// LightBounds: where the light of one light, or of several, comes from and goes to, for selection by place
// (light_tree.h).
//
// Source: Conty Estevez, Kulla 2018, "Importance sampling of many lights with adaptive tree splitting" (HPG); the union
// of cones there is this one's. Emitters lie in a box; their normals within `spread` of the axis; each shines within
// `falloff` of its normal.
// How much they shine is intensity (flux per unit of solid angle), whatever the kind of light, so that lamps of all
// kinds compare. That of flat lamps goes with the cosine from their normals: `flat` is the sum of their intensities
// along them, `flow` the sum of these times the normals; what others send alike in all directions is `even`.
//
// Conventions: angles in radians, mean of the channels. Thread safety: plain data.
#pragma once

#include "core/math/matrix.h"
#include "core/math/vector.h"

#include <cmath>
#include <initializer_list>
#include <numbers>

namespace penumbra {

struct LightBounds {
    Vec3<double> lower, upper;
    Vec3<double> axis = {0, 0, 1};     ///< unit
    double spread = std::numbers::pi;  ///< of normals round the axis
    double falloff = std::numbers::pi / 2;
    double even = 0, flat = 0;
    Vec3<double> flow = {0, 0, 0};
    bool isTwoSided = false;

    /// Of a light on all of whose points the normal is the same.
    static LightBounds ofFlat(std::initializer_list<Vec3<float>> corners, const Vec3<float>& normal, double intensity,
                              bool isTwoSided);
    /// Of a light that shines alike in all directions.
    static LightBounds ofRound(const Vec3<double>& lower, const Vec3<double>& upper, double intensity);
    static LightBounds ofPoint(const Vec3<float>& position, double intensity);

    Vec3<double> center() const { return (lower + upper) * 0.5; }
    /// Squared radius of the sphere round the box.
    double radiusSquared() const { return 0.25 * dot(upper - lower, upper - lower); }
    double intensity() const { return even + flat; }
    /// The part of the flat lamps that shines to one side; the rest goes a quarter each way, as from a sphere.
    double directed() const { return std::sqrt(dot(flow, flow)); }
    double undirected() const { return even + 0.25 * (flat - directed()); }
    void add(const LightBounds& other);

private:
    void addCone(const LightBounds& other);
};

}  // namespace penumbra
