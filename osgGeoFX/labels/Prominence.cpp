// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/Prominence.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace osgGeoFX
{

namespace
{

constexpr std::uint32_t none = 0xffffffffu;

/// Islands of ground that join as the water falls. An island is known by its highest cell.
class Islands
{
public:
    explicit Islands(std::size_t cells) : _parent(cells, none) {}

    bool has(std::uint32_t cell) const { return _parent[cell] != none; }
    void rise(std::uint32_t cell) { _parent[cell] = cell; }
    std::uint32_t summitOf(std::uint32_t cell)
    {
        while (_parent[cell] != cell)
        {
            _parent[cell] = _parent[_parent[cell]];
            cell = _parent[cell];
        }
        return cell;
    }
    void join(std::uint32_t lower, std::uint32_t higher) { _parent[lower] = higher; }

private:
    std::vector<std::uint32_t> _parent;
};

} // namespace

std::vector<Summit> computeSummits(const HeightField& field, float least)
{
    const std::vector<float>& heights = field.heights;
    std::vector<Summit> summits;
    if (field.columns < 1 || field.rows < 1 ||
        heights.size() != static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows) ||
        heights.size() >= none)
        return summits;

    std::vector<std::uint32_t> order;
    order.reserve(heights.size());
    for (std::uint32_t cell = 0; cell < heights.size(); ++cell)
        if (std::isfinite(heights[cell])) order.push_back(cell);
    // Of equal heights the first cell is the summit, whatever the order of the sort.
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b)
              { return heights[a] > heights[b] || (heights[a] == heights[b] && a < b); });

    const auto add = [&](std::uint32_t cell, float pass)
    {
        const float prominence = heights[cell] - pass;
        // On a plateau cells join at their own height.
        if (!(prominence > 0.0f) || prominence < least) return;
        summits.push_back({static_cast<int>(cell) % field.columns, static_cast<int>(cell) / field.columns,
                           heights[cell], prominence});
    };
    Islands islands(heights.size());
    for (const std::uint32_t cell : order)
    {
        islands.rise(cell);
        const int column = static_cast<int>(cell) % field.columns;
        const int row = static_cast<int>(cell) / field.columns;
        for (int y = std::max(row - 1, 0); y <= std::min(row + 1, field.rows - 1); ++y)
        {
            for (int dx = -1; dx <= 1; ++dx)
            {
                int x = column + dx;
                if (field.wraps) x = (x + field.columns) % field.columns;
                if (x < 0 || x >= field.columns) continue;
                const auto neighbor = static_cast<std::uint32_t>(y * field.columns + x);
                if (neighbor == cell || !islands.has(neighbor)) continue;
                const std::uint32_t a = islands.summitOf(cell), b = islands.summitOf(neighbor);
                if (a == b) continue;
                const bool aIsHigher = heights[a] > heights[b] || (heights[a] == heights[b] && a < b);
                const std::uint32_t lower = aIsHigher ? b : a;
                add(lower, heights[cell]);
                islands.join(lower, aIsHigher ? a : b);
            }
        }
    }
    // The highest summits of connected ground.
    std::vector<float> lowest(heights.size(), HUGE_VALF);
    for (const std::uint32_t cell : order)
    {
        float& low = lowest[islands.summitOf(cell)];
        low = std::min(low, heights[cell]);
    }
    for (const std::uint32_t cell : order)
        if (islands.summitOf(cell) == cell) add(cell, lowest[cell]);

    std::sort(summits.begin(), summits.end(),
              [](const Summit& a, const Summit& b)
              {
                  if (a.prominence != b.prominence) return a.prominence > b.prominence;
                  return a.row < b.row || (a.row == b.row && a.column < b.column);
              });
    return summits;
}

} // namespace osgGeoFX
