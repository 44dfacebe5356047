// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What an EffectScene finds out of the ground below it, and how much of the graph it looks at for that: by counting, not by time.
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/NotifyWatch.h>

#include <gtest/gtest.h>
#include <osg/CoordinateSystemNode>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/Switch>
#include <osg/ValueObject>

#include <cmath>
#include <functional>
#include <string>

using namespace osgGeoFX;

namespace
{

/// How often anyone has asked one of them what it is, which each way down a graph begins with.
int asked = 0;

class CountedGroup : public osg::Group
{
public:
    osg::Group* asGroup() override
    {
        ++asked;
        return this;
    }
    const osg::Group* asGroup() const override
    {
        ++asked;
        return this;
    }
    void traverse(osg::NodeVisitor& visitor) override
    {
        ++asked;
        osg::Group::traverse(visitor);
    }
};

/// 100,000 groups and more, ten in each, four levels and five.
osg::ref_ptr<osg::Group> makeCrowd(int levels = 5)
{
    osg::ref_ptr<osg::Group> group = new CountedGroup;
    for (int i = 0; levels > 0 && i < 10; ++i)
        group->addChild(makeCrowd(levels - 1));
    return group;
}

int askedBy(const EffectScene& scene, Ground* found = nullptr)
{
    asked = 0;
    const Ground ground = scene.ground();
    if (found) *found = ground;
    return asked;
}

osg::ref_ptr<osg::CoordinateSystemNode> makeSystem(double radius)
{
    osg::ref_ptr<osg::CoordinateSystemNode> system = new osg::CoordinateSystemNode;
    system->setEllipsoidModel(new osg::EllipsoidModel(radius, radius));
    return system;
}

osg::ref_ptr<osg::CoordinateSystemNode> makeTerrainRoot(double highest)
{
    osg::ref_ptr<osg::CoordinateSystemNode> root = makeSystem(6.4e6);
    root->setName("osgGeoFX terrain");
    root->setUserValue("geofx.format", osgGeoFX::TerrainInfo::newestFormat);
    root->setUserValue("geofx.kind", std::string("geocentric"));
    for (const char* name : {"west", "south", "east", "north", "minHeight", "pixelsPerRadian", "pixelError"})
        root->setUserValue(std::string("geofx.") + name, 1.0);
    root->setUserValue("geofx.maxHeight", highest);
    root->setUserValue("geofx.levels", 3);
    root->setUserValue("geofx.vertical", std::string("ellipsoid"));
    return root;
}

double radiusOf(const Ground& ground)
{
    return ground.ellipsoid ? ground.ellipsoid->getRadiusEquator() : 0.0;
}

/// The ground after at most so many frames.
Ground after(const EffectScene& scene, int frames)
{
    Ground ground;
    for (int i = 0; i < frames; ++i)
        askedBy(scene, &ground);
    return ground;
}

} // namespace

TEST(GroundSearch, CostsNextToNothingAfterTheFirstFrame)
{
    const osg::ref_ptr<osg::Group> crowd = makeCrowd();
    for (const std::string kind : {"no coordinate system", "a coordinate system above them", "one beside"})
    {
        SCOPED_TRACE(kind);
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        const osg::ref_ptr<osg::CoordinateSystemNode> system = makeSystem(7e6);
        if (kind[0] == 'a')
        {
            system->addChild(crowd);
            scene->addChild(system);
        }
        else
        {
            scene->addChild(crowd);
            if (kind[0] == 'o') scene->addChild(system);
        }
        const int first = askedBy(*scene);
        EXPECT_GT(first, 100000) << "it has to look once";
        for (int frame = 0; frame < 3; ++frame)
        {
            Ground ground;
            EXPECT_LE(askedBy(*scene, &ground), 300) << "of more than 100,000";
            EXPECT_EQ(radiusOf(ground), kind[0] == 'n' ? 0.0 : 7e6);
        }
    }
}

TEST(GroundSearch, CostsLittleWhereSomethingMoves)
{
    const osg::ref_ptr<osg::Group> crowd = makeCrowd();
    const osg::ref_ptr<osg::MatrixTransform> car = new osg::MatrixTransform;
    crowd->getChild(3)->asGroup()->addChild(car);
    for (const bool globe : {false, true})
    {
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        const osg::ref_ptr<osg::Group> above = globe ? makeSystem(7e6).get() : new osg::Group;
        scene->addChild(above);
        above->addChild(crowd);
        askedBy(*scene);
        for (int frame = 0; frame < 20; ++frame)
        {
            car->setMatrix(osg::Matrix::translate(frame, 0.0, 0.0));
            EXPECT_LE(askedBy(*scene), 300) << "of more than 100,000";
        }
        above->removeChild(crowd);
    }
}

