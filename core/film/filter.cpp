#include "core/film/filter.h"

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

Filter::Axis::Axis(const FilterSettings& s, double r) : radius(float(r)) {
    // The distribution function of |f| on a fine grid, by Simpson's rule; signs are constant within a fine cell but for
    // the one that holds a zero, where |f| is next to nothing.
    constexpr int kFine = 1 << 16;
    std::vector<double> cumulative(kFine + 1, 0.0);
    double signedSum = 0;
    const double h = 2 * r / kFine;
    for (int i = 0; i < kFine; ++i) {
        const double x = -r + i * h;
        const double f = (filterValue(s, r, x) + 4 * filterValue(s, r, x + h / 2) + filterValue(s, r, x + h)) * h / 6;
        signedSum += f;
        cumulative[std::size_t(i) + 1] = cumulative[std::size_t(i)] + std::fabs(f);
    }
    const double total = cumulative.back();
    normalization = s.kind == FilterKind::Mitchell || s.kind == FilterKind::Sinc ? total / signedSum : 1;
    inverse.resize(kCells + 1);
    sign.resize(kCells + 1, 1.f);
    std::size_t j = 0;
    for (int i = 0; i <= kCells; ++i) {
        const double target = total * i / kCells;
        while (j + 1 < cumulative.size() - 1 && cumulative[j + 1] < target) ++j;
        const double span = cumulative[j + 1] - cumulative[j];
        const double t = span > 0 ? std::fmin((target - cumulative[j]) / span, 1.0) : 0.0;
        inverse[std::size_t(i)] = float(-r + (double(j) + t) * h);
    }
    inverse[0] = float(-r);
    inverse[kCells] = float(r);
    for (int i = 0; i < kCells; ++i) {
        const double middle = 0.5 * (double(inverse[std::size_t(i)]) + inverse[std::size_t(i) + 1]);
        sign[std::size_t(i)] = filterValue(s, r, middle) < 0 ? -1.f : 1.f;
    }
}

Filter::Filter(const FilterSettings& s) : isBox_(s.kind == FilterKind::Box), x_(s, s.radiusX), y_(s, s.radiusY) {}

}  // namespace penumbra
