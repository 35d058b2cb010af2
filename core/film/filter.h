// Pixel filters by filter importance sampling: each sample draws its own place with density proportional to |filter| and
// counts for its own pixel alone, so pixels stay independent and need no splatting.
//
// A sample's value is multiplied by the sign of the filter where it fell, and the pixel's mean by `normalization()`, the
// integral of |f| over that of f: a constant, never the sum of weights, which would be a biased ratio (Ernst et al. 2006).
// The filters are separable with the parameters of PBRT-v4. Places are offsets from the centre of the pixel, in pixels.
#pragma once

#include "core/base/plugin.h"
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
    bool isPositive() const { return x_.isPositive && y_.isPositive; }

private:
    static constexpr int kCells = 4096;
    /// One axis: the inverse of the distribution function of |f| at kCells + 1 equal steps; inside a cell |f| is taken as linear.
    /// A cell in which f changes sign is split there, at its exact share of the cell's mass, so that the signs have the right
    /// probabilities.
    struct Axis {
        float radius = 0.5f;
        double normalization = 1;
        bool isPositive = true;
        std::vector<float> inverse;
        std::vector<float> start;                    ///< per cell: |f| at its start over the sum of |f| at both ends
        std::vector<float> sign;                     ///< per cell: of f before the split
        std::vector<float> split, splitPlace;        ///< per cell: share of the mass before the zero (1: none), and the zero
        Axis(const FilterSettings& s, double radius);

        template <class F>
        F sample(F u, F& signOut) const {
            const F scaled = u * F(float(kCells));
            const UInt<F> i = toUInt(min(scaled, F(float(kCells - 1))));
            F t = scaled - toFloat<F>(i);
            F a = gather(inverse.data(), i), b = gather(inverse.data(), i + UInt<F>(1u));
            F first = gather(start.data(), i);
            signOut = F(1.f);
            if (!isPositive) {
                const F s = gather(split.data(), i), zero = gather(splitPlace.data(), i);
                const Mask<F> whole = s == F(1.f), before = t < s;
                signOut = flipSign(!before, gather(sign.data(), i));
                t = select(before, t / s, (t - s) / max(F(1.f) - s, F(1e-9f)));
                a = select(before, a, zero);
                b = select(before, zero, b);
                first = select(whole, first, select(before, F(1.f), F(0.f)));
            }
            // Where a linear density has the share t of its mass.
            const F root = sqrt(max(first * first + t * (F(1.f) - F(2.f) * first), F(0.f)));
            return a + (b - a) * min(t / max(first + root, F(1e-9f)), F(1.f));
        }
    };
    bool isBox_ = false;
    Axis x_, y_;
};

/// The filters with their parameters, for `list`.
std::span<const PluginInfo> filterPlugins();

/// Value of one axis of the filter at x pixels from the centre.
double filterValue(const FilterSettings& s, double radius, double x);

}  // namespace penumbra
