// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// B: a route.
#include "Figures.h"
#include "Marks.h"

#include <osgGeoFX/mapping/RouteMapping.h>
#include <osgGeoFX/mapping/SymbolMapping.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

using namespace osgGeoFX;

namespace figure3
{

namespace
{

/// What a metre costs: freeways are quick, and there is little reason to leave the roads.
double costOf(float cover)
{
    switch (static_cast<int>(cover))
    {
    case FREEWAY:
        return 1.0;
    case ROAD:
        return 1.7;
    case SEA:
        return 500.0;
    default:
        return 25.0;
    }
}

/// The cheapest way from cell to cell, after Dijkstra.
std::vector<osg::Vec2d> cheapestWay(const Grid& cover, const osg::Vec2d& from, const osg::Vec2d& to)
{
    const int columns = cover.columns();
    const auto cellOf = [&](const osg::Vec2d& place)
    {
        return cover.rowOf(place.y()) * columns + cover.columnOf(place.x());
    };
    const auto middle = [&](int cell)
    {
        return cover.middle(cell % columns, cell / columns);
    };
    const int start = cellOf(from);
    const int goal = cellOf(to);
    const std::size_t cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(cover.rows());
    std::vector<double> costs(cells, std::numeric_limits<double>::max());
    std::vector<int> before(cells, -1);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    costs[static_cast<std::size_t>(start)] = 0.0;
    open.emplace(0.0, start);
    while (!open.empty() && open.top().second != goal)
    {
        const auto [cost, cell] = open.top();
        open.pop();
        if (cost > costs[static_cast<std::size_t>(cell)]) continue;
        const int column = cell % columns;
        const int row = cell / columns;
        for (int i = 0; i < 9; ++i)
        {
            const int x = column + i % 3 - 1;
            const int y = row + i / 3 - 1;
            if (i == 4 || x < 0 || y < 0 || x >= columns || y >= cover.rows()) continue;
            const int next = y * columns + x;
            const double total = cost + (middle(next) - middle(cell)).length() * costOf(cover.at(x, y));
            if (total >= costs[static_cast<std::size_t>(next)]) continue;
            costs[static_cast<std::size_t>(next)] = total;
            before[static_cast<std::size_t>(next)] = cell;
            open.emplace(total, next);
        }
    }
    std::vector<osg::Vec2d> way;
    for (int cell = goal; cell >= 0; cell = before[static_cast<std::size_t>(cell)])
        way.push_back(middle(cell));
    std::reverse(way.begin(), way.end());
    return way;
}

/// The places first…last without those that a line through the others comes near enough to, after Douglas and Peucker;
/// without the first.
void simplify(const std::vector<osg::Vec2d>& way, std::size_t first, std::size_t last, double tolerance,
              std::vector<osg::Vec2d>& result)
{
    osg::Vec2d direction = way[last] - way[first];
    direction.normalize();
    std::size_t farthest = first;
    double most = tolerance;
    for (std::size_t i = first + 1; i < last; ++i)
    {
        const osg::Vec2d d = way[i] - way[first];
        const double away = std::abs(d.x() * direction.y() - d.y() * direction.x());
        if (away <= most) continue;
        most = away;
        farthest = i;
    }
    if (farthest == first)
    {
        result.push_back(way[last]);
        return;
    }
    simplify(way, first, farthest, tolerance, result);
    simplify(way, farthest, last, tolerance, result);
}

} // namespace

Shot route(Island& island)
{
    // From the airport to the zoo below Diamond Head, past the palace.
    const osg::Vec2d stops[] = {island.place(-157.9215, 21.3360), island.place(-157.8585, 21.3065),
                                island.place(-157.8210, 21.2715)};
    std::vector<osg::Vec2d> points = {stops[0]};
    for (const auto& [from, to] : {std::pair(stops[0], stops[1]), std::pair(stops[1], stops[2])})
    {
        const std::vector<osg::Vec2d> way = cheapestWay(island.landCover(), from, to);
        simplify(way, 0, way.size() - 1, 45.0, points);
    }

    const osg::ref_ptr<RouteMapping> route = new RouteMapping;
    island.mappings->addRoute(route);
    RouteMapping::Style style;
    style.halfWidth = 48.0;
    style.casing = 22.0;
    style.pointRadius = 0.0;
    style.surroundings = 450.0;
    style.softness = 700.0;
    style.brightness = 0.55;
    style.saturation = 0.1;
    route->setStyle(style);
    route->setWayPoints(points);

    SymbolMapping* landmarks = island.keep(new SymbolMapping(*island.mappings));
    const auto addLook = [&](const osg::Vec4& color, double pixels)
    {
        SymbolMapping::Look look;
        look.levels = {{new DataLayer(makePin(color)), 60000.0}};
        look.width = 6000.0;
        look.pixels = pixels;
        look.stretch = 1.7;
        look.turned = true;
        look.order = 10;
        return *landmarks->addLook(look);
    };
    const int sight = addLook({0.96f, 0.66f, 0.10f, 1.0f}, 62.0);
    for (const auto& [longitude, latitude] : {std::pair(-157.8660, 21.3070), std::pair(-157.8480, 21.3125),
                                              std::pair(-157.8430, 21.2900), std::pair(-157.8060, 21.2620)})
        landmarks->add(sight, island.onGround(island.place(longitude, latitude)));
    const int stop = addLook({0.85f, 0.12f, 0.16f, 1.0f}, 92.0);
    for (const osg::Vec2d& place : {points.front(), stops[1], points.back()})
        landmarks->add(stop, island.onGround(place));
    return {"-157.797,21.236,5300,323,-32", 38.0, {}, nullptr};
}

} // namespace figure3
