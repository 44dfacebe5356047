// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "ViewerSetup.h"

#include "MapSaver.h"

#include <osgGeoFX/closeup/CloseUpHandler.h>
#include <osgGeoFX/map/MapKeys.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/paging/MemoryBudget.h>
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgGeoFX/scene/TilePrefetch.h>
#include <osgGeoFX/viewer/AboveGround.h>
#include <osgGeoFX/viewer/AutomaticPanorama.h>
#include <osgGeoFX/viewer/BendHandles.h>
#include <osgGeoFX/viewer/ClickAndFly.h>
#include <osgGeoFX/viewer/Compass.h>
#include <osgGeoFX/viewer/CurvePanel.h>
#include <osgGeoFX/viewer/EffectKeys.h>
#include <osgGeoFX/viewer/EffectPanel.h>
#include <osgGeoFX/viewer/GroundGrip.h>
#include <osgGeoFX/viewer/HelpPage.h>
#include <osgGeoFX/viewer/LibertyHandler.h>
#include <osgGeoFX/viewer/MappingPanel.h>
#include <osgGeoFX/viewer/MiniMap.h>
#include <osgGeoFX/viewer/PictureParts.h>
#include <osgGeoFX/viewer/PresetKeys.h>
#include <osgGeoFX/viewer/ProbePanel.h>
#include <osgGeoFX/viewer/SunKeys.h>
#include <osgGeoFX/viewer/TimeBar.h>
#include <osgGeoFX/viewer/ViewerHandlers.h>

#include <osg/Math>
#include <osgDB/FileUtils>
#include <osgDB/WriteFile>
#include <osgGA/AnimationPathManipulator>
#include <osgGA/DriveManipulator>
#include <osgGA/FirstPersonManipulator>
#include <osgGA/FlightManipulator>
#include <osgGA/OrbitManipulator>
#include <osgGA/SphericalManipulator>
#include <osgGA/StateSetManipulator>
#include <osgGA/TerrainManipulator>
#include <osgGA/TrackballManipulator>
#include <osgViewer/ViewerEventHandlers>

#include <algorithm>
#include <vector>

namespace geofx::viewer
{

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

namespace
{

/// The manipulator of a map, made where there is none yet.
void selectPanorama(osgGA::KeySwitchMatrixManipulator& manipulators, osgGeoFX::EffectScene& scene,
                    osgGeoFX::PanoramaMap& map)
{
    constexpr int key = '0';
    if (!dynamic_cast<osgGeoFX::PanoramaManipulator*>(manipulators.getMatrixManipulatorWithKey(key)))
        manipulators.addMatrixManipulator(key, "Panorama", new osgGeoFX::PanoramaManipulator(scene, map));
    unsigned int index = 0;
    for (const auto& [each, manipulator] : manipulators.getKeyManipMap())
    {
        if (each == key) manipulators.selectMatrixManipulator(index);
        ++index;
    }
}

/// Pictures of the window, each in a file that is not there yet.
class NewPictures : public osgViewer::ScreenCaptureHandler::CaptureOperation
{
public:
    void operator()(const osg::Image& image, const unsigned int context) override
    {
        const std::string begin = "screen_shot_" + std::to_string(context) + "_";
        std::string file;
        do
            file = begin + std::to_string(_next++) + ".jpg";
        while (osgDB::fileExists(file));
        if (!osgDB::writeImageFile(image, file))
            OSG_WARN << "osgGeoFX: " << file << " cannot be written; check the folder and the disk's space."
                     << std::endl;
    }

private:
    unsigned int _next = 0;
};

/// Where flights are recorded: OSG's usual file, unless paths are played, which it may be one of.
std::string flightFile(const osgGA::KeySwitchMatrixManipulator& manipulators)
{
    const auto& all = manipulators.getKeyManipMap();
    const bool plays =
        std::any_of(all.begin(), all.end(),
                    [](const auto& each) {
                        return dynamic_cast<const osgGA::AnimationPathManipulator*>(each.second.second.get());
                    });
    std::string file = "saved_animation.path";
    for (int number = 2; plays && osgDB::fileExists(file); ++number)
        file = "saved_animation-" + std::to_string(number) + ".path";
    return file;
}

} // namespace

void setManipulators(osgViewer::Viewer& viewer, osgGA::KeySwitchMatrixManipulator& manipulators,
                     osgGeoFX::EffectScene& scene)
{
    viewer.setCameraManipulator(new osgGeoFX::AboveGround(scene, manipulators));
}

void composeMappings(osgGeoFX::EffectScene& scene)
{
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        auto* mappings = dynamic_cast<osgGeoFX::ProjectiveMappings*>(scene.getEffect(i));
        if (mappings) mappings->setCaching(osgGeoFX::ProjectiveMappings::AUTOMATIC);
    }
}

void setUpPaging(const Paging& paging, osgDB::DatabasePager& pager, const osgGeoFX::Scene& scene)
{
    osg::ref_ptr<osgGeoFX::MemoryBudget> budget;
    if (paging.memory > 0.0 || paging.gpuMemory > 0.0)
    {
        budget = new osgGeoFX::MemoryBudget(pager);
        budget->setLimits(paging.memory, paging.gpuMemory);
        budget->watch(*scene.node, *scene.guard);
    }
    if (!(paging.lead > 0.0)) return;
    const osg::ref_ptr<osgGeoFX::TilePrefetch> prefetch = new osgGeoFX::TilePrefetch;
    prefetch->setLead(paging.lead);
    prefetch->setBudget(budget);
    scene.effects->setPrefetch(prefetch);
}

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

