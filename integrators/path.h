// path: unidirectional path tracing with next-event estimation (Kajiya 1986; multiple importance sampling after Veach 1997).
//
// At every vertex one light is picked and sampled, and one direction of the BSDF; what both could have found is weighed by
// the power heuristic with exponent two. `maxdepth` counts scattering events as pbrt does: emission met by the direction
// sampled at the last one still counts, with its weight.
#pragma once

#include "core/math/packed_direction.h"
#include "integrators/batch_driver.h"

namespace penumbra {

class PathShader {
public:
    /// `typical`: radiance of the picture (pilot.h), for the roulette Late; 0 where it is not known.
    PathShader(const IntegratorSettings& s, float typical)
        : maxDepth_(s.maxDepth > 0 ? std::uint32_t(s.maxDepth) : 0u),
          strategy_(s.strategy),
          roulette_(s.roulette),
          perTypical_(typical > 0.f ? 1.f / typical : 0.f) {}

    template <class F, class M>
    void shade(Step<F>& step, RayGroup<F>& g, const Hit<F>& hit, const UInt<F>& material) const noexcept {
        const Scene& scene = step.scene;
        const SurfacePoint<F> at = shadedPoint<F, M>(scene, g, hit, material);
        absorb(scene, g.medium, hit.t, g.throughput);
        if constexpr (M::kPassThrough) {
            passThrough(step, g, hit, at);
        } else {
            emission(step, g, at);
            const Mask<F> goesOn = g.live & (g.depth < UInt<F>(maxDepth_));
            if (any(goesOn)) scatterPath<F, M>(step, g, hit, at, material, goesOn);
        }
    }

    template <class F>
    void miss(Step<F>& step, RayGroup<F>& g) const noexcept {
        const LightHit<F> away{g.origin, {}, g.direction};
        for (std::uint32_t id : step.scene.lights.infiniteIds()) {
            const LightEval<F> e = evaluateLight<F>(step.scene.lights, UInt<F>(id), away);
            const F weight = emissionWeight(step, g, UInt<F>(id), e.pdf);
            step.add(g, g.throughput * e.L * weight);
        }
    }

private:
    /// Weight of emission met by a ray, against light sampling.
    template <class F>
    F emissionWeight(const Step<F>& step, const RayGroup<F>& g, const UInt<F>& light, F lightPdf) const {
        const Mask<F> whole = g.bsdfPdf == F(0.f);
        if (strategy_ == Strategy::BsdfOnly) return F(1.f);
        if (strategy_ == Strategy::LightOnly) return select(whole, F(1.f), F(0.f));
        if (all(whole)) return F(1.f);   // what the camera and mirrors see: no light sample is to be weighed against
        const LightSampler& sampler = step.scene.lightSampler;
        LitPoint<F> left{};   // where the ray comes from
        if (sampler.isByPlace()) left = {g.origin, unpackDirection<F>(gather(step.batch.slots.normal, g.slot))};
        const F other = lightPdf * sampler.probability<F>(left, light);
        return select(whole, F(1.f), powerHeuristic(g.bsdfPdf, other));
    }

    /// a^2 / (a^2 + b^2), without overflow; a > 0.
    template <class F>
    static F powerHeuristic(F a, F b) {
        const F ratio = b / a;
        return F(1.f) / (F(1.f) + ratio * ratio);
    }

    /// `distance` is finite: light from infinitely far is not absorbed at all.
    template <class F>
    static void absorb(const Scene& scene, const UInt<F>& medium, F distance, Spectrum<F>& throughput) {
        if (scene.media.size() <= 1 || none(medium != UInt<F>(0u))) return;
        const Spectrum<F> sigma = Records<F, MediumRecord>(scene.media.data(), medium)(&MediumRecord::absorption);
        throughput *= Spectrum<F>{exp(-sigma.r * distance), exp(-sigma.g * distance), exp(-sigma.b * distance)};
    }

