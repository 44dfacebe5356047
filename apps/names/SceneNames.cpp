// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "names/SceneNames.h"

#include <osgGeoFX/map/MapReader.h>
#include <osgGeoFX/map/SourceFiles.h>

#include <CLI/CLI.hpp>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>

#include <filesystem>
#include <stdexcept>

namespace geofx::names
{

namespace
{

using Fault = std::runtime_error;

std::string faultOf(const Options& options, bool names, bool lines)
{
    if (!names && !lines && !(options.svg + options.geoJson).empty())
        return "--svg and --geojson are for names and lines; give some with --labels or --lines.";
    if (!names && !options.field.empty()) return "--label-field is for names; give some with --labels.";
    if (!names && !options.font.empty()) return "--font is for names; give some with --labels.";
    if (!names && !lines && !options.style.empty())
        return "--style is for names and lines; give some with --labels or --lines.";
    return {};
}

} // namespace

std::pair<std::string, std::string> fileAndLayer(const std::string& text)
{
    const std::size_t colon = text.rfind(':');
    if (!osgDB::fileExists(text) && colon != std::string::npos && osgDB::fileExists(text.substr(0, colon)))
        return {text.substr(0, colon), text.substr(colon + 1)};
    return {text, {}};
}

std::string faultOf(const Options& options, const std::string& scene)
{
    // Terrain may take minutes to build, so a slip in the style file is told before.
    osgGeoFX::MapStyles styles;
    std::string error;
    if (!options.style.empty() && !styles.read(options.style, error)) return error;
    // Such a file may have names and lines.
    if (osgDB::getLowerCaseFileExtension(scene) == "geofx") return {};
    return faultOf(options, !options.files.empty(), !options.lines.empty());
}

void addOptions(CLI::App& app, Options& options)
{
    app.add_option("--labels", options.files,
                   "Names to put onto the picture: vector data of any kind that GDAL reads, FILE or "
                   "FILE:LAYER. As often as "
                   "wanted")
        ->expected(1)
        ->allow_extra_args(false)
        ->type_name("FILE")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--label-field", options.field,
                   "The field, or tag of OpenStreetMap, that has the names (default: name, label or title)")
        ->type_name("FIELD");
    app.add_option(
           "--lines", options.lines,
           "Lines to put onto the ground, such as roads, lifts and rivers: vector data of any kind that "
           "GDAL reads, FILE or FILE:LAYER. As often as wanted")
        ->expected(1)
        ->allow_extra_args(false)
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

osgGeoFX::InputFiles makeInputFiles()
{
    return osgGeoFX::InputFiles(
        [](const std::string& file)
        {
            osgGeoFX::SourceFiles sources;
            sources.file = file;
            std::string ignored; // without the plugin GDAL's files cannot be read either
            sources.read(ignored);
            return sources.files;
        });
}

void addInputs(const Options& options, osgGeoFX::InputFiles& inputs)
{
    for (const auto* const files : {&options.files, &options.lines})
        for (const std::string& file : *files)
            inputs.add(file);
    inputs.add(options.style);
    inputs.add(options.font);
}

void claimOutputs(const Options& options, osgGeoFX::InputFiles& inputs)
{
    if (!options.svg.empty()) inputs.claim("The SVG file", options.svg, "--svg");
    if (!options.geoJson.empty()) inputs.claim("The GeoJSON file", options.geoJson, "--geojson");
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
    if (!options.field.empty()) ages += "; by " + options.field;
    return ages + "; " + options.style + ageOf(options.style) + (options.svg.empty() ? "" : "; as vectors");
}

osgGeoFX::MapContents takeMap(const Options& options, const osgGeoFX::Scene& scene,
                              std::vector<std::string>& notices)
{
    osgGeoFX::MapContents map = osgGeoFX::MapContents::take(*scene.node);
    const std::string fault = faultOf(options, !(options.files.empty() && map.names.empty()),
                                      !(options.lines.empty() && map.lines.empty()));
    if (!fault.empty()) throw Fault(fault);
    std::string error;
    if (!options.style.empty() && !map.styles.read(options.style, error)) throw Fault(error);
    if (osgDB::fileExists(options.font))
    {
        if (!map.styles.preferFontFile(options.font, error)) throw Fault("--font: " + error);
    }
    else if (!options.font.empty())
        map.styles.preferFont(options.font);
    osgGeoFX::MapReader reader(*scene.node, *scene.effects);
    for (const std::string& each : options.files)
    {
        const auto [file, layer] = fileAndLayer(each);
        if (!reader.readNames(file, layer, options.field.empty() ? map.styles.nameField : options.field,
                              error))
            throw Fault(error);
    }
    for (const std::string& each : options.lines)
    {
        const auto [file, layer] = fileAndLayer(each);
        if (!reader.readLines(file, layer, map.styles.lineField, error)) throw Fault(error);
    }
    if (!reader.place(map, notices, error)) throw Fault(error);
    return map;
}

void showMap(const Options& options, osgGeoFX::Scene& scene, std::vector<std::string>& notices)
{
    scene.node = takeMap(options, scene, notices).addTo(*scene.effects, *scene.node);
}

} // namespace geofx::names
