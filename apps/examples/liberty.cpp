// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An OSG program that shows terrain, and the lines that take a painter's liberty with a summit: liberty FILE
#include <osgDB/ReadFile>
#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgViewer/Viewer>

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> terrain = osgDB::readRefNodeFile(argc > 1 ? argv[1] : "");
    if (!terrain) return 1;

    const osg::ref_ptr<osgGeoFX::RegionalLiberty> summit = new osgGeoFX::RegionalLiberty;
    summit->setGeodeticCenter(-2.7553, 0.3755); // Kaʻala on Oʻahu; radians
    summit->setRadii(9000.0, 9000.0);           // beyond these metres everything stays as it is
    summit->setEnlarge(1.5);                    // half again as high
    summit->setTurn(0.2);                       // and turned a little towards the viewer
    const osg::ref_ptr<osgGeoFX::PanoramaMap> map = new osgGeoFX::PanoramaMap;
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(summit); // before the map, which projects what the liberty has left
    scene->addEffect(map);
    scene->addChild(terrain);

    osgViewer::Viewer viewer;
    viewer.setSceneData(scene); // was: viewer.setSceneData(terrain)
    viewer.setCameraManipulator(new osgGeoFX::PanoramaManipulator(*scene, *map));
    return viewer.run();
}
