// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/GridStore.h>

#include <cstddef>
#include <cstdint>

namespace osgGeoFX
{

/// What a grid of mappings is like, for benchmarks.
struct GridStatistics
{
    std::size_t blocks = 0;
    std::size_t leaves = 0;    ///< cells with a list
    std::size_t listWords = 0; ///< words of the texels that lists take
    unsigned int levels = 0;   ///< blocks from the root to the smallest cell
    std::size_t longestList = 0;
    double meanList = 0.0;    ///< mappings in a list, as an average over the area of all lists
    double filledShare = 0.0; ///< of the root's area, that has a list
};

/// Of the grid from a root block on; of nothing where it is 0.
GridStatistics statisticsOf(const GridStore& store, std::uint32_t block);

} // namespace osgGeoFX
