// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace osgGeoFX
{

/// Heights on a lattice, metres, NaN for none. Row 0 is the southernmost.
struct HeightGrid
{
    HeightGrid(int c, int r)
        : columns(c), rows(r), values(static_cast<std::size_t>(c) * static_cast<std::size_t>(r))
    {
    }

    float& at(int column, int row)
    {
        return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(column)];
    }
    float at(int column, int row) const { return const_cast<HeightGrid*>(this)->at(column, row); }

    int columns, rows;
    std::vector<float> values;
};

/// Repeats the last valid column and row over the rest of a lattice, which has `channels` values at a point.
template<typename T>
void extendBeyond(std::vector<T>& values, int columns, int rows, int channels, int validColumns,
                  int validRows)
{
    const auto at = [&](int column, int row)
    {
        return values.begin() + (static_cast<std::ptrdiff_t>(row) * columns + column) * channels;
    };
    for (int row = 0; row < std::min(rows, validRows); ++row)
        for (int column = validColumns; column < columns; ++column)
            std::copy_n(at(validColumns - 1, row), channels, at(column, row));
    for (int row = validRows; row < rows; ++row)
        std::copy_n(at(0, validRows - 1), static_cast<std::ptrdiff_t>(columns) * channels, at(0, row));
}

} // namespace osgGeoFX
