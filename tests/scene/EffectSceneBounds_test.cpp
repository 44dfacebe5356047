// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The bounds below a scene are computed before cull threads ask for them, wherever a node with a bound of its own would have left
// them to the first that asks.
#include <gtest/gtest.h>
#include <osg/LOD>
#include <osgGeoFX/scene/EffectScene.h>

using namespace osgGeoFX;

namespace
{

/// Counts how often a bound is computed.
struct Counted : public osg::Node::ComputeBoundingSphereCallback
{
    osg::BoundingSphere computeBound(const osg::Node&) const override
    {
        ++times;
        return {osg::Vec3(), 1.0f};
    }
    mutable int times = 0;
};

/// Something below levels of detail that have a bound of their own, as paged tiles have; known but for what is below them.
struct Tile
{
    Tile()
    {
        osg::ref_ptr<osg::Group> inner = new osg::Group;
        inner->setComputeBoundingSphereCallback(counted);
        levels->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
        levels->setCenter(osg::Vec3());
        levels->setRadius(10.0f);
        levels->addChild(inner, 0.0f, 1e9f);
        top->addChild(levels);
        top->getBound();
    }
    osg::ref_ptr<Counted> counted = new Counted;
    osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    osg::ref_ptr<osg::Group> top = new osg::Group;
};

} // namespace

TEST(EffectSceneBounds, AreAllComputedWithTheScenes)
{
    const Tile first, second, third;
    ASSERT_EQ(first.counted->times, 0) << "OSG leaves it to who asks";
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    const osg::ref_ptr<osg::Group> plain = new osg::Group;
    scene->addChild(plain);
    scene->addChild(first.top);
    scene->getBound();
    EXPECT_EQ(first.counted->times, 1) << "its top was known already";
    // What comes later, below a plain group and below levels.
    plain->addChild(second.top);
    scene->getBound();
    EXPECT_EQ(second.counted->times, 1);
    first.levels->addChild(third.top, 1e9f, 2e9f);
    scene->getBound();
    EXPECT_EQ(third.counted->times, 1);
    // What is known is not computed again.
    scene->dirtyBound();
    scene->getBound();
    EXPECT_EQ(first.counted->times, 1);
}
