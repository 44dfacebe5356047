// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Vec3d>

#include <cmath>
#include <cstddef>
#include <vector>

namespace osgGeoFX
{

/// What is known of the cells of a terrain's extent.
struct EdgeExtent
{
    /// The cells along each side of the extent, around it, and in all.
    static constexpr int within = 256, around = 64, whole = within + 2 * around;

    enum class Cell : unsigned char
    {
        HOLE,
        GAP,
        WET_HOLE,
        LAND,
        WATER
    };

    std::vector<Cell> cells = std::vector<Cell>(std::size_t{within} * within, Cell::HOLE);
    std::vector<float> heights = std::vector<float>(std::size_t{within} * within, NAN);

    static std::size_t index(int column, int row)
    {
        return static_cast<std::size_t>(row) * within + static_cast<std::size_t>(column);
    }

    /// Takes heights from a triangle. x and y are places in the extent, 0 to 1. z is the height.
    void rasterise(const osg::Vec3d (&corners)[3]);

    /// Sorts cells into land, water and holes. `wet`: whether there is water at a place of the extent.
    template<class Wet>
    void tellCells(const Wet& wet)
    {
        for (int row = 0; row < within; ++row)
        {
            for (int column = 0; column < within; ++column)
            {
                const bool water = wet((column + 0.5) / within, (row + 0.5) / within);
                const bool data = !std::isnan(heights[index(column, row)]);
                cells[index(column, row)] =
                    data ? (water ? Cell::WATER : Cell::LAND) : (water ? Cell::WET_HOLE : Cell::HOLE);
            }
        }
    }

    /// Keeps water that is sea. Lakes and rivers become land or holes. `highest`: of the sea, metres.
    void keepSea(double highest);
    /// Finds gaps. Land does not run out towards a gap in its middle, which shows what lies behind.
    void tellGaps();
};

} // namespace osgGeoFX
