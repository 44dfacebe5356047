// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <osg/CoordinateSystemNode>
#include <osg/Node>
#include <osg/Vec3d>

#include <memory>

namespace osgGeoFX
{

/** The ground of a terrain at any place, for what is put onto it: names, lines.

    Places are those of TerrainRelief's extent: longitude and latitude in degrees on a globe, metres of the world on a plane. The terrain and
    the relief must outlive this object. It reads tiles from files and keeps the last ones. One thread at a time; no other thread may
    change the terrain meanwhile.
    @ingroup labels */
class OSGGEOFXMAPS_EXPORT FinestGround
{
public:
    /// `ellipsoid`: as for TerrainRelief::read().
    FinestGround(const osg::Node& terrain, const osg::EllipsoidModel* ellipsoid, const TerrainRelief& relief);
    ~FinestGround();
    FinestGround(const FinestGround&) = delete;
    FinestGround& operator=(const FinestGround&) = delete;

    /// World coordinates of a place at a height above the ellipsoid or the plane, metres.
    osg::Vec3d world(double x, double y, double height) const;
    /// The height as fine as the database has it, metres; not a number beside the ground.
    double finest(double x, double y) const;
    /// The height of the relief, which is quick; not a number where it has none.
    double coarse(double x, double y) const;

private:
    class Tiles;
    osg::Node& _terrain;
    osg::ref_ptr<const osg::EllipsoidModel> _ellipsoid;
    const TerrainRelief& _relief;
    double _low, _high; ///< of the relief's heights
    osg::ref_ptr<Tiles> _tiles;
};

} // namespace osgGeoFX
