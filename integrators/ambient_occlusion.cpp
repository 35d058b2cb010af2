// ambientocclusion: the share of the hemisphere over each point from which nothing is met within `maxdistance`.
//
// One direction a sample, cosine-weighted about the shading normal (cossample) or uniform over the hemisphere; the result is
// 1 where nothing occludes. Both estimate the cosine-weighted share.

#include "integrators/registry.h"
#include "integrators/shader_integrator.h"

namespace penumbra {
namespace {

class AmbientOcclusionShader {
public:
    explicit AmbientOcclusionShader(const IntegratorSettings& s) : maxDistance_(s.maxDistance), cosine_(s.cosineSampling) {}

    template <class F, class M>
    void shade(Step<F>& step, const RayGroup<F>& g, const Hit<F>& hit, const UInt<F>&) const noexcept {
        const SurfacePoint<F> at = surfacePoint(step.scene.geometry, hit, g.origin, g.direction, g.time);
        const Vec2<F> u = step.scene.sampler.template at<F>(g.address, step.vertex).get2(Dim::Direction);
        Vec3<F> w = cosine_ ? cosineHemisphere(u) : uniformSphere(u);
        w.z = abs(w.z);
        const F weight = cosine_ ? F(1.f) : F(2.f) * w.z;   // cos / pi over the density
        // The hemisphere that the viewer sees.
        Vec3<F> direction = at.frame.toWorld(w);
        direction = flipSign(dot(at.frame.n, g.direction) > F(0.f), direction);
        step.shadow(g, offsetOrigin(at.p, at.error, at.ng, direction), direction, F(maxDistance_), g.throughput * weight, g.live);
    }
    template <class F>
    void miss(Step<F>&, RayGroup<F>&) const noexcept {}

private:
    float maxDistance_;
    bool cosine_;
};

constexpr ParameterInfo kParameters[] = {
    {"bool", "cossample", "true", "directions by the cosine; false: uniform over the hemisphere"},
    {"float", "maxdistance", "infinity", "what is farther away does not occlude; scene units"},
};

}  // namespace

const PluginInfo AmbientOcclusionIntegrator::kInfo{"ambientocclusion", "openness of the hemisphere over each point", kParameters};
std::unique_ptr<Integrator> AmbientOcclusionIntegrator::make(const IntegratorSettings& s, const Scene&) {
    return std::make_unique<ShaderIntegrator<AmbientOcclusionShader>>(s);
}

}  // namespace penumbra
