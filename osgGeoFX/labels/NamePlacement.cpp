// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/NamePlacement.h>

#include <osgGeoFX/labels/FinestGround.h>
#include <osgGeoFX/labels/Prominence.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// The summits of a relief by their cells.
class Summits
{
public:
    explicit Summits(const TerrainRelief& relief) : _relief(relief)
    {
        HeightField field;
        field.columns = relief.columns;
        field.rows = relief.rows;
        field.heights = relief.heights;
        field.wraps = relief.geocentric && relief.east - relief.west > 359.9;
        for (const Summit& summit : computeSummits(field, 0.0f))
            _byCell[relief.index(summit.column, summit.row)] = summit;
    }

    /// The most prominent one within a distance of a place.
    std::optional<Summit> near(double x, double y, double reach) const
    {
        const osg::Vec2d metre = _relief.metre(y);
        const double wide = (_relief.east - _relief.west) / _relief.columns;
        const double high = (_relief.north - _relief.south) / _relief.rows;
        // A summit is in one of the cells around it, however small the reach is.
        const osg::Vec2d most(std::max(reach * metre.x(), 1.5 * wide),
                              std::max(reach * metre.y(), 1.5 * high));
        const auto cell = [](double value, int count)
        {
            return static_cast<int>(std::clamp(std::floor(value), 0.0, count - 1.0));
        };
        std::optional<Summit> best;
        for (int row = cell((y - most.y() - _relief.south) / high, _relief.rows);
             row <= cell((y + most.y() - _relief.south) / high, _relief.rows); ++row)
        {
            for (int column = cell((x - most.x() - _relief.west) / wide, _relief.columns);
                 column <= cell((x + most.x() - _relief.west) / wide, _relief.columns); ++column)
            {
                const auto found = _byCell.find(_relief.index(column, row));
                if (found == _byCell.end()) continue;
                const osg::Vec2d way = _relief.place(column, row) - osg::Vec2d(x, y);
                if (std::hypot(way.x() / most.x(), way.y() / most.y()) > 1.0) continue;
                if (!best || found->second.prominence > best->prominence) best = found->second;
            }
        }
        return best;
    }

private:
    const TerrainRelief& _relief;
    std::unordered_map<std::size_t, Summit> _byCell;
};

/// The highest place within half a cell around one, in steps that become smaller.
osg::Vec2d climb(const FinestGround& ground, osg::Vec2d place, osg::Vec2d step, double& height)
{
    height = ground.finest(place.x(), place.y());
    for (int pass = 0; pass < 3; ++pass)
    {
        const osg::Vec2d middle = place;
        for (int i = -2; i <= 2; ++i)
        {
            for (int k = -2; k <= 2; ++k)
            {
                const osg::Vec2d other = middle + osg::Vec2d(step.x() * i, step.y() * k) * 0.5;
                const double there = ground.finest(other.x(), other.y());
                if (std::isnan(there) || there <= height) continue;
                height = there;
                place = other;
            }
        }
        step *= 0.3;
    }
    return place;
}

} // namespace

NamePlacement::Result NamePlacement::place(std::vector<MapName>& names, const osg::Node& terrain,
                                           const osg::EllipsoidModel* ellipsoid,
                                           const TerrainRelief& relief) const
{
    Result result;
    const FinestGround ground(terrain, ellipsoid, relief);
    std::optional<Summits> known;
    const osg::Vec2d cell((relief.east - relief.west) / relief.columns,
                          (relief.north - relief.south) / relief.rows);
    std::size_t fine = 0;
    std::vector<MapName> placed;
    placed.reserve(names.size());
    for (MapName& name : names)
    {
        bool outside = false;
        const bool summit = name.kind == MapName::POINT &&
                            std::find(summits.begin(), summits.end(), name.style) != summits.end();
        for (osg::Vec3d& place : name.places)
        {
            // Longitudes of an extent may go on beyond 180.
            if (relief.geocentric)
            {
                const double middle = 0.5 * (relief.west + relief.east);
                place.x() = middle + std::remainder(place.x() - middle, 360.0);
            }
            const double stated = place.z();
            if (name.kind == MapName::POINT && std::isnan(name.height)) name.height = stated;
            double height = ground.coarse(place.x(), place.y());
            outside = outside || std::isnan(height);
            if (outside) break;
            const bool finely = fine < finest;
            fine += finely ? 1 : 0;
            if (summit)
            {
                if (!known) known.emplace(relief);
                const std::optional<Summit> meant =
                    reach > 0.0 ? known->near(place.x(), place.y(), reach) : std::nullopt;
                if (meant)
                {
                    osg::Vec2d at = relief.place(meant->column, meant->row);
                    height = static_cast<double>(meant->height);
                    if (finely) at = climb(ground, at, cell, height);
                    place.x() = at.x();
                    place.y() = at.y();
                    ++result.moved;
                }
                else if (finely)
                    height = ground.finest(place.x(), place.y());
                if (std::isnan(name.importance))
                    name.importance = meant ? static_cast<double>(meant->prominence)
                                            : 1e-4 * (std::isnan(stated) ? height : stated);
            }
            else if (finely)
                height = ground.finest(place.x(), place.y());
            if (std::isnan(height)) height = ground.coarse(place.x(), place.y());
            place = ground.world(place.x(), place.y(), height);
        }
        if (outside)
            ++result.outside;
        else
            placed.push_back(std::move(name));
    }
    names = std::move(placed);
    return result;
}

} // namespace osgGeoFX