TEST(GroundSearch, NoticesWhatComesAndGoes)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    const osg::ref_ptr<osg::Group> group = new osg::Group, deeper = new osg::Group;
    scene->addChild(group);
    group->addChild(new osg::Group);
    group->addChild(deeper);
    EXPECT_EQ(radiusOf(after(*scene, 1)), 0.0);
    const osg::ref_ptr<osg::CoordinateSystemNode> first = makeSystem(5e6), second = makeSystem(8e6);
    deeper->addChild(first);
    EXPECT_EQ(radiusOf(after(*scene, 2)), 5e6);
    // While it is there, another one does not take its place; then it does, at once.
    deeper->addChild(second);
    EXPECT_EQ(radiusOf(after(*scene, 2)), 5e6);
    deeper->removeChild(first);
    EXPECT_EQ(radiusOf(after(*scene, 1)), 8e6);
    group->removeChild(deeper);
    EXPECT_EQ(radiusOf(after(*scene, 1)), 0.0);
    // Its bound was asked for before it came.
    deeper->getBound();
    group->addChild(deeper);
    EXPECT_EQ(radiusOf(after(*scene, 2)), 8e6);
}

/// A globe is none the less one for what stands above its coordinate system.
TEST(GroundSearch, FindsASystemWhereverItIs)
{
    const osg::ref_ptr<osg::CoordinateSystemNode> system = makeSystem(7e6);
    const auto levels = []
    {
        return osg::ref_ptr<osg::Group>(new osg::LOD);
    };
    const auto paged = []
    {
        return osg::ref_ptr<osg::Group>(new osg::PagedLOD);
    };
    const auto group = []
    {
        return osg::ref_ptr<osg::Group>(new osg::Group);
    };
    const auto off = []
    {
        const osg::ref_ptr<osg::Switch> result = new osg::Switch;
        result->setNewChildDefaultValue(false);
        return osg::ref_ptr<osg::Group>(result);
    };
    struct Way
    {
        const char* name;
        std::function<osg::ref_ptr<osg::Group>()> make;
        int levels;
    };
    for (const Way& way : {Way{"levels of detail", levels, 1}, Way{"paged levels of detail", paged, 1},
                           Way{"many paged levels", paged, 30}, Way{"ten levels down", group, 10},
                           Way{"sixty levels down", group, 60}, Way{"a switch", off, 1}})
    {
        SCOPED_TRACE(way.name);
        for (const bool later : {false, true})
        {
            const osg::ref_ptr<EffectScene> scene = new EffectScene;
            osg::ref_ptr<osg::Group> last = scene;
            for (int i = 0; i < way.levels; ++i)
            {
                const osg::ref_ptr<osg::Group> next = way.make();
                last->addChild(next);
                last = next;
            }
            // A tile that a pager brings.
            if (later)
            {
                EXPECT_EQ(radiusOf(after(*scene, 1)), 0.0);
            }
            last->addChild(system);
            EXPECT_EQ(radiusOf(after(*scene, 2)), 7e6);
            // One that it takes away again.
            last->removeChild(system);
            EXPECT_EQ(radiusOf(after(*scene, 1)), 0.0);
        }
    }
    // Above the scene, with levels of detail between them.
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    const osg::ref_ptr<osg::Group> between = levels();
    EXPECT_EQ(radiusOf(scene->ground({system.get(), between.get(), scene.get()})), 7e6);
}

TEST(GroundSearch, NoticesWhatComesToALargeScene)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    const osg::ref_ptr<osg::Group> crowd = makeCrowd();
    scene->addChild(crowd);
    askedBy(*scene);
    crowd->getChild(9)->asGroup()->addChild(makeSystem(5e6));
    int frames = 0;
    while (radiusOf(after(*scene, 1)) == 0.0 && frames < 9000)
        ++frames;
    EXPECT_LT(frames, 5000);
}

