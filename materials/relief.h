// Relief: how a normal map or a displacement tilts the shading frame of a material. The surface stays where it is.
//
// A displacement d raises the surface along its shading normal n. With a = dp/du + d dn/du and b = dp/dv + d dn/dv, the
// raised surface has the tangents a + n dd/du and b + n dd/dv (Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH
// 1978), and with the gradient G of d within the surface (G . a = dd/du, G . b = dd/dv) its normal is along n - G. Where
// G is zero not a bit of the frame changes. dd/du is a finite difference over half the footprint, as pbrt has it. dp/dv
// is that of the surface; pbrt takes n x dp/du for it where a mesh has normals, which stretches bumps where uv are
// stretched.
//
// A normal map gives the normal in the frame of dp/du, n x dp/du and n as (r, g, b) = (normal + 1) / 2.
//
// Either normal is turned to the side of the geometric one. Light that shading and geometric normal see from different
// sides is left as it is, as in pbrt: closures know the shading frame alone, rays leave on the side that they point to.
//
// Thread safety: plain values.
#pragma once

#include "core/geometry/surface_derivatives.h"
#include "core/image/texture.h"
#include "core/math/records.h"

namespace penumbra {

/// A material's relief: at most one of the two; textures that do not vary are none.
struct ReliefRecord {
    std::uint32_t displacement = kNoTexture;  ///< of kind Float
    std::uint32_t normalMap = kNoTexture;     ///< of Textures::addNormalMap
    bool isFlat() const { return displacement == kNoTexture && normalMap == kNoTexture; }
};

namespace detail {

/// The gradient of the displacement within the surface.
template <class F>
Vec3<F> displacementGradient(const Textures& textures, const UInt<F>& texture, const TextureContext<F>& at,
                             const SurfaceDerivatives<F>& d, const Vec3<F>& n) {
    const auto within = [&](const Vec3<F>& v) { return v - n * dot(n, v); };
    const Vec3<F> alongU = within(d.dpdu), alongV = within(d.dpdv);
    const F asked = select(at.footprint > F(0.f), F(0.5f) * at.footprint, F(0.0005f));
    // As far as the look-ups really are apart.
    const F du = (at.uv.x + asked) - at.uv.x, dv = (at.uv.y + asked) - at.uv.y;
    TextureContext<F> there = at;
    there.uv.x = at.uv.x + asked;
    there.p = at.p + alongU * du;
    const F raisedU = textures.scalar<F>(texture, there);
    there.uv = {at.uv.x, at.uv.y + asked};
    there.p = at.p + alongV * dv;
    const F raisedV = textures.scalar<F>(texture, there), raised = textures.scalar<F>(texture, at);
    const F slopeU = (raisedU - raised) / du, slopeV = (raisedV - raised) / dv;
    const Vec3<F> a = alongU + d.dndu * raised, b = alongV + d.dndv * raised;
    const F area = dot(n, cross(a, b));
    const Vec3<F> gradient = (cross(b, n) * slopeU + cross(n, a) * slopeV) / area;
    // What is not finite is no slope: a place without uv, a texture of infinities.
    return select(dot(gradient, gradient) < F(1e30f), gradient, Vec3<F>{F(0.f), F(0.f), F(0.f)});
}

}  // namespace detail

/// The shading frame `frame` with the relief of each lane's material. `at` is the point of the hit; its n is the
/// geometric normal. For normal maps the frame's s has to lie along dp/du.
template <class F>
Frame<F> reliefFrame(const Records<F, ReliefRecord>& relief, const Textures& textures, const TextureContext<F>& at,
                     const SurfaceDerivatives<F>& derivatives, const Frame<F>& frame) {
    const Vec3<F>& n = frame.n;
    const UInt<F> displacement = relief(&ReliefRecord::displacement), map = relief(&ReliefRecord::normalMap);
    const Mask<F> isRaised = displacement != UInt<F>(kNoTexture), isMapped = map != UInt<F>(kNoTexture);
    Vec3<F> normal = n, tangent = frame.s;
    Mask<F> tilted(false);
    if (any(isRaised)) {
        const Vec3<F> gradient = detail::displacementGradient(textures, displacement, at, derivatives, n);
        tilted = isRaised & (dot(gradient, gradient) > F(0.f));
        normal = select(tilted, normalize(n - gradient), normal);
        tangent = select(tilted, frame.s + n * dot(gradient, frame.s), tangent);
    }
    if (any(isMapped)) {
        TextureContext<F> sharp = at;
        sharp.footprint = sharp.width = F(0.f);
        const Spectrum<F> c = textures.spectrum<F>(map, sharp);
        const auto signedValue = [](F x) { return F(2.f) * x - F(1.f); };
        const Vec3<F> local = {signedValue(c.r), signedValue(c.g), signedValue(c.b)};
        const F squared = dot(local, local);
        const Mask<F> changes = isMapped & ((local.x != F(0.f)) | (local.y != F(0.f)) | (local.z < F(0.f))) &
                                (squared > F(1e-12f)) & (squared < F(1e12f));
        normal = select(changes, normalize(frame.toWorld(local)), normal);
        tilted = tilted | changes;
    }
    if (none(tilted)) return frame;
    Frame<F> out = Frame<F>::fromNormal(flipSign(dot(normal, at.n) < F(0.f), normal));
    out.turnTowards(tangent, Mask<F>(true));
    return {select(tilted, out.s, frame.s), select(tilted, out.t, frame.t), select(tilted, out.n, frame.n)};
}

}  // namespace penumbra