    /// The medium on the side to which w points, at a border of media; else `medium`.
    template <class F>
    static UInt<F> mediumBehind(const SurfacePoint<F>& at, const Vec3<F>& w, const UInt<F>& medium) {
        const Mask<F> border = at.shape.has(kShapeMediumBoundary);
        if (none(border)) return medium;
        const UInt<F> side = select(dot(w, at.ng) < F(0.f), at.shape.mediumInside, at.shape.mediumOutside);
        return select(border, side, medium);
    }

    /// The medium of a ray that leaves in the direction w: another one where it goes through the surface.
    template <class F>
    static UInt<F> mediumOf(const SurfacePoint<F>& at, const RayGroup<F>& g, const Vec3<F>& w) {
        if (none(at.shape.has(kShapeMediumBoundary))) return g.medium;
        return select(crosses(at, g, w), mediumBehind(at, w, g.medium), g.medium);
    }

    /// Whether a ray that leaves in the direction w goes through the surface.
    template <class F>
    static Mask<F> crosses(const SurfacePoint<F>& at, const RayGroup<F>& g, const Vec3<F>& w) {
        return dot(w, at.ng) * dot(g.direction, at.ng) > F(0.f);
    }

    /// Whether w leads through a surface that shines itself: there light is found by the path alone. Light is sampled
    /// from this side of the surface, where in such a direction its own light would be all there is to see; but rays
    /// that go through leave from the far side and never meet it.
    template <class F>
    static Mask<F> throughLight(const SurfacePoint<F>& at, const RayGroup<F>& g, const Vec3<F>& w) {
        const Mask<F> shines = at.shape.light != UInt<F>(kNone);
        return none(shines) ? shines : shines & crosses(at, g, w);
    }

    template <class F>
    void passThrough(Step<F>& step, const RayGroup<F>& g, const Hit<F>& hit, const SurfacePoint<F>& at) const {
        // Shadow rays stop here, so what lies behind is found by the path alone and counts whole.
        const Mask<F> tired = Mask<F>(step.vertex > maxDepth_ + kMostPassThroughs);
        step.go(g,
                {offsetOrigin(at.p, at.error, at.ng, g.direction), g.direction, g.throughput, F(0.f), g.etaScale,
                 coneWidthAt(step.scene, g, hit), g.slot, g.depth, mediumBehind(at, g.direction, g.medium),
                 g.firstLight},
                !tired);
    }
    static constexpr std::uint32_t kMostPassThroughs = 10000;

    template <class F>
    void emission(Step<F>& step, RayGroup<F>& g, const SurfacePoint<F>& at) const {
        const UInt<F> first = at.shape.light;
        const Mask<F> emits = first != UInt<F>(kNone);
        if (none(emits)) return;
        const UInt<F> id = select(emits, first + at.primitive * at.shape.lightStride, UInt<F>(0u));
        const LightEval<F> e = evaluateLight<F>(step.scene.lights, id, {g.origin, at.p, g.direction});
        const F weight = emissionWeight(step, g, id, e.pdf);
        const Spectrum<F> value = g.throughput * e.L * weight;
        step.add(g, select(emits, value, Spectrum<F>::constant(F(0.f))));
    }

