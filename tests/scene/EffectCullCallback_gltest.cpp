// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A terrain with an EffectCullCallback is drawn as it is below an EffectScene, to the last bit.
#include <osgGeoFX/closeup/CloseUpPicking.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/EffectCullCallback.h>
#include <tools/CloseUpStage.h>

#include <osg/CoordinateSystemNode>
#include <osg/MatrixTransform>
#include <osg/Switch>

#include <functional>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

class EffectCullCallbacks : public CloseUpStage
{
protected:
    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _scene->removeEffect(_closeUps);
        _closeUps->addCloseUp(makeCloseUp({-300.0, 200.0}));
        _hills = _scene->getChild(0);
        _houses = makeHouses();
        _scene->addChild(_houses);
        viewer().getCamera()->setComputeNearFarMode(
            osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    }

    /// What the scene had as children goes below a terrain of the program's own.
    void hang(osg::Group& terrain)
    {
        _root->removeChild(_scene);
        _scene->removeChildren(0, _scene->getNumChildren());
        terrain.addChild(_hills);
        terrain.addChild(_houses);
        terrain.setCullingActive(false);
        terrain.addCullCallback(new EffectCullCallback(_scene));
        _root->addChild(&terrain);
    }
    /// As it was.
    void putBack(osg::Group& terrain)
    {
        _root->removeChild(&terrain);
        terrain.removeChildren(0, terrain.getNumChildren());
        _scene->addChild(_hills);
        _scene->addChild(_houses);
        _root->addChild(_scene);
    }

    osg::ref_ptr<osg::Node> _hills, _houses;
};

} // namespace

TEST_F(EffectCullCallbacks, DrawWhatTheGroupDraws)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    const osg::ref_ptr<PedestrianView> pedestrian = new PedestrianView;
    const osg::ref_ptr<PanoramaMap> panorama = new PanoramaMap;
    // Still water: each frame has another time.
    panorama->setRipples(0.0);
    const osg::ref_ptr<osg::Group> terrain = new osg::Group;
    for (const std::vector<Effect*>& effects :
         {std::vector<Effect*>{bend}, std::vector<Effect*>{pedestrian, _closeUps},
          std::vector<Effect*>{panorama}})
    {
        SCOPED_TRACE(effects.front()->className());
        for (Effect* each : effects)
            _scene->addEffect(each);
        Random random(3);
        for (int i = 0; i < 10; ++i)
        {
            SCOPED_TRACE("camera " + std::to_string(i));
            lookAnyhow(random);
            // The viewer writes the near and far planes that it finds into the camera.
            osg::Camera& camera = *viewer().getCamera();
            const osg::Matrixd given = camera.getProjectionMatrix();
            const osg::ref_ptr<osg::Image> expected = draw();
            EXPECT_EQ(_scene->getTerrain(), _scene);
            const osg::Matrixd projection = camera.getProjectionMatrix();
            camera.setProjectionMatrix(given);
            hang(*terrain);
            EXPECT_TRUE(same(*draw(), *expected));
            EXPECT_EQ(camera.getProjectionMatrix(), projection);
            EXPECT_EQ(_scene->getTerrain(), terrain);
            putBack(*terrain);
            terrain->setCullCallback(nullptr);
        }
        for (Effect* each : effects)
            _scene->removeEffect(each);
    }
}

TEST_F(EffectCullCallbacks, TheTerrainMayBeOfAnyClass)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    _scene->addEffect(bend);
    const osg::ref_ptr<osg::MatrixTransform> moved = new osg::MatrixTransform(
        osg::Matrixd::rotate(0.3, osg::Vec3d(0.0, 0.0, 1.0)) * osg::Matrixd::translate(150.0, 90.0, 30.0));
    const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    levels->setRangeMode(osg::LOD::PIXEL_SIZE_ON_SCREEN);
    const osg::ref_ptr<osg::Switch> choice = new osg::Switch;
    for (const osg::ref_ptr<osg::Group>& terrain :
         std::vector<osg::ref_ptr<osg::Group>>{moved, levels, choice})
    {
        SCOPED_TRACE(terrain->className());
        // The same below a scene: the transform stands above it, the others below.
        const bool above = terrain == moved;
        hang(*terrain);
        if (terrain == levels)
        {
            levels->setRange(0, 1.0f, 1e6f);
            levels->setRange(1, 0.0f, 1.0f);
        }
        if (terrain == choice) choice->setValue(1, false);
        const osg::ref_ptr<osg::Image> drawn = draw();
        const osg::Node* const shown = DeformedView(*_scene, *viewer().getCamera()).pick(100.0, 60.0)
                                           ? _scene->getTerrain().get()
                                           : nullptr;
        EXPECT_EQ(shown, terrain);
        terrain->setCullCallback(nullptr);
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(bend);
        _root->removeChild(terrain);
        if (above)
        {
            scene->addChild(_hills);
            scene->addChild(_houses);
            terrain->removeChildren(0, 2);
            terrain->addChild(scene);
            _root->addChild(terrain);
        }
        else
        {
            scene->addChild(terrain);
            _root->addChild(scene);
        }
        EXPECT_TRUE(same(*draw(), *drawn));
        _root->removeChild(above ? terrain.get() : scene.get());
    }
}

