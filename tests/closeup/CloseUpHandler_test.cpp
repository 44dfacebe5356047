// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Close-ups by hand: which one a click or the pointer makes active, and how they are dragged.
#include <osgGeoFX/closeup/CloseUpHandler.h>
#include <tools/NotifyWatch.h>

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osgViewer/Viewer>

using namespace osgGeoFX;
using osg::Vec2d;
using Event = osgGA::GUIEventAdapter;

namespace
{

/// Flat ground of 2 × 2 km seen from above, 5 m to a pixel, in a viewer that never draws. Two close-ups, of 200 m: 40 pixels,
/// stand 100 pixels north of their regions.
class CloseUpHandling : public ::testing::Test
{
protected:
    void SetUp() override
    {
        _scene->addChild(osg::createTexturedQuadGeometry({-1000, -1000, 0}, {2000, 0, 0}, {0, 2000, 0}));
        _scene->addEffect(_closeUps);
        for (const double x : {-250.0, 250.0})
        {
            osg::ref_ptr<CloseUp> closeUp = new CloseUp;
            closeUp->getRegion()->setCenter({x, -250.0});
            closeUp->getRegion()->setSize(200.0, 200.0);
            closeUp->setScale(1.0, 1.0, 1.0);
            closeUp->setOffset({0.0, 500.0, 100.0});
            _closeUps->addCloseUp(closeUp);
        }
        _viewer.setSceneData(_scene);
        osg::Camera& camera = *_viewer.getCamera();
        // Events count from the window's corner, pixels from the viewport's.
        camera.setViewport(7, 11, 200, 200);
        camera.setViewMatrixAsLookAt({0, 0, 1000}, {0, 0, 0}, {0, 1, 0});
        camera.setProjectionMatrixAsOrtho(-500, 500, -500, 500, 1, 2000);
    }

    bool send(Event::EventType type, const Vec2d& pixel = {}, int modifiers = 0, int key = 0,
              int button = Event::LEFT_MOUSE_BUTTON)
    {
        osg::ref_ptr<Event> event = new Event;
        event->setEventType(type);
        event->setX(static_cast<float>(pixel.x() + 7.0));
        event->setY(static_cast<float>(pixel.y() + 11.0));
        event->setModKeyMask(modifiers);
        event->setButton(button);
        event->setKey(key);
        return _handler->handle(*event, _viewer);
    }
    void click(const Vec2d& pixel, int modifiers = 0)
    {
        EXPECT_FALSE(send(Event::PUSH, pixel, modifiers)) << "the camera's manipulator gets clicks, too";
        EXPECT_FALSE(send(Event::RELEASE, pixel, modifiers));
    }
    void pointAt(const Vec2d& pixel)
    {
        EXPECT_FALSE(send(Event::MOVE, pixel));
        EXPECT_FALSE(send(Event::FRAME));
    }
    void expectLooks(CloseUp::Activity left, CloseUp::Activity right)
    {
        EXPECT_EQ(_closeUps->getCloseUp(0)->getActivity(), left);
        EXPECT_EQ(_closeUps->getCloseUp(1)->getActivity(), right);
    }

    const Vec2d _leftRegion{50.0, 50.0}, _rightRegion{150.0, 50.0};
    const Vec2d _leftCloseUp{50.0, 150.0}, _rightCloseUp{150.0, 150.0};
    const Vec2d _beside{100.0, 100.0};
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<CloseUps> _closeUps = new CloseUps;
    osg::ref_ptr<CloseUpHandler> _handler = new CloseUpHandler(*_scene, *_closeUps);
    osgViewer::Viewer _viewer;
};

} // namespace

