// Functions tabulated at the nodes of a grid over the unit square, bilinear between them and, where they depend on the
// direction of view, linear between the grids ("slices") of neighbouring views; and the maps that spread points of the
// square as such a function says.
//
// With a the function along a cell's edge, its integral from the edge's first end is quadratic in the place, so every
// map is found by bisection over sums at the nodes, kept in the table, and one quadratic equation; the way back needs
// neither. A mixture of slices has the mixture of their sums, so that nothing else changes.
//
// Layout of a density: for each slice width x height nodes (every `stride` floats); for each slice the sums along its
// rows (width x height, from 0 in each row); for each slice the sums over rows (height). Slices integrate to 1.
// Thread safety: immutable. Source: Dupuy & Jakob, SIGGRAPH Asia 2018 (the warp; its code is not used).
#pragma once

#include "core/math/vector.h"

#include <array>

namespace penumbra {

/// Up to four neighbouring views of one lane's direction, and their shares.
template <class F>
struct TableSlices {
    std::array<UInt<F>, 4> index;
    std::array<F, 4> share;
};

/// The interval of a rising grid of `count` numbers in which x lies, and where in it: x is held to the grid's range.
template <class F>
struct GridPlace {
    UInt<F> below;
    F fraction;
};

/// The largest i < count - 1 with value(i) <= x for rising values, else 0. `most` bounds the counts of all lanes.
template <class F, class Value>
UInt<F> bisect(const UInt<F>& count, std::uint32_t most, Value&& value, F x) {
    UInt<F> found(0u);
    for (std::uint32_t step = std::bit_floor(std::max(most, 1u)); step > 0; step /= 2) {
        const UInt<F> next = found + UInt<F>(step);
        const Mask<F> inside = next + UInt<F>(1u) < count;
        const UInt<F> looked = select(inside, next, UInt<F>(0u));
        found = select(inside & (value(looked) <= x), next, found);
    }
    return found;
}

template <class F>
GridPlace<F> placeInGrid(const float* numbers, const UInt<F>& begin, const UInt<F>& count, std::uint32_t most, F x) {
    const UInt<F> below = bisect<F>(count, most, [&](const UInt<F>& i) { return gather(numbers, begin + i); }, x);
    const UInt<F> above = select(below + UInt<F>(1u) < count, below + UInt<F>(1u), below);
    const F first = gather(numbers, begin + below), last = gather(numbers, begin + above);
    return {below, clamp((x - first) / max(last - first, F(1e-20f)), F(0.f), F(1.f))};
}

/// A grid of nodes in the table.
template <class F>
struct TableGrid {
    const float* numbers;
    UInt<F> begin, width, height;
    std::uint32_t stride = 1;

    struct Cell {
        UInt<F> column, row, node;  ///< node: the cell's first corner
        F x, y;                     ///< within the cell
    };
    Cell cell(const Vec2<F>& p) const {
        const F columns = toFloat<F>(width - UInt<F>(1u)), rows = toFloat<F>(height - UInt<F>(1u));
        const F x = clamp(p.x, F(0.f), F(1.f)) * columns, y = clamp(p.y, F(0.f), F(1.f)) * rows;
        const F column = min(floor(x), columns - F(1.f)), row = min(floor(y), rows - F(1.f));
        const UInt<F> c = toUInt(column), r = toUInt(row);
        return {c, r, r * width + c, x - column, y - row};
    }
    UInt<F> size() const { return width * height; }

    /// The number at a node, or `channel` floats beyond it.
    F node(const TableSlices<F>& slices, const UInt<F>& i, std::uint32_t channel = 0) const {
        return mixed(slices, begin + UInt<F>(channel), size() * UInt<F>(stride), i * UInt<F>(stride));
    }
    /// The function at a point of a cell.
    F at(const TableSlices<F>& slices, const Cell& c, std::uint32_t channel = 0) const {
        const F low = lerp(c.x, node(slices, c.node, channel), node(slices, c.node + UInt<F>(1u), channel));
        const UInt<F> above = c.node + width;
        return lerp(c.y, low, lerp(c.x, node(slices, above, channel), node(slices, above + UInt<F>(1u), channel)));
    }
    /// Where there is but one slice.
    F at(const Vec2<F>& p) const {
        const UInt<F> zero(0u);
        return at({{zero, zero, zero, zero}, {F(1.f), F(0.f), F(0.f), F(0.f)}}, cell(p));
    }

protected:
    F mixed(const TableSlices<F>& slices, const UInt<F>& from, const UInt<F>& sliceSize, const UInt<F>& i) const {
        F sum(0.f);
        for (std::size_t k = 0; k < 4; ++k) {
            if (none(slices.share[k] != F(0.f))) continue;
            sum += slices.share[k] * gather(numbers, from + slices.index[k] * sliceSize + i);
        }
        return sum;
    }
};

/// A density over the square, per slice.
template <class F>
struct TableDensity : TableGrid<F> {
    using Cell = typename TableGrid<F>::Cell;
    UInt<F> alongRows{}, overRows{};  ///< where the sums begin
    std::uint32_t mostNodes = 2;  ///< of rows or columns, in any lane

