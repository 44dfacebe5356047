// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/paging/TerrainInfo.h>

#include <osg/Matrixd>
#include <osg/Vec2d>
#include <osg/Vec3d>

namespace osgGeoFX
{

/// Places of a terrain's grid: degrees of longitude and latitude, or metres of the projection.
class TownGrid
{
public:
    explicit TownGrid(const TerrainInfo& terrain);

    bool geocentric() const { return _geocentric; }
    double west() const { return _west; }
    double south() const { return _south; }
    double east() const { return _east; }
    double north() const { return _north; }
    bool contains(const osg::Vec2d& place) const
    {
        return place.x() >= _west && place.x() <= _east && place.y() >= _south && place.y() <= _north;
    }
    /// A place with its longitude turned by whole circles to within 180 degrees of the terrain's middle, or of that of
    /// another place. What belongs together must be turned about one place: on the other side of the globe, neighbours
    /// would go to different ends.
    osg::Vec2d turned(const osg::Vec2d& place) const;
    osg::Vec2d turned(const osg::Vec2d& place, const osg::Vec2d& about) const;

    /// The world position of a grid place at a height; and back, with the height as z.
    osg::Vec3d toWorld(const osg::Vec2d& place, double height) const;
    osg::Vec3d fromWorld(const osg::Vec3d& world) const;
    /// The matrix to the world from the frame at a grid place, height 0: x east, y north, z up.
    osg::Matrixd frameAt(const osg::Vec2d& place) const;
    /// Metres for each unit of x and y at a y.
    osg::Vec2d metres(double y) const;

private:
    bool _geocentric;
    double _west, _south, _east, _north;
};

} // namespace osgGeoFX
