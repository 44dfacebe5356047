// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Panorama maps by hand: what the pointer holds stays under it, on both kinds of terrain, and the limits hold.
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <tools/PanoramaHills.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osgViewer/Viewer>

#include <cmath>
#include <functional>
#include <optional>

using namespace osgGeoFX;
using geofx::test::PanoramaHills;
using geofx::test::Random;
using osg::Vec2d;
using Event = osgGA::GUIEventAdapter;

namespace
{

constexpr double width = 800.0, height = 500.0;

/// A viewer that never draws.
class ByHand : public ::testing::Test
{
protected:
    void SetUp() override { setUp(std::nullopt); }

    void setUp(std::optional<double> latitude)
    {
        _scene = new EffectScene;
        _map = new PanoramaMap;
        _scene->addEffect(_map);
        const PanoramaHills hills{latitude};
        _scene->addChild(hills.terrain());
        _middle = hills.middle();
        _viewer.setSceneData(_scene);
        osg::Camera& camera = *_viewer.getCamera();
        camera.setViewport(0, 0, static_cast<int>(width), static_cast<int>(height));
        camera.setProjectionMatrixAsPerspective(30.0, width / height, 1.0, 1e6);
        _hand = new PanoramaManipulator(*_scene, *_map);
        _hand->setCameraProjection(camera.getProjectionMatrix());
        show();
    }

    void show() { _hand->updateCamera(*_viewer.getCamera()); }

    bool send(Event::EventType type, const Vec2d& pixel = {}, int button = Event::LEFT_MOUSE_BUTTON,
              int key = 0, int modifiers = 0, bool handled = false)
    {
        osg::ref_ptr<Event> event = new Event;
        event->setEventType(type);
        event->setInputRange(0.0f, 0.0f, static_cast<float>(width), static_cast<float>(height));
        event->setMouseYOrientation(Event::Y_INCREASING_UPWARDS);
        event->setX(static_cast<float>(pixel.x()));
        event->setY(static_cast<float>(pixel.y()));
        event->setButton(button);
        event->setKey(key);
        event->setModKeyMask(modifiers);
        event->setTime(_time);
        event->setHandled(handled);
        if (type == Event::SCROLL) event->setScrollingMotion(_scroll);
        const bool taken = _hand->handle(*event, _viewer);
        show();
        return taken;
    }

    /// Frames until it rests.
    void settle(const std::function<void()>& each = [] {})
    {
        for (int i = 0; i < 200 && _hand->gliding(); ++i)
        {
            _time += 0.02;
            send(Event::FRAME);
            each();
        }
        EXPECT_FALSE(_hand->gliding());
    }

    std::optional<osg::Vec3d> shownAt(const Vec2d& pixel)
    {
        const auto hit = DeformedView(*_scene, *_viewer.getCamera()).pick(pixel.x(), pixel.y());
        return hit ? std::optional<osg::Vec3d>(hit->world) : std::nullopt;
    }

    void expectAt(const osg::Vec3d& world, const Vec2d& pixel, double tolerance = 1.0)
    {
        Vec2d found;
        ASSERT_TRUE(DeformedView(*_scene, *_viewer.getCamera()).project(world, found));
        EXPECT_NEAR(found.x(), pixel.x(), tolerance);
        EXPECT_NEAR(found.y(), pixel.y(), tolerance);
    }

    /// A view of the hills, and a pixel of its ground with what it shows; the pixel of the sky is none.
    std::optional<osg::Vec3d> sample(Random& random, Vec2d& pixel)
    {
        _hand->setWidth(random.logarithmic(3000.0, 12000.0));
        _hand->setHeading(random.uniform(-4.0, 4.0));
        _hand->setPitch(random.uniform(-1.6, 0.1));
        // Some with a curve and a scale of heights of their own.
        const bool own = random.integer(0, 2) == 0;
        const double first = random.uniform(0.2, 0.4), second = random.uniform(0.5, 0.8);
        const double scale = random.uniform(0.5, 3.0);
        EXPECT_TRUE(_map->setCurvePoints(own ? std::vector<Vec2d>{{0.3, first}, {0.6, second}}
                                             : std::vector<Vec2d>()));
        EXPECT_TRUE(_map->setHorizonExaggeration(own ? scale : -1.0));
        EXPECT_TRUE(_hand->setCenter(_middle));
        show();
        pixel = aim(random);
        return shownAt(pixel);
    }
    static Vec2d aim(Random& random)
    {
        return {random.uniform(0.05, 0.95) * width, random.uniform(0.05, 0.6) * height};
    }

