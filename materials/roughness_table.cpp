#include "materials/roughness_table.h"

#include "materials/visible_average.h"

namespace penumbra {
namespace {

double coordinateOf(const TableRows& rows, std::uint32_t row) {
    return rows.count > 1 ? rows.first + (double(rows.last) - rows.first) * row / (rows.count - 1) : rows.first;
}

void appendRow(const Ggx<float>& ggx, double sinSquaredPhi, const TableValue& averages, const TableFunctions& functions,
               std::vector<float>& numbers) {
    const auto append = [&](const TableValue& a, const TableValue& b) {
        numbers.insert(numbers.end(), {float(a.first), float(b.first), float(a.second), float(b.second)});
    };
    append(averages, averages);
    TableValue previous;
    for (std::uint32_t i = 0; i <= kTableCells; ++i) {
        const double x = double(i) / kTableCells;
        const TableValue value = functions(ggx, directionAt(std::max(x * x, 1e-6), sinSquaredPhi));
        if (i > 0) append(previous, value);
        previous = value;
    }
}

}  // namespace

TableRows constantRows(const Ggx<float>& ggx) {
    const double low = std::min(ggx.ax, ggx.ay), high = std::max(ggx.ax, ggx.ay);
    return {float(std::sqrt(low)), float(std::sqrt(high)), low == high ? 1u : 33u};
}

void appendConstantTable(const Ggx<float>& ggx, const TableAverages& averages, const TableFunctions& functions,
                         std::vector<float>& numbers) {
    const TableRows rows = constantRows(ggx);
    const TableValue head = averages(ggx);
    const double x2 = double(ggx.ax) * ggx.ax, y2 = double(ggx.ay) * ggx.ay;
    for (std::uint32_t row = 0; row < rows.count; ++row) {
        const double alpha2 = std::pow(coordinateOf(rows, row), 4);
        const double sinSquaredPhi = rows.count > 1 ? std::clamp((alpha2 - x2) / (y2 - x2), 0.0, 1.0) : 0;
        appendRow(ggx, sinSquaredPhi, head, functions, numbers);
    }
}

void appendTexturedTable(const TableAverages& averages, const TableFunctions& functions, std::vector<float>& numbers) {
    for (std::uint32_t row = 0; row < kTexturedRows.count; ++row) {
        const double root = coordinateOf(kTexturedRows, row);
        const float alpha = std::max(float(root * root), kSmoothAlpha);
        const Ggx<float> ggx{alpha, alpha};
        appendRow(ggx, 0, averages(ggx), functions, numbers);
    }
}

}  // namespace penumbra
