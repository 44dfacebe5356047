// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/map/MapContents.h>
#include <osgGeoFX/viewer/Scene.h>

#include <string>
#include <utility>
#include <vector>

namespace CLI
{
class App;
}

/// The names and lines that the programs' options ask for: --labels, --lines, --style and --font.
namespace geofx::names
{

/// The height of pictures for which names have their styles' sizes, pixels.
constexpr double usualHeight = 900.0;

struct Options
{
    std::vector<std::string> files; ///< vector data with names, or FILE:LAYER
    std::string field; ///< the field of the names; empty: as the style file says, or the usual ones
    std::vector<std::string> lines; ///< vector data with lines, or FILE:LAYER
    std::string style;              ///< a JSON file; empty for the usual styles
    std::string font;               ///< a font's file or its families; empty for the styles' own
    std::string svg;                ///< a file for names and lines as vectors; empty: none
    std::string geoJson;            ///< a file for them in the picture's coordinates; empty: none
};

/// Adds --labels, --label-field, --lines, --style, --font, --svg and --geojson to a program.
void addOptions(CLI::App& app, Options& options);
/// A sentence if one of them is given for nothing; else empty. `scene`: the file that is shown; where it may have names and lines itself, takeMap()
/// tells.
std::string faultOf(const Options& options, const std::string& scene);

/// FILE, or FILE:LAYER where there is no file of the whole name: the file, and the layer or nothing.
std::pair<std::string, std::string> fileAndLayer(const std::string& text);

/// For the files that a program reads, with their sources as osgdb_geofxdata tells them.
osgGeoFX::InputFiles makeInputFiles();
/// Adds the files that the options name.
void addInputs(const Options& options, osgGeoFX::InputFiles& inputs);
/// Claims the files that --svg and --geojson name. Throws WorkError.
void claimOutputs(const Options& options, osgGeoFX::InputFiles& inputs);

/// When a file was changed last, as a text: what was drawn of a former one must not be used again. Empty if there is none.
std::string ageOf(const std::string& file);
/// The same of all files of names, lines and styles.
std::string agesOf(const Options& options);

/** Takes the names and lines out of a scene (a .geofx file may have some), and adds those of the options, whose styles and font are for all of
    them. Throws std::runtime_error with a sentence. `notices`: gets sentences that people should know. */
osgGeoFX::MapContents takeMap(const Options& options, const osgGeoFX::Scene& scene,
                              std::vector<std::string>& notices);
/// Shows the scene's and the options' names and lines live in the scene. Else as takeMap().
void showMap(const Options& options, osgGeoFX::Scene& scene, std::vector<std::string>& notices);

} // namespace geofx::names
