// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// CloseUps with input that makes no sense, while they change, in several views, contexts and threads, and against near and far
// planes.
#include <tools/CloseUpStage.h>
#include <tools/ImageComparison.h>
#include <tools/ThreadedViews.h>

#include <cmath>
#include <limits>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr CloseUps::Pipeline pipelines[] = {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS};

class CloseUpStates : public CloseUpStage
{
protected:
    /// Without close-ups.
    osg::ref_ptr<osg::Image> overview()
    {
        _closeUps->setEnabled(false);
        osg::ref_ptr<osg::Image> image = draw();
        _closeUps->setEnabled(true);
        return image;
    }
    /// How many pixels a close-up alone changes.
    double shows() { return differing(*overview(), *draw()); }
    void drawInAllThreadingModels();
};

} // namespace

TEST_F(CloseUpStates, NothingToDrawLeavesThePictureAlone)
{
    const osg::ref_ptr<osg::Image> plain = overview();
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        SCOPED_TRACE(pipeline);
        _closeUps->setPipeline(pipeline);
        _closeUps->removeCloseUps();
        EXPECT_TRUE(same(*plain, *draw())) << "no close-ups";

        const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({1e6, 0.0});
        _closeUps->addCloseUp(closeUp);
        EXPECT_TRUE(same(*plain, *draw())) << "a region off the terrain";
        EXPECT_EQ(_closeUps->statistics().closeUps, 0);

        closeUp->getRegion()->setCenter({0.0, 0.0});
        EXPECT_GT(shows(), 0.02);
        watch().messagesOf([&] { closeUp->getRegion()->setShape(RegionOfInterest::IMAGE); });
        watch().messagesOf([&] { EXPECT_TRUE(same(*plain, *draw())) << "an empty mask"; });
        closeUp->getRegion()->setShape(RegionOfInterest::ELLIPSE);
        EXPECT_GT(shows(), 0.02);

        closeUp->setOffset({0.0, 0.0, 5e6});
        closeUp->getAnchor()->setKind(Anchor::NONE);
        closeUp->getAnchor()->setLineWidth(0.0);
        EXPECT_TRUE(same(*plain, *draw())) << "a close-up out of sight";
        closeUp->setEnabled(false);
        EXPECT_TRUE(same(*plain, *draw())) << "a close-up that is switched off";
        closeUp->setEnabled(true);
        closeUp->setOffset({0.0, 0.0, 300.0});
        _closeUps->setOpacity(0.0);
        EXPECT_TRUE(same(*plain, *draw())) << "no opacity";
        _closeUps->setOpacity(1.0);
    }
}

TEST_F(CloseUpStates, WhatMakesNoSenseIsRefused)
{
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0});
    _closeUps->addCloseUp(closeUp);
    const osg::ref_ptr<osg::Image> before = draw();
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto refuses = [&](const char* what, const std::function<bool()>& set)
    {
        SCOPED_TRACE(what);
        bool done = true;
        const std::vector<std::string> said = watch().messagesOf([&] { done = set(); });
        EXPECT_FALSE(done);
        EXPECT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
        EXPECT_TRUE(same(*before, *draw()));
    };
    refuses("a singular scale", [&] { return closeUp->setScale(0.0, 1.0, 1.0); });
    refuses("a scale that mirrors", [&] { return closeUp->setScale(1.0, -1.0, 1.0); });
    refuses("no number for a scale", [&] { return closeUp->setScale(1.0, nan, 1.0); });
    refuses("no number for an offset", [&] { return closeUp->setOffset({nan, 0.0, 0.0}); });
    refuses("an offset without end", [&] { return closeUp->setOffset({0.0, 0.0, infinity}); });
    refuses("no number for a turn", [&] { return closeUp->setTurn(nan); });
    refuses("no region", [&] { return closeUp->setRegion(nullptr); });
    refuses("no anchor", [&] { return closeUp->setAnchor(nullptr); });
    refuses("a region without a size", [&] { return closeUp->getRegion()->setSize(0.0, 100.0); });
    refuses("no number for a center", [&] { return closeUp->getRegion()->setCenter({nan, 0.0}); });
    refuses("no close-up", [&] { return _closeUps->addCloseUp(nullptr); });
    refuses("the same close-up again", [&] { return _closeUps->addCloseUp(closeUp); });
    refuses("two textures on a unit", [&] { return _closeUps->setUnits(11, 11, 12); });
    // Flat maps are no singular scale.
    EXPECT_TRUE(closeUp->setScale(1.0, 1.0, 0.0));
    EXPECT_GT(shows(), 0.01);
}

