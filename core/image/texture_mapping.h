// From the point of a look-up to the coordinates of a texture: TextureSpace gives those of solid textures,
// TextureMapping those of plane ones.
//
// The space of a texture is the one that was current at its directive; p below is the point in it.
//   uv           s = uscale u + udelta, t = vscale v + vdelta
//   planar       s = p . v1 + udelta, t = p . v2 + vdelta
//   spherical    s = theta / pi, t = phi / 2 pi: theta is measured from +z, phi from +x towards +y
//   cylindrical  s = (pi + phi') / 2 pi, t = z, where phi' is phi in (-pi, pi]
//
// The footprint along a coordinate is the width of the cone times the steepest rise of the coordinate within the
// surface: the gradient, taken to world space, less its part along the normal. (With uv, which has one footprint for
// all directions, it is stretched like the coordinate.) Coordinates that jump from 1 to 0 have the footprint of their
// sides.
#pragma once

#include "core/base/plugin.h"
#include "core/image/texture.h"
#include "core/math/affine.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra {

/// The "vector3" parameter of that name.
Vec3<float> readVector(const ParameterSet& parameters, std::string_view name, const Vec3<float>& otherwise);

struct TextureSpace {
    /// Fails where the transformation at the texture has no inverse.
    static TextureSpace make(TextureInput& input);

    template <class F>
    Vec3<F> point(const TextureContext<F>& at) const {
        const auto along = [&](const float* row) {
            return F(row[0]) * at.p.x + F(row[1]) * at.p.y + F(row[2]) * at.p.z + F(row[3]);
        };
        return {along(fromWorld.m), along(fromWorld.m + 4), along(fromWorld.m + 8)};
    }

    /// The footprint along a coordinate that has this gradient in the space of the texture.
    template <class F>
    F width(const TextureContext<F>& at, const Vec3<F>& gradient) const {
        const auto along = [&](int axis) {
            const float* m = fromWorld.m + axis;
            return F(m[0]) * gradient.x + F(m[4]) * gradient.y + F(m[8]) * gradient.z;
        };
        const Vec3<F> world = {along(0), along(1), along(2)};
        return length(world - at.n * dot(at.n, world)) * at.width;
    }
    /// Along the three axes.
    template <class F>
    Vec3<F> widths(const TextureContext<F>& at) const {
        const F zero(0.f), one(1.f);
        return {width(at, {one, zero, zero}), width(at, {zero, one, zero}), width(at, {zero, zero, one})};
    }

    /// Of directions within the surface, in the mean of their squares.
    template <class F>
    F footprint(const TextureContext<F>& at) const {
        return length(widths(at)) * F(0.70710678f);
    }

    AffineRecord fromWorld{{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
};

template <class F>
struct MappedPoint {
    F s, t;
    F widthS, widthT;  ///< the footprint, along s and along t
};

enum class MappingKind { Uv, Planar, Spherical, Cylindrical };

struct TextureMapping {
    /// What a plug-in with a mapping shows as its parameters: its own, then those of the mapping.
    template <std::size_t n>
    static constexpr auto parameters(const ParameterInfo (&own)[n]) {
        constexpr ParameterInfo kRows[] = {
            {"string", "mapping", "uv", "how the surface is laid on the plane: uv, planar, spherical, cylindrical"},
            {"float", "uscale", "1", "uv: s = uscale u + udelta"},
            {"float", "vscale", "1", "uv: t = vscale v + vdelta"},
            {"float", "udelta", "0", "see uscale, v1"},
            {"float", "vdelta", "0", "see vscale, v2"},
            {"vector3", "v1", "1 0 0", "planar: s = p . v1 + udelta"},
            {"vector3", "v2", "0 1 0", "planar: t = p . v2 + vdelta"},
        };
        std::array<ParameterInfo, n + std::size(kRows)> all;
        std::copy(std::begin(kRows), std::end(kRows), std::copy(std::begin(own), std::end(own), all.begin()));
        return all;
    }

    static TextureMapping make(TextureInput& input);

    template <class F>
    MappedPoint<F> map(const TextureContext<F>& at) const {
        switch (kind) {
            case MappingKind::Planar:
                return planar(at);
            case MappingKind::Spherical:
                return spherical(at);
            case MappingKind::Cylindrical:
                return cylindrical(at);
            case MappingKind::Uv:
                break;
        }
        return {at.uv.x * F(uScale) + F(uDelta), at.uv.y * F(vScale) + F(vDelta), at.footprint * F(std::fabs(uScale)),
                at.footprint * F(std::fabs(vScale))};
    }

    MappingKind kind = MappingKind::Uv;
    float uScale = 1, vScale = 1, uDelta = 0, vDelta = 0;
    Vec3<float> v1{1, 0, 0}, v2{0, 1, 0};
    TextureSpace space;

private:
    static constexpr float kTiny = 1e-30f;  ///< squares of distances from an axis are at least this

    template <class F>
    MappedPoint<F> planar(const TextureContext<F>& at) const {
        const Vec3<F> p = space.point(at), alongS = broadcast<F>(v1), alongT = broadcast<F>(v2);
        return {dot(p, alongS) + F(uDelta), dot(p, alongT) + F(vDelta), space.width(at, alongS),
                space.width(at, alongT)};
    }
    template <class F>
    MappedPoint<F> spherical(const TextureContext<F>& at) const {
        const Vec3<F> p = space.point(at);
        const F rho2 = max(p.x * p.x + p.y * p.y, F(kTiny)), rho = sqrt(rho2);
        F phi = atan2(p.y, p.x);
        phi = select(phi < F(0.f), phi + F(kTwoPi), phi);
        const Vec3<F> polar = {p.x * p.z / rho, p.y * p.z / rho, -rho};
        return {atan2(rho, p.z) * F(kInvPi), phi * F(kInvTwoPi),
                space.width(at, polar * (F(kInvPi) / (rho2 + p.z * p.z))), aroundAxis(at, p, rho2)};
    }
    template <class F>
    MappedPoint<F> cylindrical(const TextureContext<F>& at) const {
        const Vec3<F> p = space.point(at);
        const F rho2 = max(p.x * p.x + p.y * p.y, F(kTiny));
        return {(F(kPi) + atan2(p.y, p.x)) * F(kInvTwoPi), p.z, aroundAxis(at, p, rho2),
                space.width(at, {F(0.f), F(0.f), F(1.f)})};
    }
    /// The footprint of phi / 2 pi.
    template <class F>
    F aroundAxis(const TextureContext<F>& at, const Vec3<F>& p, F rho2) const {
        return space.width(at, Vec3<F>{-p.y, p.x, F(0.f)} * (F(kInvTwoPi) / rho2));
    }
};

}  // namespace penumbra