TEST_F(EffectCullCallbacks, AreFoundByPicking)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    _scene->addEffect(bend);
    _scene->addEffect(_closeUps);
    const osg::Camera& camera = *viewer().getCamera();
    const auto places = [&]
    {
        std::vector<osg::Vec3d> found;
        for (double x = 10.0; x < _width; x += 30.0)
        {
            for (double y = 10.0; y < _height; y += 20.0)
            {
                if (const auto hit = DeformedView(*_scene, camera).pick(x, y)) found.push_back(hit->world);
                if (const auto hit = pickCloseUp(*_scene, *_closeUps, camera, x, y, 0.0))
                    found.push_back(hit->world);
            }
        }
        return found;
    };
    const osg::Matrixd given = camera.getProjectionMatrix();
    draw();
    const std::vector<osg::Vec3d> expected = places();
    ASSERT_GT(expected.size(), 20u);
    const osg::ref_ptr<osg::Group> terrain = new osg::Group;
    hang(*terrain);
    viewer().getCamera()->setProjectionMatrix(given);
    draw();
    EXPECT_EQ(places(), expected);
}

TEST_F(EffectCullCallbacks, FindTheFrameAtTheTerrainItself)
{
    const osg::ref_ptr<osg::CoordinateSystemNode> globe = new osg::CoordinateSystemNode;
    globe->setEllipsoidModel(new osg::EllipsoidModel);
    _scene->addEffect(new BirdsEyeView);
    const osg::ref_ptr<const osg::EllipsoidModel> none = _scene->ground().ellipsoid;
    EXPECT_FALSE(none);
    hang(*globe);
    draw();
    EXPECT_EQ(_scene->ground().ellipsoid, globe->getEllipsoidModel());
}

TEST_F(EffectCullCallbacks, LetTheProgramsOwnCallbacksRun)
{
    class Own : public osg::NodeCallback
    {
    public:
        void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
        {
            ++runs;
            traverse(node, visitor);
        }
        int runs = 0;
    };
    _scene->addEffect(new BirdsEyeView);
    const osg::ref_ptr<osg::Image> expected = draw();
    const osg::ref_ptr<osg::Group> terrain = new osg::Group;
    const osg::ref_ptr<Own> before = new Own;
    const osg::ref_ptr<Own> after = new Own;
    terrain->addCullCallback(before);
    hang(*terrain);
    terrain->addCullCallback(after);
    EXPECT_TRUE(same(*draw(), *expected));
    EXPECT_EQ(before->runs, 1);
    EXPECT_EQ(after->runs, 1);
}

TEST_F(EffectCullCallbacks, WarnWhereTheyCannotWork)
{
    _scene->addEffect(new BirdsEyeView);
    const osg::ref_ptr<osg::Group> terrain = new osg::Group;
    terrain->setName("ours");
    hang(*terrain);
    terrain->setCullingActive(true);
    const std::vector<std::string> culled = watch().messagesOf(
        [&]
        {
            draw();
            draw();
        });
    ASSERT_EQ(culled.size(), 1u);
    EXPECT_NE(culled.front().find("\"ours\""), std::string::npos) << culled.front();
    EXPECT_NE(culled.front().find("setCullingActive(false)"), std::string::npos) << culled.front();
    const std::vector<std::string> none = watch().messagesOf(
        [&] { dynamic_cast<EffectCullCallback&>(*terrain->getCullCallback()).setScene(nullptr); });
    EXPECT_EQ(none.size(), 1u);
    EXPECT_EQ(dynamic_cast<EffectCullCallback&>(*terrain->getCullCallback()).getScene(), _scene);
}

TEST_F(EffectCullCallbacks, InsideAnotherSceneDrawWithItsEffectsAlone)
{
    const osg::ref_ptr<osg::Group> terrain = new osg::Group;
    _scene->addEffect(new PedestrianView);
    hang(*terrain);
    const osg::ref_ptr<EffectScene> outer = new EffectScene;
    outer->addEffect(new BirdsEyeView);
    _root->replaceChild(terrain, outer);
    outer->addChild(terrain);
    osg::ref_ptr<osg::Image> nested;
    const std::vector<std::string> told = watch().messagesOf([&] { nested = draw(); });
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("drawn with the effects of the outer one alone"), std::string::npos) << told[0];
    terrain->setCullCallback(nullptr);
    EXPECT_TRUE(same(*draw(), *nested));
}
