// Piecewise-constant distributions over lanes, one- and two-dimensional, in arrays of floats that lanes gather from.
//
// A distribution of n cells is its cumulative table: n + 1 floats from 0 to 1. All of them are multiples of 2^-24, and
// a cell of positive weight has at least one such step. So differences of neighbours are exact; a probability read from
// the table is exactly the measure of the numbers u that choose the cell; and no cell that matters has probability
// zero. Sampling inverts the table, so that stratified numbers stay stratified.
//
// Thread safety: construction is cold and writes only to `table`; look-ups only read.
// Invariants: cell i is chosen where table[i] <= u < table[i + 1]; cells of weight zero never are.
#pragma once

#include "core/math/vector.h"

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra {

inline constexpr std::size_t kMaxCells = std::size_t(1) << 22;  ///< of one table; beyond, steps of 2^-24 are too coarse

/// The first stride of the search in a table of n cells: cold code computes it once.
std::uint32_t searchStride(std::size_t cells);

/// Appends the n + 1 numbers to `table`. Weights that are negative or not finite count as 0; where all are 0 the cells
/// are equally likely. REQUIRES: 1 <= n <= kMaxCells.
void appendCumulative(std::span<const double> weights, std::vector<float>& table);

/// Appends the table of a grid of width x height weights (row by row): the cumulative table of its rows, then that of
/// each row's cells. REQUIRES: 1 <= width, height <= kMaxCells.
void appendCumulativeGrid(std::span<const float> weights, std::size_t width, std::size_t height,
                          std::vector<float>& table);

template <class F>
struct Cell {
    UInt<F> index;
    F probability;
    F inside;  ///< where in the cell u lies, in [0, 1): uniform, for further use
};

/// The cell of u in [0, 1). Each lane may have a table of its own, at `first`, with its own stride.
template <class F>
Cell<F> sampleCell(const float* table, const UInt<F>& first, const UInt<F>& cells, UInt<F> stride, F u) {
    UInt<F> i(0u);
    while (any(stride != UInt<F>(0u))) {
        const UInt<F> next = i + stride;
        const Mask<F> exists = next < cells;
        const F below = gather(table, first + select(exists, next, UInt<F>(0u)));
        i = select(exists & (below <= u), next, i);
        stride = stride >> 1;
    }
    const F low = gather(table, first + i), high = gather(table, first + i + UInt<F>(1u));
    const F probability = high - low;
    return {i, probability, min((u - low) / probability, F(kOneMinusEpsilon))};
}

template <class F>
F cellProbability(const float* table, const UInt<F>& first, const UInt<F>& index) {
    return gather(table, first + index + UInt<F>(1u)) - gather(table, first + index);
}

template <class F>
struct GridCell {
    UInt<F> x, y;
    F probability;
    Vec2<F> inside;
};

/// The grid cell of u: the row by u.y, the column by u.x.
template <class F>
GridCell<F> sampleGrid(const float* table, const UInt<F>& first, const UInt<F>& width, const UInt<F>& height,
                       const UInt<F>& strideX, const UInt<F>& strideY, const Vec2<F>& u) {
    const Cell<F> row = sampleCell(table, first, height, strideY, u.y);
    const UInt<F> rowTable = first + height + UInt<F>(1u) + row.index * (width + UInt<F>(1u));
    const Cell<F> column = sampleCell(table, rowTable, width, strideX, u.x);
    return {column.index, row.index, row.probability * column.probability, {column.inside, row.inside}};
}

}  // namespace penumbra