    template <class F, class M>
    void scatterPath(Step<F>& step, const RayGroup<F>& g, const Hit<F>& hit, const SurfacePoint<F>& at,
                     const UInt<F>& material, const Mask<F>& goesOn) const {
        const Scene& scene = step.scene;
        const F coneWidth = coneWidthAt(scene, g, hit);
        const auto numbers = scene.sampler.at<F>(g.address, step.vertex);
        ShadingContext<F> context = shadingContext(scene, at, coneWidth);
        if constexpr (kIsEstimate<M>) context.chance = numbers.get1(Dim::Material);
        const auto bsdf = M::bsdf(scene.materials.template records<M, F>(material), context);
        const Vec3<F> wo = at.frame.toLocal(-g.direction);

        // At the first vertex there is nothing yet but emission.
        F gathered(0.f);
        if (roulette_ == RouletteRule::Late && step.vertex > 1) gathered = brightness(g.gathered);
        if (!scene.lightSampler.empty()) {
            const Mask<F> lit = goesOn & !bsdf.smoothOnly();
            if (any(lit)) sampleLights(step, g, at, bsdf, wo, numbers, gathered, lit);
        }

        F uLobe(0.f);
        if constexpr (M::kUsesLobe) uLobe = numbers.get1(Dim::Lobe);
        const BsdfSample<F> s = bsdf.sample(wo, uLobe, numbers.get2(Dim::Direction));
        PathRay<F> next;
        next.direction = at.frame.toWorld(s.wi);
        next.throughput = g.throughput * s.weight;
        next.bsdfPdf = select(s.delta | throughLight(at, g, next.direction), F(0.f), s.pdf);
        next.etaScale = g.etaScale * s.eta * s.eta;
        next.coneWidth = coneWidth;
        next.slot = g.slot;
        next.depth = g.depth + UInt<F>(1u);
        next.origin = offsetOrigin(at.p, at.error, at.ng, next.direction);
        next.medium = mediumOf(at, g, next.direction);
        Mask<F> survives = goesOn & s.valid & !isBlack(next.throughput);
        next.firstLight = select(g.depth < UInt<F>(2u), gathered, g.firstLight);
        if (roulette_ != RouletteRule::Off) survives = survives & playRoulette(numbers, next);
        step.go(g, next, survives);
    }

    template <class F, class Bsdf>
    void sampleLights(Step<F>& step, const RayGroup<F>& g, const SurfacePoint<F>& at, const Bsdf& bsdf, const Vec3<F>& wo,
                      const Sampler::Numbers<F>& numbers, F gathered, const Mask<F>& lit) const {
        const Scene& scene = step.scene;
        // From where rays leave, not from the point itself: both strategies have to see the light from one place. (From a
        // sphere's own inside, rounding puts the point itself inside or outside at random.)
        const Vec3<F> from = offsetOrigin(at.p, at.error, at.ng, -g.direction);
        LitPoint<F> place{};
        if (scene.lightSampler.isByPlace()) {
            // The ray that goes on may meet a light, and has to know what was known here, to the bit.
            const UInt<F> normal = packDirection(at.frame.n);
            scatter(step.batch.slots.normal, g.slot, normal);
            place = {from, unpackDirection<F>(normal)};
        }
        UInt<F> id;
        F pick;
        scene.lightSampler.pick(place, scene.lightSampler.isSingle() ? F(0.f) : numbers.get1(Dim::LightPick), id, pick);
        const Mask<F> picked = pick > F(0.f);
        LightSample<F> light = sampleLight<F>(scene.lights, id, from, numbers.get2(Dim::LightPosition));
        if (!scene.lightMasks.empty())
            light.L *= scene.lightMasks.at<F>(scene.geometry, scene.textures, id, from + light.wi * light.distance);
        Mask<F> wanted = lit & light.valid & picked & (light.delta | !throughLight(at, g, light.wi));
        if (strategy_ == Strategy::BsdfOnly) wanted = wanted & light.delta;
        if (none(wanted)) return;
        const BsdfEval<F> f = bsdf.evaluate(wo, at.frame.toLocal(light.wi));
        const F pdf = select(picked, light.pdf * pick, F(1.f));
        F weight = F(1.f) / pdf;
        if (strategy_ == Strategy::Mis) weight = select(light.delta, weight, weight * powerHeuristic(pdf, f.pdf));
        Spectrum<F> value = g.throughput * f.fCos * light.L * weight;
        const Mask<F> infinite = light.distance == F(kInfinity);
        absorb(scene, mediumOf(at, g, light.wi), select(infinite, F(0.f), light.distance), value);
        wanted = wanted & !isBlack(value);
        wanted = wanted & playShadowRoulette(numbers, gathered, value);
        const Vec3<F> origin = offsetOrigin(at.p, at.error, at.ng, light.wi);
        const Mask<F> through = wanted & !infinite & crosses(at, g, light.wi);
        if (any(through)) {
            // The ray leaves from the other side of the surface than the one from which the light was sampled.
            const Vec3<F> path = from + light.wi * light.distance - origin;
            const F distance = length(path);
            light.wi = select(through, path * (F(1.f) / max(distance, F(1e-30f))), light.wi);
            light.distance = select(through, distance, light.distance);
        }
        // The light's own surface must not shadow its points: stop short by what rounding may have moved them.
        const F slack = light.distance * F(0x1p-16f) + maxComponent(abs(at.p)) * F(0x1p-20f);
        const F far = select(infinite, light.distance, light.distance - slack);
        wanted = wanted & (far > F(0.f));
        step.shadow(g, origin, light.wi, far, value, wanted);
    }

