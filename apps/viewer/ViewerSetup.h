// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/viewer/Scene.h>

#include <osg/ArgumentParser>
#include <osgDB/DatabasePager>
#include <osgGA/KeySwitchMatrixManipulator>
#include <osgViewer/Viewer>

#include <string>

/// What osggeofx_viewer puts into its viewer; apart from main(), so that tests press its keys.
namespace geofx::viewer
{

/// osgviewer's, under osgviewer's keys, the terrain manipulator first. Takes -p and --speed from the arguments, and reports what is
/// wrong with them there.
osg::ref_ptr<osgGA::KeySwitchMatrixManipulator> makeManipulators(osg::ArgumentParser& arguments);

/// Panorama maps begin with the manipulator that is made for them, unless a path is played.
void addPanorama(osgGA::KeySwitchMatrixManipulator& manipulators, osgGeoFX::EffectScene& scene);

/// Gives the viewer the manipulators, which keep above the ground as it is seen.
void setManipulators(osgViewer::Viewer& viewer, osgGA::KeySwitchMatrixManipulator& manipulators,
                     osgGeoFX::EffectScene& scene);

/// Lets all mappings of a scene be composed beforehand.
void composeMappings(osgGeoFX::EffectScene& scene);

/// What the command line says of tiles that are not in memory.
struct Paging
{
    double lead = 0.0;      ///< how far a TilePrefetch looks ahead, seconds; 0: there is none
    double memory = 0.0;    ///< MiB of main memory for tiles; 0: no limit
    double gpuMemory = 0.0; ///< MiB of OpenGL's objects; 0: no limit
};

/// Before the scene is shown.
void setUpPaging(const Paging& paging, osgDB::DatabasePager& pager, const osgGeoFX::Scene& scene);

/// Home is the scene's home view, for every manipulator but those that play a path. `fieldOfView` is the vertical one in degrees.
void setHome(osgGA::KeySwitchMatrixManipulator& manipulators, const osgGeoFX::Scene& scene,
             double fieldOfView, double aspect);

/// The event handlers: OSG's, ours, and the help page with the keys of both. The manipulators' own keys stand there, too.
/// `file`: what is shown, beside which maps are saved; empty for nowhere.
void addHandlers(osgViewer::Viewer& viewer, const osgGeoFX::Scene& scene,
                 osgGA::KeySwitchMatrixManipulator& manipulators, const std::string& file = {});

} // namespace geofx::viewer
