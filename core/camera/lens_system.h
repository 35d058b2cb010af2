// LensSystem: a photographic lens as a row of spherical surfaces about one axis, as a lens file prescribes it, and rays
// traced through it from the film.
//
// Conventions: millimetres; the film is the plane z = 0, the scene lies towards +z; surfaces are kept in the order in
// which light traced from the film meets them. Signs of a lens file: a radius is positive where the surface bulges
// towards the scene; radius 0 is the aperture stop. Exact tracing: Spencer & Murty, "General Ray-Tracing Procedure",
// JOSA 52 (1962), in a form without cancellation for flat surfaces. Focus: paraxial matrices and the thick lens
// equation (Hecht, Optics, ch. 6). Thread safety: immutable once it is made.
#pragma once

#include "core/camera/aperture_shape.h"
#include "core/camera/camera_plugin.h"

#include <span>
#include <vector>

namespace penumbra {

/// A row of a lens file, front element first.
struct LensElement {
    double curvatureRadius = 0;   ///< 0: the stop
    double thickness = 0;         ///< to the next surface
    double eta = 1;               ///< index of refraction behind the surface (0 counts as 1)
    double apertureDiameter = 0;  ///< of what lets light through
};

/// Error(BadData) where the file does not hold rows of four, or rows that are no surfaces.
std::vector<LensElement> readLensFile(const std::string& path);

/// What a lens is to a first approximation.
struct ThickLens {
    double focalLength = 0;
    double frontPrincipal = 0;  ///< from the front vertex towards the film
    double rearPrincipal = 0;   ///< from the rear vertex towards the film
    double length = 0;          ///< between the vertices
};
ThickLens thickLensOf(std::span<const LensElement> elements);

/// From the rear vertex to the film, so that what is `focusDistance` from the film is sharp. Error(BadData), without a
/// place, for a lens that does not gather light or cannot focus so near.
double filmDistance(const ThickLens& lens, double focusDistance);

class LensSystem {
public:
    LensSystem() = default;
    /// `filmDistance`: from the rear vertex.
    LensSystem(std::span<const LensElement> elements, double filmDistance, ApertureShape shape);

    /// Of the rear vertex, above the film.
    float rearZ() const { return surfaces_.front().gap; }
    /// Half the side of a square at rearZ() through which all rays go that come from within `filmRadius` of the axis.
    float rearReach(float filmRadius) const;

    /// The ray from a point with z = 0, in a unit direction with z > 0; it leaves from the front surface, with a weight
    /// that is what the aperture lets through: 0 where a rim or total reflection stops it. `openAperture`: as if the
    /// stop were round.
    template <class F>
    LensRay<F> trace(Vec3<F> p, Vec3<F> d, bool openAperture = false) const {
        F weight(1.f);
        for (const Surface& s : surfaces_) {
            p.z = p.z - F(s.gap);  // from here on relative to the surface's vertex
            const F c(s.curvature);
            // c t^2 - 2 b t + k = 0; of the two points the one near the vertex.
            const F b = d.z - c * dot(p, d), k = c * dot(p, p) - F(2.f) * p.z;
            const F discriminant = b * b - c * k;
            const F t = k / (b + safeSqrt(discriminant));
            p = p + d * t;
            const F radiusSquared = p.x * p.x + p.y * p.y;
            const Mask<F> passes = (discriminant >= F(0.f)) & (radiusSquared <= F(s.radius * s.radius));
            weight = select(passes, weight, F(0.f));
            if (none(weight > F(0.f))) break;
            if (!s.isStop)
                refract(s, p, d, weight);
            else if (!openAperture && !shape_.isRound())
                weight = weight * shape_.transmission(p.x * F(1.f / s.radius), p.y * F(1.f / s.radius));
        }
        p.z = p.z + F(frontZ_);
        // Lanes that were stopped may hold anything.
        const Mask<F> through = weight > F(0.f);
        const Vec3<F> ahead{F(0.f), F(0.f), F(1.f)};
        return {select(through, p, ahead * F(frontZ_)), select(through, d, ahead), weight};
    }

private:
    struct Surface {
        float gap;         ///< from the surface before, or the film
        float curvature;   ///< 1 / radius, positive where the centre lies towards the scene
        float radius;      ///< of the rim
        float indexRatio;  ///< before it over behind it
        bool isStop;
    };

    /// Snell's law in vectors; `p` is on the surface, relative to its vertex.
    template <class F>
    static void refract(const Surface& s, const Vec3<F>& p, Vec3<F>& d, F& weight) {
        const F c(s.curvature), ratio(s.indexRatio);
        const Vec3<F> n{-c * p.x, -c * p.y, F(1.f) - c * p.z};  // unit, towards the centre or away from it: +z
        const F cosine = dot(d, n);
        const F squared = F(1.f) - ratio * ratio * (F(1.f) - cosine * cosine);
        weight = select((squared > F(0.f)) & (cosine > F(0.f)), weight, F(0.f));
        d = d * ratio + n * (safeSqrt(squared) - ratio * cosine);
    }

    std::vector<Surface> surfaces_;
    ApertureShape shape_;
    float frontZ_ = 0;
};

}  // namespace penumbra
