#include "integrators/path.h"

#include "integrators/pilot.h"
#include "integrators/registry.h"
#include "integrators/shader_integrator.h"

namespace penumbra {
namespace {

constexpr ParameterInfo kParameters[] = {
    {"integer", "maxdepth", "5", "scattering events at most; emission met after the last one counts"},
    {"string", "lightsampler", "bvh", "how the next light is picked: bvh (by what it may contribute), power or uniform"},
};

}  // namespace

const PluginInfo PathIntegrator::kInfo{"path", "path tracing with next-event estimation and multiple importance sampling (default)",
                                       kParameters};
std::unique_ptr<Integrator> PathIntegrator::make(const IntegratorSettings& s, const Scene& scene) {
    float typical = 0.f;
    if (s.roulette == RouletteRule::Late && s.maxDepth > 1) {   // else there is no roulette to be played
        IntegratorSettings pilot = s;
        pilot.roulette = RouletteRule::Off;
        pilot.maxDepth = 2;
        typical = typicalRadiance(scene, ShaderIntegrator<PathShader>(pilot, 0.f));
    }
    return std::make_unique<ShaderIntegrator<PathShader>>(s, typical);
}

const PluginInfo DirectIntegrator::kInfo{"direct", "emission and light that was scattered once: path with maxdepth 1",
                                         std::span(kParameters).last(1)};
std::unique_ptr<Integrator> DirectIntegrator::make(const IntegratorSettings& s, const Scene& scene) {
    IntegratorSettings once = s;
    once.maxDepth = s.maxDepth < 1 ? s.maxDepth : 1;
    return PathIntegrator::make(once, scene);
}

}  // namespace penumbra
