// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An OSG program that shows a terrain, with the ground overlays of a KML file and the ways of another one on it: overlays FILE OVERLAYS WAYS
#include <osgDB/ReadFile>
#include <osgGeoFX/map/SceneOverlays.h>
#include <osgGeoFX/map/SceneRoutes.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgViewer/Viewer>

#include <iostream>

int main(int argc, char** argv)
{
    if (argc < 4) return 1;
    const osg::ref_ptr<osg::Node> terrain = osgDB::readRefNodeFile(argv[1]);
    if (!terrain) return 1;
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addChild(terrain);

    std::string error;
    std::vector<std::string> notices;
    osgGeoFX::SceneOverlays overlays(*terrain, *scene);
    if (!overlays.add(argv[2], {}, notices, error)) return std::cerr << error << '\n', 1;
    osgGeoFX::SceneRoutes routes(*terrain, *scene); // over the overlays
    if (!routes.add(argv[3], {}, error)) return std::cerr << error << '\n', 1;

    osgViewer::Viewer viewer;
    viewer.setSceneData(scene); // was: viewer.setSceneData(terrain)
    return viewer.run();
}
