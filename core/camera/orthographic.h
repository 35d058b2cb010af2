// orthographic: parallel rays, or a thin lens about each of them.
#pragma once

#include "core/camera/projection.h"

namespace penumbra {

struct OrthographicCamera {
    static constexpr ParameterInfo kParameters[] = {
        {"float", "frameaspectratio", "", "of the screen; default: the picture's"},
        {"float[4]", "screenwindow", "",
         "x0 x1 y0 y1 of the picture in camera space; default: -1 to 1 on its shorter side"},
        ThinLens::kParameters[0],
        ThinLens::kParameters[1],
        ThinLens::kParameters[2],
        ThinLens::kParameters[3],
    };
    static constexpr PluginInfo kInfo{"orthographic", "parallel rays", kParameters};
    static constexpr bool kLooksAllRound = false;

    static OrthographicCamera make(CameraInput& input) { return {Screen::of(input, 1), ThinLens::make(input)}; }

    template <class F>
    LensRay<F> ray(const Vec2<F>& raster, const Vec2<F>& lensPoint) const {
        const Vec2<F> p = screen.at(raster);
        const LensRay<F> straight{{p.x, p.y, F(0.f)}, {F(0.f), F(0.f), F(1.f)}, F(1.f)};
        return lens.isPinhole() ? straight : lens.through(straight, lensPoint);
    }
    bool usesLens() const { return !lens.isPinhole(); }
    PixelCone cone() const { return {screen.pixel(), 0}; }

    Screen screen;
    ThinLens lens;
};

}  // namespace penumbra
