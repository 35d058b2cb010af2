// What the projective cameras share: the screen, and a thin lens with a round or bladed aperture.
#pragma once

#include "core/camera/camera_plugin.h"
#include "core/math/warps.h"

#include <cmath>

namespace penumbra {

/// From the raster to the plane z = 1.
struct Screen {
    float x0 = 0, y0 = 0, perPixelX = 0, perPixelY = 0;

    /// `scale`: of the screen window, so that perspective is a window of slopes.
    static Screen of(const CameraInput& input, double scale) {
        const ScreenWindow w = input.screen();
        return {float(w.x0 * scale), float(w.y1 * scale), float((w.x1 - w.x0) * scale / input.width()),
                float(-(w.y1 - w.y0) * scale / input.height())};
    }
    template <class F>
    Vec2<F> at(const Vec2<F>& raster) const {
        return {F(x0) + raster.x * F(perPixelX), F(y0) + raster.y * F(perPixelY)};
    }
    float pixel() const { return 0.5f * (std::fabs(perPixelX) + std::fabs(perPixelY)); }
};

struct ThinLens {
    float radius = 0, focalDistance = 1e6f;  ///< scene units; radius 0: everything is sharp
    int blades = 0;                          ///< 0: round; else a regular polygon with its corners on the circle
    float rotation = 0;                      ///< of the first corner from +x, in radians

    static constexpr ParameterInfo kParameters[] = {
        {"float", "lensradius", "0", "of a thin lens, in scene units; 0: everything is sharp"},
        {"float", "focaldistance", "1e6", "distance of the plane in focus along the axis"},
        {"integer", "apertureblades", "0", "corners of the aperture, 3 to 64; 0: round (not in pbrt)"},
        {"float", "aperturerotation", "90", "degrees from +x to a corner of it, counterclockwise (not in pbrt)"},
    };

    static ThinLens make(const CameraInput& input) {
        constexpr float kMost = 1e30f, kDegree = kPi / 180.f;
        constexpr float kFarthest = 1e18f;  // whose square a float still holds
        ThinLens lens;
        lens.radius = input.number("lensradius", 0, 0, kMost);
        lens.focalDistance = input.number("focaldistance", 1e6f, 1e-30f, kFarthest);
        lens.blades = input.integer("apertureblades", 0, 0, 64);
        if (lens.blades == 1 || lens.blades == 2) input.fail("an aperture needs 3 blades at least, or 0 to be round");
        lens.rotation = input.number("aperturerotation", 90, -360, 360) * kDegree;
        return lens;
    }
    bool isPinhole() const { return !(radius > 0.f); }

    /// The ray through a point of the lens that meets the given one in the plane of focus. REQUIRES: r.direction.z
    /// is 1.
    template <class F>
    LensRay<F> through(const LensRay<F>& r, const Vec2<F>& u) const {
        const Vec2<F> q = point(u) * F(radius);
        const Vec3<F> focus = r.origin + r.direction * F(focalDistance);
        const Vec3<F> origin = r.origin + Vec3<F>{q.x, q.y, F(0.f)};
        return {origin, focus - origin, r.weight};
    }

    /// Uniform on the aperture, whose circle has radius 1.
    template <class F>
    Vec2<F> point(const Vec2<F>& u) const {
        if (blades == 0) return concentricDisk(u);
        // A fan of triangles about the centre.
        const F place = u.x * F(float(blades)), side = min(floor(place), F(float(blades - 1)));
        const F r = sqrt(place - side), step(kTwoPi / float(blades)), angle = side * step + F(rotation);
        F s0, c0, s1, c1;
        sinCos(angle, s0, c0);
        sinCos(angle + step, s1, c1);
        return {r * (c0 + (c1 - c0) * u.y), r * (s0 + (s1 - s0) * u.y)};
    }
};

}  // namespace penumbra
