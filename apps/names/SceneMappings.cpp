// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "names/SceneMappings.h"

#include "names/SceneNames.h"

#include <osgGeoFX/map/SceneOverlays.h>

#include <CLI/CLI.hpp>

#include <stdexcept>

namespace geofx::mappings
{

void addOptions(CLI::App& app, Options& options)
{
    app.add_option("--mapping", options.files,
                   "A raster to put onto the ground: KML or KMZ with ground overlays, or any raster with a "
                   "georeference that GDAL reads. As often as wanted, the later ones on top")
        ->expected(1)
        ->type_name("FILE")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option(
           "--colors", options.colors,
           "The colors of values that --mapping shows: a color table of gdaldem color-relief, GMT (.cpt) or "
           "SLD (default: greys)")
        ->type_name("FILE");
}

void show(const Options& options, bool allowOutside, osgGeoFX::Scene& scene,
          std::vector<std::string>& notices)
{
    if (options.files.empty())
    {
        if (!options.colors.empty())
            throw std::runtime_error("--colors is for values; give some with --mapping.");
        return;
    }
    osgGeoFX::SceneOverlays overlays(*scene.node, *scene.effects);
    osgGeoFX::SceneOverlays::Options how;
    how.allowOutside = allowOutside;
    how.colors = options.colors;
    std::string error;
    for (const std::string& file : options.files)
        if (!overlays.add(file, how, notices, error)) throw std::runtime_error("--mapping: " + error);
}

std::string agesOf(const Options& options)
{
    std::string ages;
    for (const std::string& file : options.files)
        ages += "; on the ground " + file + names::ageOf(file);
    return ages + (options.colors.empty() ? "" : "; " + options.colors + names::ageOf(options.colors));
}

} // namespace geofx::mappings
