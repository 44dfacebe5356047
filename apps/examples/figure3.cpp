// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The six examples of the paper's Figure 3 (Trapp and Döllner 2009), with Oahu:
// figure3 TERRAIN DATA_FOLDER A|B|C|D|E|F PICTURE [EFFECT...]
#include "figure3/Figures.h"

#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/geodata/FileSources.h>
#include <osgGeoFX/mapping/RouteMapping.h>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/Overlay.h>

#include <CLI/CLI.hpp>
#include <osg/Group>
#include <osgDB/WriteFile>

#include <cstdio>
#include <iostream>
#include <map>
#include <stdexcept>

namespace
{

using Figure = figure3::Shot (*)(figure3::Island&);

const std::map<std::string, Figure> figures = {{"A", figure3::noiseMap}, {"B", figure3::route},
                                               {"C", figure3::textures}, {"D", figure3::towns},
                                               {"E", figure3::symbols},  {"F", figure3::transmitters}};

struct Arguments
{
    std::string terrain, dataFolder, figure, picture, view;
    std::vector<std::string> effects;
    int width = 1200;
    int height = 800;
};

void add(osgGeoFX::EffectScene& scene, const std::string& line)
{
    std::string error;
    const osg::ref_ptr<osgGeoFX::Effect> effect = osgGeoFX::parseEffect(line, error);
    if (!effect) throw std::runtime_error(error);
    scene.addEffect(effect);
}

void draw(const Arguments& arguments)
{
    figure3::Island island(arguments.terrain, arguments.dataFolder);
    const figure3::Shot shot = figures.at(arguments.figure)(island);

    osgGeoFX::Scene& scene = island.scene;
    for (const std::string& line : arguments.effects.empty() ? shot.effects : arguments.effects)
        add(*scene.effects, line);
    scene.effects->addEffect(island.mappings);
    if (shot.legend)
    {
        const osg::ref_ptr<osg::Camera> overlay = osgGeoFX::makeOverlay(arguments.width, arguments.height);
        overlay->addChild(shot.legend);
        const osg::ref_ptr<osg::Group> both = new osg::Group;
        both->addChild(scene.node);
        both->addChild(overlay);
        scene.node = both;
    }

    std::string error;
    osgGeoFX::SceneRenderer::Options options;
    options.width = arguments.width;
    options.height = arguments.height;
    options.fieldOfView = shot.fieldOfView;
    options.samples = 4;
    const auto renderer = osgGeoFX::SceneRenderer::create(scene, options, error);
    if (!renderer) throw std::runtime_error(error);
    const auto point = osgGeoFX::ViewPoint::parse(arguments.view.empty() ? shot.view : arguments.view, error);
    if (!point) throw std::runtime_error(error);
    osg::Matrixd view;
    point->viewMatrix(*scene.reference, view);
    osgGeoFX::FrameStatistics statistics;
    const osg::ref_ptr<osg::Image> image = renderer->render(view, 0.0, statistics, error);
    if (!image) throw std::runtime_error(error);
    const osg::ref_ptr<osgDB::Options> quality = new osgDB::Options("JPEG_QUALITY 87");
    if (!osgDB::writeImageFile(*image, arguments.picture, quality))
        throw std::runtime_error(arguments.picture + " cannot be written.");
    std::size_t count = island.mappings->getNumMappings();
    for (unsigned int i = 0; i < island.mappings->getNumRoutes(); ++i)
        count += island.mappings->getRoute(i)->getNumMappings();
    std::cout << arguments.picture << ": " << count << " mappings\n";
}

} // namespace

int main(int argc, char** argv)
{
    Arguments arguments;
    std::string size = "1200x800";
    CLI::App app("Draws one of six maps of Oahu with projective mappings.", "example_figure3");
    app.add_option("terrain", arguments.terrain,
                   "Oahu: data/oahu/plain.geofx, or a database of it on the globe")
        ->required();
    app.add_option("data", arguments.dataFolder, "Folder of elevation.tif and landcover.tif")->required();
    app.add_option("figure", arguments.figure,
                   "A noise, B route, C textures, D towns, E symbols, F transmitters")
        ->required()
        ->check(CLI::IsMember(&figures));
    app.add_option("picture", arguments.picture, "File to write")->required();
    app.add_option("effects", arguments.effects, "Other effects than the figure's: 'KIND PROPERTY=VALUE …'");
    app.add_option("--view", arguments.view, "Another view: LON,LAT,HEIGHT,HEADING,PITCH");
    app.add_option("--size", size, "WIDTHxHEIGHT")->capture_default_str();
    CLI11_PARSE(app, argc, argv)
    try
    {
        if (std::sscanf(size.c_str(), "%5dx%5d", &arguments.width, &arguments.height) != 2)
            throw std::runtime_error("--size " + size + ": write width and height, such as 1200x800.");
        osgGeoFX::InputFiles inputs([](const std::string& file)
                                    { return osgGeoFX::FileSources::of(file).files; });
        inputs.add(arguments.terrain);
        for (const char* raster : {"elevation.tif", "landcover.tif"})
            inputs.add(arguments.dataFolder + "/" + raster);
        inputs.claim("The picture", arguments.picture, "picture");
        draw(arguments);
    }
    catch (const std::exception& failure)
    {
        std::cerr << failure.what() << '\n';
        return 1;
    }
    return 0;
}