TEST_F(CloseUpStates, MayChangeFromFrameToFrame)
{
    const CloseUpPlan plan;
    for (int i = 0; i < (fullTest() ? 300 : 12); ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        if (_closeUps->getNumCloseUps() > 0 && random.integer(0, 1))
            _closeUps->removeCloseUp(_closeUps->getCloseUp(0));
        if (_closeUps->getNumCloseUps() < 4) _closeUps->addCloseUp(randomCloseUp(random, plan));
        _closeUps->setPipeline(pipelines[random.integer(0, 1)]);
        _closeUps->setSupersampling(random.integer(1, 2));
        if (i % 5 == 0) lookAnyhow(random);
        // Its own objects alone: OSG would go on to draw the ground from the buffer that it drew last.
        if (i % 11 == 0) withContext([&](osg::State& state) { _closeUps->releaseGLObjects(&state); });
        draw();
    }
    // What has been through all of that draws as what is new.
    osg::ref_ptr<CloseUps> fresh = new CloseUps;
    for (unsigned int i = 0; i < _closeUps->getNumCloseUps(); ++i)
        fresh->addCloseUp(_closeUps->getCloseUp(i));
    fresh->setPipeline(CloseUps::MULTI_PASS);
    _closeUps->setPipeline(CloseUps::MULTI_PASS);
    _closeUps->setSupersampling(1);
    const osg::ref_ptr<osg::Image> old = draw();
    _scene->removeEffect(_closeUps);
    _scene->addEffect(fresh);
    EXPECT_TRUE(same(*old, *draw()));
}

TEST_F(CloseUpStates, RegionsAndAnchorsMayBeShared)
{
    const osg::ref_ptr<CloseUp> first = makeCloseUp({0.0, 0.0}, 300.0, 250.0);
    const osg::ref_ptr<CloseUp> second = makeCloseUp({0.0, 0.0}, 300.0, 500.0);
    _closeUps->addCloseUp(first);
    _closeUps->addCloseUp(second);
    _closeUps->setPipeline(CloseUps::MULTI_PASS); // AUTOMATIC may choose anew
    const osg::ref_ptr<osg::Image> apart = draw();
    second->setRegion(first->getRegion());
    second->setAnchor(first->getAnchor());
    EXPECT_TRUE(same(*apart, *draw()));
    // A change of the one is seen in both.
    first->getRegion()->setShape(RegionOfInterest::STAR);
    const osg::ref_ptr<osg::Image> stars = draw();
    first->setEnabled(false);
    const osg::ref_ptr<osg::Image> one = draw();
    EXPECT_GT(differing(*stars, *one), 0.01);
    second->getRegion()->setShape(RegionOfInterest::ELLIPSE);
    EXPECT_GT(differing(*one, *draw()), 0.005);
}

TEST_F(CloseUpStates, NearAndFarPlanesHoldThem)
{
    osg::Camera& camera = *viewer().getCamera();
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 300.0);
    closeUp->setScale(2.0, 2.0, 2.0);
    _closeUps->addCloseUp(closeUp);
    for (const bool orthographic : {false, true})
    {
        look({0.0, -1500.0, 900.0}, {0.0, 0.0, 300.0});
        if (orthographic) camera.setProjectionMatrixAsOrtho(-800.0, 800.0, -600.0, 600.0, 1.0, 40000.0);
        // Near to the eye, and behind all of the ground.
        for (const osg::Vec3d& offset : {osg::Vec3d(0.0, -800.0, 700.0), osg::Vec3d(0.0, 9000.0, 300.0)})
        {
            SCOPED_TRACE(::testing::Message()
                         << "orthographic " << orthographic << ", offset " << offset.y());
            closeUp->setOffset(offset);
            camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
            const osg::Matrixd projection = camera.getProjectionMatrix();
            EXPECT_GT(shows(), 0.002);
            const osg::ref_ptr<osg::Image> fixed = draw();
            camera.setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
            const osg::ref_ptr<osg::Image> computed = draw();
            camera.setProjectionMatrix(projection);
            // Depths are rounded otherwise, which lets pixels of edges go one way or the other.
            EXPECT_TRUE(imagesMatch(*computed, *fixed, {3.1f / 255.0f, 0.005, 1.0f},
                                    std::to_string(orthographic) + std::to_string(offset.y() > 0.0)));
        }
    }
}

