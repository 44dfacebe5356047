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

/// A place of a name, in the units of the extent, on the relief.
struct Rough
{
    std::size_t name = 0, place = 0;
    bool climbs = false; ///< whether it is a summit, whose highest place is near
};

/// The places of the most important names, so many at most, in an order in which neighbors come together: then each tile is read once.
std::vector<Rough> finestFirst(std::vector<Rough> all, const std::vector<MapName>& names,
                               const TerrainRelief& relief, std::size_t most)
{
    const auto importance = [&](const Rough& each)
    {
        const double value = names[each.name].importance;
        return std::isnan(value) ? -HUGE_VAL : value;
    };
    std::stable_sort(all.begin(), all.end(),
                     [&](const Rough& a, const Rough& b) { return importance(a) > importance(b); });
    if (all.size() > most) all.resize(most);
    constexpr double blocks = 64.0;
    const auto block = [&](const Rough& each)
    {
        const osg::Vec3d& place = names[each.name].places[each.place];
        const int row = static_cast<int>((place.y() - relief.south) / (relief.north - relief.south) * blocks);
        const int column = static_cast<int>((place.x() - relief.west) / (relief.east - relief.west) * blocks);
        return std::make_pair(row, row % 2 == 0 ? column : -column);
    };
    std::stable_sort(all.begin(), all.end(),
                     [&](const Rough& a, const Rough& b) { return block(a) < block(b); });
    return all;
}

/// Puts a name onto the relief, without its world coordinates. False if it lies beside the terrain.
class RoughPlacement
{
public:
    RoughPlacement(const FinestGround& ground, const TerrainRelief& relief, double reach)
        : _ground(ground), _relief(relief), _reach(reach)
    {
    }

    std::size_t moved = 0;

    /// `climbs`: whether the place is that of a summit of the relief.
    bool place(MapName& name, osg::Vec3d& place, bool summit, bool& climbs)
    {
        // Longitudes of an extent may go on beyond 180.
        if (_relief.geocentric)
        {
            const double middle = 0.5 * (_relief.west + _relief.east);
            place.x() = middle + std::remainder(place.x() - middle, 360.0);
        }
        const double stated = place.z();
        if (name.kind == MapName::POINT && std::isnan(name.height)) name.height = stated;
        place.z() = _ground.coarse(place.x(), place.y());
        if (std::isnan(place.z())) return false;
        if (!summit) return true;
        if (!_known) _known.emplace(_relief);
        const std::optional<Summit> meant =
            _reach > 0.0 ? _known->near(place.x(), place.y(), _reach) : std::nullopt;
        if (std::isnan(name.importance))
            name.importance = meant ? static_cast<double>(meant->prominence)
                                    : 1e-4 * (std::isnan(stated) ? place.z() : stated);
        if (!meant) return true;
        const osg::Vec2d at = _relief.place(meant->column, meant->row);
        place.set(at.x(), at.y(), static_cast<double>(meant->height));
        climbs = true;
        ++moved;
        return true;
    }

private:
    const FinestGround& _ground;
    const TerrainRelief& _relief;
    const double _reach;
    std::optional<Summits> _known;
};

} // namespace

NamePlacement::Result NamePlacement::place(std::vector<MapName>& names, const osg::Node& terrain,
                                           const osg::EllipsoidModel* ellipsoid,
                                           const TerrainRelief& relief) const
{
    Result result;
    const FinestGround ground(terrain, ellipsoid, relief);
    RoughPlacement roughly(ground, relief, reach);
    std::vector<MapName> placed;
    placed.reserve(names.size());
    std::vector<Rough> places;
    for (MapName& name : names)
    {
        const bool summit = name.kind == MapName::POINT &&
                            std::find(summits.begin(), summits.end(), name.style) != summits.end();
        const std::size_t former = places.size();
        bool inside = true;
        for (std::size_t i = 0; inside && i < name.places.size(); ++i)
        {
            places.push_back({placed.size(), i, false});
            inside = roughly.place(name, name.places[i], summit, places.back().climbs);
        }
        if (inside)
        {
            placed.push_back(std::move(name));
            continue;
        }
        places.resize(former);
        ++result.outside;
    }
    result.moved = roughly.moved;
    const osg::Vec2d cell((relief.east - relief.west) / relief.columns,
                          (relief.north - relief.south) / relief.rows);
    for (const Rough& each : finestFirst(std::move(places), placed, relief, finest))
    {
        osg::Vec3d& place = placed[each.name].places[each.place];
        double height = 0.0;
        osg::Vec2d at(place.x(), place.y());
        if (each.climbs)
            at = climb(ground, at, cell, height);
        else
            height = ground.finest(at.x(), at.y());
        if (!std::isnan(height)) place.set(at.x(), at.y(), height);
    }
    for (MapName& name : placed)
        for (osg::Vec3d& place : name.places)
            place = ground.world(place.x(), place.y(), place.z());
    names = std::move(placed);
    return result;
}

} // namespace osgGeoFX
