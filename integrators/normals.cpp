// normals: the shading normal of the first hit as a colour, each world-space component mapped from [-1, 1] to [0, 1];
// turned towards the viewer. For looking at geometry, and the quickest test of a scene.

#include "integrators/registry.h"
#include "integrators/shader_integrator.h"

namespace penumbra {
namespace {

class NormalsShader {
public:
    explicit NormalsShader(const IntegratorSettings&) {}

    template <class F, class M>
    void shade(Step<F>& step, RayGroup<F>& g, const Hit<F>& hit, const UInt<F>& material) const noexcept {
        const SurfacePoint<F> at = shadedPoint<F, M>(step.scene, g, hit, material);
        const Vec3<F> n = flipSign(dot(at.frame.n, g.direction) > F(0.f), at.frame.n) * F(0.5f);
        step.add(g, {n.x + F(0.5f), n.y + F(0.5f), n.z + F(0.5f)});
    }
    template <class F>
    void miss(Step<F>&, RayGroup<F>&) const noexcept {}
};

}  // namespace

const PluginInfo NormalsIntegrator::kInfo{"normals", "shading normals as colours", {}};
std::unique_ptr<Integrator> NormalsIntegrator::make(const IntegratorSettings& s, const Scene&) {
    return std::make_unique<ShaderIntegrator<NormalsShader>>(s);
}

}  // namespace penumbra
