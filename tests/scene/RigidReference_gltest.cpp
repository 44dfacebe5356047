// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// What keeps its shape: where it is drawn, and that culling knows.
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/BentGround.h>
#include <tools/ImageComparison.h>
#include <tools/RandomSamples.h>

#include <osg/LightSource>

using namespace osgGeoFX;
using namespace geofx::test;

class RigidReferenceTest : public BentGround
{
protected:
    const osg::Matrixd& view() { return viewer().getCamera()->getViewMatrix(); }

    /// How the scene's deformation places an object: world to world.
    osg::Matrixd placed(const EffectScene& scene, const osg::Vec3d& reference, bool turn)
    {
        const osg::ref_ptr<const DeformationChain> chain =
            scene.deformation(view(), viewer().getCamera()->getProjectionMatrix());
        const osg::Vec3d eye = reference * view();
        const osg::Matrixd placement =
            turn ? chain->placement(eye) : osg::Matrixd::translate(chain->deform(eye) - eye);
        return view() * placement * osg::Matrixd::inverse(view());
    }

    /// Two ways of multiplying the same matrices: a few pixels of edges may fall to the other side.
    static ::testing::AssertionResult alike(const osg::Image& a, const osg::Image& b)
    {
        const int count = differing(a, b);
        return count <= 6 ? ::testing::AssertionSuccess()
                          : ::testing::AssertionFailure() << count << " pixels differ";
    }

    static osg::ref_ptr<RigidReference> makeRigid(const osg::ref_ptr<osg::Node>& child)
    {
        osg::ref_ptr<RigidReference> rigid = new RigidReference;
        rigid->addChild(child);
        return rigid;
    }
};

TEST_F(RigidReferenceTest, KeepsItsShape)
{
    // In the zone, across its end, in the context and in the focus.
    for (const osg::Vec3d& place :
         {osg::Vec3d(10, -40, 0), osg::Vec3d(-20, -10, 5), osg::Vec3d(0, 60, 0), osg::Vec3d(0, -100, 0)})
    {
        for (const bool turn : {true, false})
        {
            SCOPED_TRACE(::testing::Message() << place.y() << (turn ? " turned" : " upright"));
            const osg::ref_ptr<RigidReference> rigid = makeRigid(makeBox(16));
            rigid->setTurn(turn);
            osg::ref_ptr<osg::MatrixTransform> site = new osg::MatrixTransform(
                osg::Matrix::rotate(0.5, osg::Vec3d(0, 0, 1)) * osg::Matrix::translate(place));
            site->addChild(rigid);
            const osg::ref_ptr<EffectScene> scene = makeScene({site});
            const osg::ref_ptr<osg::Image> actual = render(scene);
            osg::ref_ptr<osg::MatrixTransform> plain =
                new osg::MatrixTransform(site->getMatrix() * placed(*scene, place, turn));
            plain->addChild(makeBox(16));
            const osg::ref_ptr<osg::Image> expected = render(makePlain({plain}));
            EXPECT_GT(covered(*expected), 30);
            EXPECT_TRUE(alike(*actual, *expected));
        }
    }
}

TEST_F(RigidReferenceTest, IsNotWhatTheDeformationDoesToIt)
{
    // A tower in the zone leans and shrinks unless it is rigid.
    const osg::Vec3d place(10, -40, 0);
    const osg::ref_ptr<osg::Image> rigid = render(makeScene({makeRigid(makeBox(25, place))}));
    const osg::ref_ptr<osg::Image> bent = render(makeScene({makeBox(25, place)}));
    EXPECT_FALSE(alike(*rigid, *bent));
}

TEST_F(RigidReferenceTest, ReferencePoints)
{
    const osg::Vec3d place(5, -30, 0);
    const osg::Vec3d point(20, -10, 6);
    const osg::ref_ptr<RigidReference> rigid = makeRigid(makeBox(16, place));
    const osg::ref_ptr<EffectScene> scene = makeScene({rigid});
    const auto expected = [&](const osg::Vec3d& reference)
    {
        osg::ref_ptr<osg::MatrixTransform> plain = new osg::MatrixTransform(placed(*scene, reference, true));
        plain->addChild(makeBox(16, place));
        return render(makePlain({plain}));
    };
    EXPECT_TRUE(alike(*render(scene), *expected({0, 0, 0})));
    rigid->setReference(point);
    EXPECT_TRUE(alike(*render(scene), *expected(point)));
    EXPECT_FALSE(alike(*expected(point), *expected({0, 0, 0})));
    rigid->setUseBoundCenter(true);
    EXPECT_TRUE(alike(*render(scene), *expected(rigid->getBound().center())));
    EXPECT_LT((osg::Vec3d(rigid->getBound().center()) - (place + osg::Vec3d(0, 0, 16))).length(), 0.01);
}

