// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An OSG program that shows a globe's terrain, and the lines that lift Diamond Head out of it: closeup FILE
#include <osg/Math>
#include <osgDB/ReadFile>
#include <osgGA/TerrainManipulator>
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgViewer/Viewer>

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> terrain = osgDB::readRefNodeFile(argc > 1 ? argv[1] : "");
    if (!terrain) return 1;

    const osg::ref_ptr<osgGeoFX::CloseUp> closeUp = new osgGeoFX::CloseUp;
    closeUp->getRegion()->setGeodeticCenter(osg::DegreesToRadians(-157.808), osg::DegreesToRadians(21.261));
    closeUp->getRegion()->setSize(2600.0, 2600.0);    // metres
    closeUp->setOffset(osg::Vec3d(0.0, 0.0, 3000.0)); // metres above its place
    closeUp->setScale(2.0, 2.0, 3.0);                 // heights more than the rest
    const osg::ref_ptr<osgGeoFX::CloseUps> closeUps = new osgGeoFX::CloseUps;
    closeUps->addCloseUp(closeUp);
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(closeUps);
    scene->addChild(terrain);

    osgViewer::Viewer viewer;
    viewer.setSceneData(scene); // was: viewer.setSceneData(terrain)
    viewer.setCameraManipulator(new osgGA::TerrainManipulator);
    return viewer.run();
}