    /// The brightest channel of L, what each path has gathered, relative to the picture's typical radiance.
    template <class F>
    F brightness(const Spectrum<F>& L) const {
        return max(maxComponent(L) * F(perTypical_), F(0.f));
    }

    /// Kills lanes at random where little is to be expected of them; true where the path survives. Early: what pbrt does, in
    /// proportion to the throughput. Late: from the third scattering on, with the root of
    ///   kFaint throughput / (kDark + what the first hit sent to the camera, relative to the typical radiance),
    /// so paths live long where the pixel is dark, which is where indirect light decides the relative error, and shorter where
    /// it is bright. (Rath et al., EARS, SIGGRAPH 2022, derive that rule for learned estimates of both.) docs/DESIGN.md has
    /// figures.
    template <class F>
    Mask<F> playRoulette(const Sampler::Numbers<F>& numbers, PathRay<F>& next) const {
        constexpr float kFaint = 5.f, kDark = 1.5f;
        const bool late = roulette_ == RouletteRule::Late;
        const Mask<F> plays = !(next.depth < UInt<F>(late ? 3u : 2u));
        if (none(plays)) return Mask<F>(true);
        // What is not a number must not die here unseen: Step::go makes an invalid sample of it.
        const Mask<F> broken = !isFinite(next.throughput);
        const F carried = max(maxComponent(next.throughput) * next.etaScale, F(0.f));
        F survival = min(carried, F(1.f));
        if (late) {
            // Light that is caught without loss must come to an end, too.
            const F most = select(next.depth < UInt<F>(16u), F(1.f), F(0.95f));
            survival = min(sqrt(F(kFaint) * carried / (F(kDark) + next.firstLight)), most);
        }
        return draw(plays, broken, numbers.get1(Dim::Roulette), survival, next.throughput);
    }

    /// Late only: a shadow ray whose light would add less than a quarter to what the path has gathered is traced in proportion.
    template <class F>
    Mask<F> playShadowRoulette(const Sampler::Numbers<F>& numbers, F gathered, Spectrum<F>& value) const {
        if (none(gathered > F(0.f))) return Mask<F>(true);
        const F chance = F(4.f * perTypical_) * maxComponent(value) / max(gathered, F(1e-20f));
        const Mask<F> plays = (chance < F(1.f)) & (gathered > F(0.f));
        if (none(plays)) return Mask<F>(true);
        return draw(plays, Mask<F>(false), numbers.get1(Dim::ShadowRoulette), chance, value);
    }

    /// One game of roulette: true where the lane lives, which it does whatever u is unless it plays and is not spared. What
    /// those that played stand for grows by as much as they are fewer.
    template <class F>
    static Mask<F> draw(const Mask<F>& plays, const Mask<F>& spared, F u, F chance, Spectrum<F>& value) {
        const Mask<F> lives = (u < chance) | !plays | spared;
        value = select(plays & lives, value * (F(1.f) / chance), value);
        return lives;
    }

    std::uint32_t maxDepth_;
    Strategy strategy_;
    RouletteRule roulette_;
    float perTypical_;   ///< 1 / typical radiance, or 0
};

}  // namespace penumbra
