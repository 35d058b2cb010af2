#include "core/film/filter.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

constexpr double kPiD = 3.14159265358979323846;

double sinc(double x) { return std::fabs(x) < 1e-8 ? 1 : std::sin(kPiD * x) / (kPiD * x); }

double mitchell(double x, double b, double c) {
    x = std::fabs(x);
    if (x <= 1) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
    if (x <= 2) return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) / 6;
    return 0;
}

}  // namespace

double filterValue(const FilterSettings& s, double radius, double x) {
    if (std::fabs(x) > radius) return 0;
    switch (s.kind) {
        case FilterKind::Box: return 1;
        case FilterKind::Triangle: return radius - std::fabs(x);
        case FilterKind::Gaussian: {
            const auto density = [&](double t) { return std::exp(-t * t / (2 * s.sigma * s.sigma)); };
            return std::fmax(0, density(x) - density(radius));
        }
        case FilterKind::Mitchell: return mitchell(2 * x / radius, s.b, s.c);
        case FilterKind::Sinc: return sinc(x) * sinc(x / s.tau);
    }
    return 0;
}

Filter::Axis::Axis(const FilterSettings& s, double r)
    : radius(float(r)), isPositive(s.kind != FilterKind::Mitchell && s.kind != FilterKind::Sinc) {
    if (s.kind == FilterKind::Box) return;   // sampled without a table
    // The distribution function of |f| on a fine grid, by Simpson's rule; signs are taken as constant within a fine cell,
    // which is wrong only in those that hold a zero, where |f| is next to nothing.
    constexpr std::size_t kFine = 1 << 16;
    const double h = 2 * r / double(kFine);
    std::vector<double> cumulative(kFine + 1, 0.0);
    std::vector<std::size_t> zeros;   // fine knots behind which the sign differs
    double signedSum = 0, previous = 0;
    for (std::size_t i = 0; i < kFine; ++i) {
        const double x = -r + double(i) * h;
        const double f = (filterValue(s, r, x) + 4 * filterValue(s, r, x + h / 2) + filterValue(s, r, x + h)) * h / 6;
        const double sign = std::fabs(f) < 1e-12 * h ? 0 : f;   // near a double zero rounding decides the sign
        if (sign * previous < 0) zeros.push_back(i);
        if (sign != 0) previous = sign;
        signedSum += f;
        cumulative[i + 1] = cumulative[i] + std::fabs(f);
    }
    const double total = cumulative.back();
    if (!isPositive) normalization = total / signedSum;

    inverse.resize(kCells + 1);
    std::size_t j = 0;
    for (std::size_t i = 0; i <= kCells; ++i) {
        const double target = total * double(i) / kCells;
        while (j + 1 < kFine && cumulative[j + 1] < target) ++j;
        const double span = cumulative[j + 1] - cumulative[j];
        const double t = span > 0 ? std::clamp((target - cumulative[j]) / span, 0.0, 1.0) : 0.0;
        inverse[i] = float(-r + (double(j) + t) * h);
    }
    inverse[0] = float(-r);
    inverse[kCells] = float(r);
    for (std::size_t i = 0; i < kCells; ++i) {
        const double a = std::fabs(filterValue(s, r, double(inverse[i]))), b = std::fabs(filterValue(s, r, double(inverse[i + 1])));
        start.push_back(a + b > 0 ? float(a / (a + b)) : 0.5f);
    }
    if (isPositive) return;

    sign.assign(kCells, 1.f);
    split.assign(kCells, 1.f);
    splitPlace.assign(inverse.begin() + 1, inverse.end());
    for (std::size_t i = 0; i < kCells; ++i) {
        const double start = total * double(i) / kCells, end = total * double(i + 1) / kCells;
        // A cell far out may hold several changes of sign: what counts is the exact share of its mass that has the first sign.
        double share = 0, from = start, firstEnd = double(inverse[i + 1]);
        bool asFirst = true;
        for (std::size_t z : zeros) {
            if (cumulative[z] <= start || cumulative[z] >= end) continue;
            if (asFirst) share += cumulative[z] - from;
            if (from == start) firstEnd = -r + double(z) * h;
            from = cumulative[z];
            asFirst = !asFirst;
            splitPlace[i] = float(-r + double(z) * h);
        }
        if (asFirst) share += end - from;
        split[i] = from == start ? 1.f : float(share / (end - start));
        if (filterValue(s, r, 0.5 * (double(inverse[i]) + firstEnd)) < 0) sign[i] = -1.f;
    }
}

Filter::Filter(const FilterSettings& s) : isBox_(s.kind == FilterKind::Box), x_(s, s.radiusX), y_(s, s.radiusY) {}

namespace {

constexpr std::string_view kHalfWidth = "half the width, in pixels", kHalfHeight = "half the height, in pixels";
constexpr ParameterInfo kBoxParameters[] = {
    {"float", "xradius", "0.5", kHalfWidth},
    {"float", "yradius", "0.5", kHalfHeight},
};
constexpr ParameterInfo kTriangleParameters[] = {
    {"float", "xradius", "2", kHalfWidth},
    {"float", "yradius", "2", kHalfHeight},
};
constexpr ParameterInfo kGaussianParameters[] = {
    {"float", "xradius", "1.5", kHalfWidth},
    {"float", "yradius", "1.5", kHalfHeight},
    {"float", "sigma", "0.5", "standard deviation, in pixels"},
};
constexpr ParameterInfo kMitchellParameters[] = {
    {"float", "xradius", "2", kHalfWidth},
    {"float", "yradius", "2", kHalfHeight},
    {"float", "B", "1/3", "blur against ringing"},
    {"float", "C", "1/3", "sharpness; B + 2 C = 1 is the good line"},
};
constexpr ParameterInfo kSincParameters[] = {
    {"float", "xradius", "4", kHalfWidth},
    {"float", "yradius", "4", kHalfHeight},
    {"float", "tau", "3", "cycles of the window"},
};
constexpr PluginInfo kFilters[] = {
    {"box", "the plain mean over the box, one pixel by default", kBoxParameters},
    {"triangle", "falls off linearly", kTriangleParameters},
    {"gaussian", "a bell minus its value at the radius; never negative (default)", kGaussianParameters},
    {"mitchell", "Mitchell and Netravali's cubic; sharper, with negative lobes", kMitchellParameters},
    {"sinc", "windowed sinc (Lanczos); sharpest, with negative lobes", kSincParameters},
};

}  // namespace

std::span<const PluginInfo> filterPlugins() { return kFilters; }

}  // namespace penumbra
