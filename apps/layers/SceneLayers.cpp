// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "layers/SceneLayers.h"

#include <osgGeoFX/print/PictureMesh.h>

#include <CLI/CLI.hpp>
#include <osg/Math>
#include <osgDB/FileNameUtils>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace geofx::layers
{

namespace
{

/// Reads all tiles of a print's terrain.
void readTiles(const osgGeoFX::Scene& scene, const osgGeoFX::PrintSize& size,
               const osgGeoFX::SceneRenderer::Options& options, const osg::Matrixd& view)
{
    osgGeoFX::SceneRenderer::Options drawing = options;
    drawing.samples = 0;
    drawing.width = std::min(size.width, 2048);
    drawing.height = std::min(size.height, 2048);
    drawing.pictureWidth = size.width;
    drawing.pictureHeight = size.height;
    std::string error;
    const auto renderer = osgGeoFX::SceneRenderer::create(scene, drawing, error);
    if (!renderer) throw std::runtime_error(error);
    for (int y = 0; y < size.height; y += drawing.height)
    {
        for (int x = 0; x < size.width; x += drawing.width)
        {
            renderer->setTile(x, y);
            osgGeoFX::FrameStatistics unused;
            if (!renderer->render(view, 0.0, unused, error)) throw std::runtime_error(error);
        }
    }
}

} // namespace

void addOptions(CLI::App& app, Options& options)
{
    app.add_option(
           "--layers", options.folder,
           "Also write the picture as layers, to finish it by hand: sky, terrain, shade, forest, water, "
           "strokes "
           "and names as images, and the class, distance, height, longitude and latitude of each pixel. "
           "layers.json in the folder tells how they are put together")
        ->type_name("DIR");
    app.add_option("--mesh", options.mesh,
                   "Also write the terrain as the picture shows it, deformed, for a modelling program. "
                   "Metres in a local frame, "
                   "which the file tells, with the view")
        ->type_name("FILE.obj|FILE.osgb");
}

void claimOutputs(const Options& options, osgGeoFX::InputFiles& inputs)
{
    namespace fs = std::filesystem;
    if (!options.folder.empty())
    {
        std::vector<std::string> names = osgGeoFX::PictureLayers::fileNames();
        names.emplace_back("lines.png");
        for (const std::string& name : names)
            inputs.claim("The layer", (fs::path(options.folder) / name).string(), "--layers");
    }
    if (options.mesh.empty()) return;
    inputs.claim("The mesh", options.mesh, "--mesh");
    if (osgDB::getLowerCaseFileExtension(options.mesh) != "obj") return;
    inputs.claim("The mesh's file", fs::path(options.mesh).replace_extension(".mtl").string(), "--mesh");
    inputs.claimFolder("The mesh's folder", fs::path(options.mesh).replace_extension(".textures").string(),
                       "--mesh");
}

void check(const Options& options)
{
    std::string error;
    if (!options.folder.empty() && !osgGeoFX::PictureLayers::prepare(options.folder, error))
        throw std::runtime_error("--layers: " + error);
    if (!options.mesh.empty()) error = osgGeoFX::PictureMesh::faultOf(options.mesh);
    if (!error.empty()) throw std::runtime_error("--mesh " + error);
}

void write(const Options& options, const osgGeoFX::Scene& scene, const osgGeoFX::PrintSize& size,
           const osgGeoFX::SceneRenderer::Options& renderer, const geofx::names::PictureMap& map,
           const osg::Matrixd& view)
{
    if (!options.any()) return;
    const bool atOnce = size.dpi <= 0.0 && !osgGeoFX::PicturePrint::isLarge(size);
    std::string error;
    if (!options.folder.empty())
    {
        osgGeoFX::PictureLayers::Options layers;
        layers.size = size;
        layers.renderer = renderer;
        layers.names = map.names();
        if (const osgGeoFX::LinePicture* const lines = map.linesAbove())
            layers.overlays.push_back({"lines", "The lines: roads, lifts, rivers, borders.",
                                       [lines](osg::Image& rows, int top) { lines->drawOnto(rows, top); },
                                       true});
        // What is drawn at once stays so: then layers are those of the picture to the bit.
        if (atOnce) layers.tile = 4096;
        if (!osgGeoFX::PictureLayers::write(scene, layers, view, options.folder, error))
            throw std::runtime_error(error);
    }
    if (options.mesh.empty()) return;
    // A print that goes on where it was interrupted may have read nothing.
    if (options.folder.empty() && !atOnce) readTiles(scene, size, renderer, view);
    const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setViewport(0, 0, size.width, size.height);
    camera->setViewMatrix(view);
    camera->setProjectionMatrixAsPerspective(renderer.fieldOfView,
                                             static_cast<double>(size.width) / size.height, 1.0, 1e6);
    camera->setLODScale(scene.lodScale(size.height, osg::DegreesToRadians(renderer.fieldOfView)));
    const osgGeoFX::PictureMesh mesh(*scene.effects, *camera, scene.reference);
    if (!mesh.write(options.mesh, error)) throw std::runtime_error(error);
}

} // namespace geofx::layers
