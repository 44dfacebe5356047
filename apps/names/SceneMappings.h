// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/viewer/Scene.h>

#include <string>
#include <vector>

namespace CLI
{
class App;
}

/// The rasters and ways that the programs' options put onto the ground: --mapping, --sequence, --colors, --stretch, --route and --route-width.
namespace geofx::mappings
{

struct Options
{
    std::vector<std::string> files; ///< KML, KMZ, any raster with a georeference, vector data, or FILE:LAYER
    std::vector<std::string> sequences; ///< rasters in time: files, FILE:VARIABLE, or folders
    bool paged = true;                  ///< whether large rasters are read in tiles as they are needed
    std::vector<std::string> routes;    ///< GPX, KML or other vector data with lines, or FILE:LAYER
    double routeWidth = 0.0;            ///< metres; 0: by their extent
    std::string colors;                 ///< a color table's file, for values; empty: greys
    std::string
        stretch; ///< "LOW,HIGH": the numbers of pictures that are black and white; empty: by their numbers
    std::string style; ///< an SLD file, for vector data; empty: the one beside each file, or its own look
    std::vector<std::string> linked; ///< what show() has read of KML files, with what they link
};

/// Adds them to a program.
void addOptions(CLI::App& app, Options& options);
/// Adds the files that the options name, and the styles beside them.
void addInputs(const Options& options, osgGeoFX::InputFiles& inputs);
/// Puts the files onto the scene, the later ones on top, and ways over rasters. Throws std::runtime_error with a sentence. `notices`: gets sentences that
/// people should know.
void show(Options& options, bool allowOutside, osgGeoFX::Scene& scene, std::vector<std::string>& notices);
/// When the files were changed last, also those that KML files link if show() was called before, as a text: what was drawn of former ones must not be used again.
std::string agesOf(const Options& options);

} // namespace geofx::mappings
