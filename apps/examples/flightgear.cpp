// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// FlightGear's scenery with the kit's effects: how a simulator with a loader, materials and a cull visitor of its own adds
// them. example_flightgear --place LON,LAT,HEIGHT,HEADING,PITCH [--effect 'KIND PROPERTY=VALUE ...'] [--output picture.png]
#include "flightgear/Check.h"
#include "flightgear/Effects.h"
#include "flightgear/Ground.h"
#include "flightgear/Scenery.h"

#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/viewer/ViewPoint.h>

#include <CLI/CLI.hpp>
#include <osgDB/WriteFile>
#include <osgGA/TerrainManipulator>
#include <osgViewer/Viewer>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <stdexcept>

namespace
{

struct Arguments
{
    std::string data = "/usr/share/games/flightgear", output, size = "1600x900";
    std::string place = "-157.88,21.24,2500,20,-18";
    std::vector<std::string> effects, closeUps, mappings, covers, settings;
    double radius = 40000.0, fieldOfView = 40.0, nearest = 0.0;
    int check = 0;
    bool lamps = false;
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

void addEffects(osgGeoFX::EffectScene& scene, const Arguments& arguments)
{
    for (const std::string& line : arguments.effects)
        scene.addEffect(flightgear::makeEffect(line));
    for (const std::string& line : arguments.mappings)
        scene.addEffect(flightgear::makeMapping(line));
    if (!arguments.closeUps.empty()) scene.addEffect(flightgear::makeCloseUps(arguments.closeUps));
}

int show(const osgGeoFX::Scene& scene, const osg::Matrixd& view, bool lamps)
{
    osgViewer::Viewer viewer;
    scene.setUpView(viewer);
    if (!lamps) flightgear::hideLamps(*viewer.getCamera());
    viewer.getDatabasePager()->setUpThreads(1, 0); // SimGear's loaders share geometry
    viewer.setSceneData(scene.node);
    const osg::ref_ptr<osgGA::TerrainManipulator> manipulator = new osgGA::TerrainManipulator;
    manipulator->setByMatrix(osg::Matrixd::inverse(view));
    viewer.setCameraManipulator(manipulator, false);
    return viewer.run();
}

int run(const Arguments& arguments)
{
    if (!arguments.output.empty() && arguments.check == 0)
    {
        osgGeoFX::InputFiles inputs;
        for (const std::string& mapping : arguments.mappings)
            inputs.add(mapping.substr(mapping.rfind(',') + 1));
        inputs.claim("The picture", arguments.output, "--output");
    }
    const flightgear::Scenery scenery(arguments.data, settingsOf(arguments.settings));
    std::string error;
    const auto eye = osgGeoFX::ViewPoint::parse(arguments.place, error);
    if (!eye) throw std::runtime_error("--place: " + error);
    const osgGeoFX::Scene scene = makeScene(scenery, *eye, arguments.radius);
    flightgear::Ground ground(scene, arguments.covers);
    addEffects(*scene.effects, arguments);
    osg::Matrixd view;
    if (!scene.reference || !eye->viewMatrix(*scene.reference, view))
        throw std::runtime_error("--place: it lies outside of the Earth's surface.");

    flightgear::Frame frame;
    frame.fieldOfView = arguments.fieldOfView;
    frame.lamps = arguments.lamps;
    if (arguments.check > 0) frame.samples = 0;
    if (std::sscanf(arguments.size.c_str(), "%dx%d", &frame.width, &frame.height) != 2)
        throw std::runtime_error("--size: write it as 1600x900.");
    if (arguments.check > 0)
        return flightgear::check(scene, ground, *eye, {arguments.check, arguments.nearest, arguments.output},
                                 frame);
    const double nearest =
        arguments.nearest > 0.0 ? arguments.nearest : std::max(eye->height - ground.highest(), 100.0);
    ground.refine(ground.longestEdge(frame, nearest));
    if (arguments.output.empty()) return show(scene, view, arguments.lamps);
    const osg::ref_ptr<osg::Image> image = flightgear::Drawing(scene, frame).draw(view);
    for (const std::string& name : ground.unknownMaterials())
        std::cout << "The legend does not know the material \"" << name << "\"." << std::endl;
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
    app.add_option(
        "--closeup", arguments.closeUps,
        "A close-up, as LON,LAT,SIZE,HEIGHT,SCALE (degrees, metres, a factor); as often as wanted");
    app.add_option(
        "--mapping", arguments.mappings,
        "A picture on the ground, as LON,LAT,WIDTH,HEADING,FILE (degrees, metres); as often as wanted");
    app.add_option(
        "--cover", arguments.covers,
        "What a material is covered with, as NAME,TREES,TOWN,BARE (shares, 0 to 1), in the place of what "
        "flightgear.csv has; as often as wanted");
    app.add_flag("--lamps", arguments.lamps, "Shows the lamps of towns and runways");
    app.add_option("--nearest", arguments.nearest,
                   "How near the camera comes to the ground, metres, for which large triangles are split; 0: "
                   "as near as at "
                   "--place");
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
