// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "names/PictureMap.h"

#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/print/PictureLayers.h>
#include <osgGeoFX/viewer/Scene.h>

#include <string>

namespace CLI
{
class App;
}

/// A picture in parts, to be finished by hand: the programs' options --layers and --mesh.
namespace geofx::layers
{

struct Options
{
    std::string folder; ///< for the layers; empty for none
    std::string mesh;   ///< a file for the deformed terrain; empty for none

    bool any() const { return !folder.empty() || !mesh.empty(); }
};

void addOptions(CLI::App& app, Options& options);

/// Claims what the options write. Throws WorkError.
void claimOutputs(const Options& options, osgGeoFX::InputFiles& inputs);

/// Makes sure, before anything is drawn, that all can be written. Throws std::runtime_error with a sentence.
void check(const Options& options);

/** Draws the scene again and writes what the options ask for. Throws std::runtime_error with a sentence. No renderer may show the scene any more.
    `size`, `map`: of the picture. */
void write(const Options& options, const osgGeoFX::Scene& scene, const osgGeoFX::PrintSize& size,
           const osgGeoFX::SceneRenderer::Options& renderer, const geofx::names::PictureMap& map,
           const osg::Matrixd& view);

} // namespace geofx::layers