TEST_F(CloseUpStates, DepthTestDecidesWhatIsInFront)
{
    // Below the ground from where the camera is.
    const osg::ref_ptr<CloseUp> hidden = makeCloseUp({0.0, 0.0}, 300.0, -400.0);
    hidden->getAnchor()->setKind(Anchor::NONE);
    hidden->getAnchor()->setLineWidth(0.0);
    _closeUps->addCloseUp(hidden);
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        _closeUps->setPipeline(pipeline);
        _closeUps->setDepthTest(true);
        EXPECT_EQ(shows(), 0.0);
        _closeUps->setDepthTest(false);
        EXPECT_GT(shows(), 0.01);
    }
    // Without the test, the last one is in front; with it, the nearer one.
    const osg::ref_ptr<CloseUp> low = makeCloseUp({0.0, 0.0}, 300.0, 100.0);
    const osg::ref_ptr<CloseUp> high = makeCloseUp({0.0, 0.0}, 300.0, 500.0);
    for (const osg::ref_ptr<CloseUp>& each : {low, high})
    {
        each->getAnchor()->setKind(Anchor::NONE);
        each->getAnchor()->setLineWidth(0.0);
        each->setSaturation(each == low ? 0.0 : 3.0);
    }
    look({0.0, -10.0, 3000.0}, {0.0, 0.0, 0.0}, 20.0);
    const auto inOrder = [&](CloseUp* a, CloseUp* b, bool test)
    {
        _closeUps->removeCloseUps();
        _closeUps->addCloseUp(a);
        _closeUps->addCloseUp(b);
        _closeUps->setDepthTest(test);
        return draw();
    };
    EXPECT_TRUE(same(*inOrder(low, high, true), *inOrder(high, low, true)));
    EXPECT_GT(differing(*inOrder(low, high, false), *inOrder(high, low, false)), 0.01);
    EXPECT_EQ(differing(*inOrder(low, high, false), *inOrder(low, high, true)), 0.0);
}

TEST_F(CloseUpStates, TwoTraversalsOfAFrame)
{
    // The same scene again in a camera of its own, whose picture stands in a corner.
    _closeUps->addCloseUp(makeCloseUp({0.0, 0.0}));
    const osg::ref_ptr<osg::Image> alone = draw();
    osg::ref_ptr<osg::Camera> inset = new osg::Camera;
    inset->setRenderOrder(osg::Camera::POST_RENDER);
    inset->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    inset->setClearMask(GL_DEPTH_BUFFER_BIT);
    inset->setViewport(0, 0, 40, 30);
    inset->setViewMatrix(viewer().getCamera()->getViewMatrix());
    inset->setProjectionMatrix(viewer().getCamera()->getProjectionMatrix());
    inset->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    osg::ref_ptr<EffectScene> again = new EffectScene;
    again->setNestedCameras(true);
    again->addChild(_scene->getChild(0));
    again->addEffect(_closeUps);
    inset->addChild(again);
    _root->addChild(inset);
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        _closeUps->setPipeline(pipeline);
        draw();
        const osg::ref_ptr<osg::Image> both = draw();
        int differing = 0;
        for (int y = 0; y < _height; ++y)
        {
            for (int x = y < 30 ? 40 : 0; x < _width; ++x)
            {
                const unsigned char* a =
                    alone->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
                const unsigned char* b =
                    both->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
                for (int channel = 0; channel < 3; ++channel)
                    differing += std::abs(a[channel] - b[channel]) > 2 ? 1 : 0;
            }
        }
        EXPECT_LE(differing, _width * _height / 1000) << pipeline;
    }
    _root->removeChild(inset);
    EXPECT_LE(differing(*alone, *draw()), 0.001);
}

