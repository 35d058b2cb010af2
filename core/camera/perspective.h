// perspective: straight lines through one point, or through a thin lens. Rays weigh 1: no cos^4.
#pragma once

#include "core/camera/projection.h"

namespace penumbra {

struct PerspectiveCamera {
    static constexpr ParameterInfo kParameters[] = {
        {"float", "fov", "90", "degrees that the shorter side of the picture spans"},
        {"float", "frameaspectratio", "", "of the screen; default: the picture's"},
        {"float[4]", "screenwindow", "", "x0 x1 y0 y1 of the screen, on which fov spans -1 to 1"},
        ThinLens::kParameters[0],
        ThinLens::kParameters[1],
        ThinLens::kParameters[2],
        ThinLens::kParameters[3],
    };
    static constexpr PluginInfo kInfo{"perspective", "a pinhole, or a thin lens", kParameters};
    static constexpr bool kLooksAllRound = false;

    static PerspectiveCamera make(CameraInput& input) {
        const double fov = input.number("fov", 90, 1e-4f, 179.99f);
        return {Screen::of(input, std::tan(fov * 3.14159265358979323846 / 360)), ThinLens::make(input)};
    }

    template <class F>
    LensRay<F> ray(const Vec2<F>& raster, const Vec2<F>& lensPoint) const {
        const Vec2<F> p = screen.at(raster);
        const LensRay<F> pinhole{{F(0.f), F(0.f), F(0.f)}, {p.x, p.y, F(1.f)}, F(1.f)};
        return lens.isPinhole() ? pinhole : lens.through(pinhole, lensPoint);
    }
    bool usesLens() const { return !lens.isPinhole(); }
    PixelCone cone() const { return {0, screen.pixel()}; }

    Screen screen;
    ThinLens lens;
};

}  // namespace penumbra
