// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/town/detail/TownFrame.h>

#include <GeographicLib/Geocentric.hpp>
#include <osg/CoordinateSystemNode>
#include <osg/Math>

#include <cmath>

namespace osgGeoFX
{

TownGrid::TownGrid(const TerrainInfo& terrain)
    : _geocentric(terrain.geocentric), _west(terrain.west), _south(terrain.south), _east(terrain.east),
      _north(terrain.north)
{
}

osg::Vec2d TownGrid::turned(const osg::Vec2d& place) const
{
    return turned(place, {0.5 * (_west + _east), 0.0});
}

osg::Vec2d TownGrid::turned(const osg::Vec2d& place, const osg::Vec2d& about) const
{
    if (!_geocentric) return place;
    return {about.x() + std::remainder(place.x() - about.x(), 360.0), place.y()};
}

osg::Vec3d TownGrid::toWorld(const osg::Vec2d& place, double height) const
{
    if (!_geocentric) return {place.x(), place.y(), height};
    osg::Vec3d world;
    GeographicLib::Geocentric::WGS84().Forward(place.y(), place.x(), height, world.x(), world.y(), world.z());
    return world;
}

osg::Vec3d TownGrid::fromWorld(const osg::Vec3d& world) const
{
    if (!_geocentric) return world;
    double latitude = 0.0, longitude = 0.0, height = 0.0;
    GeographicLib::Geocentric::WGS84().Reverse(world.x(), world.y(), world.z(), latitude, longitude, height);
    const osg::Vec2d place = turned({longitude, latitude});
    return {place.x(), place.y(), height};
}

osg::Matrixd TownGrid::frameAt(const osg::Vec2d& place) const
{
    if (!_geocentric) return osg::Matrixd::translate(place.x(), place.y(), 0.0);
    osg::Matrixd frame;
    const osg::ref_ptr<osg::EllipsoidModel> globe = new osg::EllipsoidModel;
    globe->computeLocalToWorldTransformFromLatLongHeight(osg::DegreesToRadians(place.y()),
                                                         osg::DegreesToRadians(place.x()), 0.0, frame);
    return frame;
}

osg::Vec2d TownGrid::metres(double y) const
{
    if (!_geocentric) return {1.0, 1.0};
    // Of the ellipsoid; a degree's parts are for sizes alone.
    constexpr double degree = 111320.0, least = 0.01;
    return {degree * std::max(std::cos(osg::DegreesToRadians(y)), least), degree};
}

} // namespace osgGeoFX
