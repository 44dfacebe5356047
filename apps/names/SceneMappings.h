// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/viewer/Scene.h>

#include <string>
#include <vector>

namespace CLI
{
class App;
}

/// The rasters that the programs' options put onto the ground: --mapping and --colors.
namespace geofx::mappings
{

struct Options
{
    std::vector<std::string> files; ///< KML, KMZ, or any raster with a georeference
    std::string colors;             ///< a color table's file, for values; empty: greys
};

/// Adds --mapping and --colors to a program.
void addOptions(CLI::App& app, Options& options);
/// Puts the files onto the scene, the later ones on top. Throws std::runtime_error with a sentence. `notices`: gets sentences that
/// people should know.
void show(const Options& options, bool allowOutside, osgGeoFX::Scene& scene,
          std::vector<std::string>& notices);
/// When the files were changed last, as a text: what was drawn of former ones must not be used again.
std::string agesOf(const Options& options);

} // namespace geofx::mappings
