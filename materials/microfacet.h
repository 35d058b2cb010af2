// The GGX (Trowbridge-Reitz) distribution of microfacets with Smith's height-correlated masking, and the roughness
// parameters that rough materials share.
//
// Conventions: w, wo, wi, m are unit vectors in the local frame; those given to Ggx have z >= 0 (the caller mirrors
// what lies below). alpha is per axis, x along the tangent. Thread safety: plain values. Sources: Walter, Marschner, Li
// & Torrance, EGSR 2007 (microfacet BSDFs); Heitz, JCGT 3(2), 2014 (masking, eq. 71-99, anisotropy); Dupuy & Benyoub,
// CGF 42(8), 2023 (visible normals by spherical caps).
//
// Everything below is written in L(w) = sqrt((ax x)^2 + (ay y)^2 + z^2), because Smith's terms then have no quotient
// that fails at grazing angles: Lambda(w) = (L/z - 1)/2, so G1(w) = 2z/(z + L), and with o = wo.z, i = wi.z
//   G2 / (4 o i) = 1 / (2 (i L(wo) + o L(wi))),     visible density D_w(m) / (4 w.m) = D / (2 (o + L(wo))).
#pragma once

#include "materials/material.h"

namespace penumbra {

/// Below this alpha (both axes) a surface counts as perfectly smooth, as the scene format has it.
inline constexpr float kSmoothAlpha = 1e-3f;

/// Rough reflection without its Fresnel factor.
template <class F>
struct GgxReflection {
    F fCos;  ///< D G2 / (4 o i) times i
    F pdf;   ///< of reflecting wo at a visible normal
};

template <class F>
struct Ggx {
    F ax, ay;

    /// D(m), where m is h made unit. h.z >= 0; |h|^2 is given because callers have it.
    F density(const Vec3<F>& h, F lengthSquaredOfH) const {
        const F a = ax * ay;
        const F q = sqr(h.x * ay) + sqr(h.y * ax) + sqr(h.z * a);
        const F ratio = lengthSquaredOfH * a / max(q, F(1e-36f));
        return select(q > F(1e-36f), a * F(kInvPi) * ratio * ratio, F(0.f));
    }
    /// L(w) of the file's comment.
    F shape(const Vec3<F>& w) const { return sqrt(sqr(ax * w.x) + sqr(ay * w.y) + w.z * w.z); }

    /// G2 / G1(wo): the weight of a sampled visible normal, for wi above or (|z| taken) below the surface.
    F shadowing(const Vec3<F>& wo, const Vec3<F>& wi) const {
        const F o = wo.z, i = abs(wi.z), lo = shape(wo);
        return i * (o + lo) / max(i * lo + o * shape(wi), F(1e-30f));
    }

    /// `h` = wo + wi.
    GgxReflection<F> reflection(const Vec3<F>& wo, const Vec3<F>& wi, F densityOfH) const {
        const F o = wo.z, i = wi.z, lo = shape(wo);
        const F masking = max(i * lo + o * shape(wi), F(1e-20f)), visible = o + lo;
        const F common = F(0.5f) * densityOfH / (masking * visible);  // one division for both quotients
        return {common * visible * i, common * masking};
    }

    /// A normal with the density of those visible from w: G1(w) D(m) max(0, w.m) / w.z.
    Vec3<F> sampleVisible(const Vec3<F>& w, const Vec2<F>& u) const {
        // In the space where the surface is a unit hemisphere, reflected directions are uniform on a cap.
        const Vec3<F> v = normalize(Vec3<F>{ax * w.x, ay * w.y, w.z});
        const F hz = (F(1.f) - u.y) * (F(1.f) + v.z);  // z of cap point + v, formed without cancellation: never 0
        const F z = hz - v.z;
        const F radius = safeSqrt(F(1.f) - z * z);
        F s, c;
        sinCos(F(kTwoPi) * u.x, s, c);
        return normalize(Vec3<F>{ax * (radius * c + v.x), ay * (radius * s + v.y), hz});
    }
};

/// A surface's GGX at a hit. Smooth lanes carry some harmless alpha.
template <class F>
struct SurfaceRoughness {
    Ggx<F> ggx;
    Mask<F> smooth;
};

/// The members that a rough material has, and how they are read from a scene and at a hit. Derive from it.
struct RoughnessInputs {
    ScalarInput uAlpha, vAlpha;          ///< constants are alpha; textures give alpha too, or roughness:
    std::uint32_t rootU = 0, rootV = 0;  ///< not 0: alpha is the square root of what the texture gives

