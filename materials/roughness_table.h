// Tables of two functions of a direction above a rough (GGX) surface, for materials whose light does more than bounce once.
//
// Layout of a block: rows of kTableRowFloats floats. A row is a head of four floats, {a, a, b, b} with two averages, then
// kTableCells cells {f, f', g, g'}, the values of the two functions at both ends of the cell, so that one load of four floats
// interpolates both. The cell's coordinate is sqrt(cos theta): near grazing such functions are linear in the cosine. The rows'
// coordinate is the square root of
//   alpha(w) = sqrt((ax x)^2 + (ay y)^2) / sqrt(x^2 + y^2),  the roughness that counts in w's plane,
// because that, and not the azimuth, is what they vary smoothly with.
//
// Thread safety: pure functions, plain values. Filling tables: visible_average.h has the quadrature.
#pragma once

#include "materials/microfacet.h"

#include <functional>
#include <vector>

namespace penumbra {

inline constexpr std::uint32_t kTableCells = 256;
inline constexpr std::uint32_t kTableRowFloats = 4 * (kTableCells + 1);

/// The rows of a block: `count` steps of sqrt(alpha(w)) from `first` to `last`; one row where alpha is the same for
/// all.
struct TableRows {
    float first = 0, last = 0;
    std::uint32_t count = 1;
};

/// Of a surface of constant roughness: one row, or where it is anisotropic one for every step of alpha(w).
TableRows constantRows(const Ggx<float>& ggx);
/// For any isotropic alpha up to 1.
inline constexpr TableRows kTexturedRows{0.f, 1.f, 65};

/// What fills a table: the two functions at w, and the two averages.
struct TableValue {
    double first = 0, second = 0;
};
using TableFunctions = std::function<TableValue(const Ggx<float>&, const Vec3<float>& w)>;
using TableAverages = std::function<TableValue(const Ggx<float>&)>;

/// Appends the block with the rows of constantRows(ggx), or of kTexturedRows.
void appendConstantTable(const Ggx<float>& ggx, const TableAverages& averages, const TableFunctions& functions,
                         std::vector<float>& numbers);
void appendTexturedTable(const TableAverages& averages, const TableFunctions& functions, std::vector<float>& numbers);

/// Reads a block. Smooth lanes have no cells.
template <class F>
struct RoughnessTable {
    Mask<F> smooth;
    Ggx<F> ggx;
    const float* tables;
    UInt<F> offset;  ///< of the lane's block
    F firstRow, rowsPerRoot, lastRow;

    struct Value {
        F first, second;
    };

    /// The two functions for a direction with z > 0; anything for smooth lanes.
    Value at(const Vec3<F>& w) const {
        const F coordinate = sqrt(clamp(w.z, F(0.f), F(1.f))) * F(float(kTableCells));
        const F cell = min(floor(coordinate), F(float(kTableCells - 1)));
        const F fraction = coordinate - cell;
        // Smooth lanes read the head of their block and drop it.
        const UInt<F> word = select(smooth, UInt<F>(0u), toUInt(cell) * UInt<F>(4u) + UInt<F>(4u));
        return betweenRows(rowCoordinate(w), word, fraction);
    }
    /// The two averages of the head, in a table of several isotropic rows between those that are next.
    Value averages() const { return betweenRows(rowAt(sqrt(ggx.ax * ggx.ay)), UInt<F>(0u), F(0.f)); }
    Mask<F> hasRows() const { return lastRow > F(0.f); }

private:
    F rowAt(F alpha) const {
        const F row = (sqrt(alpha) - firstRow) * rowsPerRoot;
        return select(smooth, F(0.f), clamp(row, F(0.f), lastRow));
    }
    F rowCoordinate(const Vec3<F>& w) const {
        if (none(hasRows())) return F(0.f);
        const F planar = max(w.x * w.x + w.y * w.y, F(1e-20f));
        const F alpha = sqrt((sqr(ggx.ax * w.x) + sqr(ggx.ay * w.y)) / planar);
        return rowAt(select(ggx.ax == ggx.ay, ggx.ax, alpha));
    }
    /// The two functions of the four floats at `word`, each interpolated within its cell and between two rows.
    Value betweenRows(F row, const UInt<F>& word, F fraction) const {
        const F below = floor(row), rowFraction = row - below;
        const auto inRow = [&](F r) {
            F v[4];
            loadRows4(tables, offset + toUInt(r) * UInt<F>(kTableRowFloats) + word, v);
            return Value{lerp(fraction, v[0], v[1]), lerp(fraction, v[2], v[3])};
        };
        const Value first = inRow(below);
        if (none(rowFraction > F(0.f))) return first;
        const Value second = inRow(min(below + F(1.f), lastRow));
        return {lerp(rowFraction, first.first, second.first), lerp(rowFraction, first.second, second.second)};
    }
};

/// Where a material's block is: members of a row of a material. Derive from it.
struct RoughnessTableInputs {
    std::uint32_t table = 0;  ///< offset of the block
    float firstRow = 0.f, rowsPerRoot = 0.f, lastRow = 0.f;

    void setBlock(std::uint32_t offset, const TableRows& rows) {
        table = offset;
        firstRow = rows.first;
        lastRow = float(rows.count - 1);
        rowsPerRoot = rows.count > 1 ? lastRow / (rows.last - rows.first) : 0.f;
    }

    /// The table of M, a type derived from this one.
    template <class F, class M>
    static RoughnessTable<F> reader(const Records<F, M>& m, const float* tables, const SurfaceRoughness<F>& rough) {
        using Inputs = RoughnessTableInputs;
        return {rough.smooth,
                rough.ggx,
                tables,
                m(static_cast<std::uint32_t M::*>(&Inputs::table)),
                m(static_cast<float M::*>(&Inputs::firstRow)),
                m(static_cast<float M::*>(&Inputs::rowsPerRoot)),
                m(static_cast<float M::*>(&Inputs::lastRow))};
    }
};

}  // namespace penumbra
