// realistic: rays through the lens that a lens file prescribes, from a film of a given size.
//
// A point of the film sees the scene through the exit pupil: rays are sent to a rectangle about it, whose size is found
// for rings of the film when the camera is made (Kolb, Mitchell & Hanrahan 1995; Steinert et al. 2011). A ray's weight
// is cos^4 x rectangle / distance^2, with the distance from the film to the rear element: the irradiance of the film
// for radiance 1, so that pictures are as dark as those of a camera are, and need a film speed to match (PBRT-v4). Rays
// that a rim stops weigh 0: they count as black samples, which is what vignetting is.
//
// Conventions: the lens file is in millimetres, the scene in metres; the film's centre is the origin of camera space.
#pragma once

#include "core/camera/lens_system.h"

namespace penumbra {

class RealisticCamera {
public:
    static constexpr ParameterInfo kParameters[] = {
        {"string", "lensfile", "",
         "rows of radius, thickness, index and diameter in mm, front element first; radius 0: the stop"},
        {"float", "aperturediameter", "1", "of the stop, in mm"},
        {"float", "focusdistance", "10", "from the film to what is sharp, in metres"},
        {"string", "aperture", "",
         "what the stop looks like: gaussian, square, pentagon, star, or an image; default: round"},
    };
    static constexpr PluginInfo kInfo{"realistic", "a lens of many elements before a film of 35 mm (Film's diagonal)",
                                      kParameters};
    static constexpr bool kLooksAllRound = false;

    static RealisticCamera make(CameraInput& input);

    template <class F>
    LensRay<F> ray(const Vec2<F>& raster, const Vec2<F>& lens) const;
    bool usesLens() const { return true; }
    PixelCone cone() const { return {0, pixelSlope_}; }

private:
    /// A rectangle in the plane of the rear vertex that holds the exit pupil of points of the film on the +x axis.
    struct Pupil {
        float x0, x1, y1;  ///< y from -y1 to y1: it is symmetric
    };
    static constexpr int kRings = 64;

    void findPupils(float reach);
    /// Whether light from (filmX, 0) to that place of the rear vertex's plane comes through, of eight places side by
    /// side.
    unsigned passing(float filmX, const Vec2<Lanes8f>& place) const;
    Pupil pupilOfRing(float inner, float outer, float reach) const;

    LensSystem lens_;
    float width_ = 0, height_ = 0;         ///< of the film
    float perPixelX_ = 0, perPixelY_ = 0;  ///< millimetres
    float ringsPerLength_ = 0;
    float pixelSlope_ = 0;
    std::vector<Pupil> pupils_;  ///< of the rings, and one for all points beyond them
};

extern template LensRay<float> RealisticCamera::ray(const Vec2<float>&, const Vec2<float>&) const;
extern template LensRay<Lanes8f> RealisticCamera::ray(const Vec2<Lanes8f>&, const Vec2<Lanes8f>&) const;

}  // namespace penumbra
