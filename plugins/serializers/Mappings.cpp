// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Wrappers of the mappings and of what they are made of.
#include "LayerRequests.h"
#include "Wrappers.h"

#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/mapping/RouteMapping.h>

#include <osg/Notify>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

void addPicture(osgDB::ObjectWrapper& wrapper)
{
    addImage<DataLayer, &DataLayer::getImage, &DataLayer::setImage>(wrapper, "Image");
}

void addMappingParts(osgDB::ObjectWrapper& wrapper)
{
    using Self = ProjectiveMapping;
    addPart<Self, DataLayer, &Self::getLayer, &Self::setLayer>(wrapper, "Layer");
    addPart<Self, DataLayer, &Self::getMask, &Self::setMask>(wrapper, "Mask");
    addPart<Self, ColorTable, &Self::getTable, &Self::setTable>(wrapper, "Table");
    addPart<Self, ColorTransfer, &Self::getTransfer, &Self::setTransfer>(wrapper, "Transfer");
}

/// Those that name a file.
std::vector<const PagedRaster*> rastersOf(const ProjectiveMappings& mappings)
{
    std::vector<const PagedRaster*> rasters;
    for (unsigned int i = 0; i < mappings.getNumRasters(); ++i)
        if (mappings.getRaster(i)->tiles().source()) rasters.push_back(mappings.getRaster(i));
    return rasters;
}

bool hasRasters(const ProjectiveMappings& mappings)
{
    return !rastersOf(mappings).empty();
}

/// A mapping is one of those before, or one of its own in a file that somebody has changed. In XML, nothing but objects may
/// follow an object.
bool readRasters(osgDB::InputStream& stream, ProjectiveMappings& mappings)
{
    unsigned int count = 0;
    stream >> count >> stream.BEGIN_BRACKET;
    std::vector<std::pair<PagedRaster::Options, LayerTilesRequest>> heads;
    for (unsigned int i = 0; i < count && !stream.getException(); ++i)
    {
        PagedRaster::Options options;
        stream >> options.megabytes >> options.threads >> options.tilesPerFrame;
        heads.emplace_back(options, LayerTilesRequest{readSource(stream), nullptr});
    }
    for (auto& [options, request] : heads)
    {
        if (stream.getException()) break;
        const osg::ref_ptr<ProjectiveMapping> mapping = stream.readObjectOfType<ProjectiveMapping>();
        if (stream.getException()) break;
        std::string error;
        osg::ref_ptr<PagedRaster> raster;
        if (askForLayer("layerTiles", &request, error))
            raster = PagedRaster::create(request.tiles, options, error, mapping);
        if (raster)
            mappings.addRaster(raster);
        else
            OSG_WARN << "osgGeoFX: A raster of a file stays coarse: " << error << std::endl;
    }
    stream >> stream.END_BRACKET;
    return true;
}

bool writeRasters(osgDB::OutputStream& stream, const ProjectiveMappings& mappings)
{
    const std::vector<const PagedRaster*> rasters = rastersOf(mappings);
    stream << static_cast<unsigned int>(rasters.size()) << stream.BEGIN_BRACKET << std::endl;
    for (const PagedRaster* const raster : rasters)
    {
        const PagedRaster::Options& options = raster->getOptions();
        stream << options.megabytes << options.threads << options.tilesPerFrame;
        writeSource(stream, *raster->tiles().source());
    }
    for (const PagedRaster* const raster : rasters)
        stream.writeObject(raster->getMapping());
    stream << stream.END_BRACKET << std::endl;
    return true;
}

/// The places of the line, with 1 where they are way points, and then these in degrees.
bool writeWay(osgDB::OutputStream& stream, const RouteMapping& route)
{
    const RouteMapping::Way& way = route.getWay();
    stream << static_cast<unsigned int>(way.line.size()) << static_cast<unsigned int>(way.degrees.size())
           << stream.BEGIN_BRACKET << std::endl;
    for (std::size_t i = 0; i < way.line.size(); ++i)
    {
        const bool marked = std::binary_search(way.wayPoints.begin(), way.wayPoints.end(), i);
        stream << exactText(way.line[i].x()) << exactText(way.line[i].y()) << exactText(marked ? 1.0 : 0.0)
               << std::endl;
    }
    for (const osg::Vec2d& place : way.degrees)
        stream << exactText(place.x()) << exactText(place.y()) << std::endl;
    stream << stream.END_BRACKET << std::endl;
    return true;
}

bool readWay(osgDB::InputStream& stream, RouteMapping& route)
{
    constexpr const char* self = "RouteMapping";
    RouteMapping::Way way;
    unsigned int lineCount = 0, degreesCount = 0;
    stream >> lineCount >> degreesCount >> stream.BEGIN_BRACKET;
    const auto readPlace = [&]
    {
        const double x = readNumber(stream, self);
        return osg::Vec2d(x, readNumber(stream, self));
    };
    for (unsigned int i = 0; i < lineCount && !stream.getException(); ++i)
    {
        way.line.push_back(readPlace());
        if (readNumber(stream, self) > 0.0) way.wayPoints.push_back(i);
    }
    for (unsigned int i = 0; i < degreesCount && !stream.getException(); ++i)
        way.degrees.push_back(readPlace());
    stream >> stream.END_BRACKET;
    // A refusal has its own warning, and the rest of the file is fine.
    if (!stream.getException()) route.setWay(way);
    return true;
}