    /// On a plane, on the equator, in the far north, and above an exaggeration.
    template<typename Body>
    void onAllTerrains(const Body& body)
    {
        for (const std::optional<double> latitude : {std::optional<double>(), std::optional<double>(0.0),
                                                     std::optional<double>(1.2), std::optional<double>(-0.6)})
        {
            SCOPED_TRACE(latitude.value_or(-99.0));
            setUp(latitude);
            if (latitude == -0.6)
            {
                const osg::ref_ptr<VerticalExaggeration> taller = new VerticalExaggeration;
                taller->setFactor(1.7);
                _scene->removeEffect(_map);
                _scene->addEffect(taller);
                _scene->addEffect(_map);
            }
            int grounds = 0;
            for (int i = 0; i < 12; ++i)
            {
                SCOPED_TRACE(i);
                Random random(static_cast<std::uint64_t>(i));
                Vec2d pixel;
                const auto world = sample(random, pixel);
                if (!world) continue;
                ++grounds;
                body(random, *world, pixel);
                if (HasFailure()) return;
            }
            EXPECT_GT(grounds, 8);
        }
    }

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<PanoramaMap> _map;
    osg::ref_ptr<PanoramaManipulator> _hand;
    osg::Vec3d _middle;
    osgViewer::Viewer _viewer;
    double _time = 1.0;
    Event::ScrollingMotion _scroll = Event::SCROLL_UP;
};

double angleBetween(double a, double b)
{
    return std::abs(std::remainder(a - b, 2.0 * osg::PI));
}

} // namespace

TEST_F(ByHand, DraggedGroundStaysUnderThePointer)
{
    onAllTerrains(
        [&](Random& random, const osg::Vec3d& world, const Vec2d& pixel)
        {
            const double before = _hand->getWidth();
            const double heading = _hand->getHeading();
            EXPECT_TRUE(send(Event::PUSH, pixel));
            expectAt(world, pixel);
            for (int i = 0; i < 4; ++i)
            {
                const Vec2d next = aim(random);
                EXPECT_TRUE(send(Event::DRAG, next));
                expectAt(world, next);
            }
            EXPECT_TRUE(send(Event::RELEASE, pixel));
            EXPECT_FALSE(send(Event::DRAG, pixel)) << "nothing is held any more";
            EXPECT_NEAR(_hand->getWidth(), before, 1e-3);
            EXPECT_EQ(_hand->getHeading(), heading);
        });
}

TEST_F(ByHand, ZoomsAreAboutThePointer)
{
    onAllTerrains(
        [&](Random& random, const osg::Vec3d& world, const Vec2d& pixel)
        {
            const double before = _hand->getWidth();
            _scroll = random.integer(0, 1) ? Event::SCROLL_UP : Event::SCROLL_DOWN;
            EXPECT_TRUE(send(Event::SCROLL, pixel));
            EXPECT_TRUE(_hand->gliding());
            settle([&] { expectAt(world, pixel); });
            const double factor = _scroll == Event::SCROLL_UP ? 0.8 : 1.25;
            EXPECT_NEAR(_hand->getWidth(), before * factor, 1e-6 * before);
            // By the button, from any place; up comes nearer.
            EXPECT_TRUE(send(Event::PUSH, pixel, Event::RIGHT_MOUSE_BUTTON));
            const Vec2d next = pixel + Vec2d(5.0, -30.0);
            EXPECT_TRUE(send(Event::DRAG, next));
            expectAt(world, pixel);
            EXPECT_GT(_hand->getWidth(), before * factor);
        });
}

