// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An OSG program that shows terrain, and the lines that light it by the sun of an hour, with shadows, in a bent view, too: sun FILE
#include <osgDB/ReadFile>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/light/SunLight.h>
#include <osgGeoFX/light/SunShadows.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgViewer/Viewer>

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> terrain = osgDB::readRefNodeFile(argc > 1 ? argv[1] : "");
    if (!terrain) return 1;

    const osg::ref_ptr<osgGeoFX::SunLight> sun = new osgGeoFX::SunLight; // light 0
    sun->setPlace(-2.7553, 0.3755, osg::Matrixd());                      // radians; x east, y north, z up
    sun->setTime(*osgGeoFX::readClockTime("2026-06-21T17:30:00-10:00"));
    const osg::ref_ptr<osgGeoFX::SunShadows> shadows = new osgGeoFX::SunShadows;
    shadows->setMapSize(4096); // sharper, in four times the memory
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(shadows);
    scene->addEffect(new osgGeoFX::BirdsEyeView);
    scene->addChild(sun);
    scene->addChild(terrain);
    scene->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);

    osgViewer::Viewer viewer;
    viewer.setLightingMode(osg::View::NO_LIGHT); // no headlight
    viewer.setSceneData(scene);                  // was: viewer.setSceneData(terrain)
    return viewer.run();
}
