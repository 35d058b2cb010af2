// The integrators there are. A new one is a header with its shader, a .cpp with its factory, and an entry in IntegratorTypes.
#pragma once

#include "core/base/plugin.h"
#include "integrators/integrator.h"

namespace penumbra {

/// What stands in the list: the information and the factory of an integrator. The shader behind it is known to its own .cpp
/// alone, so that each is compiled once.
struct PathIntegrator {
    static const PluginInfo kInfo;
    static std::unique_ptr<Integrator> make(const IntegratorSettings&, const Scene&);
};
struct DirectIntegrator {
    static const PluginInfo kInfo;
    static std::unique_ptr<Integrator> make(const IntegratorSettings&, const Scene&);
};
struct AmbientOcclusionIntegrator {
    static const PluginInfo kInfo;
    static std::unique_ptr<Integrator> make(const IntegratorSettings&, const Scene&);
};
struct NormalsIntegrator {
    static const PluginInfo kInfo;
    static std::unique_ptr<Integrator> make(const IntegratorSettings&, const Scene&);
};

using IntegratorTypes = TypeList<PathIntegrator, DirectIntegrator, AmbientOcclusionIntegrator, NormalsIntegrator>;

/// The integrator that the scene's settings name, ready for that scene; Error(Usage) naming the nearest where there is none.
std::unique_ptr<Integrator> makeIntegrator(const Scene& scene);

}  // namespace penumbra
