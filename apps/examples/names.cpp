// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An OSG program that shows terrain, and the lines that put names of its own onto a bent view: names FILE
#include <osgDB/ReadFile>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/labels/MapLabels.h>
#include <osgGeoFX/labels/NamePlacement.h>
#include <osgViewer/Viewer>

#include <cmath>
#include <iostream>

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> terrain = osgDB::readRefNodeFile(argc > 1 ? argv[1] : "");
    if (!terrain) return 1;
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(new osgGeoFX::BirdsEyeView);
    scene->addChild(terrain);

    osgGeoFX::MapName kaala, honolulu;
    kaala.text = "Kaʻala";
    kaala.places = {{-158.1425, 21.5069, std::nan("")}}; // degrees; the ground's own height
    honolulu.text = "Honolulu";
    honolulu.places = {{-157.8583, 21.3069, std::nan("")}};
    honolulu.style = "city"; // with a dot, and not with a line
    std::vector<osgGeoFX::MapName> names = {kaala, honolulu};
    const osg::ref_ptr<const osg::EllipsoidModel> globe = scene->ground().ellipsoid;
    std::string error;
    const auto relief = osgGeoFX::TerrainRelief::read(*terrain, globe, 1024, error);
    if (!relief) return std::cerr << error << '\n', 1;
    osgGeoFX::NamePlacement().place(names, *terrain, globe,
                                    *relief); // onto the ground, summits onto their summits
    const osg::ref_ptr<osgGeoFX::NameSet> set = new osgGeoFX::NameSet(names);
    for (const auto& [kind, style] : osgGeoFX::usualNameStyles())
        set->setStyle(kind, style);
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(scene);
    root->addChild(new osgGeoFX::MapLabels(*scene, set)); // beside the scene, and not below it

    osgViewer::Viewer viewer;
    viewer.setSceneData(root); // was: viewer.setSceneData(scene)
    return viewer.run();
}