TEST_F(CloseUpHandling, ClicksChoose)
{
    _closeUps->getCloseUp(1)->setActivity(CloseUp::NO_ANCHOR);
    pointAt(_leftCloseUp);
    EXPECT_EQ(_handler->chosen(), nullptr) << "the pointer alone does nothing yet";
    click(_leftCloseUp);
    EXPECT_EQ(_handler->chosen(), _closeUps->getCloseUp(0));
    expectLooks(CloseUp::ACTIVE, CloseUp::DESATURATED);
    click(_rightRegion);
    EXPECT_EQ(_handler->chosen(), _closeUps->getCloseUp(1));
    expectLooks(CloseUp::DESATURATED, CloseUp::ACTIVE);
    click(_beside);
    EXPECT_EQ(_handler->chosen(), nullptr);
    expectLooks(CloseUp::ACTIVE, CloseUp::NO_ANCHOR);
    click(_leftCloseUp + Vec2d(21.0, 0.0));
    EXPECT_EQ(_handler->chosen(), nullptr) << "it is a disc of 20 pixels";
    click(_leftCloseUp + Vec2d(18.0, 0.0));
    EXPECT_EQ(_handler->chosen(), _closeUps->getCloseUp(0));
    click(_beside);
    click(_leftRegion + Vec2d(0.0, 18.0));
    EXPECT_EQ(_handler->chosen(), _closeUps->getCloseUp(0));
    click(_beside);
    // Not a click: it has moved, it is another button or has other keys with it.
    send(Event::PUSH, _leftCloseUp);
    send(Event::RELEASE, _leftCloseUp + Vec2d(5.0, 0.0));
    EXPECT_EQ(_handler->chosen(), nullptr);
    send(Event::PUSH, _leftCloseUp, 0, 0, Event::RIGHT_MOUSE_BUTTON);
    send(Event::RELEASE, _leftCloseUp, 0, 0, Event::RIGHT_MOUSE_BUTTON);
    EXPECT_EQ(_handler->chosen(), nullptr);
    click(_leftCloseUp, Event::MODKEY_LEFT_CTRL);
    click(_leftCloseUp, Event::MODKEY_RIGHT_ALT);
    EXPECT_EQ(_handler->chosen(), nullptr);
}

TEST_F(CloseUpHandling, ThePointerChoosesInItsMode)
{
    _handler->setMode(CloseUpHandler::HOVER);
    ASSERT_TRUE(_handler->setInactiveLook(CloseUp::REGION_ONLY));
    EXPECT_FALSE(send(Event::FRAME));
    EXPECT_EQ(_handler->chosen(), nullptr);
    pointAt(_leftRegion);
    expectLooks(CloseUp::ACTIVE, CloseUp::REGION_ONLY);
    pointAt(_beside);
    expectLooks(CloseUp::ACTIVE, CloseUp::REGION_ONLY);
    pointAt(_rightCloseUp);
    expectLooks(CloseUp::ACTIVE, CloseUp::REGION_ONLY);
    pointAt(_rightRegion);
    expectLooks(CloseUp::REGION_ONLY, CloseUp::ACTIVE);
    click(_beside);
    expectLooks(CloseUp::ACTIVE, CloseUp::ACTIVE);
}

TEST_F(CloseUpHandling, TheKeyCyclesModes)
{
    EXPECT_EQ(_handler->getMode(), CloseUpHandler::CLICK);
    click(_leftCloseUp);
    EXPECT_FALSE(send(Event::KEYDOWN, {}, 0, 'u'));
    EXPECT_EQ(_handler->getMode(), CloseUpHandler::HOVER);
    expectLooks(CloseUp::ACTIVE, CloseUp::DESATURATED);
    EXPECT_FALSE(send(Event::KEYDOWN, {}, 0, 'u'));
    EXPECT_EQ(_handler->getMode(), CloseUpHandler::OFF);
    expectLooks(CloseUp::ACTIVE, CloseUp::ACTIVE);
    click(_leftCloseUp);
    pointAt(_leftCloseUp);
    EXPECT_EQ(_handler->chosen(), nullptr);
    EXPECT_FALSE(send(Event::KEYDOWN, {}, 0, 'u'));
    EXPECT_EQ(_handler->getMode(), CloseUpHandler::CLICK);
    EXPECT_FALSE(send(Event::KEYUP, {}, 0, 'u'));
    EXPECT_FALSE(send(Event::KEYDOWN, {}, 0, 'x'));
    EXPECT_EQ(_handler->getMode(), CloseUpHandler::CLICK);
    _handler->setModeKey('x');
    EXPECT_FALSE(send(Event::KEYDOWN, {}, 0, 'u'));
    EXPECT_EQ(_handler->getMode(), CloseUpHandler::CLICK);
    EXPECT_FALSE(send(Event::KEYDOWN, {}, 0, 'x'));
    EXPECT_EQ(_handler->getMode(), CloseUpHandler::HOVER);
    _handler->setModeKey(0);
    EXPECT_FALSE(send(Event::KEYDOWN, {}, 0, 0));
    EXPECT_EQ(_handler->getMode(), CloseUpHandler::HOVER);
}

