// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/EdgeBorder.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace osgGeoFX
{

namespace
{

constexpr int within = EdgeExtent::within, around = EdgeExtent::around, whole = EdgeExtent::whole;
/// The land along the border has these distances from it, cells. The last cells do not count, since a picture of the
/// whole extent does not draw them. Blocks have so many cells along a side. At the distance `farCells` a block's
/// weight is a quarter.
constexpr double besideFirst = 4.0, besideLast = 14.0;
constexpr int blockCells = 8;
constexpr double farCells = 16.0;
/// Most mountains are lower than so many standard deviations above the mean.
constexpr double summits = 1.2;

using Cell = EdgeExtent::Cell;

/// Sums over the land of one block of cells.
struct Block
{
    double x = 0.0, y = 0.0, height = 0.0, square = 0.0, count = 0.0;
};

constexpr int blocks = whole / blockCells;
constexpr int corners = blocks + 1;

std::vector<Block> blocksAlong(const EdgeExtent& extent, const std::vector<float>& distances)
{
    std::vector<Block> all(std::size_t{blocks} * blocks), seeds;
    for (int row = 0; row < within; ++row)
    {
        for (int column = 0; column < within; ++column)
        {
            const std::size_t cell = EdgeExtent::index(column, row);
            const int x = column + around, y = row + around;
            const auto away = static_cast<double>(
                distances[static_cast<std::size_t>(y) * whole + static_cast<std::size_t>(x)]);
            if (extent.cells[cell] != Cell::LAND || away < besideFirst || away > besideLast) continue;
            Block& block = all[static_cast<std::size_t>(y / blockCells) * blocks +
                               static_cast<std::size_t>(x / blockCells)];
            block.x += x;
            block.y += y;
            const auto height = static_cast<double>(extent.heights[cell]);
            block.height += height;
            block.square += height * height;
            block.count += 1.0;
        }
    }
    std::copy_if(all.begin(), all.end(), std::back_inserter(seeds),
                 [](const Block& block) { return block.count > 0.0; });
    return seeds;
}

/// The heights at the blocks' corners. Between them heights change little.
std::vector<double> heightsAtCorners(const std::vector<Block>& seeds)
{
    std::vector<double> coarse(std::size_t{corners} * corners, 0.0);
    for (int row = 0; row < corners; ++row)
    {
        for (int column = 0; column < corners; ++column)
        {
            double sum = 0.0, squares = 0.0, weights = 0.0;
            for (const Block& seed : seeds)
            {
                const double x = seed.x / seed.count - column * blockCells;
                const double y = seed.y / seed.count - row * blockCells;
                const double far = x * x + y * y + farCells * farCells;
                const double weight = 1.0 / (far * far);
                sum += weight * seed.height;
                squares += weight * seed.square;
                weights += weight * seed.count;
            }
            if (!(weights > 0.0)) continue;
            const double mean = sum / weights;
            const double spread = std::sqrt(std::max(squares / weights - mean * mean, 0.0));
            coarse[static_cast<std::size_t>(row) * corners + static_cast<std::size_t>(column)] =
                mean + summits * spread;
        }
    }
    return coarse;
}

} // namespace

EdgeBorder::EdgeBorder(const EdgeExtent& extent)
{
    _sums.push_back(0);
    for (int turn = 0; turn < 3; ++turn)
    {
        for (int i = 0; i < length; ++i)
        {
            const int side = i / within, along = i % within;
            const int columns[] = {along, within - 1, within - 1 - along, 0};
            const int rows[] = {0, along, within - 1, within - 1 - along};
            const Cell cell = extent.cells[EdgeExtent::index(columns[side], rows[side])];
            const bool water = cell == Cell::WATER || cell == Cell::WET_HOLE;
            _sums.push_back(_sums.back() + (water ? 1 : 0));
        }
    }
}

bool EdgeBorder::sea(int column, int row) const
{
    const int nearX = std::clamp(column, 0, within - 1), nearY = std::clamp(row, 0, within - 1);
    const double away = std::hypot(static_cast<double>(column - nearX), static_cast<double>(row - nearY));
    const int reach = std::min(static_cast<int>(2.0 * away), length / 2 - 1);
    const int place = row < 0            ? nearX
                      : column >= within ? within + nearY
                      : row >= within    ? 3 * within - 1 - nearX
                                         : 4 * within - 1 - nearY;
    const int first = length + place - reach, last = length + place + reach + 1;
    return 2 * (_sums[static_cast<std::size_t>(last)] - _sums[static_cast<std::size_t>(first)]) >
           last - first;
}

std::vector<float> EdgeBorder::heights(const EdgeExtent& extent, const std::vector<float>& distances)
{
    const std::vector<double> coarse = heightsAtCorners(blocksAlong(extent, distances));
    std::vector<float> heights(std::size_t{whole} * whole);
    for (int row = 0; row < whole; ++row)
    {
        for (int column = 0; column < whole; ++column)
        {
            const double x = (column + 0.5) / blockCells, y = (row + 0.5) / blockCells;
            const auto left = static_cast<std::size_t>(x), low = static_cast<std::size_t>(y);
            const double u = x - static_cast<double>(left), v = y - static_cast<double>(low);
            const double* at = &coarse[low * corners + left];
            heights[static_cast<std::size_t>(row) * whole + static_cast<std::size_t>(column)] =
                static_cast<float>((1.0 - v) * ((1.0 - u) * at[0] + u * at[1]) +
                                   v * ((1.0 - u) * at[corners] + u * at[corners + 1]));
        }
    }
    return heights;
}

} // namespace osgGeoFX
