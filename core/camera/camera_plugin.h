// What a camera type is to a scene, and what it asks of the scene when it is made.
//
// A camera type is a plain value with
//   static constexpr PluginInfo kInfo;
//   static constexpr bool kLooksAllRound; // not along an axis: depth is distance
//   static T make(CameraInput&);                                       // from parameters, at scene build (cold)
//   template <class F> LensRay<F> ray(const Vec2<F>& raster, const Vec2<F>& lens) const;   // hot
//   bool usesLens() const;                // false: ray() does not look at `lens`, which then need not be drawn
//   PixelCone cone() const;
// in a file of its own and an entry in registry.h. Where the camera stands, how it moves and when its shutter is open
// concern no type: camera.h adds them.
//
// Conventions (PBRT-v4's): camera space is left-handed, +x right, +y up, +z forward; raster (0, 0) is the top left
// corner of the picture and pixel (i, j) covers [i, i+1] x [j, j+1]. Filters reach a few pixels beyond the picture, so
// raster points may lie outside it.
#pragma once

#include "core/base/parameters.h"
#include "core/base/plugin.h"
#include "core/math/vector.h"

#include <string>

namespace penumbra {

/// A ray in camera space.
template <class F>
struct LensRay {
    Vec3<F> origin, direction;  ///< the direction has any length, finite and not zero
    F weight;                   ///< what its radiance counts; 0: nothing comes through, the ray need not be traced
};

/// The cone of a pixel: as wide as `width` where rays start, wider by `spread` per unit of distance.
struct PixelCone {
    float width = 0, spread = 0;
};

/// The picture's rectangle on the plane z = 1.
struct ScreenWindow {
    double x0 = -1, x1 = 1, y0 = -1, y1 = 1;
};

/// The parameters of a Camera directive, and what cameras need to know of the film.
class CameraInput {
public:
    virtual ~CameraInput() = default;
    virtual int width() const = 0;  ///< of the whole picture, in pixels
    virtual int height() const = 0;
    virtual double filmDiagonal() const = 0;  ///< millimetres
    /// From "screenwindow" or "frameaspectratio"; the shorter side is -1 to 1 where neither is given.
    virtual ScreenWindow screen() const = 0;

    virtual const ParameterSet& parameters() const = 0;
    /// A parameter between limits; fails outside them.
    virtual float number(std::string_view name, float otherwise, float least, float most) const = 0;
    virtual int integer(std::string_view name, int otherwise, int least, int most) const = 0;
    /// The name of a file as a parameter gives it, resolved like every path of the scene.
    virtual std::string path(const std::string& name) const = 0;
    virtual void warn(const std::string& text) = 0;
    [[noreturn]] virtual void fail(const std::string& text, ErrorKind kind = ErrorKind::BadData) const = 0;
};

}  // namespace penumbra