    struct Point {
        Vec2<F> p;
        F density;
    };

    F density(const TableSlices<F>& slices, const Vec2<F>& p) const { return this->at(slices, this->cell(p)) * cells(); }

    /// Spreads uniform points.
    Point spread(const TableSlices<F>& slices, const Vec2<F>& u) const {
        const UInt<F> row = bisect<F>(
            this->height, mostNodes, [&](const UInt<F>& i) { return rowSum(slices, i); }, u.y);
        const UInt<F> first = row * this->width, second = first + this->width, last = this->width - UInt<F>(1u);
        const F low = sum(slices, first + last), high = sum(slices, second + last);
        const F y = solve(u.y - rowSum(slices, row), low, high);

        const auto columnSum = [&](const UInt<F>& i) { return lerp(y, sum(slices, first + i), sum(slices, second + i)); };
        const F within = u.x * lerp(y, low, high);
        const UInt<F> column = bisect<F>(this->width, mostNodes, columnSum, within);
        const UInt<F> node = first + column, next = node + UInt<F>(1u);
        const F left = lerp(y, this->node(slices, node), this->node(slices, node + this->width));
        const F right = lerp(y, this->node(slices, next), this->node(slices, next + this->width));
        const F x = solve(within - columnSum(column), left, right);
        return {{(toFloat<F>(column) + x) / toFloat<F>(last),
                 (toFloat<F>(row) + y) / toFloat<F>(this->height - UInt<F>(1u))},
                lerp(x, left, right) * cells()};
    }

    /// The uniform point that spread() takes to p, and the density there.
    Point gathered(const TableSlices<F>& slices, const Vec2<F>& p) const {
        const Cell c = this->cell(p);
        const UInt<F> first = c.row * this->width, second = first + this->width, last = this->width - UInt<F>(1u);
        const UInt<F> above = c.node + this->width;
        const F left = lerp(c.y, this->node(slices, c.node), this->node(slices, above));
        const F right = lerp(c.y, this->node(slices, c.node + UInt<F>(1u)), this->node(slices, above + UInt<F>(1u)));
        const F low = sum(slices, first + last), high = sum(slices, second + last);
        const F x = integral(c.x, left, right) + lerp(c.y, sum(slices, c.node), sum(slices, above));
        const F y = integral(c.y, low, high) + rowSum(slices, c.row);
        return {{clamp(x / max(lerp(c.y, low, high), F(1e-20f)), F(0.f), F(kOneMinusEpsilon)),
                 clamp(y, F(0.f), F(kOneMinusEpsilon))},
                lerp(c.x, left, right) * cells()};
    }

private:
    F cells() const { return toFloat<F>((this->width - UInt<F>(1u)) * (this->height - UInt<F>(1u))); }
    F sum(const TableSlices<F>& slices, const UInt<F>& node) const {
        return this->mixed(slices, alongRows, this->size(), node);
    }
    F rowSum(const TableSlices<F>& slices, const UInt<F>& row) const {
        return this->mixed(slices, overRows, this->height, row);
    }
    /// Of the function that goes from a to b over [0, 1], up to t.
    static F integral(F t, F a, F b) { return t * (a + F(0.5f) * t * (b - a)); }
    /// The t at which that integral is s: the root 2 s / (a + sqrt(a^2 + 2 s (b - a))), which never cancels.
    static F solve(F s, F a, F b) {
        const F root = a + safeSqrt(a * a + F(2.f) * s * (b - a));
        return clamp(F(2.f) * s / max(root, F(1e-20f)), F(0.f), F(1.f));
    }
};

}  // namespace penumbra
