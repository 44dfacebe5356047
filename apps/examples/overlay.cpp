// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An OSG program that shows a globe's terrain, and the lines that throw a picture onto Honolulu: overlay FILE PICTURE
#include <osg/Math>
#include <osgDB/ReadFile>
#include <osgGA/TerrainManipulator>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgViewer/Viewer>

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> terrain = osgDB::readRefNodeFile(argc > 1 ? argv[1] : "");
    if (!terrain) return 1;

    const osg::ref_ptr<osgGeoFX::ProjectiveMapping> mapping = new osgGeoFX::ProjectiveMapping;
    mapping->setLayer(new osgGeoFX::DataLayer(osgDB::readImageFile(argc > 2 ? argv[2] : "")));
    mapping->setRectangle(osg::Vec2d(0.0, 0.0), 4000.0, 3000.0, 0.3); // metres about the origin; its heading
    mapping->setOpacity(0.8);
    const osg::ref_ptr<osgGeoFX::ProjectiveMappings> mappings = new osgGeoFX::ProjectiveMappings;
    mappings->setGeodeticOrigin(osg::DegreesToRadians(-157.86), osg::DegreesToRadians(21.31));
    mappings->addMapping(mapping);
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(mappings);
    scene->addChild(terrain);

    osgViewer::Viewer viewer;
    viewer.setSceneData(scene); // was: viewer.setSceneData(terrain)
    viewer.setCameraManipulator(new osgGA::TerrainManipulator);
    return viewer.run();
}
