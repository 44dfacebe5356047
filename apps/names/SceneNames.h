// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/labels/NamePlacement.h>
#include <osgGeoFX/labels/NameSet.h>
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
    std::vector<std::string> lines; ///< vector data with lines, or FILE:LAYER
    std::string style;              ///< a JSON file; empty for the usual styles
    std::string font;               ///< a font's file or its families; empty for the styles' own
    std::string svg;                ///< a file for names and lines as vectors; empty: none
    std::string geoJson;            ///< a file for them in the picture's coordinates; empty: none
};

/// Adds --labels, --lines, --style, --font, --svg and --geojson to a program.
void addOptions(CLI::App& app, Options& options);
/// A sentence if one of them is given for nothing, or a file cannot be written there; else empty.
std::string faultOf(const Options& options);

/// FILE, or FILE:LAYER where there is no file of the whole name: the file, and the layer or nothing.
std::pair<std::string, std::string> fileAndLayer(const std::string& text);
/// The coordinate system of a projected scene, as WKT; empty if it states none.
std::string wktOf(osg::Node& node);

/// When a file was changed last, as a text: what was drawn of a former one must not be used again. Empty if there is none.
std::string ageOf(const std::string& file);
/// The same of all files of names, lines and styles.
std::string agesOf(const Options& options);

/** The names of all files on a scene's ground, with their styles. Throws std::runtime_error with a sentence. `notice`: what people should know
    of the names, in a sentence; empty where all are well. */
osg::ref_ptr<osgGeoFX::NameSet> read(const Options& options, const osgGeoFX::Scene& scene,
                                     std::string& notice);

} // namespace geofx::names
