// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SceneLoading.h"

#include <osgGeoFX/mapping/ColorRampFile.h>

#include <osg/CoordinateSystemNode>
#include <osg/ImageStream>
#include <osg/Math>
#include <osg/NodeVisitor>
#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <exception>

namespace osgGeoFX
{

namespace
{

std::string wktOf(const osg::Node& terrain)
{
    class Finder : public osg::NodeVisitor
    {
    public:
        Finder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
        void apply(osg::CoordinateSystemNode& node) override { wkt = node.getCoordinateSystem(); }
        std::string wkt;
    };
    Finder finder;
    const_cast<osg::Node&>(terrain).accept(finder);
    return finder.wkt;
}

} // namespace

void fail(const ScenePlace& place, const std::string& text)
{
    throw SceneFailure{place.message(text)};
}

osg::ref_ptr<osg::Image> pictureOf(const ScenePath& file)
{
    std::string reason;
    try
    {
        osgDB::ReaderWriter::ReadResult result = osgDB::Registry::instance()->readImage(file.path, nullptr);
        osg::ref_ptr<osg::Image> image = result.getImage();
        // A film has no pixels before it plays.
        if (image && (image->valid() || dynamic_cast<osg::ImageStream*>(image.get()))) return image;
        reason = image ? "it holds no pixels" : result.statusMessage();
    }
    catch (const std::exception& exception)
    {
        reason = exception.what();
    }
    fail(file.place, "the picture \"" + file.path + "\" cannot be read (" + reason +
                         "); convert it to PNG, or put the folder of OSG's plugin for it on "
                         "OSG_LIBRARY_PATH.");
}

void readTable(const SceneTable& table)
{
    std::string reason;
    const osg::ref_ptr<ColorTable> read = ColorRampFile::read(table.file.path, table.range, reason);
    if (!read) fail(table.file.place, reason);
    table.table->setStops(read->getStops());
    if (table.table->getNoDataColor() == osg::Vec4()) table.table->setNoDataColor(read->getNoDataColor());
}

osg::Vec3d SceneTerrain::worldOf(const ScenePlace& place, double longitude, double latitude)
{
    osg::Vec3d world;
    const double x = osg::DegreesToRadians(longitude);
    const double y = osg::DegreesToRadians(latitude);
    if (_ellipsoid)
    {
        _ellipsoid->convertLatLongHeightToXYZ(y, x, 0.0, world.x(), world.y(), world.z());
        return world;
    }
    std::string reason;
    if (!_reference) _reference = Georeference::create(&_terrain, reason);
    if (!_reference) fail(place, reason);
    if (!_reference->toWorld(x, y, 0.0, world))
        fail(place, "the place lies outside the terrain's projection; correct its longitude and latitude.");
    return world;
}

void SceneTerrain::straighten(const ScenePlace& place, SceneBox& box) const
{
    if (_ellipsoid)
    {
        const double furthest = std::max(std::abs(box.west), std::abs(box.east));
        if (furthest > 360.0 || box.south < -90.0 || box.north > 90.0)
            fail(place, "the terrain is a globe, and west, south, east and north are degrees; write "
                        "longitudes from -180 to 180 and latitudes from -90 to 90.");
        if (box.east < box.west) box.east += 360.0;
    }
    else if (box.east < box.west)
    {
        fail(place, "west must be less than east.");
    }
}

osg::Vec3d SceneTerrain::worldOfMap(const ScenePlace& place, const osg::Vec2d& point)
{
    return _ellipsoid ? worldOf(place, point.x(), point.y()) : osg::Vec3d(point, 0.0);
}

MappingFrame SceneTerrain::frame() const
{
    MappingFrame result;
    result.globe = _ellipsoid.valid();
    if (!_ellipsoid) result.wkt = wktOf(_terrain);
    return result;
}

std::string SceneTerrain::ask(const ScenePlace& place, const std::string& service, void* request,
                              const std::string& instead)
{
    osgDB::ReaderWriter* data = osgDB::Registry::instance()->getReaderWriterForExtension("geofxdata");
    if (!data)
        fail(place,
             "rasters are brought to their places by the OSG plugin osgdb_geofxdata, which was not found or "
             "lacks its libraries (GDAL); put its folder on OSG_LIBRARY_PATH, or " +
                 instead + ".");
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setPluginStringData("version", GEOFX_VERSION);
    options->setPluginData("request", request);
    const osgDB::ReaderWriter::ReadResult result = data->readObject(service, options);
    return result.success() ? std::string() : result.message();
}

} // namespace osgGeoFX