TEST_F(ByHand, TurnsAreAboutTheMiddle)
{
    for (const std::optional<double> latitude : {std::optional<double>(), std::optional<double>(1.2)})
    {
        setUp(latitude);
        for (const double horizon : {0.8, 0.5})
        {
            _map->setHorizonLine(horizon);
            _hand->setWidth(10000.0);
            EXPECT_TRUE(_hand->setCenter(_middle));
            show();
            const Vec2d middle(width / 2.0, horizon < 0.7 ? 0.7 * horizon * height : height / 2.0);
            expectAt(_middle, middle);
            const double before = _hand->getWidth();
            const double heading = _hand->getHeading();
            EXPECT_TRUE(send(Event::PUSH, {100.0, 100.0}, Event::MIDDLE_MOUSE_BUTTON));
            EXPECT_TRUE(send(Event::DRAG, {300.0, 50.0}, Event::MIDDLE_MOUSE_BUTTON));
            EXPECT_NEAR(angleBetween(_hand->getHeading(), heading), osg::PI_4, 1e-6);
            expectAt(_middle, middle);
            send(Event::RELEASE);
            for (const int key : {int(Event::KEY_Left), int(Event::KEY_Left), int(Event::KEY_Right)})
            {
                EXPECT_TRUE(send(Event::KEYDOWN, {}, 0, key));
                settle([&] { expectAt(_middle, middle); });
            }
            EXPECT_NEAR(angleBetween(_hand->getHeading(), heading), osg::PI_4 + osg::PI / 18.0, 1e-6);
            EXPECT_NEAR(_hand->getWidth(), before, 1e-3);
            EXPECT_TRUE(send(Event::KEYDOWN, {}, 0, Event::KEY_Up));
            EXPECT_TRUE(send(Event::KEYDOWN, {}, 0, Event::KEY_Up));
            settle([&] { expectAt(_middle, middle); });
            EXPECT_NEAR(_hand->getWidth(), 0.64 * before, 1e-3 * before) << "two presses add up";
        }
    }
}

TEST_F(ByHand, SkyIsNothingToHold)
{
    _hand->setWidth(60000.0);
    _hand->setCenter(_middle);
    show();
    ASSERT_FALSE(shownAt({400.0, 495.0}));
    EXPECT_TRUE(send(Event::PUSH, {400.0, 495.0}));
    const osg::Vec3d before = _hand->getCenter();
    EXPECT_TRUE(send(Event::DRAG, {400.0, 495.0}));
    EXPECT_NEAR((_hand->getCenter() - before).length(), 0.0, 1e-3) << "and does not make the map jump";
    EXPECT_TRUE(send(Event::DRAG, {440.0, 495.0}));
    // 40 of 800 pixels to the right.
    EXPECT_NEAR((_hand->getCenter() - before).length(), 3000.0, 1.0);
}

TEST_F(ByHand, TheEyeStaysWithinItsLimits)
{
    for (const std::optional<double> latitude : {std::optional<double>(), std::optional<double>(0.7)})
    {
        setUp(latitude);
        const double wide = _viewer.getCamera()->getProjectionMatrix()(0, 0);
        _hand->setWidth(1e12);
        EXPECT_NEAR(_hand->getWidth(), 2.0 * 5e6 / wide, 1.0);
        _hand->setWidth(1e-3);
        EXPECT_NEAR(_hand->getWidth(), 2.0 * 100.0 / wide, 1e-4);
        _scroll = Event::SCROLL_UP;
        EXPECT_TRUE(send(Event::SCROLL, {400.0, 200.0}));
        settle();
        EXPECT_NEAR(_hand->getWidth(), 2.0 * 100.0 / wide, 1e-4);
        _hand->setPitch(-2.0);
        EXPECT_NEAR(_hand->getPitch(), osg::DegreesToRadians(-85.0), 1e-12);
        _hand->setPitch(1.0);
        EXPECT_EQ(_hand->getPitch(), 0.0);
    }
}

TEST_F(ByHand, TakesOverOtherManipulatorsViews)
{
    for (const std::optional<double> latitude : {std::optional<double>(), std::optional<double>(0.7)})
    {
        setUp(latitude);
        _hand->setHeading(0.7);
        _hand->setPitch(-0.4);
        _hand->setWidth(9000.0);
        const osg::Matrixd level = _hand->getMatrix();
        _hand->setByMatrix(level);
        for (int i = 0; i < 16; ++i)
            EXPECT_NEAR(_hand->getMatrix()(i / 4, i % 4), level(i / 4, i % 4), 1e-6) << i;
        // A roll is taken out; the place and the way to the right stay.
        _hand->setByMatrix(osg::Matrixd::rotate(0.3, osg::Vec3d(0.0, 0.0, 1.0)) * level);
        EXPECT_NEAR((_hand->getMatrix().getTrans() - level.getTrans()).length(), 0.0, 1e-6);
        EXPECT_NEAR(_hand->getPitch(), -0.4, 1e-6);
        _hand->setByInverseMatrix(osg::Matrixd::inverse(level));
        EXPECT_NEAR(_hand->getHeading(), 0.7, 1e-9);
    }
}

