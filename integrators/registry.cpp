#include "integrators/registry.h"

#include "core/base/error.h"

namespace penumbra {

std::unique_ptr<Integrator> makeIntegrator(const Scene& scene) {
    const IntegratorSettings& settings = scene.integrator;
    std::unique_ptr<Integrator> made;
    forEachType(IntegratorTypes{}, [&]<class T>() {
        if (T::kInfo.name == settings.name) made = T::make(settings, scene);
    });
    if (!made)
        throw Error(ErrorKind::Usage, "unknown integrator '" + settings.name + "'" + suggestion(settings.name, pluginNames(IntegratorTypes{})));
    return made;
}

}  // namespace penumbra