TEST_F(RigidReferenceTest, IsStyledAndLitAndLeftOutAsAnything)
{
    const osg::Vec3d place(10, -40, 0);
    const osg::ref_ptr<RigidReference> rigid = makeRigid(makeBox(16));
    osg::ref_ptr<osg::MatrixTransform> site = new osg::MatrixTransform(osg::Matrix::translate(place));
    site->addChild(rigid);
    const osg::ref_ptr<EffectScene> scene = makeScene({site});
    const osg::ref_ptr<osg::Image> plain = render(makePlain({site}));
    EXPECT_FALSE(alike(*render(scene), *plain));
    // Left out, by itself, above it or on what it holds, it is drawn where it is.
    for (osg::Node* node : {static_cast<osg::Node*>(rigid), static_cast<osg::Node*>(site)})
    {
        node->getOrCreateStateSet()->setDefine("GEOFX_DEFORMATION", osg::StateAttribute::OFF);
        EXPECT_TRUE(same(*render(scene), *plain));
        node->setStateSet(nullptr);
    }
    scene->getEffect(0)->setEnabled(false);
    EXPECT_TRUE(same(*render(scene), *plain));
}

TEST_F(RigidReferenceTest, IsNotCulledWrongly)
{
    osg::Camera& camera = *viewer().getCamera();
    // What is smaller than two pixels may be left out.
    const osg::CullSettings::CullingMode culling =
        camera.getCullingMode() & ~osg::CullSettings::SMALL_FEATURE_CULLING;
    const osg::Matrixd home = camera.getViewMatrix();
    const int count = fullTest() ? 1000 : 60;
    int some = 0;
    int border = 0;
    // One scene for each effect, since each one compiles its own program.
    std::vector<osg::ref_ptr<EffectScene>> scenes = {makeScene({}), new EffectScene, new EffectScene};
    const osg::ref_ptr<PedestrianView> walk = new PedestrianView;
    walk->setFocusDistance(80);
    scenes[1]->addEffect(walk);
    const osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
    scenes[2]->addEffect(lift);
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        walk->setZoneWidth(random.uniform(20, 100));
        lift->setFactor(random.uniform(0.3, 4));
        EffectScene* scene = scenes[static_cast<std::size_t>(i % 3)];
        scene->removeChildren(0, scene->getNumChildren());
        // Villages: groups in groups, each with a few objects.
        for (int village = 0; village < 2; ++village)
        {
            const osg::ref_ptr<osg::Group> outer = new osg::Group;
            const osg::Vec3d middle(random.uniform(-90, 90), random.uniform(-60, 140), random.uniform(0, 40));
            for (int house = 0; house < 3; ++house)
            {
                const osg::Vec3d place = middle + osg::Vec3d(random.uniform(-15, 15), random.uniform(-15, 15),
                                                             random.uniform(0, 9));
                const osg::ref_ptr<RigidReference> rigid =
                    makeRigid(makeBox(static_cast<float>(random.uniform(1, 12))));
                rigid->setTurn(random.integer(0, 1) == 1);
                rigid->setUseBoundCenter(random.integer(0, 1) == 1);
                // Far from the object, too.
                if (random.integer(0, 1))
                    rigid->setReference({random.uniform(-25, 25), random.uniform(-25, 25), 0});
                osg::ref_ptr<osg::MatrixTransform> site =
                    new osg::MatrixTransform(osg::Matrix::rotate(random.uniform(0, 3), osg::Vec3d(0, 0, 1)) *
                                             osg::Matrix::translate(place));
                site->addChild(rigid);
                outer->addChild(site);
            }
            scene->addChild(outer);
        }
        const osg::Matrixd aside = osg::Matrix::rotate(random.uniform(-0.5, 0.5), osg::Vec3d(0, 1, 0));
        camera.setViewMatrix(home * aside *
                             osg::Matrix::rotate(random.uniform(-0.3, 0.1), osg::Vec3d(1, 0, 0)));
        camera.setCullingMode(culling);
        const osg::ref_ptr<osg::Image> actual = render(scene);
        camera.setCullingMode(osg::CullSettings::NO_CULLING);
        const osg::ref_ptr<osg::Image> expected = render(scene);
        EXPECT_TRUE(same(*actual, *expected, "sample " + std::to_string(i)));
        const int seen = covered(*expected);
        some += seen > 0 ? 1 : 0;
        border += seen > 0 && seen < 300 ? 1 : 0;
    }
    EXPECT_GT(some, count / 2);
    EXPECT_GT(border, count / 10);
}

