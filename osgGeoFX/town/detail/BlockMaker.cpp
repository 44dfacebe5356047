// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/town/detail/BlockMaker.h>

#include <osgGeoFX/geodata/detail/GdalSupport.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

namespace osgGeoFX
{

namespace
{

// Metres.
constexpr double CELL = 128.0;       ///< no block is wider, about
constexpr double GAP = 18.0;         ///< of two buildings that are one block
constexpr double STRAIGHT = 4.0;     ///< that a block's outline may be off by
constexpr double TOWER = 32.0;       ///< the height from which a building stands by itself
constexpr double LEAST_BLOCK = 60.0; ///< square metres: smaller ones do not show

using GeometryPtr = std::unique_ptr<OGRGeometry>;

OGRLinearRing* toOgr(const Ring& ring)
{
    auto* result = new OGRLinearRing;
    for (const osg::Vec2d& place : ring)
        result->addPoint(place.x(), place.y());
    result->closeRings();
    return result;
}

std::unique_ptr<OGRPolygon> toOgr(const std::vector<Ring>& rings)
{
    auto polygon = std::make_unique<OGRPolygon>();
    for (const Ring& ring : rings)
        polygon->addRingDirectly(toOgr(ring));
    return polygon;
}

std::vector<Ring> fromOgr(const OGRPolygon& polygon, double leastCourtyard)
{
    std::vector<Ring> rings;
    for (const OGRLinearRing* each : polygon)
    {
        Ring ring;
        for (int i = 0; i + 1 < each->getNumPoints(); ++i)
            ring.emplace_back(each->getX(i), each->getY(i));
        const bool outline = rings.empty();
        if (ring.size() < 3) break;
        const double area = ringArea(ring);
        if (!outline && std::abs(area) < leastCourtyard) continue;
        if ((area > 0.0) != outline) std::reverse(ring.begin(), ring.end());
        rings.push_back(std::move(ring));
    }
    return rings;
}

void collect(const OGRGeometry& geometry, std::vector<std::vector<Ring>>& outlines)
{
    const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
    if (type == wkbPolygon)
    {
        std::vector<Ring> rings = fromOgr(*geometry.toPolygon(), 400.0);
        if (!rings.empty() && ringArea(rings.front()) >= LEAST_BLOCK) outlines.push_back(std::move(rings));
    }
    else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection))
        for (const OGRGeometry* part : *geometry.toGeometryCollection())
            collect(*part, outlines);
}

/// Blocks of the low buildings of a cell.
void addBlocks(const std::vector<const PlacedBuilding*>& buildings, std::vector<PlacedBuilding>& blocks)
{
    OGRMultiPolygon all;
    for (const PlacedBuilding* each : buildings)
        all.addGeometryDirectly(toOgr(std::vector<Ring>{each->rings.front()}).release());
    // Gaps close, and the rest of the outline stays where it is.
    const GdalErrorScope quiet;
    GeometryPtr joined(all.Buffer(0.5 * GAP, 2));
    if (joined) joined.reset(joined->Buffer(-0.5 * GAP, 2));
    if (joined) joined.reset(joined->SimplifyPreserveTopology(STRAIGHT));
    std::vector<std::vector<Ring>> outlines;
    if (joined) collect(*joined, outlines);
    std::vector<char> taken(buildings.size(), 0);
    for (std::vector<Ring>& rings : outlines)
    {
        PlacedBuilding block;
        double area = 0.0, top = 0.0, ground = 0.0, tiled = 0.0, largest = 0.0;
        for (std::size_t i = 0; i < buildings.size(); ++i)
        {
            const PlacedBuilding& each = *buildings[i];
            if (taken[i] || !isWithin({rings.front()}, {each.reference.x(), each.reference.y()})) continue;
            taken[i] = 1;
            block.foot = area > 0.0 ? std::min(block.foot, each.foot) : each.foot;
            area += each.area;
            top += each.area * each.top;
            ground += each.area * each.reference.z();
            if (each.gabled || each.use == BuildingUse::HOUSE) tiled += each.area;
            if (each.area <= largest) continue;
            largest = each.area;
            block.use = each.use;
            block.seed = each.seed;
        }
        if (!(area > 0.0)) continue;
        const osg::Vec2d middle = ringMiddle(rings.front());
        block.reference.set(middle.x(), middle.y(), ground / area);
        block.top = top / area;
        block.area = area;
        block.gabled = 2.0 * tiled > area;
        block.rings = std::move(rings);
        blocks.push_back(std::move(block));
    }
    // Those that are in no block, by their middle.
    for (std::size_t i = 0; i < buildings.size(); ++i)
        if (!taken[i] && buildings[i]->area >= LEAST_BLOCK)
            blocks.push_back(simplified(*buildings[i], STRAIGHT));
}

} // namespace

PlacedBuilding simplified(const PlacedBuilding& building, double tolerance)
{
    PlacedBuilding result = building;
    const std::size_t corners = building.rings.front().size();
    if (building.rings.size() == 1 && corners <= 4) return result;
    const GdalErrorScope quiet;
    const GeometryPtr simple(toOgr(building.rings)->SimplifyPreserveTopology(tolerance));
    if (!simple || wkbFlatten(simple->getGeometryType()) != wkbPolygon) return result;
    std::vector<Ring> rings = fromOgr(*simple->toPolygon(), 20.0 * tolerance * tolerance);
    if (!rings.empty()) result.rings = std::move(rings);
    return result;
}

std::vector<PlacedBuilding> makeBlocks(const std::vector<PlacedBuilding>& buildings)
{
    std::vector<PlacedBuilding> blocks;
    std::map<std::pair<int, int>, std::vector<const PlacedBuilding*>> cells;
    for (const PlacedBuilding& each : buildings)
    {
        if (each.top - each.reference.z() >= TOWER)
        {
            blocks.push_back(simplified(each, 0.5 * STRAIGHT));
            continue;
        }
        cells[{static_cast<int>(std::floor(each.reference.y() / CELL)),
               static_cast<int>(std::floor(each.reference.x() / CELL))}]
            .push_back(&each);
    }
    for (const auto& [cell, inside] : cells)
        addBlocks(inside, blocks);
    return blocks;
}

} // namespace osgGeoFX
