// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/labels/LabelPicture.h>
#include <osgGeoFX/labels/NamePlacement.h>
#include <osgGeoFX/labels/NameSet.h>
#include <osgGeoFX/scene/DepthReader.h>
#include <osgGeoFX/viewer/Scene.h>

#include <map>
#include <string>
#include <vector>

namespace CLI
{
class App;
}

/// The names that the programs' options ask for: --labels, --style and --font.
namespace geofx::names
{

/// The height of pictures for which names have their styles' sizes, pixels.
constexpr double usualHeight = 900.0;

struct Options
{
    std::vector<std::string> files; ///< vector data with names, or FILE:LAYER
    std::string style;              ///< a JSON file; empty for the usual styles
    std::string font;               ///< a font's file or its families; empty for the styles' own
};

/// Adds --labels, --style and --font to a program.
void addOptions(CLI::App& app, Options& options);

/// When a file was changed last, as a text: what was drawn of a former one must not be used again. Empty if there is none.
std::string ageOf(const std::string& file);

/// The styles of a JSON file over the usual ones. Throws std::runtime_error with a sentence.
std::map<std::string, osgGeoFX::NameStyle> readStyles(const std::string& file);

/** The names of all files on a scene's ground, with their styles. Throws std::runtime_error with a sentence. `notice`: what people should know
    of the names, in a sentence; empty where all are well. */
osg::ref_ptr<osgGeoFX::NameSet> read(const Options& options, const osgGeoFX::Scene& scene,
                                     std::string& notice);

/** Names on pictures of a SceneRenderer. Make it before the renderer, since it adds to the scene's node what reads the depths. */
class PictureNames
{
public:
    /// `height`: of the pictures, pixels. Names grow with it.
    PictureNames(osgGeoFX::NameSet& names, osgGeoFX::Scene& scene, int height);

    /// Places the names of the renderer's last picture. `camera`: SceneRenderer::camera().
    osgGeoFX::LabelPicture place(const osg::Camera& camera) const;

private:
    osg::ref_ptr<osgGeoFX::NameSet> _names;
    osg::ref_ptr<osgGeoFX::EffectScene> _effects;
    osg::ref_ptr<osgGeoFX::DepthReader> _reader = new osgGeoFX::DepthReader;
};

} // namespace geofx::names