TEST_F(CloseUpHandling, LooksCanBeChosen)
{
    _handler->choose(_closeUps->getCloseUp(1));
    expectLooks(CloseUp::DESATURATED, CloseUp::ACTIVE);
    EXPECT_TRUE(_handler->setInactiveLook(CloseUp::NO_ANCHOR));
    expectLooks(CloseUp::NO_ANCHOR, CloseUp::ACTIVE);
    geofx::test::NotifyWatch watch;
    const auto messages = watch.messagesOf([&] { EXPECT_FALSE(_handler->setInactiveLook(CloseUp::ACTIVE)); });
    EXPECT_EQ(messages.size(), 1u);
    EXPECT_EQ(_handler->getInactiveLook(), CloseUp::NO_ANCHOR);
    _handler->choose(nullptr);
    expectLooks(CloseUp::ACTIVE, CloseUp::ACTIVE);
    // One that goes away while another one is chosen, and the chosen one itself.
    _handler->choose(_closeUps->getCloseUp(1));
    _closeUps->removeCloseUp(_closeUps->getCloseUp(0));
    _handler->choose(nullptr);
    _handler->choose(_closeUps->getCloseUp(0));
    _closeUps->removeCloseUps();
    EXPECT_EQ(_handler->chosen(), nullptr);
    _handler->choose(nullptr);
}

TEST_F(CloseUpHandling, ShiftDrags)
{
    CloseUp& closeUp = *_closeUps->getCloseUp(0);
    const int shift = Event::MODKEY_LEFT_SHIFT;
    for (const CloseUpHandler::Mode mode : {CloseUpHandler::OFF, CloseUpHandler::CLICK})
    {
        _handler->setMode(mode);
        closeUp.setOffset({0.0, 500.0, 100.0});
        EXPECT_FALSE(send(Event::PUSH, _leftRegion, shift)) << "regions stay";
        EXPECT_FALSE(send(Event::DRAG, _leftRegion + Vec2d(10.0, 0.0), shift));
        EXPECT_FALSE(send(Event::RELEASE, _leftRegion + Vec2d(10.0, 0.0), shift));
        EXPECT_EQ(closeUp.getOffset(), osg::Vec3d(0.0, 500.0, 100.0));

        EXPECT_TRUE(send(Event::PUSH, _leftCloseUp, shift));
        EXPECT_TRUE(send(Event::DRAG, _leftCloseUp + Vec2d(40.0, 7.0), shift));
        EXPECT_TRUE(send(Event::DRAG, _leftCloseUp + Vec2d(10.0, -20.0), shift));
        EXPECT_LT((closeUp.getOffset() - osg::Vec3d(50.0, 400.0, 100.0)).length(), 1e-3);
        EXPECT_TRUE(send(Event::RELEASE, _leftCloseUp + Vec2d(10.0, -20.0), shift));
        EXPECT_EQ(_handler->chosen(), nullptr);
        EXPECT_FALSE(send(Event::DRAG, _leftCloseUp, shift)) << "it has been let go";
        EXPECT_LT((closeUp.getOffset() - osg::Vec3d(50.0, 400.0, 100.0)).length(), 1e-3);
    }
}

TEST_F(CloseUpHandling, LeavesAloneWhatOthersHandled)
{
    osg::ref_ptr<Event> event = new Event;
    event->setEventType(Event::PUSH);
    event->setX(static_cast<float>(_leftCloseUp.x()) + 7.0f);
    event->setY(static_cast<float>(_leftCloseUp.y()) + 11.0f);
    event->setButton(Event::LEFT_MOUSE_BUTTON);
    event->setHandled(true);
    EXPECT_FALSE(_handler->handle(*event, _viewer));
    EXPECT_FALSE(send(Event::RELEASE, _leftCloseUp));
    EXPECT_EQ(_handler->chosen(), nullptr);
    const osg::ref_ptr<osg::ApplicationUsage> usage = new osg::ApplicationUsage;
    _handler->getUsage(*usage);
    EXPECT_EQ(usage->getKeyboardMouseBindings().count("u"), 1u);
    EXPECT_EQ(usage->getKeyboardMouseBindings().count("Shift + left button"), 1u);
}
