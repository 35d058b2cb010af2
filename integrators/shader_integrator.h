// ShaderIntegrator: the Integrator of a shader (see batch_driver.h). Include it in the one .cpp of each integrator: it
// instantiates the whole transport, for eight lanes and for one.
#pragma once

#include "integrators/batch_driver.h"

namespace penumbra {

template <class Shader>
class ShaderIntegrator final : public Integrator {
public:
    /// The arguments go to the shader.
    template <class... Args>
    explicit ShaderIntegrator(const Args&... args) : shader_(args...) {}

    void render(const Scene& scene, const Tile& tile, SampleRange samples, const RenderControls& controls, Film& film,
                RenderCounts& counts) const noexcept override {
        if (controls.lanes == 1) BatchDriver<float, Shader>(scene, shader_, controls, film, counts).render(tile, samples);
        else BatchDriver<Lanes8f, Shader>(scene, shader_, controls, film, counts).render(tile, samples);
    }

private:
    Shader shader_;
};

}  // namespace penumbra
