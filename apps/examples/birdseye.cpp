// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An OSG program that shows a terrain, and the lines that bend it: birdseye FILE
#include <osgDB/ReadFile>
#include <osgGA/TerrainManipulator>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgViewer/Viewer>

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> terrain = osgDB::readRefNodeFile(argc > 1 ? argv[1] : "");
    if (!terrain) return 1;

    const osg::ref_ptr<osgGeoFX::BirdsEyeView> view = new osgGeoFX::BirdsEyeView;
    view->setFocusLine(0.35);    // below this line of the picture a map
    view->setHorizonLine(0.85);  // here the skyline, wherever the camera looks
    view->setTessellation(true); // with OpenGL 4, a smooth bend however coarse the terrain is
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(view);
    scene->addChild(terrain);

    osgViewer::Viewer viewer;
    viewer.setSceneData(scene); // was: viewer.setSceneData(terrain)
    viewer.setCameraManipulator(new osgGA::TerrainManipulator);
    return viewer.run();
}
