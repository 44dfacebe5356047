// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "MappingsLoader.h"

#include <osgGeoFX/mapping/ColorRampFile.h>
#include <osgGeoFX/paging/Georeference.h>

#include <osg/ImageStream>
#include <osg/Math>
#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <exception>

namespace osgGeoFX
{

namespace
{

/// Thrown with the whole sentence; it does not leave this file.
struct Failure
{
    std::string sentence;
};

[[noreturn]] void fail(const ScenePlace& place, const std::string& text)
{
    throw Failure{place.message(text)};
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

void readTable(const SceneMappings::Table& table)
{
    std::string reason;
    const osg::ref_ptr<ColorTable> read = ColorRampFile::read(table.file.path, table.range, reason);
    if (!read) fail(table.file.place, reason);
    table.table->setStops(read->getStops());
    if (table.table->getNoDataColor() == osg::Vec4()) table.table->setNoDataColor(read->getNoDataColor());
}

/// Without a transfer of its own, a mapping shows its table, or its values from the lowest to the highest.
void setTransfer(ProjectiveMapping& mapping, double lowest, double highest)
{
    const osg::ref_ptr<ColorTransfer> transfer = new ColorTransfer;
    if (mapping.getTable())
    {
        transfer->setSource(ColorTransfer::TABLE);
        std::tie(lowest, highest) = mapping.getTable()->range();
    }
    constexpr double most = 9e7;
    lowest = std::clamp(lowest, -most, most);
    highest = std::clamp(highest, -most, most);
    if (lowest < highest) transfer->setValueRange(lowest, highest);
    mapping.setTransfer(transfer);
}

/// One effect and the terrain below it.
class Loader
{
public:
    Loader(const SceneMappings& mappings, const EffectScene& node, const osg::Node& terrain)
        : _mappings(mappings), _effect(*mappings.effect), _terrain(terrain),
          _ellipsoid(node.ground().ellipsoid), _hasOrigin(mappings.hasOrigin)
    {
    }

    void load()
    {
        for (const SceneMappings::Layer& layer : _mappings.layers)
            layer.layer->setImage(pictureOf(layer.file));
        for (const SceneMappings::Table& table : _mappings.tables)
            readTable(table);
        for (const SceneMapping& mapping : _mappings.mappings)
        {
            if (mapping.box)
                place(mapping, *mapping.box);
            else if (mapping.point)
                place(mapping, *mapping.point);
            else if (mapping.raster)
                place(mapping, *mapping.raster);
            if (!mapping.raster && !mapping.hasTransfer && mapping.mapping->getTable())
                setTransfer(*mapping.mapping, 0.0, 1.0);
            // The origin is the first mapping's, or nobody's.
            _hasOrigin = true;
        }
    }

private:
    osg::Vec3d worldOf(const ScenePlace& place, double longitude, double latitude)
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
            fail(place,
                 "the place lies outside the terrain's projection; correct its longitude and latitude.");
        return world;
    }

    osg::Vec2d placeOf(const ScenePlace& place, const osg::Vec3d& world) const
    {
        if (_ellipsoid)
        {
            const osg::Vec3d there = _ellipsoid->computeLocalUpVector(world.x(), world.y(), world.z());
            const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Z_AXIS, _effect.frameToWorld(_ellipsoid));
            // Where the frame's plane is seen from its edge, a place has no x and y to go by.
            constexpr double nearlyBeyond = 0.05;
            if (there * up < nearlyBeyond)
                fail(place, "it lies on the other side of the globe from the effect's origin; give "
                            "<projectiveMappings> its longitudeDegrees and latitudeDegrees near it.");
        }
        const osg::Vec3d result = _effect.placeOf(world, _ellipsoid);
        return {result.x(), result.y()};
    }

    void setOrigin(const osg::Vec2d& middle)
    {
        if (_hasOrigin) return;
        if (_ellipsoid)
            _effect.setGeodeticOrigin(std::remainder(osg::DegreesToRadians(middle.x()), 2.0 * osg::PI),
                                      osg::DegreesToRadians(middle.y()));
        else
            _effect.setOrigin(middle);
    }