TEST(GroundSearch, FindsTheKitsTerrainBelowAnotherSystem)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    const osg::ref_ptr<osg::CoordinateSystemNode> system = makeSystem(6.4e6);
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    scene->addChild(system);
    system->addChild(group);
    EXPECT_FALSE(after(*scene, 1).heightsKnown);
    const osg::ref_ptr<osg::CoordinateSystemNode> terrain = makeTerrainRoot(1234.0);
    group->addChild(terrain);
    EXPECT_TRUE(after(*scene, 2).heightsKnown);
    EXPECT_EQ(after(*scene, 1).maxHeight, 1234.0);
    group->replaceChild(terrain, makeTerrainRoot(567.0));
    EXPECT_EQ(after(*scene, 1).maxHeight, 567.0);
    group->removeChildren(0, group->getNumChildren());
    EXPECT_FALSE(after(*scene, 1).heightsKnown);
    // The system above the scene.
    const osg::ref_ptr<osg::CoordinateSystemNode> above = makeTerrainRoot(89.0);
    EXPECT_EQ(scene->ground({above.get(), scene.get()}).maxHeight, 89.0);
}

TEST(GroundSearch, AGlobeWithoutASystemHasOneEllipsoid)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    scene->setTerrainFrame(EffectScene::GEOCENTRIC);
    const Ground first = scene->ground();
    ASSERT_TRUE(first.ellipsoid);
    EXPECT_EQ(first.ellipsoid, scene->ground().ellipsoid)
        << "effects tell by it whether the ground has changed";
    EXPECT_EQ(first.ellipsoid->getRadiusEquator(), osg::WGS_84_RADIUS_EQUATOR);
}

TEST(GroundSearch, WhatIsStatedComesFirstAndADatabaseFillsTheRest)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    EffectScene::GroundDescription stated;
    stated.minHeight = -3.0;
    stated.maxHeight = 2110.0;
    stated.tileCells = 16;
    ASSERT_TRUE(scene->setGround(stated));
    Ground ground = scene->ground();
    EXPECT_TRUE(ground.heightsKnown);
    EXPECT_EQ(ground.minHeight, -3.0);
    EXPECT_EQ(ground.maxHeight, 2110.0);
    EXPECT_EQ(ground.tileEdge, 0.125) << "the diagonal of one of 16 cells, in halves of the tile's";
    EXPECT_GT(ground.tileError, 0.0) << "without an error no edge would be short enough";
    EXPECT_FALSE(ground.ellipsoid);
    EXPECT_FALSE(ground.terrain.valid());

    // A database of the kit below: its ellipsoid and latitude, and the heights that were stated.
    scene->addChild(makeTerrainRoot(567.0));
    ground = scene->ground();
    EXPECT_EQ(radiusOf(ground), 6.4e6);
    EXPECT_TRUE(ground.terrain.valid());
    EXPECT_EQ(ground.maxHeight, 2110.0);
    // Nothing but the frame is stated.
    stated = {};
    stated.frame = EffectScene::PROJECTED;
    ASSERT_TRUE(scene->setGround(stated));
    EXPECT_EQ(scene->getTerrainFrame(), EffectScene::PROJECTED);
    ground = scene->ground();
    EXPECT_FALSE(ground.ellipsoid);
    EXPECT_EQ(ground.maxHeight, 567.0);
    EXPECT_EQ(ground.tileEdge, 0.0);
}

TEST(GroundSearch, ADescriptionThatCannotBeRightIsRefusedInASentence)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    EffectScene::GroundDescription good;
    good.minHeight = 1.0;
    good.maxHeight = 2.0;
    ASSERT_TRUE(scene->setGround(good));
    geofx::test::NotifyWatch watch;
    const auto refused =
        [&](const std::string& why, const std::function<void(EffectScene::GroundDescription&)>& change)
    {
        EffectScene::GroundDescription bad = good;
        change(bad);
        const auto said = watch.messagesOf([&] { EXPECT_FALSE(scene->setGround(bad)); });
        ASSERT_EQ(said.size(), 1u);
        EXPECT_NE(said[0].find(why), std::string::npos) << said[0];
        EXPECT_EQ(scene->getGround().maxHeight, 2.0) << "the former one stays";
        EXPECT_EQ(scene->getGround().tileCells, 0);
    };
    refused("together", [](auto& each) { each.maxHeight.reset(); });
    refused("together", [](auto& each) { each.minHeight.reset(); });
    refused("must not be above", [](auto& each) { each.maxHeight = 0.5; });
    refused("-12000 to 100000", [](auto& each) { each.minHeight = -12001.0; });
    refused("-12000 to 100000", [](auto& each) { each.maxHeight = 1e5 + 1.0; });
    refused("-12000 to 100000", [](auto& each) { each.maxHeight = std::nan(""); });
    refused("tileCells", [](auto& each) { each.tileCells = -1; });
    refused("tileCells", [](auto& each) { each.tileCells = 4097; });
}