// The tightest case: nothing in the group but one small thing, far from its reference.
TEST_F(RigidReferenceTest, IsNotCulledWronglyFarFromItsReference)
{
    osg::Camera& camera = *viewer().getCamera();
    // What is smaller than two pixels may be left out.
    const osg::CullSettings::CullingMode culling =
        camera.getCullingMode() & ~osg::CullSettings::SMALL_FEATURE_CULLING;
    const osg::Matrixd home = camera.getViewMatrix();
    const int count = fullTest() ? 4000 : 300;
    int some = 0;
    // One scene for all, since each one compiles its own program.
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    const osg::ref_ptr<PedestrianView> walk = new PedestrianView;
    walk->setFocusDistance(80);
    scene->addEffect(walk);
    for (int i = 0; i < count; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        walk->setZoneWidth(random.uniform(20, 60));
        walk->setBendAngle(random.uniform(0.8, 1.5));
        const osg::ref_ptr<RigidReference> rigid = makeRigid(makeBox(2));
        rigid->setReference({random.uniform(-30, 30), random.uniform(10, 120), random.uniform(0, 20)});
        rigid->setTurn(i % 4 != 0);
        osg::ref_ptr<osg::MatrixTransform> site = new osg::MatrixTransform(
            osg::Matrix::translate(random.uniform(-80, 80), random.uniform(-140, 0), random.uniform(0, 40)));
        site->addChild(rigid);
        scene->removeChildren(0, scene->getNumChildren());
        scene->addChild(makePlain({site}));
        camera.setViewMatrix(home * osg::Matrix::rotate(random.uniform(-0.6, 0.6), osg::Vec3d(0, 1, 0)) *
                             osg::Matrix::rotate(random.uniform(-1, 1), osg::Vec3d(1, 0, 0)));
        camera.setCullingMode(culling);
        const osg::ref_ptr<osg::Image> actual = render(scene);
        camera.setCullingMode(osg::CullSettings::NO_CULLING);
        const osg::ref_ptr<osg::Image> expected = render(scene);
        ASSERT_TRUE(same(*actual, *expected)) << "sample " << i;
        some += covered(*expected) > 0 ? 1 : 0;
    }
    EXPECT_GT(some, count / 10);
}

/// Towers below a map's projection.
class RigidTowers : public RigidReferenceTest
{
protected:
    void SetUp() override
    {
        RigidReferenceTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        viewer().getCamera()->setProjectionMatrixAsPerspective(35.0, static_cast<double>(WIDTH) / HEIGHT, 1.0,
                                                               1e6);
        _map->setPaint(false);
        _map->setStrokes(false);
        _map->setWater(false);
        _map->setSky(false);
        _scene->addEffect(_map);
    }

    static osg::ref_ptr<osg::MatrixTransform> makeTower(const osg::Vec2d& place, double size)
    {
        osg::ref_ptr<osg::MatrixTransform> site =
            new osg::MatrixTransform(osg::Matrix::translate(place.x(), place.y(), 0.0));
        site->addChild(makeRigid(makeBox(static_cast<float>(size))));
        return site;
    }

    void lookNorth(double height, double down)
    {
        viewer().getCamera()->setViewMatrixAsLookAt({0, 0, height},
                                                    {0, std::cos(down), height - std::sin(down)}, {0, 0, 1});
    }

    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<PanoramaMap> _map = new PanoramaMap;
};

TEST_F(RigidTowers, BeyondTheEndOfAMapAreNotThere)
{
    _map->setViewRadius(1000);
    lookNorth(300, 0.3);
    const auto seen = [&](double y)
    {
        _scene->removeChildren(0, _scene->getNumChildren());
        _scene->addChild(makeTower({0, y}, 200));
        return covered(*render(_scene));
    };
    EXPECT_GT(seen(800), 50);
    EXPECT_EQ(seen(20000), 0);
    // Nor can they be picked.
    const DeformedView view(*_scene, *viewer().getCamera());
    for (int row = 0; row < HEIGHT; ++row)
        EXPECT_FALSE(view.pick(WIDTH / 2.0, row + 0.5)) << row;
    // Without a projection they stand far away.
    _scene->removeEffect(_map);
    EXPECT_GT(covered(*render(_scene)), 0);
}

TEST_F(RigidTowers, AreNotCulledWronglyInAMap)
{
    osg::Camera& camera = *viewer().getCamera();
    const osg::CullSettings::CullingMode culling =
        camera.getCullingMode() & ~osg::CullSettings::SMALL_FEATURE_CULLING;
    const int count = fullTest() ? 2000 : 200;
    int some = 0;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        const double radius = random.logarithmic(500, 20000);
        _map->setViewRadius(radius);
        // A village anywhere, also beyond the end of the map, with the highest towers that stand there.
        const osg::Vec2d middle(random.uniform(-2, 2) * radius, random.logarithmic(0.1, 30) * radius);
        const osg::ref_ptr<osg::Group> village = new osg::Group;
        for (int house = 0; house < 6; ++house)
        {
            const double size = random.logarithmic(0.01, 0.3) * radius;
            village->addChild(
                makeTower(middle + osg::Vec2d(random.uniform(-1, 1), random.uniform(-1, 1)) * radius, size));
        }
        _scene->removeChildren(0, _scene->getNumChildren());
        _scene->addChild(village);
        lookNorth(random.logarithmic(0.02, 1.0) * radius, random.uniform(0.05, 0.8));
        camera.setCullingMode(culling);
        const osg::ref_ptr<osg::Image> actual = render(_scene);
        camera.setCullingMode(osg::CullSettings::NO_CULLING);
        const osg::ref_ptr<osg::Image> expected = render(_scene);
        EXPECT_TRUE(same(*actual, *expected));
        some += covered(*expected) > 0 ? 1 : 0;
    }
    EXPECT_GT(some, count / 5);
}