TEST_F(CloseUpStates, ReleasedAndDrawnAgain)
{
    for (int i = 0; i < 3; ++i)
        _closeUps->addCloseUp(makeCloseUp(osg::Vec2d(500.0 * i - 500.0, 0.0)));
    _closeUps->setSurfaceData(makeSurfaceData({}, 900.0));
    _closeUps->getCloseUp(1)->setSurface("height");
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        _closeUps->setPipeline(pipeline);
        const osg::ref_ptr<osg::Image> before = draw();
        withContext([&](osg::State& state) { _root->releaseGLObjects(&state); });
        EXPECT_TRUE(same(*before, *draw()));
        // And in a second context at the same time.
        ThreadedViews views(osgViewer::ViewerBase::SingleThreaded);
        views.add(_root, *viewer().getCamera());
        views.realize();
        EXPECT_TRUE(same(*before, *views.pictures().front()));
        EXPECT_TRUE(same(*before, *draw()));
    }
}

TEST_F(CloseUpStates, EveryThreadingModelAndTwoViews)
{
    // OSG hands buffers of windows that are gone to the next ones, and Mesa tells of what is then loaded into them.
    const std::vector<std::string> messages = watch().messagesOf([&] { drawInAllThreadingModels(); });
    for (const std::string& message : messages)
        EXPECT_NE(message.find("GL_STATIC_DRAW"), std::string::npos) << message;
}

void CloseUpStates::drawInAllThreadingModels()
{
    for (int i = 0; i < 3; ++i)
    {
        const osg::ref_ptr<CloseUp> closeUp = makeCloseUp(osg::Vec2d(500.0 * i - 500.0, 0.0));
        closeUp->getAnchor()->setKind(static_cast<Anchor::Kind>(i));
        _closeUps->addCloseUp(closeUp);
    }
    osg::ref_ptr<EffectScene> other = new EffectScene;
    other->addChild(_scene->getChild(0));
    osg::ref_ptr<CloseUps> others = new CloseUps;
    others->addCloseUp(makeCloseUp({200.0, 200.0}, 600.0));
    // Both scenes have one of the close-ups.
    others->addCloseUp(_closeUps->getCloseUp(0));
    other->addEffect(others);
    osg::ref_ptr<osg::Group> second = new osg::Group;
    second->addChild(_root->getChild(0));
    second->setStateSet(_root->getStateSet());
    second->addChild(other);
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        _closeUps->setPipeline(pipeline);
        others->setPipeline(pipeline);
        std::vector<osg::ref_ptr<osg::Image>> expected;
        {
            ThreadedViews views(osgViewer::ViewerBase::SingleThreaded);
            views.add(_root, *viewer().getCamera());
            views.add(second, *viewer().getCamera());
            views.realize();
            expected = views.pictures();
        }
        ASSERT_TRUE(expected[0] && expected[1]);
        EXPECT_GT(differing(*expected[0], *expected[1]), 0.05);
        for (const auto model : ThreadedViews::models)
        {
            // In a short test each model has one of the pipelines.
            if (!fullTest() && pipelines[static_cast<std::size_t>(model) % std::size(pipelines)] != pipeline)
                continue;
            SCOPED_TRACE("threading model " + std::to_string(model));
            ThreadedViews views(model);
            views.add(_root, *viewer().getCamera());
            views.add(second, *viewer().getCamera());
            views.add(_root, *viewer().getCamera());
            views.realize();
            // Under way they change between frames.
            for (int i = 0; i < (fullTest() ? 60 : 6); ++i)
            {
                CloseUp& closeUp = *_closeUps->getCloseUp(static_cast<unsigned int>(i % 3));
                closeUp.setTurn(0.1 * i);
                closeUp.getRegion()->setShape(static_cast<RegionOfInterest::Shape>(i % 3));
                _closeUps->setPipeline(pipelines[i % 2]);
                closeUp.setEnabled(i % 4 > 0);
                views.frame();
            }
            for (unsigned int i = 0; i < 3; ++i)
            {
                _closeUps->getCloseUp(i)->setTurn(0.0);
                _closeUps->getCloseUp(i)->setEnabled(true);
                _closeUps->getCloseUp(i)->getRegion()->setShape(RegionOfInterest::ELLIPSE);
            }
            _closeUps->setPipeline(pipeline);
            const std::vector<osg::ref_ptr<osg::Image>> images = views.pictures();
            for (std::size_t i = 0; i < images.size(); ++i)
            {
                ASSERT_TRUE(images[i]);
                EXPECT_TRUE(same(*expected[i % 2], *images[i])) << "view " << i;
            }
        }
    }
}