    void place(const SceneMapping& mapping, SceneMapping::Box box)
    {
        if (_ellipsoid)
        {
            const double furthest = std::max(std::abs(box.west), std::abs(box.east));
            if (furthest > 360.0 || box.south < -90.0 || box.north > 90.0)
                fail(mapping.place,
                     "the terrain is a globe, and west, south, east and north are degrees; write "
                     "longitudes from -180 to 180 and latitudes from -90 to 90.");
            if (box.east < box.west) box.east += 360.0;
        }
        else if (box.east < box.west)
        {
            fail(mapping.place, "west must be less than east.");
        }
        setOrigin({(box.west + box.east) / 2.0, (box.south + box.north) / 2.0});
        const osg::Vec2d edges[4] = {
            {box.west, box.south}, {box.east, box.south}, {box.east, box.north}, {box.west, box.north}};
        osg::Vec2d corners[4];
        for (int i = 0; i < 4; ++i)
        {
            const osg::Vec3d world =
                _ellipsoid ? worldOf(mapping.place, edges[i].x(), edges[i].y()) : osg::Vec3d(edges[i], 0.0);
            corners[i] = placeOf(mapping.place, world);
        }
        if (!mapping.mapping->setQuad(corners))
            fail(mapping.place,
                 "its corners span no quadrilateral on the ground; keep its edges apart, and off "
                 "the poles.");
    }

    void place(const SceneMapping& mapping, const SceneMapping::Point& point)
    {
        const osg::Vec3d world = worldOf(mapping.place, point.longitude, point.latitude);
        setOrigin(_ellipsoid ? osg::Vec2d(point.longitude, point.latitude)
                             : osg::Vec2d(world.x(), world.y()));
        mapping.mapping->setCentre(placeOf(mapping.place, world));
    }

    void place(const SceneMapping& mapping, const SceneMapping::Raster& raster)
    {
        MappingRasterRequest request;
        request.file = raster.file.path;
        request.options.kind = raster.kind;
        request.options.maxSide = raster.maxSide;
        request.hasOrigin = _hasOrigin;
        request.frame.globe = _ellipsoid.valid();
        request.frame.longitude = _effect.getLongitude();
        request.frame.latitude = _effect.getLatitude();
        request.frame.origin = _effect.getOrigin();
        if (!_ellipsoid) request.frame.wkt = wktOfTerrain();
        ask(mapping.place, request);
        if (_ellipsoid)
            _effect.setGeodeticOrigin(request.frame.longitude, request.frame.latitude);
        else
            _effect.setOrigin(request.frame.origin);
        if (!request.raster.apply(*mapping.mapping))
            fail(mapping.place, "the raster covers no area on the ground; check it with gdalinfo.");
        const bool plainColors =
            request.raster.layer->getKind() == DataLayer::COLOR && !mapping.mapping->getTable();
        if (!mapping.hasTransfer && !plainColors)
            setTransfer(*mapping.mapping, request.raster.lowest, request.raster.highest);
    }

    std::string wktOfTerrain() const
    {
        class Finder : public osg::NodeVisitor
        {
        public:
            Finder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
            void apply(osg::CoordinateSystemNode& node) override { wkt = node.getCoordinateSystem(); }
            std::string wkt;
        };
        Finder finder;
        const_cast<osg::Node&>(_terrain).accept(finder);
        return finder.wkt;
    }

    static void ask(const ScenePlace& place, MappingRasterRequest& request)
    {
        osgDB::ReaderWriter* data = osgDB::Registry::instance()->getReaderWriterForExtension("geofxdata");
        if (!data)
            fail(place,
                 "rasters are brought to their places by the OSG plugin osgdb_geofxdata, which was not found "
                 "or "
                 "lacks its libraries (GDAL); put its folder on OSG_LIBRARY_PATH, or use a <layer> with a "
                 "<mapping>.");
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
        options->setPluginStringData("version", GEOFX_VERSION);
        options->setPluginData("request", &request);
        const osgDB::ReaderWriter::ReadResult result = data->readObject("mappingRaster", options);
        if (!request.raster.layer) fail(place, result.message());
    }

    const SceneMappings& _mappings;
    ProjectiveMappings& _effect;
    const osg::Node& _terrain;
    osg::ref_ptr<const osg::EllipsoidModel> _ellipsoid;
    osg::ref_ptr<Georeference> _reference;
    bool _hasOrigin;
};

} // namespace

bool loadMappings(const SceneFile& scene, const EffectScene& node, const osg::Node& terrain,
                  std::string& error)
{
    try
    {
        for (const SceneMappings& mappings : scene.mappings)
            Loader(mappings, node, terrain).load();
        return true;
    }
    catch (const Failure& failure)
    {
        error = failure.sentence;
        return false;
    }
}

} // namespace osgGeoFX
