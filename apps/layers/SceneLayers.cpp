// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "layers/SceneLayers.h"

#include <CLI/CLI.hpp>

#include <stdexcept>

namespace geofx::layers
{

void addOptions(CLI::App& app, Options& options)
{
    app.add_option(
           "--layers", options.folder,
           "Also write the picture as layers, to finish it by hand: sky, terrain, shade, forest, water, "
           "strokes "
           "and names as images, and the class, distance, height, longitude and latitude of each pixel. "
           "layers.json in the folder tells how they are put together")
        ->type_name("DIR");
}

void check(const Options& options)
{
    std::string error;
    if (!options.folder.empty() && !osgGeoFX::PictureLayers::prepare(options.folder, error))
        throw std::runtime_error("--layers: " + error);
}

void write(const Options& options, const osgGeoFX::Scene& scene, const osgGeoFX::PrintSize& size,
           const osgGeoFX::SceneRenderer::Options& renderer, const osg::ref_ptr<osgGeoFX::NameSet>& names,
           const osg::Matrixd& view)
{
    if (options.folder.empty()) return;
    osgGeoFX::PictureLayers::Options layers;
    layers.size = size;
    layers.renderer = renderer;
    layers.names = names;
    // What is drawn at once stays so: then layers are those of the picture to the bit.
    if (size.dpi <= 0.0 && !osgGeoFX::PicturePrint::isLarge(size)) layers.tile = 4096;
    std::string error;
    if (!osgGeoFX::PictureLayers::write(scene, layers, view, options.folder, error))
        throw std::runtime_error(error);
}

} // namespace geofx::layers
