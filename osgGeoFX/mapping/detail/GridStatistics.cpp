// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/GridStatistics.h>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

struct Census
{
    void take(std::uint32_t block, unsigned int level, double cellArea)
    {
        ++result.blocks;
        result.levels = std::max(result.levels, level);
        for (unsigned int cell = 0; cell < 64; ++cell)
        {
            const std::uint32_t word = store.word(block, cell);
            if (GridStore::isChild(word))
                take(GridStore::offsetOf(word), level + 1, cellArea / 64);
            else if (word != 0)
                count(store.count(word), cellArea);
        }
    }

    void count(std::size_t length, double cellArea)
    {
        ++result.leaves;
        result.listWords += 4 * std::size_t(listTexels(length));
        result.longestList = std::max(result.longestList, length);
        result.filledShare += cellArea;
        mappings += cellArea * static_cast<double>(length);
    }

    const GridStore& store;
    GridStatistics result;
    double mappings = 0.0; ///< times area
};

} // namespace

GridStatistics statisticsOf(const GridStore& store, std::uint32_t block)
{
    Census census{store, {}};
    if (block != 0) census.take(block, 1, 1.0 / 64);
    GridStatistics& result = census.result;
    if (result.filledShare > 0.0) result.meanList = census.mappings / result.filledShare;
    return result;
}

} // namespace osgGeoFX
