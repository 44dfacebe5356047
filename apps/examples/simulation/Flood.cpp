// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Flood.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace simulation
{

namespace
{

struct Cell
{
    float level;
    int column, row;
    bool operator<(const Cell& other) const { return level > other.level; } // the lowest comes first
};

} // namespace

Flood::Flood(const Field& heights, const std::function<bool(int column, int row)>& isSea)
    : _heights(heights), _levels(heights.columns, heights.rows, never), _sea(heights.cells.size())
{
    std::priority_queue<Cell> open;
    std::size_t index = 0;
    for (int row = 0; row < heights.rows; ++row)
    {
        for (int column = 0; column < heights.columns; ++column, ++index)
        {
            if (!isSea(column, row)) continue;
            _sea[index] = true;
            _levels.at(column, row) = -never;
            open.push({-never, column, row});
        }
    }
    while (!open.empty())
    {
        const Cell cell = open.top();
        open.pop();
        if (cell.level > _levels.at(cell.column, cell.row)) continue;
        constexpr int aside[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
        for (const auto& [dx, dy] : aside)
        {
            const int column = cell.column + dx, row = cell.row + dy;
            // A cell without a height is none that water could come to.
            if (!heights.has(column, row) || !std::isfinite(heights.at(column, row))) continue;
            const float level = std::max(cell.level, heights.at(column, row));
            if (level >= _levels.at(column, row)) continue;
            _levels.at(column, row) = level;
            open.push({level, column, row});
        }
    }
}

void Flood::draw(double level, osg::Image& image) const
{
    const auto sea = static_cast<float>(level);
    std::size_t index = 0;
    for (int row = 0; row < _levels.rows; ++row)
    {
        auto* out = reinterpret_cast<float*>(image.data(0, static_cast<unsigned int>(row)));
        for (int column = 0; column < _levels.columns; ++column, ++index)
        {
            const bool wet = !_sea[index] && _levels.cells[index] < sea;
            out[column] = wet ? sea - _heights.cells[index] : std::numeric_limits<float>::quiet_NaN();
        }
    }
    image.dirty();
}

std::size_t Flood::flooded(double level) const
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < _sea.size(); ++i)
    {
        if (!_sea[i] && _levels.cells[i] < static_cast<float>(level)) ++count;
    }
    return count;
}

} // namespace simulation