void addRouteParts(osgDB::ObjectWrapper& wrapper)
{
    using Self = RouteMapping;
    addOwn<Self>(
        wrapper, "Way", [](const Self& route) { return !route.getWay().line.empty(); }, &readWay, &writeWay);
    addPart<Self, DataLayer, &Self::getPointLayer, &Self::setPointLayer>(wrapper, "PointLayer");
}

void addMappings(osgDB::ObjectWrapper& wrapper)
{
    using Self = ProjectiveMappings;
    addParts<Self, ProjectiveMapping, &Self::getNumMappings, &Self::getMapping, &Self::addMapping>(
        wrapper, "Mappings");
    addOwn<Self>(wrapper, "Rasters", &hasRasters, &readRasters, &writeRasters);
    addParts<Self, RouteMapping, &Self::getNumRoutes, &Self::getRoute, &Self::addRoute>(wrapper, "Routes");
}

constexpr const char* tableModes[] = {"LINEAR", "NEAREST", "EXACT", "STEPS"};

void writeColor(osgDB::OutputStream& stream, const osg::Vec4& color)
{
    for (int i = 0; i < 4; ++i)
        stream << exactText(static_cast<double>(color[i]));
}

osg::Vec4 readColor(osgDB::InputStream& stream)
{
    osg::Vec4 color;
    for (int i = 0; i < 4; ++i)
        color[i] = static_cast<float>(readNumber(stream, "ColorTable"));
    return color;
}

bool readTable(osgDB::InputStream& stream, ColorTable& table)
{
    std::string mode;
    unsigned int count = 0;
    stream >> mode;
    const auto* end = std::end(tableModes);
    const auto* found = std::find(std::begin(tableModes), end, mode);
    if (found != end)
        table.setMode(static_cast<ColorTable::Mode>(found - std::begin(tableModes)));
    else
        OSG_WARN << "osgGeoFX: A file is wrong: ColorTable: the mode must be LINEAR, NEAREST, EXACT or "
                    "STEPS, not \""
                 << mode << "\". The default stays." << std::endl;
    table.setNoDataColor(readColor(stream));
    stream >> count >> stream.BEGIN_BRACKET;
    ColorTable::Stops stops;
    for (unsigned int i = 0; i < count && !stream.getException(); ++i)
    {
        const double value = readNumber(stream, "ColorTable");
        stops.push_back({value, readColor(stream)});
    }
    stream >> stream.END_BRACKET;
    // A refusal has its own warning, and the rest of the file is fine.
    table.setStops(stops);
    return true;
}

bool writeTable(osgDB::OutputStream& stream, const ColorTable& table)
{
    stream << std::string(tableModes[table.getMode()]);
    writeColor(stream, table.getNoDataColor());
    stream << static_cast<unsigned int>(table.getStops().size()) << stream.BEGIN_BRACKET << std::endl;
    for (const ColorTable::Stop& stop : table.getStops())
    {
        stream << exactText(stop.value);
        writeColor(stream, stop.color);
        stream << std::endl;
    }
    stream << stream.END_BRACKET << std::endl;
    return true;
}

/// A table has no properties: it is a list.
class TableWrapper : public osgDB::RegisterCustomWrapperProxy
{
public:
    TableWrapper()
        : osgDB::RegisterCustomWrapperProxy([]() -> osg::Object* { return new ColorTable; }, serializerDomain,
                                            "osgGeoFX::ColorTable", "osg::Object osgGeoFX::ColorTable", &add)
    {
    }

private:
    static void add(const char*, osgDB::ObjectWrapper* wrapper)
    {
        addOwn<ColorTable>(
            *wrapper, "Stops", [](const ColorTable&) { return true; }, &readTable, &writeTable);
    }
};

const TableWrapper tableWrapper;
const Wrapper<DataLayer, addPicture> layerWrapper("osgGeoFX::DataLayer", "osg::Object osgGeoFX::DataLayer");
const Wrapper<LayerClock> clockWrapper("osgGeoFX::LayerClock", "osg::Object osgGeoFX::LayerClock");
const Wrapper<ColorTransfer> transferWrapper("osgGeoFX::ColorTransfer",
                                             "osg::Object osgGeoFX::ColorTransfer");
const Wrapper<RouteMapping, addRouteParts> routeWrapper("osgGeoFX::RouteMapping",
                                                        "osg::Object osgGeoFX::RouteMapping");
const Wrapper<ProjectiveMapping, addMappingParts> mappingWrapper("osgGeoFX::ProjectiveMapping",
                                                                 "osg::Object osgGeoFX::ProjectiveMapping");
const Wrapper<ProjectiveMappings, addMappings>
    mappingsWrapper("osgGeoFX::ProjectiveMappings",
                    "osg::Object osgGeoFX::Effect osgGeoFX::ProjectiveMappings");

} // namespace

} // namespace osgGeoFX
