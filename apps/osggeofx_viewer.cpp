// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osggeofx_viewer: osgviewer, made for terrain.
#include "names/SceneMappings.h"
#include "names/SceneNames.h"
#include "viewer/ViewerSetup.h"

#include <osgGeoFX/paging/FreedMemory.h>
#include <osgGeoFX/paging/ReadingFile.h>
#include <osgGeoFX/paging/RemoteFiles.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/ArgumentParser>
#include <osg/GraphicsContext>
#include <osgDB/ReadFile>
#include <osgViewer/Viewer>

#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <vector>

namespace
{

constexpr int badInput = 2;

int refuse(const std::string& sentence)
{
    std::cerr << "osggeofx_viewer: " << sentence << std::endl;
    return badInput;
}

void describe(osg::ApplicationUsage& usage)
{
    usage.setApplicationName("osggeofx_viewer");
    usage.setDescription(
        "osggeofx_viewer shows terrain databases, .geofx scenes and whatever else OpenSceneGraph reads. "
        "It takes osgviewer's options and keys; press h in the window for its own keys, H for osgviewer's. g "
        "shows "
        "the coordinates of the ground below the pointer, o a compass and i a small map. F9 lists the "
        "scene's "
        "mappings, F10 its effects with all their properties. A click makes a close-up active (the key u "
        "says when), Shift and the left button drag "
        "it. F11 makes a panorama map of any terrain, F12 saves it as a scene file and as a recipe of "
        "osggeofx_panorama. k takes a painter's liberty with the ground below the pointer. A panorama map "
        "has a manipulator of its own, key 0. n hides and shows names, r lines.");
    usage.setCommandLineUsage("osggeofx_viewer [options] FILE ...");
    usage.addCommandLineOption("--fov <degrees>", "Vertical field of view (default: the scene's, or 30).");
    usage.addCommandLineOption("--effect '<kind> <property>=<value> ...'",
                               "Add an effect to the scene's, as in osggeofx_render; as often as wanted.");
    usage.addCommandLineOption(
        "--cache-mappings",
        "Compose mappings that rest beforehand, instead of drawing them anew in each frame.");
    usage.addCommandLineOption("--sky", "Put a sky around the Earth in place of the plain background.");
    usage.addCommandLineOption("--city <file>",
                               "Add a city model of others, in the scene's coordinates; each building keeps "
                               "its shape in bends.");
    usage.addCommandLineOption(
        "--mapping <file>", "Put a file onto the ground: KML, KMZ, any raster with a georeference, or vector "
                            "data; FILE or FILE:LAYER.");
    usage.addCommandLineOption("--mapping-style <file>", "How vector data on the ground look: an SLD file.");
    usage.addCommandLineOption(
        "--sequence <file>", "Rasters in time: NetCDF, GRIB, Zarr, bands or a folder; FILE, FILE:VARIABLE or "
                             "FOLDER.");
    usage.addCommandLineOption("--colors <file>",
                               "The colors of values: a table of gdaldem color-relief, GMT or SLD.");
    usage.addCommandLineOption("--stretch <low,high>",
                               "The numbers of pictures on the ground that become black and white.");
    usage.addCommandLineOption(
        "--route <file>",
        "Put a way onto the ground: GPX, KML, KMZ or lines of any vector file; FILE or FILE:LAYER.");
    usage.addCommandLineOption("--route-width <metres>",
                               "Width of the ways' lines (default: by their extent).");
    usage.addCommandLineOption("--labels <file>",
                               "Show the names of a vector file, FILE or FILE:LAYER; as often as wanted.");
    usage.addCommandLineOption("--lines <file>",
                               "Show the lines of a vector file, such as roads; FILE or FILE:LAYER.");
    usage.addCommandLineOption("--style <file.json>", "How names and lines look, as in osggeofx_render.");
    usage.addCommandLineOption("--font <name or file>",
                               "The names' font: installed families, or a font's file.");
    usage.addCommandLineOption("--prefetch <seconds>",
                               "Ask for the tiles that the camera will need in so many seconds, 0.1 to 60.");
    usage.addCommandLineOption("--memory <MiB>",
                               "Keep tiles within so much main memory; those seen longest ago go first.");
    usage.addCommandLineOption("--gpu-memory <MiB>", "The same of OpenGL's objects.");
    usage.addCommandLineOption("--help-effects", "List the effects with all their properties.");
    usage.addCommandLineOption(
        "--allow-outside",
        "Let a .geofx scene or a KML file name files outside its own folder, and addresses.");
    usage.addCommandLineOption("-p <file>", "Play a camera path that was saved with the key z.");
    usage.addCommandLineOption("--speed <factor>", "How fast the path is played; 1 is as recorded.");
}

bool hasDisplay()
{
    const char* display = std::getenv("DISPLAY");
    if (!display || !*display)
    {
        return false;
    }
    // OSG would say it in words of its own.
    const osg::NotifySeverity former = osg::getNotifyLevel();
    osg::setNotifyLevel(osg::ALWAYS);
    osg::GraphicsContext::ScreenIdentifier screen;
    screen.readDISPLAY();
    screen.setUndefinedScreenDetailsToDefaultScreen();
    osg::GraphicsContext::WindowingSystemInterface* system =
        osg::GraphicsContext::getWindowingSystemInterface();
    const bool found = system && system->getNumScreens(screen) > 0;
    osg::setNotifyLevel(former);
    return found;
}

} // namespace

