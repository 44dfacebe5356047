// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What is taller than the bend's radius folds over. A database that tells its heights gets a zone that is wide enough; of
// anything else the scene says so, once, in one sentence whose advice helps.
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <tools/BentGround.h>

#include <osg/CoordinateSystemNode>
#include <osg/ValueObject>

using namespace osgGeoFX;
using geofx::test::BentGround;

namespace
{

class Folds : public BentGround
{
protected:
    /// The ground ahead folded up from y = −50 m to −10 m, with a radius of about 35 m; the eye stands at y = −150 m.
    static osg::ref_ptr<PedestrianView> makeFold(double tallest = -1.0)
    {
        osg::ref_ptr<PedestrianView> fold = new PedestrianView;
        fold->setFocusDistance(100.0);
        fold->setZoneWidth(40.0);
        fold->setTallest(tallest);
        return fold;
    }

    static osg::ref_ptr<EffectScene> sceneOf(Effect* effect,
                                             const std::vector<osg::ref_ptr<osg::Node>>& children)
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(effect);
        for (const auto& child : children)
            scene->addChild(child);
        return scene;
    }

    /// A thing below what tells of the heights of the ground, as the kit's databases do.
    static osg::ref_ptr<osg::Node> database(double lowest, double highest, osg::Node* thing)
    {
        osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
        root->setName("osgGeoFX terrain");
        root->setUserValue("geofx.format", osgGeoFX::TerrainInfo::newestFormat);
        root->setUserValue("geofx.kind", std::string("projected"));
        for (const char* name : {"geofx.west", "geofx.south", "geofx.east", "geofx.north",
                                 "geofx.pixelsPerRadian", "geofx.pixelError"})
            root->setUserValue(name, 0.0);
        root->setUserValue("geofx.minHeight", lowest);
        root->setUserValue("geofx.maxHeight", highest);
        root->setUserValue("geofx.levels", 1);
        root->setUserValue("geofx.vertical", std::string("none"));
        root->addChild(thing);
        return root;
    }

    /// What is said while a scene is drawn three times.
    std::vector<std::string> said(EffectScene& scene)
    {
        return watch().messagesOf(
            [&]
            {
                for (int frame = 0; frame < 3; ++frame)
                    render(&scene);
            });
    }

    static constexpr double high = 60.0;
    const osg::Vec3d _inZone = {0, -30, 0};
    /// With the ball around a thing of that height.
    const osg::Vec3d _inFocus = {0, -90, 0};
    const osg::Vec3d _inContext = {0, 30, 0};
    const std::string _advice = "the reference plane, beyond the radius of the bend, and folds over; set "
                                "`tallest` to that or more.\n";
};

} // namespace

TEST_F(Folds, AreToldOnceInOneSentence)
{
    const osg::ref_ptr<EffectScene> scene =
        sceneOf(makeFold(), {makeGround(), makeBox(high / 2, _inZone), makeBox(high / 2, _inZone)});
    EXPECT_EQ(said(*scene),
              std::vector<std::string>(
                  {"OSG: osgGeoFX: something in the transition zone reaches 60 m above " + _advice}));
    scene->removeChildren(0, scene->getNumChildren());
    scene->addChild(makeBox(high, _inZone));
    EXPECT_EQ(said(*scene), std::vector<std::string>()) << "another height is not another complaint";
}

TEST_F(Folds, AreToldOfWhatHangsBelowADownwardBend)
{
    osg::ref_ptr<BirdsEyeView> bend = makeBend();
    const osg::ref_ptr<osg::Node> deep = makeBox(130, {0, -30, -260});
    EXPECT_EQ(said(*sceneOf(bend, {deep})),
              std::vector<std::string>(
                  {"OSG: osgGeoFX: something in the transition zone reaches 260 m below " + _advice}));
    EXPECT_EQ(said(*sceneOf(bend, {makeBox(130, {0, -30, 0})})), std::vector<std::string>())
        << "the outer side of the bend";
    bend->setTallest(260.0);
    EXPECT_EQ(said(*sceneOf(bend, {deep})), std::vector<std::string>()) << "the advice was followed";
}

