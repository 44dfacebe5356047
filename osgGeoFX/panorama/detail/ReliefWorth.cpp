// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/ReliefWorth.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace osgGeoFX
{

namespace
{

/// The shares of a cell's worth: of any land, of its relief, and of a shore.
constexpr double ofLand = 0.15, ofRelief = 0.6, ofShore = 0.25;
/// Half the window in which heights spread, of the longer side.
constexpr int windows = 64;
/// So many summits count. Less prominent ones than this share of the relief are knobs.
constexpr std::size_t mostSummits = 60;
constexpr double leastProminence = 0.04;
/// Sea is water no higher than this share of the relief, and at least so many metres, above the lowest place.
constexpr double seaShare = 0.02, seaHeight = 10.0;

/// Sums over rectangles of cells.
class Sums
{
public:
    Sums(const TerrainRelief& relief, int power) : _columns(relief.columns), _rows(relief.rows)
    {
        _sums.assign(static_cast<std::size_t>(_columns + 1) * static_cast<std::size_t>(_rows + 1), 0.0);
        for (int row = 0; row < _rows; ++row)
        {
            double line = 0.0;
            for (int column = 0; column < _columns; ++column)
            {
                const auto height = static_cast<double>(relief.heights[relief.index(column, row)]);
                if (!std::isnan(height)) line += power == 0 ? 1.0 : power == 1 ? height : height * height;
                at(column + 1, row + 1) = at(column + 1, row) + line;
            }
        }
    }

    double around(int column, int row, int reach) const
    {
        const int left = std::max(column - reach, 0), right = std::min(column + reach + 1, _columns);
        const int bottom = std::max(row - reach, 0), top = std::min(row + reach + 1, _rows);
        return get(right, top) - get(left, top) - get(right, bottom) + get(left, bottom);
    }

private:
    std::size_t index(int column, int row) const
    {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(_columns + 1) +
               static_cast<std::size_t>(column);
    }
    double& at(int column, int row) { return _sums[index(column, row)]; }
    double get(int column, int row) const { return _sums[index(column, row)]; }

    int _columns, _rows;
    std::vector<double> _sums;
};

/// The standard deviation of heights around each cell, metres.
std::vector<float> spreads(const TerrainRelief& relief)
{
    const Sums count(relief, 0), sum(relief, 1), squares(relief, 2);
    const int reach = std::max(std::max(relief.columns, relief.rows) / windows, 1);
    std::vector<float> result(relief.heights.size(), 0.0f);
    for (int row = 0; row < relief.rows; ++row)
    {
        for (int column = 0; column < relief.columns; ++column)
        {
            const double known = count.around(column, row, reach);
            if (known < 1.0) continue;
            const double mean = sum.around(column, row, reach) / known;
            const double variance = squares.around(column, row, reach) / known - mean * mean;
            result[relief.index(column, row)] = static_cast<float>(std::sqrt(std::max(variance, 0.0)));
        }
    }
    return result;
}

/// The value below which a share of the values lies.
double quantile(std::vector<float> values, double share)
{
    if (values.empty()) return 0.0;
    const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return static_cast<double>(values[static_cast<std::size_t>(place)]);
}

/// Calls `action(column, row)` for the neighbours of a cell.
template<class Action>
void forNeighbours(const TerrainRelief& relief, int column, int row, const Action& action)
{
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, relief.rows - 1); ++y)
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, relief.columns - 1); ++x)
            if (x != column || y != row) action(x, y);
}

/** Summits with their prominence: how far one must go down to reach a higher one. Cells join in the order of their
    heights; where two areas meet, the lower summit's prominence is known. */
class Prominence
{
public:
    Prominence(const TerrainRelief& relief, std::vector<ReliefSummit>& summits)
        : _relief(relief), _area(relief.heights.size(), none)
    {
        std::vector<std::size_t> order;
        for (std::size_t cell = 0; cell < relief.heights.size(); ++cell)
            if (!std::isnan(relief.heights[cell])) order.push_back(cell);
        if (order.empty()) return;
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return relief.heights[a] > relief.heights[b]; });
        const double lowest = height(order.back());
        for (const std::size_t cell : order)
            join(cell);
        std::vector<std::pair<double, std::size_t>> found;
        for (std::size_t i = 0; i < _summits.size(); ++i)
        {
            // The highest one stands above everything.
            if (_above[i] < 0.0) _above[i] = height(_summits[i]) - lowest;
            found.emplace_back(_above[i], _summits[i]);
        }
        std::stable_sort(found.begin(), found.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        const double most = found.front().first;
        for (const auto& [prominence, cell] : found)
        {
            if (summits.size() == mostSummits || !(prominence > leastProminence * most)) break;
            const auto columns = static_cast<std::size_t>(relief.columns);
            summits.push_back(
                {relief.place(static_cast<int>(cell % columns), static_cast<int>(cell / columns)),
                 height(cell), prominence / most});
        }
    }

