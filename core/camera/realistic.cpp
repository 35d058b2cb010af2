#include "core/camera/realistic.h"

#include "core/image/image_io.h"
#include "core/math/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace penumbra {
namespace {

constexpr double kMillimetre = 1e-3;  // in the scene's metres

/// Calls f(); an Error of it gets the camera's place.
template <class Function>
auto placed(const CameraInput& input, const std::string& what, Function&& f) {
    try {
        return f();
    } catch (const Error& error) {
        input.fail(what + error.what(), error.kind());
        throw;  // fail() never returns
    }
}

/// With the stop as wide as the scene asks.
std::vector<LensElement> readElements(CameraInput& input) {
    const std::string name = input.parameters().text("lensfile", "");
    if (name.empty()) input.fail("the parameter \"string lensfile\" is missing");
    std::vector<LensElement> elements = placed(input, "", [&] { return readLensFile(input.path(name)); });
    const double diameter = input.number("aperturediameter", 1, 1e-6f, 1e6f);
    bool hasStop = false;
    for (LensElement& e : elements) {
        if (e.curvatureRadius != 0) continue;
        hasStop = true;
        if (diameter > e.apertureDiameter)
            input.warn(fmt::format("the stop of the lens opens to {} mm, not to {} mm", e.apertureDiameter, diameter));
        e.apertureDiameter = std::min(e.apertureDiameter, diameter);
    }
    if (!hasStop) input.warn("the lens has no stop, so aperturediameter does nothing");
    return elements;
}

ApertureShape readShape(CameraInput& input) {
    const std::string name = input.parameters().text("aperture", "");
    if (name.empty()) return {};
    const std::span<const std::string> known = ApertureShape::names();
    if (std::find(known.begin(), known.end(), name) != known.end()) return ApertureShape::named(name);
    const std::string what = "aperture " + quote(name) + " is none of gaussian, square, pentagon, star and no image: ";
    return placed(input, what, [&] { return ApertureShape::fromImage(readImage(input.path(name))); });
}

}  // namespace

RealisticCamera RealisticCamera::make(CameraInput& input) {
    const std::vector<LensElement> elements = readElements(input);
    const ThickLens thick = thickLensOf(elements);
    const double focus = input.number("focusdistance", 10, 1e-6f, 1e9f) / kMillimetre;
    const double distance = placed(input, "", [&] { return filmDistance(thick, focus); });
    RealisticCamera camera;
    camera.lens_ = LensSystem(elements, distance, readShape(input));
    const double aspect = double(input.height()) / input.width(), diagonal = input.filmDiagonal();
    const double width = diagonal / std::sqrt(1 + aspect * aspect);
    camera.width_ = float(width);
    camera.height_ = float(width * aspect);
    camera.perPixelX_ = float(width / input.width());
    camera.perPixelY_ = float(width * aspect / input.height());
    camera.pixelSlope_ = float(width / input.width() / (distance - thick.rearPrincipal));
    const float reach = camera.lens_.rearReach(float(0.75 * diagonal));
    if (!std::isfinite(reach)) input.fail("the rim of the rear element touches the film");
    camera.findPupils(reach);
    return camera;
}

unsigned RealisticCamera::passing(float filmX, const Vec2<Lanes8f>& place) const {
    const Vec3<Lanes8f> film{Lanes8f(filmX), Lanes8f(0.f), Lanes8f(0.f)};
    const Vec3<Lanes8f> to{place.x - film.x, place.y, Lanes8f(lens_.rearZ())};
    return bits(Mask8(lens_.trace(film, normalize(to), true).weight > Lanes8f(0.f)));
}

/// The bounds of all places of a grid that let light through to some point of the ring, and a cell more on all sides.
RealisticCamera::Pupil RealisticCamera::pupilOfRing(float inner, float outer, float reach) const {
    constexpr int kCells = 64, kPoints = 3;
    const float cell = 2 * reach / kCells;
    Pupil bounds{reach, -reach, 0};
    for (int point = 0; point < kPoints; ++point)
        for (int row = 0; row <= kCells / 2; ++row)  // symmetric
            for (int column = 0; column <= kCells; column += kLanes<Lanes8f>) {
                const Vec2<Lanes8f> place{
                    (toFloat<Lanes8f>(laneIndices<Lanes8f>()) + Lanes8f(float(column))) * Lanes8f(cell) -
                        Lanes8f(reach),
                    Lanes8f(float(row) * cell)};
                const float x = inner + (outer - inner) * float(point) / (kPoints - 1);
                for (unsigned open = passing(x, place); open; open &= open - 1) {
                    const float at = lane(place.x, std::countr_zero(open));
                    bounds.x0 = std::min(bounds.x0, at - cell);
                    bounds.x1 = std::max(bounds.x1, at + cell);
                    bounds.y1 = std::max(bounds.y1, float(row + 1) * cell);
                }
            }
    // Where the grid met nothing, something may still come through.
    if (bounds.x0 > bounds.x1) return {-reach, reach, reach};
    return {std::max(bounds.x0, -reach), std::min(bounds.x1, reach), std::min(bounds.y1, reach)};
}

void RealisticCamera::findPupils(float reach) {
    const float corner = float(0.5 * std::hypot(double(width_), double(height_)));
    ringsPerLength_ = kRings / corner;
    for (int i = 0; i < kRings; ++i)
        pupils_.push_back(pupilOfRing(float(i) / ringsPerLength_, float(i + 1) / ringsPerLength_, reach));
    pupils_.push_back({-reach, reach, reach});
}

template <class F>
LensRay<F> RealisticCamera::ray(const Vec2<F>& raster, const Vec2<F>& lens) const {
    // Upside down and left to right, as a lens throws its picture.
    const Vec3<F> film{F(0.5f * width_) - raster.x * F(perPixelX_), raster.y * F(perPixelY_) - F(0.5f * height_),
                       F(0.f)};
    const F radius = sqrt(film.x * film.x + film.y * film.y);
    const UInt<F> ring = toUInt(min(radius * F(ringsPerLength_), F(float(kRings))));
    const Records<F, Pupil> pupil(pupils_.data(), ring);
    const F x0 = pupil(&Pupil::x0), x1 = pupil(&Pupil::x1), y1 = pupil(&Pupil::y1);
    const Vec2<F> p{x0 + (x1 - x0) * lens.x, y1 * (F(2.f) * lens.y - F(1.f))};
    // Pupils are those of points on the +x axis.
    const Mask<F> onAxis = radius == F(0.f);
    const F inverse = F(1.f) / select(onAxis, F(1.f), radius);
    const F c = select(onAxis, F(1.f), film.x * inverse), s = film.y * inverse;
    const F z(lens_.rearZ());
    const Vec3<F> to = Vec3<F>{c * p.x - s * p.y, s * p.x + c * p.y, z} - film;
    const Vec3<F> d = normalize(to);
    LensRay<F> r = lens_.trace(film, d);
    const F cosSquared = d.z * d.z, area = (x1 - x0) * F(2.f) * y1;
    r.weight = r.weight * cosSquared * cosSquared * area / (z * z);
    r.origin = r.origin * F(float(kMillimetre));
    return r;
}

template LensRay<float> RealisticCamera::ray(const Vec2<float>&, const Vec2<float>&) const;
template LensRay<Lanes8f> RealisticCamera::ray(const Vec2<Lanes8f>&, const Vec2<Lanes8f>&) const;

}  // namespace penumbra
