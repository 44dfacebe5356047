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

constexpr float nearlyWet = 5.0f; // metres

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
    findShore();
}

/// The sea's cells that touch land.
void Flood::findShore()
{
    _shore.assign(_sea.size(), false);
    for (int i = 0; i < static_cast<int>(_sea.size()); ++i)
    {
        const int column = i % _levels.columns, row = i / _levels.columns;
        for (int k = 0; k < 9 && _sea[static_cast<std::size_t>(i)]; ++k)
        {
            const int x = column + k % 3 - 1, y = row + k / 3 - 1;
            const auto other = static_cast<std::size_t>(y * _levels.columns + x);
            if (_levels.has(x, y) && !_sea[other]) _shore[static_cast<std::size_t>(i)] = true;
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
            const float over = sea - _levels.cells[index];
            if (_shore[index] && sea > 0.0f)
                out[column] = sea;
            else if (_sea[index] || over <= -nearlyWet)
                out[column] = std::numeric_limits<float>::quiet_NaN();
            else
                out[column] = over > 0.0f ? sea - _heights.cells[index] : over;
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
