// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An OSG program with shadows of osgShadow, and the lines that bend its town of boxes: shadows [FILE, in the place of the town]
#include <osg/Geometry>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgGA/TerrainManipulator>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/MeshRefiner.h>
#include <osgShadow/LightSpacePerspectiveShadowMap>
#include <osgShadow/ShadowedScene>
#include <osgViewer/Viewer>

#include <cmath>

namespace
{

/// Boxes along streets, on a plane, 3 km wide.
osg::ref_ptr<osg::Node> makeTown()
{
    osg::ref_ptr<osg::Group> town = new osg::Group;
    const osg::ref_ptr<osg::Geometry> ground = osg::createTexturedQuadGeometry(
        {-1500.0f, -1500.0f, 0.0f}, {3000.0f, 0.0f, 0.0f}, {0.0f, 3000.0f, 0.0f});
    const osg::ref_ptr<osg::Vec4Array> green = new osg::Vec4Array(1);
    green->front().set(0.55f, 0.60f, 0.47f, 1.0f);
    ground->setColorArray(green, osg::Array::BIND_OVERALL);
    town->addChild(ground);
    const auto add = [&](const osg::Vec3& middle, const osg::Vec3& size, const osg::Vec4& color)
    {
        osg::ref_ptr<osg::ShapeDrawable> box =
            new osg::ShapeDrawable(new osg::Box(middle, size.x(), size.y(), size.z()));
        box->setColor(color);
        town->addChild(box);
    };
    for (int i = 0; i < 40 * 40; ++i)
    {
        const int column = i % 40, row = i / 40;
        if (column % 5 == 2 || row % 7 == 3) continue; // streets
        const auto x = static_cast<float>(column * 70 - 1365), y = static_cast<float>(row * 70 - 1365);
        const float tall =
            10.0f + 60.0f * std::exp(-(x * x + y * y) / 250000.0f) + static_cast<float>(i * 7 % 13);
        const float shade = 0.78f + 0.02f * static_cast<float>(i * 5 % 11);
        add({x, y, 0.5f * tall}, {36.0f, 44.0f, tall},
            i % 3 == 0 ? osg::Vec4(shade, 0.74f * shade, 0.62f * shade, 1.0f)
                       : osg::Vec4(shade, 0.95f * shade, 0.86f * shade, 1.0f));
    }
    return town;
}

} // namespace

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> town = argc > 1 ? osgDB::readRefNodeFile(argv[1]) : makeTown();
    if (!town) return 1;
    const osg::ref_ptr<osgShadow::ShadowedScene> shadows = new osgShadow::ShadowedScene;
    const osg::ref_ptr<osgShadow::LightSpacePerspectiveShadowMapVB> technique =
        new osgShadow::LightSpacePerspectiveShadowMapVB;
    technique->setTextureSize({4096, 4096});
    shadows->setShadowTechnique(technique);
    const osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
    sun->getLight()->setPosition({-0.6f, -0.5f, 0.5f, 0.0f});
    sun->getLight()->setDiffuse({0.72f, 0.66f, 0.55f, 1.0f});
    sun->getLight()->setSpecular({0.0f, 0.0f, 0.0f, 1.0f});
    shadows->addChild(sun);
    const osg::ref_ptr<osg::LightModel> sky = new osg::LightModel;
    sky->setAmbientIntensity({0.38f, 0.42f, 0.5f, 1.0f});
    shadows->getOrCreateStateSet()->setAttribute(sky);

    // The ground is two triangles, which no bend can bend.
    const osg::ref_ptr<osgGeoFX::MeshRefiner> refiner = new osgGeoFX::MeshRefiner(20.0);
    refiner->refine(*town);
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(new osgGeoFX::BirdsEyeView);
    scene->setAdaptsPrograms(true); // the technique's are no node's
    scene->addChild(town);
    shadows->addChild(scene);

    osgViewer::Viewer viewer;
    viewer.setSceneData(shadows);
    viewer.setCameraManipulator(new osgGA::TerrainManipulator);
    return viewer.run();
}
