// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/GridStore.h>

#include <cstddef>
#include <cstdint>

namespace osgGeoFX
{

/// Figures of a grid of mappings, for benchmarks.
struct GridStatistics
{
    std::size_t blocks = 0;
    std::size_t leaves = 0;    ///< cells with a list
    std::size_t listWords = 0; ///< words in the texels of lists
    unsigned int levels = 0;   ///< blocks from the root to the smallest cell
    std::size_t longestList = 0;
    double meanList = 0.0;    ///< mappings in a list, on average over the area of all lists
    double filledShare = 0.0; ///< share of the root's area that has a list
};

/// The figures of the grid below a root block; empty for block 0.
GridStatistics statisticsOf(const GridStore& store, std::uint32_t block);

} // namespace osgGeoFX
