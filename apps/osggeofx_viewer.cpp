// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osggeofx_viewer: osgviewer, made for terrain.
#include <osgGeoFX/closeup/CloseUpHandler.h>
#include <osgGeoFX/deformation/ClickAndFly.h>
#include <osgGeoFX/mapping/MappingPanel.h>
#include <osgGeoFX/paging/Scene.h>
#include <osgGeoFX/paging/ViewerHandlers.h>
#include <osgGeoFX/panel/EffectPanel.h>
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgGeoFX/scene/EffectKeys.h>
#include <osgGeoFX/scene/EffectKinds.h>

#include <osg/ArgumentParser>
#include <osg/GraphicsContext>
#include <osg/Math>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>
#include <osgGA/AnimationPathManipulator>
#include <osgGA/DriveManipulator>
#include <osgGA/FirstPersonManipulator>
#include <osgGA/FlightManipulator>
#include <osgGA/KeySwitchMatrixManipulator>
#include <osgGA/OrbitManipulator>
#include <osgGA/SphericalManipulator>
#include <osgGA/StateSetManipulator>
#include <osgGA/TerrainManipulator>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>
#include <osgViewer/ViewerEventHandlers>

#include <cstdlib>
#include <iostream>

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
        "It takes osgviewer's options and keys; press h in the window for the keys. F9 lists the scene's "
        "mappings, F10 its effects with all their properties. A click makes a close-up active (the key u "
        "says when), Shift and the left button drag "
        "it. A panorama map has a manipulator of its own, key 0.");
    usage.setCommandLineUsage("osggeofx_viewer [options] FILE ...");
    usage.addCommandLineOption("--fov <degrees>", "Vertical field of view (default: the scene's, or 30).");
    usage.addCommandLineOption("--effect '<kind> <property>=<value> ...'",
                               "Add an effect to the scene's, as in osggeofx_render; as often as wanted.");
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

osg::ref_ptr<osgGA::KeySwitchMatrixManipulator> makeManipulators(osg::ArgumentParser& arguments)
{
    osg::ref_ptr<osgGA::KeySwitchMatrixManipulator> manipulators = new osgGA::KeySwitchMatrixManipulator;
    // The keys are osgviewer's.
    manipulators->addMatrixManipulator('1', "Trackball", new osgGA::TrackballManipulator);
    manipulators->addMatrixManipulator('2', "Flight", new osgGA::FlightManipulator);
    manipulators->addMatrixManipulator('3', "Drive", new osgGA::DriveManipulator);
    manipulators->addMatrixManipulator('4', "Terrain", new osgGA::TerrainManipulator);
    manipulators->addMatrixManipulator('5', "Orbit", new osgGA::OrbitManipulator);
    manipulators->addMatrixManipulator('6', "FirstPerson", new osgGA::FirstPersonManipulator);
    manipulators->addMatrixManipulator('7', "Spherical", new osgGA::SphericalManipulator);
    manipulators->selectMatrixManipulator(3);

    double speed = 1.0;
    arguments.read("--speed", speed);
    std::string file;
    for (int key = '8'; arguments.read("-p", file); ++key)
    {
        osg::ref_ptr<osgGA::AnimationPathManipulator> path;
        if (osgDB::fileExists(file)) path = new osgGA::AnimationPathManipulator(file);
        if (!path || path->getAnimationPath()->empty())
        {
            arguments.reportError("The camera path \"" + file + "\" cannot be read");
            continue;
        }
        path->setTimeScale(speed);
        const unsigned int index = manipulators->getNumMatrixManipulators();
        manipulators->addMatrixManipulator(key, "Path", path);
        manipulators->selectMatrixManipulator(index);
    }
    return manipulators;
}

/// Panorama maps begin with the manipulator that is made for them, unless a path is played.
void addPanorama(osgGA::KeySwitchMatrixManipulator& manipulators, osgGeoFX::EffectScene& scene)
{
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        auto* map = dynamic_cast<osgGeoFX::PanoramaMap*>(scene.getEffect(i));
        if (!map) continue;
        manipulators.addMatrixManipulator('0', "Panorama", new osgGeoFX::PanoramaManipulator(scene, *map));
        const bool plays =
            dynamic_cast<osgGA::AnimationPathManipulator*>(manipulators.getCurrentMatrixManipulator());
        // The first in the order of keys.
        if (map->getEnabled() && !plays) manipulators.selectMatrixManipulator(0);
        return;
    }
}

