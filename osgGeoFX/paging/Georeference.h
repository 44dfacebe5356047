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

/** Relates a database's world coordinates to longitude, latitude and height on WGS 84.

    Geocentric databases are served here; projected ones by the plugin `osgdb_geofxdata`, which has the
    projections, so that a program that draws needs no GDAL. Angles are radians, lengths metres; heights are
    above the database's zero height. Thread-safe: all methods may be called from any thread. */
class OSGGEOFX_EXPORT Georeference : public osg::Object
{
public:
    /// The georeference of a database's root, or of the first CoordinateSystemNode below `node`.
    /// Null, with the reason in `error`, where there is none or where the plugin cannot be found.
    static osg::ref_ptr<Georeference> create(const osg::Node* node, std::string& error);

    virtual bool isGeocentric() const = 0;

    /// World position of a longitude and latitude (radians) and height (metres); false outside the projection.
    virtual bool toWorld(double longitude, double latitude, double height, osg::Vec3d& world) const = 0;

    /// Longitude (−π…π), latitude (radians) and height (metres) of a world position.
    virtual bool toGeodetic(const osg::Vec3d& world, double& longitude, double& latitude,
                            double& height) const = 0;

    /// Frame at a place: x east, y north (true north), z up; from the frame to the world. False outside the projection.
    virtual bool localToWorld(double longitude, double latitude, double height,
                              osg::Matrixd& frame) const = 0;

protected:
    Georeference() = default;
    Georeference(const Georeference& other, const osg::CopyOp& op) : osg::Object(other, op) {}
    ~Georeference() override = default;
};

} // namespace osgGeoFX
