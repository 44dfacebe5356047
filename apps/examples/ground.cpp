// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An OSG program that shows terrain, and the lines that give its ground detail from nearby, in a bent view whose distance is a map in
// grey: ground FILE
#include <osgDB/ReadFile>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/ground/GroundDetail.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgViewer/Viewer>

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> terrain = osgDB::readRefNodeFile(argc > 1 ? argv[1] : "");
    if (!terrain) return 1;

    const osg::ref_ptr<osgGeoFX::GroundDetail> detail = new osgGeoFX::GroundDetail;
    detail->setRelief(0.8);   // how much light and shade its waves make
    detail->setSmallest(0.3); // metres
    const osg::ref_ptr<osgGeoFX::BirdsEyeView> view = new osgGeoFX::BirdsEyeView;
    view->setCoverMap(true);         // a map of what the tiles say of the ground
    view->setContextSaturation(0.3); // and greyer
    view->setContextBlocks(1.0);     // buildings without windows
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(detail);
    scene->addEffect(view);
    scene->addChild(terrain);

    osgViewer::Viewer viewer;
    viewer.setSceneData(scene); // was: viewer.setSceneData(terrain)
    return viewer.run();
}
