// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Fire.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace simulation
{

namespace
{

constexpr float soon = 3600.0f; // seconds

struct Cell
{
    float time;
    int column, row;
    bool operator<(const Cell& other) const { return time > other.time; } // the earliest comes first
};

/// Seconds from a cell to one of the sixteen around it; `never` where nothing burns between.
double seconds(const Fire::Ground& ground, int column, int row, int dx, int dy)
{
    const double length = std::hypot(dx, dy) * ground.cell;
    const double rise =
        static_cast<double>(ground.heights.at(column + dx, row + dy) - ground.heights.at(column, row));
    constexpr double steepest = 0.577; // 30 degrees
    const double slope = std::min(std::abs(rise) / length, steepest);
    const double hill = std::exp(3.533 * std::pow(slope, 1.2));
    const double along = (ground.wind.x() * dx + ground.wind.y() * dy) / std::hypot(dx, dy);
    const double wind = along > 0.0 ? 1.0 + along : 1.0 / (1.0 - along);
    // Half of the way over each of both; of a knight's move also over the two cells that it passes.
    const int halfX = dx / 2, halfY = dy / 2;
    double inverse = 0.0;
    for (const auto& [x, y] :
         {std::pair(0, 0), std::pair(dx, dy), std::pair(halfX, halfY), std::pair(dx - halfX, dy - halfY)})
    {
        const auto speed = static_cast<double>(ground.speeds.at(column + x, row + y));
        if (!(speed > 0.0)) return std::numeric_limits<double>::infinity();
        inverse += 0.25 / speed;
    }
    return length * inverse / ((rise >= 0.0 ? hill : 1.0 / hill) * wind);
}

constexpr int around[16][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},  {1, 1}, {1, -1}, {-1, 1}, {-1, -1},
                               {2, 1}, {2, -1}, {-2, 1}, {-2, -1}, {1, 2}, {1, -2}, {-1, 2}, {-1, -2}};

} // namespace

Fire::Fire(const Ground& ground, int column, int row)
    : _times(ground.heights.columns, ground.heights.rows, never)
{
    if (!_times.has(column, row)) return;
    std::priority_queue<Cell> open;
    _times.at(column, row) = 0.0f;
    open.push({0.0f, column, row});
    while (!open.empty())
    {
        const Cell cell = open.top();
        open.pop();
        if (cell.time > _times.at(cell.column, cell.row)) continue;
        for (const auto& [dx, dy] : around)
        {
            const int x = cell.column + dx, y = cell.row + dy;
            if (!_times.has(x, y)) continue;
            const float time = cell.time + static_cast<float>(seconds(ground, cell.column, cell.row, dx, dy));
            if (!(time < _times.at(x, y))) continue;
            _times.at(x, y) = time;
            open.push({time, x, y});
        }
    }
}

void Fire::draw(double time, osg::Image& image) const
{
    const auto now = static_cast<float>(time);
    for (int row = 0; row < _times.rows; ++row)
    {
        auto* out = reinterpret_cast<float*>(image.data(0, static_cast<unsigned int>(row)));
        for (int column = 0; column < _times.columns; ++column)
        {
            const float age = now - _times.at(column, row);
            out[column] = age > -soon ? age : std::numeric_limits<float>::quiet_NaN();
        }
    }
    image.dirty();
}

std::size_t Fire::burnt(double time) const
{
    return static_cast<std::size_t>(std::count_if(_times.cells.begin(), _times.cells.end(),
                                                  [&](float each)
                                                  { return each <= static_cast<float>(time); }));
}

double fireSpeed(int landCover)
{
    switch (landCover)
    {
    case 9:  // grassland
    case 12: // crops
        return 0.12;
    case 10: // scrub
        return 0.07;
    case 11: // forest
        return 0.025;
    case 8: // bare ground, with some grass
        return 0.02;
    case 13: // lawns
    case 14:
    case 22:
        return 0.01;
    case 15: // gardens and houses
        return 0.006;
    default:
        return 0.0;
    }
}

} // namespace simulation
