// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An OSG program that shows a globe's terrain, and the lines that put roads onto a bent view: lines FILE ROADS
#include <osgDB/ReadFile>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/lines/LineFile.h>
#include <osgGeoFX/lines/LinePlacement.h>
#include <osgGeoFX/lines/MapLines.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgViewer/Viewer>

#include <iostream>

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> terrain = osgDB::readRefNodeFile(argc > 1 ? argv[1] : "");
    if (!terrain) return 1;
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(new osgGeoFX::BirdsEyeView);
    scene->addChild(terrain);

    osgGeoFX::LineFile roads;
    roads.file = argc > 2 ? argv[2] : "";
    std::string error;
    if (!roads.read(error)) return std::cerr << error << '\n', 1;
    const osg::ref_ptr<const osg::EllipsoidModel> globe = scene->ground().ellipsoid;
    const auto relief = osgGeoFX::TerrainRelief::read(*terrain, globe, 1024, error);
    if (!relief) return std::cerr << error << '\n', 1;
    const auto styles = osgGeoFX::usualLineStyles();
    osgGeoFX::LinePlacement().place(roads.lines, styles, *terrain, globe, *relief); // onto the ground
    scene->addChild(new osgGeoFX::MapLines(roads.lines, styles)); // below the scene, whose effects move them

    osgViewer::Viewer viewer;
    viewer.setSceneData(scene); // was: viewer.setSceneData(terrain)
    return viewer.run();
}
