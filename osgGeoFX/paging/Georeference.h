// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/CoordinateSystemNode>
#include <osg/Matrixd>
#include <osg/Object>
#include <osg/Vec3d>

#include <string>

namespace osgGeoFX
{

/** Converts between a database's world coordinates and longitude, latitude and height on WGS 84.

    This class handles geocentric databases itself. The plugin `osgdb_geofxdata` handles projected ones, because it
    has the projections. So a program that only draws needs no GDAL. Angles are radians, lengths metres; heights are
    above the database's zero height. Thread-safe: all methods may be called from any thread.

    @ingroup paging */
class OSGGEOFX_EXPORT Georeference : public osg::Object
{
public:
    /// The georeference of the first CoordinateSystemNode at or below `node`. Null, with the reason in `error`, if
    /// there is none, if its coordinate system cannot be used, or if the plugin cannot be found.
    static osg::ref_ptr<Georeference> create(const osg::Node* node, std::string& error);

    /// Whether world coordinates are geocentric; otherwise they are projected with z up.
    virtual bool isGeocentric() const = 0;

    /// The world position of a longitude and latitude (radians) and a height (metres). False outside the projection.
    virtual bool toWorld(double longitude, double latitude, double height, osg::Vec3d& world) const = 0;

    /// The longitude (−π…π) and latitude (radians) and the height (metres) of a world position. False outside the
    /// projection.
    virtual bool toGeodetic(const osg::Vec3d& world, double& longitude, double& latitude,
                            double& height) const = 0;

    /// The local frame at a place: x east, y north (true north), z up. `frame` is the matrix from this frame to the
    /// world. False outside the projection.
    virtual bool localToWorld(double longitude, double latitude, double height,
                              osg::Matrixd& frame) const = 0;

protected:
    Georeference() = default;
    Georeference(const Georeference& other, const osg::CopyOp& op) : osg::Object(other, op) {}
    ~Georeference() override = default;
};

} // namespace osgGeoFX