TEST_F(ByHand, HomeIsTheSceneUnlessOneIsSet)
{
    EXPECT_NEAR((_hand->getCenter() - _scene->getBound().center()).length(), 0.0, 5000.0);
    EXPECT_NEAR(_hand->getWidth(), 2.0 * static_cast<double>(_scene->getBound().radius()), 1.0);
    _hand->setHomePosition({1000.0, -9000.0, 12000.0}, {1000.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
    EXPECT_TRUE(send(Event::KEYDOWN, {}, 0, Event::KEY_Space));
    EXPECT_NEAR((_hand->getMatrix().getTrans() - osg::Vec3d(1000.0, -9000.0, 12000.0)).length(), 0.0, 1e-6);
    EXPECT_NEAR(angleBetween(_hand->getHeading(), 0.0), 0.0, 1e-9);
    EXPECT_NEAR(_hand->getPitch(), std::atan2(-12000.0, 9000.0), 1e-9);
}

TEST_F(ByHand, WidthsOfTheMapItselfAreZoomedToo)
{
    _map->setViewRadius(5000.0);
    _hand = new PanoramaManipulator(*_scene, *_map);
    send(Event::FRAME);
    EXPECT_NEAR(_hand->getWidth(), 10000.0, 1e-6);
    _hand->setWidth(6000.0);
    EXPECT_NEAR(_map->getViewRadius(), 3000.0, 1e-6);
    EXPECT_TRUE(send(Event::KEYDOWN, {}, 0, Event::KEY_Space));
    EXPECT_EQ(_map->getViewRadius(), 5000.0) << "home is what it was";
    // An orthographic camera has a width of its own until somebody zooms.
    _map->setViewRadius(0.0);
    _hand = new PanoramaManipulator(*_scene, *_map);
    _viewer.getCamera()->setProjectionMatrixAsOrtho(-4000.0, 4000.0, -2500.0, 2500.0, 1.0, 1e6);
    send(Event::FRAME);
    EXPECT_NEAR(_hand->getWidth(), 8000.0, 1e-6);
    EXPECT_EQ(_map->getViewRadius(), 0.0);
    EXPECT_TRUE(_hand->setCenter(_middle));
    show();
    const Vec2d pixel(300.0, 150.0);
    const auto world = shownAt(pixel);
    ASSERT_TRUE(world);
    EXPECT_TRUE(send(Event::SCROLL, pixel));
    settle([&] { expectAt(*world, pixel); });
    EXPECT_NEAR(_map->getViewRadius(), 3200.0, 1e-2);
}

TEST_F(ByHand, LeavesEventsToOthers)
{
    const osg::Matrixd before = _hand->getMatrix();
    for (const int modifier : {int(Event::MODKEY_CTRL), int(Event::MODKEY_ALT), int(Event::MODKEY_SHIFT)})
    {
        EXPECT_FALSE(send(Event::PUSH, {400.0, 100.0}, Event::LEFT_MOUSE_BUTTON, 0, modifier));
        EXPECT_FALSE(send(Event::DRAG, {100.0, 100.0}));
    }
    EXPECT_FALSE(send(Event::PUSH, {400.0, 100.0}, Event::LEFT_MOUSE_BUTTON, 0, 0, true)) << "handled";
    EXPECT_FALSE(send(Event::KEYDOWN, {}, 0, 'x'));
    EXPECT_FALSE(send(Event::MOVE, {10.0, 10.0}));
    EXPECT_EQ(_hand->getMatrix(), before);
    const osg::ref_ptr<osg::ApplicationUsage> usage = new osg::ApplicationUsage;
    _hand->getUsage(*usage);
    EXPECT_EQ(usage->getKeyboardMouseBindings().size(), 5u);
}
