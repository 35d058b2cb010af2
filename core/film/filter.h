// Pixel filters by filter importance sampling: each sample draws its own place with density proportional to |filter| and
// counts for its own pixel alone, so pixels stay independent and need no splatting.
//
// A sample's value is multiplied by the sign of the filter where it fell, and the pixel's mean by `normalization()`, the
// integral of |f| over that of f: a constant, never the sum of weights, which would be a biased ratio (Ernst et al. 2006).
// The filters are separable with the parameters of PBRT-v4. Places are offsets from the centre of the pixel, in pixels.
#pragma once

#include "core/math/vector.h"

#include <string>
#include <vector>

namespace penumbra {

enum class FilterKind { Box, Triangle, Gaussian, Mitchell, Sinc };

struct FilterSettings {
    FilterKind kind = FilterKind::Gaussian;
    double radiusX = 1.5, radiusY = 1.5;
    double sigma = 0.5;                   ///< gaussian
    double b = 1.0 / 3, c = 1.0 / 3;      ///< mitchell
    double tau = 3;                       ///< sinc
};

template <class F>
struct FilterSample {
    Vec2<F> offset;
    F sign;              ///< +1 or -1
};

class Filter {
public:
    Filter() : Filter(FilterSettings{FilterKind::Box, 0.5, 0.5, 0.5, 0, 0, 0}) {}
    explicit Filter(const FilterSettings& s);

    template <class F>
    FilterSample<F> sample(const Vec2<F>& u) const {
        if (isBox_) return {{(u.x - F(0.5f)) * F(2 * x_.radius), (u.y - F(0.5f)) * F(2 * y_.radius)}, F(1.f)};
        F sx, sy;
        const F x = x_.sample(u.x, sx), y = y_.sample(u.y, sy);
        return {{x, y}, sx * sy};
    }
    /// What the mean of signed samples has to be multiplied by.
    double normalization() const { return x_.normalization * y_.normalization; }
    /// The filter is nowhere negative.
    bool isPositive() const { return x_.normalization == 1 && y_.normalization == 1; }

private:
    static constexpr int kCells = 1024;
    /// One axis: the inverse of the distribution function of |f|, at kCells + 1 equal steps, linear between.
    struct Axis {
        float radius = 0.5f;
        double normalization = 1;
        std::vector<float> inverse;
        std::vector<float> sign;          ///< per cell: -1 where the filter is negative
        Axis(const FilterSettings& s, double radius);

        template <class F>
        F sample(F u, F& signOut) const {
            const F scaled = u * F(float(kCells));
            const UInt<F> i = toUInt(min(scaled, F(float(kCells - 1))));
            const F t = scaled - toFloat<F>(i);
            const F a = gather(inverse.data(), i), b = gather(inverse.data(), i + UInt<F>(1u));
            signOut = gather(sign.data(), i);
            return a + (b - a) * t;
        }
    };
    bool isBox_ = false;
    Axis x_, y_;
};

/// Value of one axis of the filter at x pixels from the centre.
double filterValue(const FilterSettings& s, double radius, double x);

}  // namespace penumbra
