// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/labels/NameSet.h>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Image>
#include <osg/Matrixd>

#include <string>

namespace CLI
{
class App;
}

/// The web page that the programs' option --web asks for.
namespace geofx::web
{

struct Options
{
    std::string folder; ///< of the page; empty for none
    std::string title;  ///< empty: the picture's name
    std::string attribution;

    bool wanted() const { return !folder.empty(); }
};

/// Adds --web, --title and --attribution to a program.
void addOptions(CLI::App& app, Options& options);

/// Claims the page's folder. Throws WorkError.
void claimOutputs(const Options& options, osgGeoFX::InputFiles& inputs);

/** A page about the picture that a program draws. All throw std::runtime_error with a sentence. */
class ScenePage
{
public:
    /// Before anything is drawn, since it may find that the page cannot be written. `picture`: the program's output.
    ScenePage(const Options& options, const std::string& picture);
    ~ScenePage();
    ScenePage(const ScenePage&) = delete;
    ScenePage& operator=(const ScenePage&) = delete;

    /// A file for the picture without names, which the page is made of. It goes with this object.
    const std::string& plain() const { return _plain; }
    /// Writes that file from an image.
    void setPicture(const osg::Image& image) const;

    /** Writes the page, once the plain picture is there. It draws the view again, reduced, and learns from its depths which names are to be
        seen, and what each pixel shows.
        `renderer`: the picture's size, field of view and platform. `view`: from world to eye coordinates. `names`: null for none. */
    void write(osgGeoFX::Scene& scene, const osgGeoFX::SceneRenderer::Options& renderer,
               const osg::Matrixd& view, osgGeoFX::NameSet* names) const;

private:
    Options _options;
    std::string _plain;
};

} // namespace geofx::web
