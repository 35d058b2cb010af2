#include "core/camera/lens_system.h"

#include "core/base/number_file.h"
#include "core/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra {
namespace {

constexpr std::size_t kMostElements = 1000;

/// Index of refraction; the files write 0 where there is air.
double indexOf(double eta) {
    return eta == 0 ? 1 : eta;
}

double curvatureOf(const LensElement& e) {
    return e.curvatureRadius == 0 ? 0 : 1 / e.curvatureRadius;
}

}  // namespace

std::vector<LensElement> readLensFile(const std::string& path) {
    const auto fail = [&](const std::string& reason) {
        throw Error(ErrorKind::BadData, pathText(path) + ": " + reason);
    };
    const std::vector<float> n = readNumbers(path, "lens");
    if (n.empty() || n.size() % 4)
        fail(fmt::format("a lens is given by rows of radius, thickness, index and diameter, but there are {} numbers",
                         n.size()));
    if (n.size() / 4 > kMostElements) fail(fmt::format("a lens of more than {} surfaces", kMostElements));
    std::vector<LensElement> elements;
    for (std::size_t i = 0; i < n.size(); i += 4) {
        const LensElement e{n[i], n[i + 1], n[i + 2], n[i + 3]};
        const std::string row = fmt::format("surface {}: ", i / 4 + 1);
        if (!(e.apertureDiameter > 0)) fail(row + fmt::format("diameter {} is not above 0", e.apertureDiameter));
        if (e.eta != 0 && !(e.eta >= 1 && e.eta <= 10)) fail(row + fmt::format("index {} is outside 1 to 10", e.eta));
        if (!(e.thickness >= 0)) fail(row + fmt::format("thickness {} is below 0", e.thickness));
        elements.push_back(e);
    }
    if (std::all_of(elements.begin(), elements.end(), [](const LensElement& e) { return e.curvatureRadius == 0; }))
        fail("no surface of the lens is curved");
    return elements;
}

ThickLens thickLensOf(std::span<const LensElement> elements) {
    // The paraxial matrix from the front vertex to the rear one, of height and index times slope.
    double a = 1, b = 0, c = 0, d = 1, length = 0, index = 1;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const LensElement& e = elements[i];
        const double behind = indexOf(e.eta), power = (behind - index) * curvatureOf(e);
        c -= power * a, d -= power * b;
        index = behind;
        if (i + 1 == elements.size()) break;  // what is behind the last one is the distance of the film
        a += e.thickness / index * c, b += e.thickness / index * d;
        length += e.thickness;
    }
    return {-1 / c, (d - 1) / c, (1 - a) / c, length};
}

double filmDistance(const ThickLens& lens, double focusDistance) {
    const double f = lens.focalLength;
    if (!std::isfinite(f) || !(f > 0))
        throw Error(ErrorKind::BadData,
                    fmt::format("the lens does not gather light: its focal length is {:.4g} mm", f));
    // Object and image are a and b away from their principal planes, which are h apart: 1/a + 1/b = 1/f, a + b = D - h.
    const double h = lens.length + lens.rearPrincipal - lens.frontPrincipal, sum = focusDistance - h;
    if (!(sum > 4 * f))
        throw Error(
            ErrorKind::BadData,
            fmt::format(
                "the lens has a focal length of {:.4g} mm and cannot be focused on {:.4g} mm: at least {:.4g} mm", f,
                focusDistance, 4 * f + h));
    const double b = 2 * f * sum / (sum + std::sqrt(sum * (sum - 4 * f)));  // the smaller one, without cancellation
    const double distance = b + lens.rearPrincipal;
    if (!(distance > 0)) throw Error(ErrorKind::BadData, "the lens would have to stand behind the film");
    return distance;
}

LensSystem::LensSystem(std::span<const LensElement> elements, double filmDistance, ApertureShape shape)
    : shape_(std::move(shape)) {
    double gap = filmDistance, z = 0;
    for (std::size_t i = elements.size(); i-- > 0;) {
        const LensElement& e = elements[i];
        const double before = indexOf(e.eta), behind = i > 0 ? indexOf(elements[i - 1].eta) : 1;
        surfaces_.push_back({float(gap), float(-curvatureOf(e)), float(e.apertureDiameter / 2), float(before / behind),
                             e.curvatureRadius == 0});
        z += gap;
        gap = i > 0 ? elements[i - 1].thickness : 0;
    }
    frontZ_ = float(z);
}

float LensSystem::rearReach(float filmRadius) const {
    // Where the rim is nearer to the film than the vertex, rays from across the axis pass the vertex's plane outside
    // it.
    const Surface& s = surfaces_.front();
    const double r = s.radius, flat = 1 - double(s.curvature) * s.curvature * r * r;
    const double sag = s.curvature * r * r / (1 + std::sqrt(std::fmax(flat, 0.0))), rim = s.gap + sag;
    if (!(rim > 0)) return std::numeric_limits<float>::infinity();
    const double outermost = (r + filmRadius) * s.gap / rim - filmRadius;
    return float(std::fmax(r, outermost));
}

}  // namespace penumbra
