// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Scenes that are replaced between frames, while threads draw the last frame of the former ones.
#include <tools/GlFixture.h>
#include <tools/ThreadedViews.h>

#include <osg/Geometry>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <cstring>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

constexpr int SIDE = 128; ///< of the picture, pixels
constexpr int CELLS = 24; ///< of the ground along a side

/// Level ground of many drawables, so that a frame is drawn for a while, below an exaggeration.
osg::ref_ptr<EffectScene> newScene()
{
    osg::ref_ptr<EffectScene> scene = new EffectScene;
    osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
    high->setFactor(2.0);
    scene->addEffect(high);
    osg::ref_ptr<osg::Group> ground = new osg::Group;
    for (int i = 0; i < CELLS * CELLS; ++i)
        ground->addChild(osg::createTexturedQuadGeometry(
            osg::Vec3(i % CELLS, i / CELLS, 0.0f), osg::Vec3(0.8f, 0.0f, 0.0f), osg::Vec3(0.0f, 0.8f, 0.0f)));
    scene->addChild(ground);
    return scene;
}

using SceneReplacement = GlFixture;

TEST_F(SceneReplacement, BetweenFramesLeavesTheFrameThatIsDrawnAsItIs)
{
    osg::ref_ptr<osg::Camera> like = new osg::Camera;
    like->setViewport(0, 0, SIDE, SIDE);
    like->setClearColor(osg::Vec4(0.0f, 0.0f, 0.3f, 1.0f));
    like->setProjectionMatrixAsPerspective(45.0, 1.0, 1.0, 1000.0);
    like->setViewMatrixAsLookAt(osg::Vec3(12.0f, -20.0f, 20.0f), osg::Vec3(12.0f, 12.0f, 0.0f), osg::Z_AXIS);
    osg::ref_ptr<osg::Image> expected;
    for (const auto model : ThreadedViews::models)
    {
        SCOPED_TRACE("threading model " + std::to_string(model));
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(newScene());
        ThreadedViews views(model);
        views.add(root, *like);
        views.realize();
        for (int i = 0; i < 40; ++i)
        {
            views.frame();
            root->setChild(0, newScene());
        }
        const osg::ref_ptr<osg::Image> picture = views.pictures().at(0);
        ASSERT_TRUE(picture);
        if (!expected) expected = picture;
        ASSERT_EQ(picture->getTotalSizeInBytes(), expected->getTotalSizeInBytes());
        EXPECT_EQ(std::memcmp(picture->data(), expected->data(), expected->getTotalSizeInBytes()), 0);
        EXPECT_NE(std::memcmp(picture->data(SIDE / 2, SIDE / 2), picture->data(0, SIDE - 1), 3), 0)
            << "the ground is seen";
    }
}

} // namespace
