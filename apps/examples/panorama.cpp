// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An OSG program that shows terrain, and the lines that paint it as a panorama map: panorama FILE
#include <osgDB/ReadFile>
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgViewer/Viewer>

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> terrain = osgDB::readRefNodeFile(argc > 1 ? argv[1] : "");
    if (!terrain) return 1;

    const osg::ref_ptr<osgGeoFX::PanoramaMap> map = new osgGeoFX::PanoramaMap;
    map->setHorizonLine(0.8);  // of the picture's height
    map->setExaggeration(2.5); // heights over widths
    map->setSeason(0.75);      // autumn
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(map);
    scene->addChild(terrain);

    osgViewer::Viewer viewer;
    viewer.setSceneData(scene); // was: viewer.setSceneData(terrain)
    // Any manipulator will do; with this one the painted ground follows the pointer.
    viewer.setCameraManipulator(new osgGeoFX::PanoramaManipulator(*scene, *map));
    return viewer.run();
}
