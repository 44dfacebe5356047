// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/BlendMask.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

// Points of the lattice across the blend, and points along the layer's edge at most.
constexpr double ACROSS = 6.0;
constexpr int MOST_POINTS = 4096;

} // namespace

BlendMask::BlendMask(const Area& area, const osg::Vec2d& width, const Heights& heights)
{
    const auto count = [](double extent, double step)
    {
        return static_cast<int>(std::clamp(std::ceil(extent / step), 2.0, MOST_POINTS - 1.0)) + 1;
    };
    _lattice.columns = count(area.east - area.west, width.x() / ACROSS);
    _lattice.rows = count(area.north - area.south, width.y() / ACROSS);
    _lattice.dx = (area.east - area.west) / (_lattice.columns - 1);
    _lattice.dy = (area.north - area.south) / (_lattice.rows - 1);
    _lattice.x0 = area.west;
    _lattice.y0 = area.south;

    // Distances from the nearest point without data, by two sweeps. All around the lattice there is none.
    std::vector<float> distances = heights(_lattice);
    const auto at = [&](int column, int row)
    {
        if (column < 0 || row < 0 || column >= _lattice.columns || row >= _lattice.rows) return 0.0f;
        return distances[static_cast<std::size_t>(row) * static_cast<std::size_t>(_lattice.columns) +
                         static_cast<std::size_t>(column)];
    };
    for (float& each : distances)
        each = std::isnan(each) ? 0.0f : static_cast<float>(_lattice.columns + _lattice.rows);
    constexpr float diagonal = 1.41421356f;
    const auto sweep = [&](int column, int row, int back)
    {
        float& here = distances[static_cast<std::size_t>(row) * static_cast<std::size_t>(_lattice.columns) +
                                static_cast<std::size_t>(column)];
        here = std::min({here, at(column - back, row) + 1.0f, at(column, row - back) + 1.0f,
                         at(column - back, row - back) + diagonal, at(column + back, row - back) + diagonal});
    };
    for (int row = 0; row < _lattice.rows; ++row)
        for (int column = 0; column < _lattice.columns; ++column)
            sweep(column, row, 1);
    for (int row = _lattice.rows - 1; row >= 0; --row)
        for (int column = _lattice.columns - 1; column >= 0; --column)
            sweep(column, row, -1);
    // The data end somewhere between a point without and the next one, so both count nothing.
    const double full = std::max(1.0, std::max(width.x() / _lattice.dx, width.y() / _lattice.dy) - 1.0);
    for (float& each : distances)
    {
        const double t = std::clamp((static_cast<double>(each) - 1.0) / full, 0.0, 1.0);
        each = static_cast<float>(t * t * (3.0 - 2.0 * t));
    }
    _shares = std::move(distances);
}

double BlendMask::share(double x, double y) const
{
    const double c = (x - _lattice.x0) / _lattice.dx, r = (y - _lattice.y0) / _lattice.dy;
    if (!(c >= 0.0 && r >= 0.0 && c <= _lattice.columns - 1.0 && r <= _lattice.rows - 1.0)) return 0.0;
    const int column = std::min(static_cast<int>(c), _lattice.columns - 2),
              row = std::min(static_cast<int>(r), _lattice.rows - 2);
    const double u = c - column, v = r - row;
    const auto at = [&](int i, int j)
    {
        return static_cast<double>(
            _shares[static_cast<std::size_t>(row + j) * static_cast<std::size_t>(_lattice.columns) +
                    static_cast<std::size_t>(column + i)]);
    };
    return (at(0, 0) * (1.0 - u) + at(1, 0) * u) * (1.0 - v) + (at(0, 1) * (1.0 - u) + at(1, 1) * u) * v;
}

} // namespace osgGeoFX