/// Home is the scene's home view, for every manipulator but those that play a path.
void setHome(osgGA::KeySwitchMatrixManipulator& manipulators, const osgGeoFX::Scene& scene,
             double fieldOfView, double aspect)
{
    osg::Vec3d eye;
    osg::Vec3d center;
    osg::Vec3d up;
    const osg::Matrixd view = scene.homeViewMatrix(osg::DegreesToRadians(fieldOfView), aspect);
    const osg::BoundingSphere& bound = scene.node->getBound();
    const osg::Vec3d inEye = osg::Vec3d(bound.center()) * view;
    view.getLookAt(eye, center, up, std::max(-inEye.z(), 0.01 * static_cast<double>(bound.radius())));
    for (auto& entry : manipulators.getKeyManipMap())
    {
        osgGA::CameraManipulator* manipulator = entry.second.second.get();
        if (dynamic_cast<osgGA::AnimationPathManipulator*>(manipulator)) continue;
        manipulator->setAutoComputeHomePosition(false);
        manipulator->setHomePosition(eye, center, up);
    }
}

void addHandlers(osgViewer::Viewer& viewer, osg::ArgumentParser& arguments, const osgGeoFX::Scene& scene)
{
    viewer.addEventHandler(new osgGA::StateSetManipulator(viewer.getCamera()->getOrCreateStateSet()));
    viewer.addEventHandler(new osgViewer::ThreadingHandler);
    viewer.addEventHandler(new osgViewer::WindowSizeHandler);
    viewer.addEventHandler(new osgViewer::StatsHandler);
    viewer.addEventHandler(new osgViewer::HelpHandler(arguments.getApplicationUsage()));
    viewer.addEventHandler(new osgViewer::RecordCameraPathHandler);
    viewer.addEventHandler(new osgViewer::LODScaleHandler);
    viewer.addEventHandler(new osgViewer::ScreenCaptureHandler);
    viewer.addEventHandler(new osgGeoFX::CursorReadout(scene));
    viewer.addEventHandler(new osgGeoFX::LodScaleFollower(scene));
    viewer.addEventHandler(new osgGeoFX::EffectKeys(*scene.effects));
    viewer.addEventHandler(new osgGeoFX::ClickAndFly(*scene.effects));
    viewer.addEventHandler(new osgGeoFX::EffectPanel(*scene.effects));
    const osg::ref_ptr<osgGeoFX::MappingPanel> panel = new osgGeoFX::MappingPanel(*scene.effects);
    if (panel->hasEffect()) viewer.addEventHandler(panel);
    for (unsigned int i = 0; i < scene.effects->getNumEffects(); ++i)
    {
        auto* closeUps = dynamic_cast<osgGeoFX::CloseUps*>(scene.effects->getEffect(i));
        if (closeUps) viewer.addEventHandler(new osgGeoFX::CloseUpHandler(*scene.effects, *closeUps));
    }
}

} // namespace

int main(int argc, char** argv)
{
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
    std::vector<osg::ref_ptr<osgGeoFX::Effect>> effects;
    std::string text;
    std::string effectFault;
    while (arguments.read("--effect", text) && effectFault.empty())
    {
        effects.push_back(osgGeoFX::parseEffect(text, effectFault));
    }
    if (!effectFault.empty()) return refuse("--effect: " + effectFault);
    double fieldOfView = 0.0;
    const bool fieldOfViewGiven = arguments.read("--fov", fieldOfView);
    const osg::ref_ptr<osgGA::KeySwitchMatrixManipulator> manipulators = makeManipulators(arguments);
    arguments.reportRemainingOptionsAsUnrecognized();
    if (arguments.errors())
    {
        return refuse(arguments.getErrorMessageMap().begin()->first + "; see --help.");
    }
    if (arguments.argc() < 2)
    {
        return refuse("Name a file to show; see --help.");
    }
    if (fieldOfViewGiven && !(fieldOfView > 0.0 && fieldOfView < 180.0))
    {
        return refuse("--fov must lie between 0 and 180 degrees.");
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
        scene = osgGeoFX::Scene::load(arguments[1], error);
    }
    else if (const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFiles(arguments))
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

    for (const auto& effect : effects)
        scene->effects->addEffect(effect);
    scene->effects->listenTo(*scene->guard);
    if (!fieldOfViewGiven) fieldOfView = scene->settings.homeFov.value_or(30.0);
    viewer.setSceneData(scene->node);
    const osg::Vec4 color = viewer.getCamera()->getClearColor();
    const double nearFarRatio = viewer.getCamera()->getNearFarRatio();
    scene->setUpView(viewer);
    if (colorGiven) viewer.getCamera()->setClearColor(color);
    if (nearFarGiven) viewer.getCamera()->setNearFarRatio(nearFarRatio);
    addHandlers(viewer, arguments, *scene);
    viewer.realize();
    if (!viewer.isRealized())
    {
        return refuse("No window with OpenGL can be opened on this display; check that it has GLX.");
    }
    const osg::Viewport* viewport = viewer.getCamera()->getViewport();
    const double aspect = viewport ? viewport->aspectRatio() : 1.0;
    viewer.getCamera()->setProjectionMatrixAsPerspective(fieldOfView, aspect, 1.0, 1e6);
    addPanorama(*manipulators, *scene->effects);
    setHome(*manipulators, *scene, fieldOfView, aspect);
    viewer.setCameraManipulator(manipulators);
    return viewer.run();
}
