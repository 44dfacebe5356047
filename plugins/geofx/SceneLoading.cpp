// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SceneLoading.h"

#include "MappingsLoader.h"

#include <osgGeoFX/geodata/OverlayReader.h>
#include <osgGeoFX/paging/FilesByOthers.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/raster/ColorRampFile.h>

#include <osg/CoordinateSystemNode>
#include <osg/ImageStream>
#include <osg/Math>
#include <osg/NodeVisitor>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <exception>
#include <locale>
#include <sstream>

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

/// By the file's name, as OSG does.
osg::ref_ptr<osg::Image> readByName(const std::string& file, std::string& reason)
{
    try
    {
        osgDB::ReaderWriter::ReadResult result = osgDB::Registry::instance()->readImage(file, nullptr);
        osg::ref_ptr<osg::Image> image = result.getImage();
        // A film has no pixels before it plays.
        if (image && (image->valid() || dynamic_cast<osg::ImageStream*>(image.get()))) return image;
        reason = image ? "it holds no pixels" : result.statusMessage();
    }
    catch (const std::exception& exception)
    {
        reason = exception.what();
    }
    return nullptr;
}

/// All that a scene by others unpacks, bytes.
constexpr double mostBytes = 512.0 * 1024.0 * 1024.0;

const char* const tooMany = "the scene's pictures take more than 512 MiB together when they are unpacked; "
                            "name fewer or smaller ones; or, if you trust the scene, start the program with "
                            "--allow-outside, or give OSG the option string \"allowOutside\".";

osg::ref_ptr<osg::Image> rasterOf(const ScenePath& file, DataLayer::Kind kind, int maxSide,
                                  std::string& reason)
{
    PictureRequest request;
    request.file = file.path;
    request.kind = kind;
    request.maxSide = maxSide;
    const std::optional<std::string> fault = SceneTerrain::askIfAny("picture", &request);
    reason = fault.value_or("");
    if (!request.done) return nullptr;
    if (std::max(request.width, request.height) > maxSide)
        warn(file.place, "the picture \"" + file.path + "\" has " + std::to_string(request.width) + " × " +
                             std::to_string(request.height) + " texels, and is reduced to " +
                             std::to_string(maxSide) + ".");
    return request.image;
}

} // namespace

void fail(const ScenePlace& place, const std::string& text)
{
    throw SceneFailure{place.message(text)};
}

void warn(const ScenePlace& place, const std::string& text)
{
    OSG_WARN << "osgGeoFX: " << place.message(text) << std::endl;
}

osg::ref_ptr<osg::Image> SceneTerrain::pictureOf(const ScenePath& file, DataLayer::Kind kind, int maxSide)
{
    const auto [known, isNew] =
        _pictures.emplace(std::make_tuple(osgDB::getRealPath(file.path), kind, maxSide), nullptr);
    if (isNew) known->second = readPicture(file, kind, maxSide);
    return known->second;
}

double SceneTerrain::texelsLeft() const
{
    return _anywhere ? OverlayReader::Options().maxTexels : std::max(0.0, mostBytes - _pictureBytes) / 4.0;
}

int SceneTerrain::sideWithin(const ScenePath& file, int maxSide, double bytes) const
{
    if (_anywhere) return maxSide;
    const int side = static_cast<int>(std::sqrt(4.0 * texelsLeft() / bytes));
    if (side >= maxSide) return maxSide;
    if (side < 1) fail(file.place, tooMany);
    warn(file.place, "\"" + file.path + "\" has no more than " + std::to_string(side) +
                         " texels along a side, since the scene's pictures take up to 512 MiB together; name "
                         "fewer or smaller "
                         "ones.");
    return side;
}

void SceneTerrain::count(const osg::Image* image)
{
    if (image && _counted.insert(image).second) _pictureBytes += image->getTotalSizeInBytes();
}

osg::ref_ptr<osg::Image> SceneTerrain::readPicture(const ScenePath& file, DataLayer::Kind kind, int maxSide)
{
    PictureRequest look;
    look.file = file.path;
    look.look = true;
    askIfAny("picture", &look);
    // OSG's readers take all of it, and are not asked for more than 256 MiB.
    constexpr double mostPixels = 8192.0 * 8192.0;
    const double pixels = static_cast<double>(look.width) * static_cast<double>(look.height);
    const bool isHuge = pixels > mostPixels;
    if (!_anywhere && pixels > 0.0)
    {
        const double shrink = std::sqrt(texelsLeft() / pixels);
        maxSide = std::min(maxSide, static_cast<int>(shrink * std::max(look.width, look.height)));
    }
    if (maxSide < 1) fail(file.place, tooMany);
    std::string reason;
    std::string rasterReason;
    osg::ref_ptr<osg::Image> image;
    // OSG's reader of TIFF knows no tiles, and says so at length.
    const std::string extension = osgDB::getLowerCaseFileExtension(file.path);
    const bool isTiff = extension == "tif" || extension == "tiff";
    const bool isReduced = std::max(look.width, look.height) > maxSide;
    if (kind != DataLayer::COLOR || isHuge || isTiff || isReduced)
        image = rasterOf(file, kind, maxSide, rasterReason);
    if (!image && !isHuge)
        image = _anywhere ? readByName(file.path, reason) : FilesByOthers::readPicture(file.path, reason);
    if (!image && rasterReason.empty()) image = rasterOf(file, kind, maxSide, rasterReason);
    if (image)
    {
        count(image);
        if (!_anywhere && _pictureBytes > mostBytes) fail(file.place, tooMany);
        return image;
    }
    if (!rasterReason.empty()) reason += (reason.empty() ? "" : "; ") + rasterReason;
    fail(file.place,
         "the picture \"" + file.path + "\" cannot be read (" + reason +
             "); convert it to PNG, or to GeoTIFF with gdal_translate" +
             (_anywhere ? ", or put the folder of OSG's plugin for it on OSG_LIBRARY_PATH."
                        : "; or, if you trust the scene, start the program with --allow-outside."));
}

