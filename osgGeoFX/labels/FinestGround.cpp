// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/FinestGround.h>

#include <osgGeoFX/effect/GroundShade.h>
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/paging/TileGuard.h>

#include <osg/Math>
#include <osgDB/ReadFile>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <algorithm>
#include <cmath>
#include <limits>
#include <list>
#include <map>
#include <string>
#include <utility>

namespace osgGeoFX
{

/// Files of a paged database that were read last.
class FinestGround::Tiles : public osgUtil::IntersectionVisitor::ReadCallback
{
public:
    explicit Tiles(const osg::Node& terrain) : _options(TileGuard::readingOptions(terrain)) {}

    osg::ref_ptr<osg::Node> readNodeFile(const std::string& file) override
    {
        const auto found = _tiles.find(file);
        if (found != _tiles.end())
        {
            _order.splice(_order.begin(), _order, found->second.second);
            return found->second.first;
        }
        const osg::ref_ptr<osg::Node> tile = osgDB::readRefNodeFile(file, _options.get());
        _order.push_front(file);
        _tiles[file] = {tile, _order.begin()};
        if (_order.size() > most)
        {
            _tiles.erase(_order.back());
            _order.pop_back();
        }
        return tile;
    }

private:
    static constexpr std::size_t most = 64;
    const osg::ref_ptr<osgDB::Options> _options;
    std::list<std::string> _order;
    std::map<std::string, std::pair<osg::ref_ptr<osg::Node>, std::list<std::string>::iterator>> _tiles;
};

namespace
{

/// Passes over towns: names and lines lie on the ground below them.
class GroundVisitor : public osgUtil::IntersectionVisitor
{
public:
    using osgUtil::IntersectionVisitor::IntersectionVisitor;
    void apply(osg::Drawable& drawable) override
    {
        if (!RigidParts::inForce(getNodePath()) && !GroundShade::is(drawable))
            osgUtil::IntersectionVisitor::apply(drawable);
    }
};

} // namespace

FinestGround::FinestGround(const osg::Node& terrain, const osg::EllipsoidModel* ellipsoid,
                           const TerrainRelief& relief)
    : _terrain(const_cast<osg::Node&>(terrain)), _ellipsoid(ellipsoid), _relief(relief), _low(HUGE_VAL),
      _high(-HUGE_VAL), _tiles(new Tiles(terrain))
{
    for (const float height : relief.heights)
    {
        if (std::isnan(height)) continue;
        _low = std::min(_low, static_cast<double>(height));
        _high = std::max(_high, static_cast<double>(height));
    }
}

FinestGround::~FinestGround() = default;

osg::Vec3d FinestGround::world(double x, double y, double height) const
{
    if (!_ellipsoid) return {x, y, height};
    osg::Vec3d place;
    _ellipsoid->convertLatLongHeightToXYZ(osg::DegreesToRadians(y), osg::DegreesToRadians(x), height,
                                          place.x(), place.y(), place.z());
    return place;
}

double FinestGround::finest(double x, double y) const
{
    // The relief's cells may be lower than their ground.
    const double room = 1000.0 + 0.1 * (_high - _low);
    const osg::ref_ptr<osgUtil::LineSegmentIntersector> line =
        new osgUtil::LineSegmentIntersector(world(x, y, _high + room), world(x, y, _low - room));
    line->setIntersectionLimit(osgUtil::Intersector::LIMIT_NEAREST);
    GroundVisitor visitor(line, _tiles.get());
    visitor.setLODSelectionMode(osgUtil::IntersectionVisitor::USE_HIGHEST_LEVEL_OF_DETAIL);
    _terrain.accept(visitor);
    if (!line->containsIntersections()) return std::numeric_limits<double>::quiet_NaN();
    const osg::Vec3d hit = line->getFirstIntersection().getWorldIntersectPoint();
    if (!_ellipsoid) return hit.z();
    double latitude = 0.0, longitude = 0.0, height = 0.0;
    _ellipsoid->convertXYZToLatLongHeight(hit.x(), hit.y(), hit.z(), latitude, longitude, height);
    return height;
}

double FinestGround::coarse(double x, double y) const
{
    const auto column =
        static_cast<int>(std::floor((x - _relief.west) / (_relief.east - _relief.west) * _relief.columns));
    const auto row =
        static_cast<int>(std::floor((y - _relief.south) / (_relief.north - _relief.south) * _relief.rows));
    if (column < 0 || row < 0 || column >= _relief.columns || row >= _relief.rows)
        return std::numeric_limits<double>::quiet_NaN();
    return static_cast<double>(_relief.heights[_relief.index(column, row)]);
}

} // namespace osgGeoFX
