// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/Footprint.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/// A mapping as the grid sees it.
struct GridItem
{
    std::uint32_t id = 0;
    std::uint64_t rank = 0;
    FootprintShape shape;

    bool drawnBefore(const GridItem& other) const
    {
        return rank != other.rank ? rank < other.rank : id < other.id;
    }
};

/// What a grid has to keep to.
struct GridLimits
{
    double margin = 0.0;       ///< footprints are wider by this, for the float arithmetic of the shader
    double smallestCell = 0.0; ///< side of the smallest cell that float arithmetic tells from its neighbours
    std::int64_t words = 0;    ///< that may be added by splitting
};

/// A block of 8 x 8 cells to be.
struct PlannedBlock
{
    std::vector<const GridItem*> items;    ///< those of cell 0 in drawing order, those of cell 1, …
    std::array<std::uint32_t, 65> begin{}; ///< where each cell's items begin
    std::array<std::uint32_t, 64>
        child{}; ///< index of the block that a cell is split into; 0 where it is not
};

constexpr unsigned int partialsWorthSplitting = 4;

/// Texels of a list: one word for the count and one for each mapping.
constexpr std::uint32_t listTexels(std::size_t count)
{
    return count == 0 ? 0 : static_cast<std::uint32_t>(count / 4 + 1);
}

/** The blocks for a square with mappings over it, in drawing order. The first is the square's own; none where
    splitting the square does not pay, unless it `must`.

    A cell is split where four or more boundaries run through it, if the lists get shorter by a quarter on the
    average, the cells do not get smaller than an eighth of the smallest of those mappings, and there are words left.
    Those with the most boundaries times area come first, so that the words go where they save the most. */
std::vector<PlannedBlock> planGrid(const PlaneSquare& square, const std::vector<const GridItem*>& items,
                                   const GridLimits& limits, bool must);

/// Calls back for each cell of a square that a footprint lies over, with its index and its square.
template<class Visit>
void forCellsUnder(const FootprintShape& shape, const PlaneSquare& square, double margin, const Visit& visit)
{
    // The row and the column before and behind it cost little, and then rounding decides nothing here.
    const auto first = [&](double low, double origin)
    {
        return std::clamp(std::floor((low - origin) / square.size * 8) - 1, 0.0, 8.0);
    };
    const auto last = [&](double high, double origin)
    {
        return std::clamp(std::floor((high - origin) / square.size * 8) + 1, -1.0, 7.0);
    };
    const int rowEnd = static_cast<int>(last(shape.high().y(), square.origin.y()));
    const int columnBegin = static_cast<int>(first(shape.low().x(), square.origin.x()));
    const int columnEnd = static_cast<int>(last(shape.high().x(), square.origin.x()));
    for (int row = static_cast<int>(first(shape.low().y(), square.origin.y())); row <= rowEnd; ++row)
    {
        for (int column = columnBegin; column <= columnEnd; ++column)
        {
            const auto index = static_cast<unsigned int>(8 * row + column);
            const PlaneSquare cell = square.cell(index);
            if (shape.overlaps(cell, margin)) visit(index, cell);
        }
    }
}

} // namespace osgGeoFX