    /// `prefix` comes before the names: a layered material has two roughnesses.
    static RoughnessInputs make(MaterialInput& input, const std::string& prefix = {}) {
        const ScalarInput both = input.scalar(prefix + "roughness", 0.f);
        RoughnessInputs r{input.scalar(prefix + "uroughness", both), input.scalar(prefix + "vroughness", both)};
        const bool remap = input.parameters().boolean("remaproughness", true);
        const auto settle = [remap, &input](ScalarInput& roughness, std::uint32_t& root) {
            if (!(roughness.constant >= 0 && roughness.constant <= 1))
                input.fail("a roughness of " + std::to_string(roughness.constant) + " is outside the allowed range, 0 to 1");
            root = remap && roughness.texture != kNoTexture ? 1u : 0u;
            if (roughness.texture == kNoTexture) roughness.constant = alpha(roughness.constant, remap);
        };
        settle(r.uAlpha, r.rootU);
        settle(r.vAlpha, r.rootV);
        return r;
    }
    bool isTextured() const { return uAlpha.texture != kNoTexture || vAlpha.texture != kNoTexture; }
    /// Whether the x axis of the shading frame matters.
    bool needsTangent() const {
        return uAlpha.texture != vAlpha.texture || (uAlpha.texture == kNoTexture && uAlpha.constant != vAlpha.constant);
    }

    template <class F>
    static F alpha(F roughness, const Mask<F>& root) {
        const F r = clamp(roughness, F(0.f), F(1e3f));
        return any(root) ? select(root, sqrt(r), r) : r;
    }
    template <class F>
    static SurfaceRoughness<F> surface(F alphaX, F alphaY) {
        const Mask<F> smooth = max(alphaX, alphaY) < F(kSmoothAlpha);
        const auto usable = [&](F a) { return select(smooth, F(1.f), max(a, F(1e-4f))); };
        return {{usable(alphaX), usable(alphaY)}, smooth};
    }

    /// The roughness of M, a type derived from this one; where it has two, of its base Part.
    template <class F, class M, class Part = RoughnessInputs>
    static SurfaceRoughness<F> surface(const Records<F, M>& m, const ShadingContext<F>& at) {
        const auto read = [&](ScalarInput Part::*input, std::uint32_t Part::*root) {
            const F value = at.scalar(m, static_cast<ScalarInput M::*>(input));
            return alpha(value, Mask<F>(m(static_cast<std::uint32_t M::*>(root)) != UInt<F>(0u)));
        };
        return surface(read(&RoughnessInputs::uAlpha, &RoughnessInputs::rootU),
                       read(&RoughnessInputs::vAlpha, &RoughnessInputs::rootV));
    }
};

inline constexpr ParameterInfo kRoughnessParameter{"float", "roughness", "0",
                                                   "of the microfacets; 0 is smooth; texture or number"};
inline constexpr ParameterInfo kURoughnessParameter{"float", "uroughness", "roughness", "roughness along the tangent"};
inline constexpr ParameterInfo kVRoughnessParameter{"float", "vroughness", "roughness", "roughness across the tangent"};
inline constexpr ParameterInfo kRemapRoughnessParameter{"bool", "remaproughness", "true",
                                                        "alpha = sqrt(roughness), else alpha = roughness"};

}  // namespace penumbra
