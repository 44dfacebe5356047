// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>
#include <vector>

namespace osgGeoFX
{

/// Heights on a lattice, metres, NaN where there are none; row 0 is the southernmost.
struct HeightGrid
{
    HeightGrid(int c, int r) : columns(c), rows(r), values(static_cast<std::size_t>(c) * static_cast<std::size_t>(r)) {}

    float& at(int column, int row) { return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)]; }
    float at(int column, int row) const { return const_cast<HeightGrid*>(this)->at(column, row); }

    int columns, rows;
    std::vector<float> values;
};

} // namespace osgGeoFX