// Such as skies, and bounds that are set to everything.
TEST_F(Folds, AreToldWithoutANumberWhereThereIsNone)
{
    for (const float size : {1e8f, 3e38f})
    {
        const osg::ref_ptr<osg::Geometry> ground = makeGround();
        ground->setInitialBound(osg::BoundingBox(-size, -size, -size, size, size, size));
        const std::vector<std::string> all = said(*sceneOf(makeFold(), {ground}));
        ASSERT_EQ(all.size(), 1u) << size;
        EXPECT_NE(all[0].find("reaches more than 1000 km above the reference plane"), std::string::npos)
            << all[0];
        EXPECT_EQ(all[0].find('-'), std::string::npos) << all[0];
    }
}

TEST_F(Folds, AreNotToldOutsideTheZone)
{
    EXPECT_EQ(said(*sceneOf(makeFold(), {makeBox(high / 2, _inFocus), makeBox(high / 2, _inContext)})),
              std::vector<std::string>());
    EXPECT_EQ(said(*sceneOf(makeFold(), {makeBox(high / 2, {1000, -30, 0})})), std::vector<std::string>())
        << "beside the picture";
}

TEST_F(Folds, AreNotToldOfWhatCannotFold)
{
    const osg::ref_ptr<osg::Node> tower = makeBox(high / 2, _inZone);
    EXPECT_EQ(said(*sceneOf(makeFold(), {makeGround(), makeBox(10, _inZone)})), std::vector<std::string>())
        << "lower than the radius";
    EXPECT_EQ(said(*sceneOf(makeFold(high), {tower})), std::vector<std::string>())
        << "the advice was followed";
    EXPECT_EQ(said(*sceneOf(makeFold(), {makeBox(high / 2, _inZone - osg::Vec3d(0, 0, high))})),
              std::vector<std::string>())
        << "the outer side of the bend";
    osg::ref_ptr<PedestrianView> slight = makeFold();
    slight->setBendAngle(0.3);
    EXPECT_EQ(said(*sceneOf(slight, {tower})), std::vector<std::string>()) << "a radius of 130 m";
}

TEST_F(Folds, AreNotToldOfADatabaseThatTellsItsHeights)
{
    const osg::ref_ptr<osg::Node> tower = database(0.0, high, makeBox(high / 2, _inZone));
    EXPECT_EQ(said(*sceneOf(makeFold(), {tower})), std::vector<std::string>());
    EXPECT_EQ(said(*sceneOf(makeBend(), {database(0.0, 0.0, makeBox(130, {0, -30, -260}))})),
              std::vector<std::string>())
        << "what hangs below its ground are skirts";
    EXPECT_EQ(said(*sceneOf(makeFold(10.0), {tower})).size(), 1u)
        << "someone says that its heights do not matter";
}

// So culling need not look at each box of it: where its heights matter, it must, and nowhere else.
TEST_F(Folds, AreWatchedWhereTheGroundIsHighEnough)
{
    const auto watches = [](double highest, double tallest)
    {
        const osg::ref_ptr<EffectScene> scene =
            sceneOf(makeFold(tallest), {database(0.0, highest, makeBox(10.0f))});
        // Level, over y = −150 m, northward.
        const osg::Matrixd view =
            osg::Matrixd::lookAt(osg::Vec3d(0, -150, 30), osg::Vec3d(0, 0, 30), osg::Vec3d(0, 0, 1));
        const auto chain = scene->deformation(view, osg::Matrixd::perspective(40.0, 4.0 / 3.0, 1.0, 10000.0));
        EXPECT_FALSE(chain->empty());
        return chain->looksAtBoxes();
    };
    // The radius is some 35 m; the zone is never narrower than `tallest` needs.
    EXPECT_FALSE(watches(20.0, 10.0));
    EXPECT_TRUE(watches(60.0, 10.0));
    EXPECT_FALSE(watches(60.0, -1.0));
}
