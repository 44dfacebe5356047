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

/// The limits of a grid.
struct GridLimits
{
    double margin = 0.0; ///< added to footprints on all sides, for the shader's float arithmetic
    double smallestCell =
        0.0;                ///< side of the smallest cell that float arithmetic can tell from its neighbours
    std::int64_t words = 0; ///< the words that splitting may add
};

/// A planned block of 8 x 8 cells.
struct PlannedBlock
{
    std::vector<const GridItem*> items;    ///< those of cell 0 in drawing order, then those of cell 1, …
    std::array<std::uint32_t, 65> begin{}; ///< where each cell's items begin
    std::array<std::uint32_t, 64> child{}; ///< index of the block that a cell is split into; 0 for none
};

constexpr unsigned int partialsWorthSplitting = 4;

/// The texels of a list: one word for the count and one for each mapping.
constexpr std::uint32_t listTexels(std::size_t count)
{
    return count == 0 ? 0 : static_cast<std::uint32_t>(count / 4 + 1);
}

/** Plans the blocks for a square. `items` are the mappings over it, in drawing order. The first block is the square's
    own. There is none if splitting the square does not pay, unless it `must`.

    A cell is split under four conditions. Four or more boundaries run through it. Lists get shorter by a quarter on
    average. The new cells are at least an eighth as wide as the smallest of those mappings. There are words left.
    Cells with the largest product of boundaries and area come first, so that the words save the most. */
std::vector<PlannedBlock> planGrid(const PlaneSquare& square, const std::vector<const GridItem*>& items,
                                   const GridLimits& limits, bool must);

/// Calls `visit` for each cell of a square under a footprint, with the cell's index and square.
template<class Visit>
void forCellsUnder(const FootprintShape& shape, const PlaneSquare& square, double margin, const Visit& visit)
{
    // One more row and column on each side cost little. With them, rounding decides nothing here.
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
