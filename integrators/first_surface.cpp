#include "integrators/first_surface.h"

#include "integrators/batch_driver.h"

#include <bit>

namespace penumbra {
namespace {

/// What a film can add up; beyond it a surface is seen along itself.
constexpr float kMostChange = 1e9f;

/// The channels of all AOVs, in lanes.
template <class F>
struct AovLanes {
    F channel[kAovChannels];

    template <class... Fs>
    void put(Aov aov, const Fs&... values) {
        F* to = channel + aovKinds()[std::size_t(aov)].first;
        ((*to++ = values), ...);
    }
    void put(Aov aov, const Vec3<F>& v) { put(aov, v.x, v.y, v.z); }
};

template <class F>
Spectrum<F> albedoAt(const Scene& scene, const RayGroup<F>& g, const Hit<F>& hit, const SurfacePoint<F>& at,
                     const UInt<F>& material, unsigned tag) {
    const ShadingContext<F> context = shadingContext(scene, at, coneWidthAt(scene, g, hit));
    const Vec3<F> wo = at.frame.toLocal(-g.direction);
    return dispatch(MaterialTypes{}, tag, [&]<class M>() -> Spectrum<F> {
        return M::bsdf(scene.materials.template records<M, F>(material), context).albedo(wo);
    });
}

/// Along the camera's axis, or the distance where it has none; `p` in camera space.
template <class F>
F depthOf(const Scene& scene, const Vec3<F>& p) {
    return scene.camera.looksAllRound() ? length(p) : p.z;
}

/// How much the depth changes across a pixel, to the right and downwards, without its sign: between the camera's rays
/// half a pixel to either side, where they meet the tangent plane. Where one of them does not, the hit stands for it.
template <class F>
Vec2<F> depthAcrossPixel(const Scene& scene, const SlotBuffer& slots, const RayGroup<F>& g, const SurfacePoint<F>& at,
                         const CameraSpace<F>& space) {
    const CameraNumbers<F> numbers =
        cameraNumbers(scene, gather(slots.rasterX, g.slot), gather(slots.rasterY, g.slot), g.address);
    const F middle = depthOf(scene, space.point(at.p));
    const auto across = [&](float dx, float dy) {
        F change(0.f), sides(0.f);
        for (const float side : {-1.f, 1.f}) {
            const Vec2<F> raster{numbers.raster.x + F(side * dx), numbers.raster.y + F(side * dy)};
            const CameraRay<F> ray = scene.camera.ray(raster, numbers.lens, numbers.shutter);
            const F t = dot(at.p - ray.origin, at.ng) / dot(ray.direction, at.ng);
            const F depth = depthOf(scene, space.point(ray.origin + ray.direction * t));
            const Mask<F> meets = (ray.weight > F(0.f)) & (t > F(0.f)) & (abs(depth - middle) < F(kMostChange));
            change = change + select(meets, (depth - middle) * F(side), F(0.f));
            sides = sides + select(meets, F(0.5f), F(0.f));
        }
        return abs(change) / max(sides, F(0.5f));
    };
    return {across(0.5f, 0.f), across(0.f, 0.5f)};
}

template <class F>
Vec3<F> towardsViewer(const Vec3<F>& n, const Vec3<F>& direction) {
    return flipSign(dot(n, direction) > F(0.f), n);
}

}  // namespace

template <class F>
void recordFirstSurface(const Scene& scene, const SlotBuffer& slots, const RayGroup<F>& g, const Hit<F>& hit, const UInt<F>& material,
                        unsigned tag, Film& film) noexcept {
    const unsigned first = bits(Mask<F>(g.live & (g.depth == UInt<F>(0u))));
    if (!first) return;
    const auto at = dispatch(MaterialTypes{}, tag, [&]<class M>() { return shadedPoint<F, M>(scene, g, hit, material); });
    const F time = timeOf<F>(slots, g.slot);
    const CameraSpace<F> camera = scene.camera.space(time);

    AovLanes<F> lanes{};
    Vec3<F> n = towardsViewer(at.ng, g.direction), ns = towardsViewer(at.frame.n, g.direction), p = camera.point(at.p);
    lanes.put(Aov::Depth, depthOf(scene, p));
    if (film.aovs().set().has(Aov::DepthAlongX) || film.aovs().set().has(Aov::DepthAlongY)) {
        const Vec2<F> change = depthAcrossPixel(scene, slots, g, at, camera);
        lanes.put(Aov::DepthAlongX, change.x);
        lanes.put(Aov::DepthAlongY, change.y);
    }
    if (scene.film.aovsInCameraSpace) {
        n = camera.normal(n);
        ns = camera.normal(ns);
    } else {
        p = at.p;
    }
    lanes.put(Aov::Normal, n);
    lanes.put(Aov::ShadingNormal, ns);
    lanes.put(Aov::Position, p);
    lanes.put(Aov::Uv, at.uv.x, at.uv.y);
    lanes.put(Aov::Time, time);
    if (film.aovs().set().has(Aov::Albedo)) {
        const Spectrum<F> albedo = albedoAt(scene, g, hit, at, material, tag);
        lanes.put(Aov::Albedo, albedo.r, albedo.g, albedo.b);
    }

    for (unsigned left = first; left; left &= left - 1) {
        const int k = std::countr_zero(left);
        AovValues values;
        for (std::size_t c = 0; c < kAovChannels; ++c) values[c] = lane(lanes.channel[c], k);
        const std::uint32_t slot = lane(g.slot, k);
        film.aovs().add(slots.pixel[slot], values, slots.sign[slot]);
    }
}

template void recordFirstSurface<float>(const Scene&, const SlotBuffer&, const RayGroup<float>&, const Hit<float>&, const UInt<float>&,
                                        unsigned, Film&) noexcept;
template void recordFirstSurface<Lanes8f>(const Scene&, const SlotBuffer&, const RayGroup<Lanes8f>&, const Hit<Lanes8f>&,
                                          const UInt<Lanes8f>&, unsigned, Film&) noexcept;

}  // namespace penumbra
