// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/MapReader.h>

#include <osgGeoFX/labels/NameFile.h>
#include <osgGeoFX/labels/NamePlacement.h>
#include <osgGeoFX/lines/LineFile.h>
#include <osgGeoFX/lines/LinePlacement.h>
#include <osgGeoFX/map/detail/SceneCrs.h>

#include <iterator>

namespace osgGeoFX
{

namespace
{

/// Cells of the relief, along the longer side: where summits are looked for, and as long as the steps of lines on the ground.
constexpr int reliefCells = 2048;

template<class Thing>
void append(std::vector<Thing>& from, std::vector<Thing>& to)
{
    std::move(from.begin(), from.end(), std::back_inserter(to));
    from.clear();
}

} // namespace

MapReader::MapReader(osg::Node& node, EffectScene& scene)
    : _node(node), _scene(scene), _ellipsoid(scene.ground().ellipsoid)
{
    if (!_ellipsoid) _wkt = crsOfScene(node);
}

bool MapReader::readNames(const std::string& file, const std::string& layer, const std::string& nameField,
                          std::string& error)
{
    NameFile request;
    request.file = file;
    request.layer = layer;
    request.name = nameField;
    request.globe = _ellipsoid.valid();
    request.wkt = _wkt;
    if (!request.read(error)) return false;
    append(request.names, _names);
    return true;
}

bool MapReader::readLines(const std::string& file, const std::string& layer, const std::string& styleField,
                          std::string& error)
{
    LineFile request;
    request.file = file;
    request.layer = layer;
    request.style = styleField;
    request.globe = _ellipsoid.valid();
    request.wkt = _wkt;
    if (!request.read(error)) return false;
    append(request.lines, _lines);
    return true;
}

bool MapReader::place(MapContents& contents, std::vector<std::string>& notices, std::string& error)
{
    if (_names.empty() && _lines.empty()) return true;
    const auto relief = TerrainRelief::read(_node, _ellipsoid.get(), reliefCells, error);
    if (!relief) return false;
    return placeNames(contents, *relief, notices, error) && placeLines(contents, *relief, notices, error);
}

bool MapReader::placeNames(MapContents& contents, const TerrainRelief& relief,
                           std::vector<std::string>& notices, std::string& error)
{
    const std::string all = std::to_string(_names.size());
    if (_names.empty()) return true;
    const NamePlacement placement;
    const NamePlacement::Result result =
        placement.place(_names, *_scene.getTerrain(), _ellipsoid.get(), relief);
    if (_names.empty())
    {
        error = "All " + all + " names lie beside the terrain; check the file's coordinate reference system.";
        return false;
    }
    if (result.outside > 0)
        notices.push_back(std::to_string(result.outside) + " of " + all +
                          " names lie beside the terrain and are left out.");
    append(_names, contents.names);
    return true;
}

bool MapReader::placeLines(MapContents& contents, const TerrainRelief& relief,
                           std::vector<std::string>& notices, std::string& error)
{
    const std::string all = std::to_string(_lines.size());
    if (_lines.empty()) return true;
    const LinePlacement placement;
    const LinePlacement::Result result =
        placement.place(_lines, contents.styles.lines, *_scene.getTerrain(), _ellipsoid.get(), relief);
    if (_lines.empty() && result.outside > 0)
    {
        error = "All " + std::to_string(result.outside) +
                " lines lie beside the terrain; check the file's coordinate reference system.";
        return false;
    }
    if (result.outside > 0)
        notices.push_back(std::to_string(result.outside) + " of " + all +
                          " lines lie beside the terrain and are left out.");
    append(_lines, contents.lines);
    return true;
}

} // namespace osgGeoFX
