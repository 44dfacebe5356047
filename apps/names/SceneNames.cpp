// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "names/SceneNames.h"

#include "names/StyleFile.h"

#include <osgGeoFX/labels/NameFile.h>
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <CLI/CLI.hpp>
#include <osg/Group>
#include <osgDB/FileUtils>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <stdexcept>
#include <tuple>

namespace geofx::names
{

namespace
{

/// Cells of the relief in which summits are looked for, along the longer side.
constexpr int reliefCells = 2048;

using Fault = std::runtime_error;

} // namespace

std::pair<std::string, std::string> fileAndLayer(const std::string& text)
{
    const std::size_t colon = text.rfind(':');
    if (!osgDB::fileExists(text) && colon != std::string::npos && osgDB::fileExists(text.substr(0, colon)))
        return {text.substr(0, colon), text.substr(colon + 1)};
    return {text, {}};
}

std::string wktOf(osg::Node& node)
{
    struct Finder : public osg::NodeVisitor
    {
        Finder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
        void apply(osg::CoordinateSystemNode& found) override { wkt = found.getCoordinateSystem(); }
        void apply(osg::LOD&) override {}
        std::string wkt;
    } finder;
    node.accept(finder);
    return finder.wkt;
}

std::string faultOf(const Options& options)
{
    if (options.files.empty() && options.lines.empty() && !(options.svg + options.geoJson).empty())
        return "--svg and --geojson are for names and lines; give some with --labels or --lines.";
    if (options.files.empty() && !options.font.empty())
        return "--font is for names; give some with --labels.";
    if (options.files.empty() && options.lines.empty() && !options.style.empty())
        return "--style is for names and lines; give some with --labels or --lines.";
    return {};
}

void addOptions(CLI::App& app, Options& options)
{
    app.add_option("--labels", options.files,
                   "Names to put onto the picture: vector data of any kind that GDAL reads, FILE or "
                   "FILE:LAYER. As often as "
                   "wanted")
        ->expected(1)
        ->type_name("FILE")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option(
           "--lines", options.lines,
           "Lines to put onto the ground, such as roads, lifts and rivers: vector data of any kind that "
           "GDAL reads, FILE or FILE:LAYER. As often as wanted")
        ->expected(1)
        ->type_name("FILE")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--style", options.style,
                   "How names and lines look: JSON such as {\"names\": {\"peak\": {\"size\": 16}}, "
                   "\"lines\": {\"river\": {\"width\": 2}}}")
        ->type_name("FILE.json");
    app.add_option("--font", options.font,
                   "The names' font: the families of installed ones, or a font's file")
        ->type_name("NAME|FILE");
    app.add_option(
           "--svg", options.svg,
           "Also write names and lines as an SVG file over the picture, which has none then; to finish by "
           "hand")
        ->type_name("FILE.svg");
    app.add_option(
           "--geojson", options.geoJson,
           "Also write names and lines in the picture's coordinates, pixels, as vector data for other "
           "programs")
        ->type_name("FILE.geojson");
}

std::string ageOf(const std::string& file)
{
    std::error_code fault;
    const auto time = std::filesystem::last_write_time(file, fault);
    return fault ? std::string() : " of " + std::to_string(time.time_since_epoch().count());
}

std::string agesOf(const Options& options)
{
    std::string ages;
    for (const auto* const files : {&options.files, &options.lines})
        for (const std::string& file : *files)
            ages += "; " + file + ageOf(fileAndLayer(file).first);
    return ages + "; " + options.style + ageOf(options.style) + (options.svg.empty() ? "" : "; as vectors");
}

osg::ref_ptr<osgGeoFX::NameSet> read(const Options& options, const osgGeoFX::Scene& scene,
                                     std::string& notice)
{
    std::map<std::string, osgGeoFX::NameStyle> styles = readStyles(options.style).names;
    std::string error;
    if (!options.font.empty())
    {
        const bool isFile = osgDB::fileExists(options.font);
        std::string families = options.font;
        if (isFile && !osgGeoFX::addFontFile(options.font, families, error)) throw Fault("--font: " + error);
        for (auto& [name, style] : styles)
            style.text.font = families + "," + style.text.font;
    }
    const osg::ref_ptr<const osg::EllipsoidModel> ellipsoid = scene.effects->ground().ellipsoid;
    std::vector<osgGeoFX::MapName> names;
    for (const std::string& each : options.files)
    {
        osgGeoFX::NameFile file;
        std::tie(file.file, file.layer) = fileAndLayer(each);
        file.globe = ellipsoid.valid();
        if (!file.globe) file.wkt = wktOf(*scene.node);
        if (!file.read(error)) throw Fault(error);
        std::move(file.names.begin(), file.names.end(), std::back_inserter(names));
    }
    const auto relief = osgGeoFX::TerrainRelief::read(*scene.node, ellipsoid.get(), reliefCells, error);
    if (!relief) throw Fault("--labels: " + error);
    const std::size_t all = names.size();
    const osgGeoFX::NamePlacement placement;
    const osgGeoFX::NamePlacement::Result result =
        placement.place(names, *scene.effects->getTerrain(), ellipsoid.get(), *relief);
    notice.clear();
    if (names.empty())
        throw Fault("--labels: all " + std::to_string(all) +
                    " names lie beside the terrain; check the file's coordinate reference system.");
    if (result.outside > 0)
        notice = std::to_string(result.outside) + " of " + std::to_string(all) +
                 " names lie beside the terrain and are left out.";
    const osg::ref_ptr<osgGeoFX::NameSet> set = new osgGeoFX::NameSet(std::move(names));
    for (const auto& [name, style] : styles)
        set->setStyle(name, style);
    return set;
}

} // namespace geofx::names