int main(int argc, char** argv)
{
    const osgGeoFX::FreedMemory freed;
    osg::ArgumentParser arguments(&argc, argv);
    describe(*arguments.getApplicationUsage());
    const bool colorGiven = arguments.find("--clear-color") > 0;
    const bool nearFarGiven = arguments.find("--NEAR_FAR_RATIO") > 0;
    // The viewer adds its own options to the help page, and takes them from the arguments.
    osgViewer::Viewer viewer(arguments);
    if (const unsigned int help = arguments.readHelpType())
    {
        arguments.getApplicationUsage()->write(std::cout, help);
        return 0;
    }
    if (arguments.read("--help-effects"))
    {
        std::cout << osgGeoFX::effectsHelp();
        return 0;
    }
    std::vector<osg::ref_ptr<osgGeoFX::Effect>> effects;
    std::string text;
    std::string effectFault;
    while (arguments.read("--effect", text) && effectFault.empty())
    {
        effects.push_back(osgGeoFX::parseEffect(text, effectFault));
    }
    if (!effectFault.empty()) return refuse("--effect: " + effectFault);
    const osg::ref_ptr<osgDB::Options> reading =
        arguments.read("--allow-outside") ? new osgDB::Options("allowOutside") : nullptr;
    const bool sky = arguments.read("--sky");
    std::vector<std::string> cities;
    while (arguments.read("--city", text))
        cities.push_back(text);
    geofx::mappings::Options mappingOptions;
    while (arguments.read("--mapping", text))
        mappingOptions.files.push_back(text);
    while (arguments.read("--sequence", text))
        mappingOptions.sequences.push_back(text);
    arguments.read("--mapping-style", mappingOptions.style);
    arguments.read("--colors", mappingOptions.colors);
    arguments.read("--stretch", mappingOptions.stretch);
    while (arguments.read("--route", text))
        mappingOptions.routes.push_back(text);
    const bool routeWidthGiven = arguments.read("--route-width", mappingOptions.routeWidth);
    const bool cacheMappings = arguments.read("--cache-mappings");
    geofx::names::Options nameOptions;
    while (arguments.read("--labels", text))
        nameOptions.files.push_back(text);
    while (arguments.read("--lines", text))
        nameOptions.lines.push_back(text);
    arguments.read("--style", nameOptions.style);
    arguments.read("--font", nameOptions.font);
    double fieldOfView = 0.0;
    const bool fieldOfViewGiven = arguments.read("--fov", fieldOfView);
    geofx::viewer::Paging paging;
    const bool prefetchGiven = arguments.read("--prefetch", paging.lead);
    const bool memoryGiven = arguments.read("--memory", paging.memory),
               gpuMemoryGiven = arguments.read("--gpu-memory", paging.gpuMemory);
    const osg::ref_ptr<osgGA::KeySwitchMatrixManipulator> manipulators =
        geofx::viewer::makeManipulators(arguments);
    arguments.reportRemainingOptionsAsUnrecognized();
    if (arguments.errors())
    {
        return refuse(arguments.getErrorMessageMap().begin()->first + "; --help lists the options.");
    }
    if (arguments.argc() < 2)
    {
        return refuse("Name a file to show; --help lists the options.");
    }
    if (fieldOfViewGiven && !(fieldOfView > 0.0 && fieldOfView < 180.0))
    {
        return refuse("--fov must lie between 0 and 180 degrees.");
    }
    if (routeWidthGiven && !(mappingOptions.routeWidth > 0.0))
    {
        return refuse("--route-width must be more than 0 metres.");
    }
    if (prefetchGiven && !(paging.lead >= 0.1 && paging.lead <= 60.0))
    {
        return refuse("--prefetch must lie between 0.1 and 60 seconds.");
    }
    if ((memoryGiven && !(paging.memory >= 1.0)) || (gpuMemoryGiven && !(paging.gpuMemory >= 1.0)))
    {
        return refuse("--memory and --gpu-memory must be 1 MiB at least.");
    }
    if (!hasDisplay())
    {
        return refuse(
            "There is no X display to show a window on (DISPLAY is not set, or nothing answers there); "
            "osggeofx_render makes pictures without one.");
    }

    std::string error;
    std::optional<osgGeoFX::Scene> scene;
    if (arguments.argc() == 2)
    {
        scene = osgGeoFX::Scene::load(arguments[1], error, reading);
    }
    else if (const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFiles(arguments, reading))
    {
        scene = osgGeoFX::Scene::adopt(node, error);
    }
    else
    {
        error = "None of the files can be read; name files that OpenSceneGraph or one of its plugins reads.";
    }
    if (!scene)
    {
        return refuse(error);
    }

    for (const std::string& city : cities)
        if (!scene->addCity(city, error, reading)) return refuse("--city: " + error);
    if (sky && !scene->addSky(error)) return refuse("--sky: " + error);
    for (const auto& effect : effects)
        scene->effects->addEffect(effect);
    if (cacheMappings) geofx::viewer::composeMappings(*scene->effects);
    scene->effects->listenTo(*scene->guard);
    if (!fieldOfViewGiven) fieldOfView = scene->settings.homeFov.value_or(30.0);
    if (const std::string fault = geofx::names::faultOf(nameOptions, arguments[1]); !fault.empty())
        return refuse(fault);
    try
    {
        std::vector<std::string> notices;
        geofx::mappings::show(mappingOptions, reading.valid(), *scene, notices);
        geofx::names::showMap(nameOptions, *scene, notices);
        for (const std::string& notice : notices)
            std::cerr << "osggeofx_viewer: " << notice << std::endl;
    }
    catch (const std::runtime_error& fault)
    {
        return refuse(fault.what());
    }
    osgGeoFX::RemoteFiles::setUpThreads(*viewer.getDatabasePager(), 1);
    geofx::viewer::setUpPaging(paging, *viewer.getDatabasePager(), *scene);
    viewer.setSceneData(scene->node);
    const osg::Vec4 color = viewer.getCamera()->getClearColor();
    const double nearFarRatio = viewer.getCamera()->getNearFarRatio();
    scene->setUpView(viewer);
    if (colorGiven) viewer.getCamera()->setClearColor(color);
    if (nearFarGiven) viewer.getCamera()->setNearFarRatio(nearFarRatio);
    geofx::viewer::addPanorama(*manipulators, *scene->effects);
    geofx::viewer::addHandlers(viewer, *scene, *manipulators, arguments.argc() == 2 ? arguments[1] : "");
    viewer.realize();
    if (!viewer.isRealized())
    {
        return refuse("No window with OpenGL can be opened on this display; check that it has GLX.");
    }
    const osg::Viewport* viewport = viewer.getCamera()->getViewport();
    const double aspect = viewport ? viewport->aspectRatio() : 1.0;
    viewer.getCamera()->setProjectionMatrixAsPerspective(fieldOfView, aspect, 1.0, 1e6);
    geofx::viewer::setHome(*manipulators, *scene, fieldOfView, aspect);
    geofx::viewer::setManipulators(viewer, *manipulators, *scene->effects);
    const int result = viewer.run();
    // GDAL's readers cannot be stopped, and a silent service keeps them for half a minute.
    if (!osgGeoFX::ReadingFile::longest().empty())
    {
        std::cout.flush();
        std::_Exit(result);
    }
    return result;
}