void addHandlers(osgViewer::Viewer& viewer, const osgGeoFX::Scene& scene,
                 osgGA::KeySwitchMatrixManipulator& manipulators, const std::string& file)
{
    viewer.addEventHandler(new osgGA::StateSetManipulator(viewer.getCamera()->getOrCreateStateSet()));
    viewer.addEventHandler(new osgViewer::ThreadingHandler);
    viewer.addEventHandler(new osgViewer::WindowSizeHandler);
    viewer.addEventHandler(new osgViewer::StatsHandler);
    viewer.addEventHandler(new osgViewer::RecordCameraPathHandler(flightFile(manipulators)));
    viewer.addEventHandler(new osgViewer::LODScaleHandler);
    viewer.addEventHandler(new osgViewer::ScreenCaptureHandler(new NewPictures));
    viewer.addEventHandler(new osgGeoFX::LodScaleFollower(scene));
    viewer.addEventHandler(osgGeoFX::makePartsHandler(*scene.effects));

    std::vector<osgGeoFX::HelpPage::Group> groups;
    const auto add = [&](const std::string& title, osgGA::GUIEventHandler* handler)
    {
        viewer.addEventHandler(handler);
        const auto known = std::find_if(groups.begin(), groups.end(),
                                        [&](const auto& group) { return group.title == title; });
        if (known == groups.end())
            groups.push_back({title, {handler}});
        else
            known->handlers.emplace_back(handler);
    };
    const osg::ref_ptr<osgGeoFX::CursorReadout> readout = new osgGeoFX::CursorReadout(scene);
    // OSG takes pictures of the window with c.
    readout->setKey('g');
    add("Ground", readout);
    add("Ground", new osgGeoFX::ClickAndFly(*scene.effects));
    add("Ground", new osgGeoFX::GroundGrip(*scene.effects));
    add("Ground", new osgGeoFX::Compass(*scene.effects, scene.reference));
    add("Ground", new osgGeoFX::MiniMap(*scene.effects, scene.reference, scene.terrain));
    const osg::ref_ptr<osgGeoFX::SunKeys> sun = new osgGeoFX::SunKeys(*scene.node);
    if (sun->hasSun()) add("Ground", sun);
    add("Effects", new osgGeoFX::EffectKeys(*scene.effects));
    add("Effects", new osgGeoFX::BendHandles(*scene.effects));
    const osg::ref_ptr<osgGeoFX::PresetKeys> presets = new osgGeoFX::PresetKeys(*scene.effects);
    if (presets->hasPresets()) add("Effects", presets);
    const osg::ref_ptr<osgGeoFX::EffectPanel> effects = new osgGeoFX::EffectPanel(*scene.effects);
    add("Lists", effects);
    const osg::ref_ptr<osgGeoFX::AutomaticPanorama> automatic =
        new osgGeoFX::AutomaticPanorama(*scene.effects, *scene.node);
    automatic->setPrepared([manipulators = osg::ref_ptr(&manipulators), scene = scene.effects](
                               osgGeoFX::PanoramaMap& map) { selectPanorama(*manipulators, *scene, map); });
    effects->addButton("Make a panorama map", [automatic] { automatic->request(); });
    effects->addButton("Make one with liberties",
                       [automatic] { automatic->request(osgGeoFX::PanoramaComposer::usualLiberties); });
    const osg::ref_ptr<osgGeoFX::MappingPanel> panel = new osgGeoFX::MappingPanel(*scene.effects);
    if (panel->hasEffect()) add("Lists", panel);
    if (panel->hasEffect()) add("Ground", new osgGeoFX::ProbePanel(*scene.effects));
    if (osgGeoFX::LayerPlayer* const player = osgGeoFX::LayerPlayer::of(*scene.effects))
        add("Layers in time", new osgGeoFX::TimeBar(*player->getClock()));
    for (unsigned int i = 0; i < scene.effects->getNumEffects(); ++i)
    {
        auto* closeUps = dynamic_cast<osgGeoFX::CloseUps*>(scene.effects->getEffect(i));
        if (closeUps) add("Close-ups", new osgGeoFX::CloseUpHandler(*scene.effects, *closeUps));
    }
    add("Effects", new osgGeoFX::LibertyHandler(*scene.effects));
    const osg::ref_ptr<osgGeoFX::MapKeys> map = new osgGeoFX::MapKeys(*scene.node);
    if (map->hasNames() || map->hasLines()) add("Names and lines", map);
    add("Panorama map", automatic);
    add("Panorama map", new osgGeoFX::CurvePanel(*scene.effects));
    if (!file.empty()) add("Panorama map", new MapSaver(scene, file));
    for (const auto& [key, manipulator] : manipulators.getKeyManipMap())
    {
        const auto* panorama = dynamic_cast<const osgGeoFX::PanoramaManipulator*>(manipulator.second.get());
        if (panorama) groups.back().handlers.emplace_back(panorama);
    }
    // The last, which looks at all others.
    viewer.addEventHandler(new osgGeoFX::HelpPage(groups));
}

} // namespace geofx::viewer