void readTable(const SceneTable& table)
{
    std::string reason;
    osg::ref_ptr<ColorTable> read;
    if (osgDB::getLowerCaseFileExtension(table.file.path) == "sld")
    {
        ColorsRequest request;
        request.file = table.file.path;
        reason =
            SceneTerrain::ask(table.file.place, "colors", &request, "write the colors as <stop> elements");
        read = request.table;
        // What the file says of them is part of their meaning.
        if (read) table.table->setMode(read->getMode());
    }
    else
        read = ColorRampFile::read(table.file.path, table.range, reason);
    if (!read) fail(table.file.place, reason);
    if (read->getMode() != ColorTable::LINEAR) table.table->setMode(read->getMode());
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

void SceneTerrain::warnIfOff(const ScenePlace& place, const osg::Vec2d& point, double reach)
{
    std::string reason;
    const std::optional<TerrainInfo> info = TerrainInfo::read(&_terrain, reason);
    if (!info || info->geocentric != _ellipsoid.valid())
    {
        const osg::BoundingSphere& bound = _terrain.getBound();
        osg::Vec3d away = worldOfMap(place, point) - osg::Vec3d(bound.center());
        if (!_ellipsoid) away.z() = 0.0;
        if (bound.valid() && away.length() > static_cast<double>(bound.radius()) + reach)
            warn(place, "the region lies off the terrain, and nothing is seen of it; correct its place.");
        return;
    }
    const osg::Vec2d half((info->east - info->west) / 2.0, (info->north - info->south) / 2.0);
    osg::Vec2d away = point - osg::Vec2d(info->west, info->south) - half;
    if (_ellipsoid) away.x() = std::remainder(away.x(), 360.0);
    osg::Vec2d beyond(std::max(0.0, std::abs(away.x()) - half.x()),
                      std::max(0.0, std::abs(away.y()) - half.y()));
    if (_ellipsoid)
    {
        const double metres = osg::DegreesToRadians(_ellipsoid->getRadiusEquator());
        beyond.set(beyond.x() * metres * std::cos(osg::DegreesToRadians(point.y())), beyond.y() * metres);
    }
    if (beyond.length() <= reach) return;
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(10);
    text << "the region lies off the terrain, and nothing is seen of it; correct its place: the terrain "
            "reaches "
         << (_ellipsoid ? "from longitude " : "from x = ") << info->west << " to " << info->east
         << (_ellipsoid ? " and from latitude " : " and from y = ") << info->south << " to " << info->north
         << ".";
    warn(place, text.str());
}

osg::Vec3d SceneTerrain::worldOfMap(const ScenePlace& place, const osg::Vec2d& point)
{
    return _ellipsoid ? worldOf(place, point.x(), point.y()) : osg::Vec3d(point, 0.0);
}

LocalOrigin SceneTerrain::originAt(const osg::Vec2d& point) const
{
    return _ellipsoid
               ? LocalOrigin::onGlobe(osg::DegreesToRadians(point.x()), osg::DegreesToRadians(point.y()))
               : LocalOrigin::onPlane(point);
}

osg::ref_ptr<Georeference> SceneTerrain::reference(std::string& error)
{
    // The terrain itself may lie below a node that says so.
    if (!_reference) _reference = Georeference::create(&_terrain, error);
    return _reference;
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
    if (const std::optional<std::string> answer = askIfAny(service, request)) return *answer;
    fail(place,
         "rasters are brought to their places by the OSG plugin osgdb_geofxdata, which was not found or "
         "lacks its libraries (GDAL); put its folder on OSG_LIBRARY_PATH, or " +
             instead + ".");
}

std::optional<std::string> SceneTerrain::askIfAny(const std::string& service, void* request,
                                                  const std::string& plugin)
{
    osgDB::ReaderWriter* data = osgDB::Registry::instance()->getReaderWriterForExtension(plugin);
    if (!data) return std::nullopt;
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setPluginStringData("version", GEOFX_VERSION);
    options->setPluginData("request", request);
    const osgDB::ReaderWriter::ReadResult result = data->readObject(service, options);
    return result.success() ? std::string() : result.message();
}

} // namespace osgGeoFX