private:
    static constexpr std::size_t none = ~std::size_t{0};

    double height(std::size_t cell) const { return static_cast<double>(_relief.heights[cell]); }

    std::size_t areaOf(std::size_t summit)
    {
        while (_parent[summit] != summit)
            summit = _parent[summit] = _parent[_parent[summit]];
        return summit;
    }

    void join(std::size_t cell)
    {
        const auto columns = static_cast<std::size_t>(_relief.columns);
        std::size_t here = none;
        forNeighbours(_relief, static_cast<int>(cell % columns), static_cast<int>(cell / columns),
                      [&](int x, int y)
                      {
                          const std::size_t there = _area[_relief.index(x, y)];
                          if (there == none) return;
                          const std::size_t area = areaOf(there);
                          if (here == none || here == area)
                          {
                              here = area;
                              return;
                          }
                          const bool hereIsHigher = height(_summits[here]) >= height(_summits[area]);
                          const std::size_t low = hereIsHigher ? area : here;
                          here = hereIsHigher ? here : area;
                          _above[low] = height(_summits[low]) - height(cell);
                          _parent[low] = here;
                      });
        if (here == none)
        {
            here = _summits.size();
            _summits.push_back(cell);
            _parent.push_back(here);
            _above.push_back(-1.0);
        }
        _area[cell] = here;
    }

    const TerrainRelief& _relief;
    std::vector<std::size_t> _area; ///< of each cell, the number of a summit
    std::vector<std::size_t> _summits, _parent;
    std::vector<double> _above; ///< prominence, metres; negative while unknown
};

/// How far cells are from those that have no ground, metres (two sweeps over neighbours).
std::vector<float> insideOf(const TerrainRelief& relief, double seaLevel)
{
    const osg::Vec2d size = relief.size();
    const auto wide = static_cast<float>(size.x() / relief.columns),
               high = static_cast<float>(size.y() / relief.rows);
    const float slanted = std::hypot(wide, high);
    const float far = static_cast<float>(size.x() + size.y());
    std::vector<float> inside(relief.heights.size(), far);
    const auto sea = [&](std::size_t cell)
    {
        return relief.water[cell] && static_cast<double>(relief.heights[cell]) <= seaLevel;
    };
    for (int row = 0; row < relief.rows; ++row)
    {
        for (int column = 0; column < relief.columns; ++column)
        {
            const std::size_t cell = relief.index(column, row);
            const bool border =
                column == 0 || row == 0 || column + 1 == relief.columns || row + 1 == relief.rows;
            if (std::isnan(relief.heights[cell]))
                inside[cell] = 0.0f;
            else if (border && !sea(cell))
                inside[cell] = 0.5f * std::min(wide, high);
        }
    }
    const auto sweep = [&](int column, int row, int step)
    {
        float& nearest = inside[relief.index(column, row)];
        const auto look = [&](int x, int y, float away)
        {
            if (x < 0 || y < 0 || x >= relief.columns || y >= relief.rows) return;
            nearest = std::min(nearest, inside[relief.index(x, y)] + away);
        };
        look(column - step, row, wide);
        look(column, row - step, high);
        look(column - step, row - step, slanted);
        look(column + step, row - step, slanted);
    };
    for (int row = 0; row < relief.rows; ++row)
        for (int column = 0; column < relief.columns; ++column)
            sweep(column, row, 1);
    for (int row = relief.rows; row-- > 0;)
        for (int column = relief.columns; column-- > 0;)
            sweep(column, row, -1);
    return inside;
}

} // namespace

ReliefWorth::ReliefWorth(const TerrainRelief& relief)
{
    lowest = HUGE_VAL;
    highest = -HUGE_VAL;
    for (const float height : relief.heights)
    {
        if (std::isnan(height)) continue;
        lowest = std::min(lowest, static_cast<double>(height));
        highest = std::max(highest, static_cast<double>(height));
    }
    if (!(highest >= lowest)) lowest = highest = 0.0;

    const std::vector<float> spread = spreads(relief);
    std::vector<float> rough, slopes;
    const osg::Vec2d size = relief.size();
    const double across = size.x() / relief.columns;
    for (int row = 0; row < relief.rows; ++row)
    {
        for (int column = 0; column < relief.columns; ++column)
        {
            const std::size_t cell = relief.index(column, row);
            if (std::isnan(relief.heights[cell]) || relief.water[cell]) continue;
            rough.push_back(spread[cell]);
            if (column + 1 == relief.columns || std::isnan(relief.heights[cell + 1])) continue;
            slopes.push_back(std::abs(relief.heights[cell + 1] - relief.heights[cell]) /
                             static_cast<float>(across));
        }
    }
    const double roughest = std::max(quantile(rough, 0.9), 1e-3);
    steep = quantile(slopes, 0.9);

    worth.assign(relief.heights.size(), 0.0f);
    for (int row = 0; row < relief.rows; ++row)
    {
        for (int column = 0; column < relief.columns; ++column)
        {
            const std::size_t cell = relief.index(column, row);
            if (std::isnan(relief.heights[cell])) continue;
            bool land = !relief.water[cell], water = !land;
            forNeighbours(relief, column, row,
                          [&](int x, int y)
                          {
                              const std::size_t there = relief.index(x, y);
                              if (std::isnan(relief.heights[there])) return;
                              land = land || !relief.water[there];
                              water = water || relief.water[there];
                          });
            double value = relief.water[cell] ? 0.0 : ofLand;
            value += ofRelief * std::min(static_cast<double>(spread[cell]) / roughest, 1.0);
            if (land && water) value += ofShore;
            worth[cell] = static_cast<float>(value);
            total += value;
        }
    }
    inside = insideOf(relief, lowest + std::max(seaHeight, seaShare * (highest - lowest)));
    if (highest > lowest) Prominence(relief, summits);
}

} // namespace osgGeoFX
