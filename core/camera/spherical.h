// spherical: all directions from one point, as an equal-area octahedral map (what infinite lights read) or by longitude
// and latitude.
//
// Conventions: "equirectangular": the top row looks to +y, u = 0.25 to +z, u = 0 to +x. "equalarea": the map's axes
// with y and z swapped, so that the centre of the picture looks to +y, its corners to -y, its lower edge to +z. Points
// outside the picture continue over its edge, so that filters see no seam.
#pragma once

#include "core/camera/camera_plugin.h"
#include "core/math/equal_area.h"

#include <cmath>

namespace penumbra {

struct SphericalCamera {
    static constexpr ParameterInfo kParameters[] = {
        {"string", "mapping", "equalarea", "equalarea or equirectangular"},
    };
    static constexpr PluginInfo kInfo{"spherical", "all directions from one point", kParameters};
    static constexpr bool kLooksAllRound = true;

    static SphericalCamera make(CameraInput& input) {
        // What a projective camera takes is accepted and has no meaning.
        (void)input.screen();
        for (const char* ignored : {"lensradius", "focaldistance"})
            input.parameters().number(ignored, 0);
        const std::string mapping = input.parameters().text("mapping", "equalarea");
        static const std::vector<std::string> known{"equalarea", "equirectangular"};
        if (mapping != known[0] && mapping != known[1])
            input.fail("unknown mapping " + quote(mapping) + suggestion(mapping, known));
        return {mapping == "equalarea", 1.f / float(input.width()), 1.f / float(input.height())};
    }

    template <class F>
    LensRay<F> ray(const Vec2<F>& raster, const Vec2<F>&) const {
        const Vec2<F> st{raster.x * F(perPixelX), raster.y * F(perPixelY)};
        return {{F(0.f), F(0.f), F(0.f)}, equalArea ? octahedral(st) : longitudeLatitude(st), F(1.f)};
    }
    bool usesLens() const { return false; }
    PixelCone cone() const { return {0, std::sqrt(4 * kPi * perPixelX * perPixelY)}; }

    bool equalArea = true;
    float perPixelX = 1, perPixelY = 1;

private:
    template <class F>
    static Vec3<F> octahedral(Vec2<F> st) {
        wrap(st.x, st.y);
        wrap(st.y, st.x);
        const Vec3<F> d = equalAreaDirection(st);
        return {d.x, d.z, d.y};
    }
    /// Across an edge of the octahedral map lies the same edge, reversed.
    template <class F>
    static void wrap(F& over, F& along) {
        const Mask<F> outside = (over < F(0.f)) | (over > F(1.f));
        along = select(outside, F(1.f) - along, along);
        over = select(over < F(0.f), -over, select(over > F(1.f), F(2.f) - over, over));
    }
    template <class F>
    static Vec3<F> longitudeLatitude(const Vec2<F>& st) {
        F sinTheta, cosTheta, sinPhi, cosPhi;
        sinCos(st.y * F(kPi), sinTheta, cosTheta);
        sinCos(st.x * F(kTwoPi), sinPhi, cosPhi);
        return {sinTheta * cosPhi, cosTheta, sinTheta * sinPhi};
    }
};

}  // namespace penumbra
