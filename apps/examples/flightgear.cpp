// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// FlightGear's scenery with the kit's effects: how a simulator with a loader, materials and a cull visitor of its own adds
// them. example_flightgear --place LON,LAT,HEIGHT,HEADING,PITCH [--effect 'KIND PROPERTY=VALUE ...'] [--output picture.png]
#include "flightgear/Check.h"
#include "flightgear/Scenery.h"

#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/ViewPoint.h>

#include <CLI/CLI.hpp>
#include <osgDB/WriteFile>
#include <osgGA/TerrainManipulator>
#include <osgViewer/Viewer>

#include <cstdio>
#include <iostream>
#include <stdexcept>

namespace
{

struct Arguments
{
    std::string data = "/usr/share/games/flightgear", output, size = "1600x900";
    std::string place = "-157.88,21.24,2500,20,-18";
    std::vector<std::string> effects, settings;
    double radius = 40000.0, fieldOfView = 40.0;
    int check = 0;
};

std::vector<std::pair<std::string, std::string>> settingsOf(const std::vector<std::string>& lines)
{
    std::vector<std::pair<std::string, std::string>> settings;
    for (const std::string& line : lines)
    {
        const std::size_t equals = line.find('=');
        if (equals == std::string::npos)
            throw std::runtime_error("--set " + line + " has no value; write --set /path/of/property=value.");
        settings.emplace_back(line.substr(0, equals), line.substr(equals + 1));
    }
    return settings;
}

osgGeoFX::Scene makeScene(const flightgear::Scenery& scenery, const osgGeoFX::ViewPoint& eye, double radius)
{
    const flightgear::Place place = {osg::RadiansToDegrees(eye.longitude),
                                     osg::RadiansToDegrees(eye.latitude)};
    const osg::ref_ptr<osg::Group> world = scenery.load(place, radius);
    world->setUserValue("geofx.hasLight", true);
    std::string error;
    std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::adopt(world, error);
    if (!scene) throw std::runtime_error(error);
    scene->effects->setFirstTextureUnit(16); // FlightGear's shaders read units 0 to 8
    return *scene;
}

int show(const osgGeoFX::Scene& scene, const osg::Matrixd& view)
{
    osgViewer::Viewer viewer;
    scene.setUpView(viewer);
    viewer.getDatabasePager()->setUpThreads(1, 0); // SimGear's loaders share geometry
    viewer.setSceneData(scene.node);
    const osg::ref_ptr<osgGA::TerrainManipulator> manipulator = new osgGA::TerrainManipulator;
    manipulator->setByMatrix(osg::Matrixd::inverse(view));
    viewer.setCameraManipulator(manipulator, false);
    return viewer.run();
}

int run(const Arguments& arguments)
{
    const flightgear::Scenery scenery(arguments.data, settingsOf(arguments.settings));
    std::string error;
    const auto eye = osgGeoFX::ViewPoint::parse(arguments.place, error);
    if (!eye) throw std::runtime_error("--place: " + error);
    const osgGeoFX::Scene scene = makeScene(scenery, *eye, arguments.radius);
    for (const std::string& line : arguments.effects)
    {
        const osg::ref_ptr<osgGeoFX::Effect> effect = osgGeoFX::parseEffect(line, error);
        if (!effect) throw std::runtime_error("--effect: " + error);
        scene.effects->addEffect(effect);
    }
    osg::Matrixd view;
    if (!scene.reference || !eye->viewMatrix(*scene.reference, view))
        throw std::runtime_error("--place: it lies outside of the Earth's surface.");

    flightgear::Frame frame;
    frame.fieldOfView = arguments.fieldOfView;
    if (std::sscanf(arguments.size.c_str(), "%dx%d", &frame.width, &frame.height) != 2)
        throw std::runtime_error("--size: write it as 1600x900.");
    if (arguments.check > 0) return flightgear::check(scene, *eye, arguments.check, frame, arguments.output);
    if (arguments.output.empty()) return show(scene, view);
    const osg::ref_ptr<osg::Image> image = flightgear::Drawing(scene, frame).draw(view);
    if (!osgDB::writeImageFile(*image, arguments.output))
        throw std::runtime_error("\"" + arguments.output + "\" cannot be written; name another file.");
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    Arguments arguments;
    CLI::App app("FlightGear's scenery with the kit's effects.");
    app.add_option("--place", arguments.place,
                   "Where the camera is: LON,LAT,HEIGHT,HEADING,PITCH (degrees, metres)");
    app.add_option("--radius", arguments.radius, "How far around it tiles are loaded, metres");
    app.add_option("--effect", arguments.effects,
                   "An effect, as \"birdsEyeView focusLine=0.3\"; as often as wanted");
    app.add_option("--output", arguments.output, "Draws one picture into this file, without a window");
    app.add_option("--size", arguments.size, "Of the picture, WxH");
    app.add_option("--fov", arguments.fieldOfView, "Vertical field of view, degrees");
    app.add_option("--data", arguments.data, "FlightGear's data folder");
    app.add_option("--set", arguments.settings, "A setting of FlightGear's, /path/of/property=value");
    app.add_option(
        "--check", arguments.check,
        "Compares pictures of this many random cameras; --output is a folder for those that differ");
    CLI11_PARSE(app, argc, argv);
    try
    {
        return run(arguments);
    }
    catch (const std::exception& exception)
    {
        std::cerr << "example_flightgear: " << exception.what() << std::endl;
        return 2;
    }
}
