// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "names/SceneMappings.h"

#include "names/SceneNames.h"

#include <osgGeoFX/map/SceneOverlays.h>
#include <osgGeoFX/map/SceneRoutes.h>
#include <osgGeoFX/map/SceneSequences.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <tuple>

namespace geofx::mappings
{

void addOptions(CLI::App& app, Options& options)
{
    app.add_option("--mapping", options.files,
                   "What to put onto the ground: KML or KMZ with ground overlays, any raster with a "
                   "georeference, or the areas, lines and points of any vector data that GDAL reads; FILE or "
                   "FILE:LAYER. As often as wanted, the later ones on top")
        ->expected(1)
        ->allow_extra_args(false)
        ->type_name("FILE")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--sequence", options.sequences,
                   "Rasters in time to put onto the ground: the time of NetCDF, GRIB or Zarr, the bands of a "
                   "raster, or a "
                   "folder of rasters; FILE, FILE:VARIABLE, FILE:VARIABLE[DIMENSION=VALUE] or FOLDER. As "
                   "often as wanted")
        ->expected(1)
        ->allow_extra_args(false)
        ->type_name("FILE")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option(
           "--route", options.routes,
           "A way to put onto the ground: the routes and tracks of GPX, the lines and tracks of KML or KMZ, "
           "the lines of any other vector data that GDAL reads; FILE or FILE:LAYER. As often as wanted")
        ->expected(1)
        ->allow_extra_args(false)
        ->type_name("FILE")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--route-width", options.routeWidth,
                   "Width of the ways' lines, metres (default: by their extent)")
        ->type_name("M")
        ->check(CLI::PositiveNumber);
    app.add_option("--mapping-style", options.style,
                   "How the vector data of --mapping look: an SLD file, as QGIS and GeoServer write them "
                   "(default: NAME.sld beside NAME.EXT, or the file's own styles, or plain colors)")
        ->type_name("FILE");
    app.add_option("--colors", options.colors,
                   "The colors of values that --mapping and --sequence show: a color table of gdaldem "
                   "color-relief, GMT (.cpt) or "
                   "SLD (default: greys)")
        ->type_name("FILE");
    app.add_option(
           "--stretch", options.stretch,
           "Of pictures with more than 8 bits that --mapping and --sequence show, and of others where it is "
           "given: the numbers that become black and white (default: 2 to 98 % of them, or the whole range "
           "where they fill half of it)")
        ->type_name("LOW,HIGH");
}

namespace
{

/// Of --stretch.
std::optional<osgGeoFX::RasterBands> bandsOf(const Options& options)
{
    if (options.stretch.empty()) return std::nullopt;
    if (options.files.empty() && options.sequences.empty())
        throw std::runtime_error("--stretch is for pictures; give some with --mapping or --sequence.");
    osgGeoFX::RasterBands bands;
    if (!bands.setRange(options.stretch))
        throw std::runtime_error(
            "--stretch: \"" + options.stretch +
            "\" is not LOW,HIGH; write two different numbers with a comma between them.");
    return bands;
}

void showRoutes(Options& options, osgGeoFX::Scene& scene)
{
    if (options.routes.empty() && options.routeWidth > 0.0)
        throw std::runtime_error("--route-width is for ways; give some with --route.");
    if (options.routes.empty()) return;
    osgGeoFX::SceneRoutes routes(*scene.node, *scene.effects);
    std::string error;
    for (const std::string& each : options.routes)
    {
        osgGeoFX::SceneRoutes::Options how;
        how.look.width = options.routeWidth;
        std::string file;
        std::tie(file, how.layer) = names::fileAndLayer(each);
        if (!routes.add(file, how, error)) throw std::runtime_error("--route: " + error);
    }
    options.linked.insert(options.linked.end(), routes.files().begin(), routes.files().end());
}

void showRasters(Options& options, bool allowOutside, osgGeoFX::Scene& scene,
                 std::vector<std::string>& notices)
{
    if (options.files.empty() && options.sequences.empty() && !options.colors.empty())
        throw std::runtime_error("--colors is for values; give some with --mapping or --sequence.");
    if (options.files.empty() && !options.style.empty())
        throw std::runtime_error("--mapping-style is for vector data; give some with --mapping.");
    bandsOf(options);
    if (options.files.empty()) return;
    osgGeoFX::SceneOverlays overlays(*scene.node, *scene.effects);
    osgGeoFX::SceneOverlays::Options how;
    how.allowOutside = allowOutside;
    how.colors = options.colors;
    how.bands = bandsOf(options);
    how.paged = options.paged;
    std::string error;
    how.style = options.style;
    for (const std::string& each : options.files)
    {
        std::string file;
        std::tie(file, how.layer) = names::fileAndLayer(each);
        if (!overlays.add(file, how, notices, error)) throw std::runtime_error("--mapping: " + error);
    }
    options.linked.insert(options.linked.end(), overlays.files().begin(), overlays.files().end());
}

void showSequences(const Options& options, osgGeoFX::Scene& scene)
{
    if (options.sequences.empty()) return;
    osgGeoFX::SceneSequences sequences(*scene.node, *scene.effects);
    osgGeoFX::SceneSequences::Options how;
    how.colors = options.colors;
    how.bands = bandsOf(options);
    std::string error;
    for (const std::string& file : options.sequences)
        if (!sequences.add(file, how, error)) throw std::runtime_error("--sequence: " + error);
}

} // namespace

void show(Options& options, bool allowOutside, osgGeoFX::Scene& scene, std::vector<std::string>& notices)
{
    showRasters(options, allowOutside, scene, notices);
    showSequences(options, scene);
    showRoutes(options, scene);
}

void addInputs(const Options& options, osgGeoFX::InputFiles& inputs)
{
    for (const std::string& file : options.files)
    {
        inputs.add(file);
        inputs.add(std::filesystem::path(names::fileAndLayer(file).first).replace_extension(".sld").string());
    }
    for (const auto* const files : {&options.sequences, &options.routes})
        for (const std::string& file : *files)
            inputs.add(file);
    inputs.add(options.colors);
    inputs.add(options.style);
}

std::string agesOf(const Options& options)
{
    std::string ages;
    for (const std::string& file : options.files)
    {
        // A style that is found beside the file counts, too.
        const std::string name = names::fileAndLayer(file).first;
        const std::string style = std::filesystem::path(name).replace_extension(".sld").string();
        ages += "; on the ground " + file + names::ageOf(name) + names::ageOf(style);
    }
    for (const std::string& file : options.sequences)
        ages += "; in time " + file + names::ageOf(names::fileAndLayer(file).first);
    for (const std::string& file : options.routes)
        ages += "; the way " + file + names::ageOf(names::fileAndLayer(file).first);
    for (const std::string& file : options.linked)
        ages += "; " + file + names::ageOf(file);
    if (options.routeWidth > 0.0) ages += " " + std::to_string(options.routeWidth);
    if (!options.stretch.empty()) ages += "; stretched " + options.stretch;
    if (!options.style.empty()) ages += "; " + options.style + names::ageOf(options.style);
    return ages + (options.colors.empty() ? "" : "; " + options.colors + names::ageOf(options.colors));
}

} // namespace geofx::mappings
