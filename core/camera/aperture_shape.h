// ApertureShape: what a stop that is not round lets through, as a grid over the square about it.
//
// Named shapes of PBRT-v4 (gaussian, square, pentagon, star) or the mean of an image's channels; its top is +y, its
// right +x. All are scaled so that they let through as much as the round stop; a ray may therefore weigh more than 1.
// Thread safety: immutable once it is made.
#pragma once

#include "core/image/image.h"
#include "core/math/lanes.h"

#include <span>
#include <string>
#include <vector>

namespace penumbra {

class ApertureShape {
public:
    ApertureShape() = default;  ///< round
    /// REQUIRES: a name of names().
    static ApertureShape named(const std::string& name);
    /// Error(BadData), without a place, for an image that lets nothing through.
    static ApertureShape fromImage(const Image& image);
    static std::span<const std::string> names();

    bool isRound() const { return grid_.empty(); }

    /// At a point whose coordinates are fractions of the stop's radius; bilinear, 0 outside. REQUIRES: !isRound(), |x|,
    /// |y| <= 1.
    template <class F>
    F transmission(F x, F y) const {
        // The grid has a border of zeros.
        const F column = (x + F(1.f)) * F(0.5f * float(width_ - 2)) + F(0.5f);
        const F row = (F(1.f) - y) * F(0.5f * float(height_ - 2)) + F(0.5f);
        const F left = clamp(floor(column), F(0.f), F(float(width_ - 2)));
        const F top = clamp(floor(row), F(0.f), F(float(height_ - 2)));
        const UInt<F> at = toUInt(top) * UInt<F>(std::uint32_t(width_)) + toUInt(left);
        const auto value = [&](std::uint32_t step) { return gather(grid_.data(), at + UInt<F>(step)); };
        const F fx = column - left, fy = row - top;
        const std::uint32_t below = std::uint32_t(width_);
        const F upper = value(0) + (value(1) - value(0)) * fx,
                lower = value(below) + (value(below + 1) - value(below)) * fx;
        return upper + (lower - upper) * fy;
    }

private:
    /// Values row by row from the top, scaled to a mean of pi / 4.
    ApertureShape(int width, int height, const std::vector<double>& values);

    int width_ = 0, height_ = 0;  ///< of the grid, with its border
    std::vector<float> grid_;
};

}  // namespace penumbra
