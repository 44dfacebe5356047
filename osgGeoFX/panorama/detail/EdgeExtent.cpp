// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/EdgeExtent.h>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

constexpr int within = EdgeExtent::within;
/// Holes within the data that are smaller than this share of the extent are gaps.
constexpr double largestGap = 0.02;

/// Calls `action` with the cells of each connected area of a kind.
template<class Kind, class Action>
void forAreas(const std::vector<EdgeExtent::Cell>& cells, const Kind& kind, const Action& action)
{
    std::vector<char> seen(cells.size(), 0);
    std::vector<std::size_t> area;
    for (std::size_t first = 0; first < cells.size(); ++first)
    {
        if (seen[first] || !kind(cells[first])) continue;
        area.assign(1, first);
        seen[first] = 1;
        for (std::size_t next = 0; next < area.size(); ++next)
        {
            const std::size_t cell = area[next], column = cell % within, row = cell / within;
            const auto add = [&](bool there, std::size_t neighbour)
            {
                if (!there || seen[neighbour] || !kind(cells[neighbour])) return;
                seen[neighbour] = 1;
                area.push_back(neighbour);
            };
            add(column > 0, cell - 1);
            add(column + 1 < within, cell + 1);
            add(row > 0, cell - within);
            add(row + 1 < within, cell + within);
        }
        action(area);
    }
}

} // namespace

void EdgeExtent::rasterise(const osg::Vec3d (&corners)[3])
{
    const auto cellsFrom = [](double a, double b, double c, int& first, int& last)
    {
        first = std::max(0, static_cast<int>(std::ceil(std::min({a, b, c}) * within - 0.5)));
        last = std::min(within - 1, static_cast<int>(std::floor(std::max({a, b, c}) * within - 0.5)));
    };
    int left = 0, right = 0, bottom = 0, top = 0;
    cellsFrom(corners[0].x(), corners[1].x(), corners[2].x(), left, right);
    cellsFrom(corners[0].y(), corners[1].y(), corners[2].y(), bottom, top);
    const osg::Vec3d a = corners[1] - corners[0], b = corners[2] - corners[0];
    const double area = a.x() * b.y() - a.y() * b.x();
    if (std::abs(area) < 1e-15) return; // a wall of the skirt
    for (int row = bottom; row <= top; ++row)
    {
        for (int column = left; column <= right; ++column)
        {
            const osg::Vec3d p = osg::Vec3d((column + 0.5) / within, (row + 0.5) / within, 0.0) - corners[0];
            const double u = (p.x() * b.y() - p.y() * b.x()) / area;
            const double v = (a.x() * p.y() - a.y() * p.x()) / area;
            if (u < -1e-9 || v < -1e-9 || u + v > 1.0 + 1e-9) continue;
            heights[index(column, row)] = static_cast<float>(corners[0].z() + u * a.z() + v * b.z());
        }
    }
}

void EdgeExtent::keepSea(double highest)
{
    std::vector<std::size_t> others;
    forAreas(
        cells, [](Cell cell) { return cell == Cell::WATER || cell == Cell::WET_HOLE; },
        [&](const std::vector<std::size_t>& area)
        {
            std::size_t low = 0, known = 0;
            for (const std::size_t cell : area)
            {
                if (std::isnan(heights[cell])) continue;
                ++known;
                low += static_cast<double>(heights[cell]) <= highest ? 1 : 0;
            }
            if (2 * low < known) others.insert(others.end(), area.begin(), area.end());
        });
    for (const std::size_t cell : others)
        cells[cell] = cells[cell] == Cell::WATER ? Cell::LAND : Cell::HOLE;
}

void EdgeExtent::tellGaps()
{
    std::vector<std::size_t> gaps;
    forAreas(
        cells, [](Cell cell) { return cell == Cell::HOLE; },
        [&](const std::vector<std::size_t>& area)
        {
            const bool small = static_cast<double>(area.size()) < largestGap * within * within;
            const auto onBorder = [](std::size_t cell)
            {
                const std::size_t column = cell % within, row = cell / within;
                return column == 0 || row == 0 || column + 1 == within || row + 1 == within;
            };
            if (small && std::none_of(area.begin(), area.end(), onBorder))
                gaps.insert(gaps.end(), area.begin(), area.end());
        });
    for (const std::size_t cell : gaps)
        cells[cell] = Cell::GAP;
}

} // namespace osgGeoFX
