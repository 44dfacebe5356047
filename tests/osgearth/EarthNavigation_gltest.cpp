// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The kit's EarthManipulator over deformed ground of osgEarth. Events go through the viewer's queue.
#include "EarthMap.h"

#include <osgEarth/EarthManipulator>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/viewer/AboveGround.h>
#include <osgGeoFX/viewer/EarthNavigation.h>
#include <tools/RandomSamples.h>

#include <osg/MatrixTransform>

#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;
using osgEarth::Util::EarthManipulator;

namespace
{

using Event = osgGA::GUIEventAdapter;
using Navigation = EarthNavigation<EarthManipulator>;

/// Pixels that a place may be away from the pointer.
constexpr double tolerance = 2.0;

class EarthNavigationTest : public EarthMaps
{
protected:
    ~EarthNavigationTest() override
    {
        viewer().setCameraManipulator(nullptr);
        viewer().setEventQueue(new osgGA::EventQueue);
    }
    /// Shows a map with these effects, and lets a manipulator move the camera.
    bool navigate(const std::string& effects, EarthManipulator* manipulator = new Navigation)
    {
        if (!show(extension(effects)) || !scene()) return false;
        use(*manipulator);
        return true;
    }
    void use(EarthManipulator& manipulator)
    {
        const osg::ref_ptr<osgGA::EventQueue> queue = new osgGA::EventQueue(Event::Y_INCREASING_UPWARDS);
        queue->getCurrentEventState()->setWindowRectangle(0, 0, WIDTH, HEIGHT);
        viewer().setEventQueue(queue);
        viewer().setCameraManipulator(&manipulator);
        earth = &manipulator;
    }
    static osgEarth::Viewpoint viewpoint(double longitude, double latitude, double heading, double pitch,
                                         double range)
    {
        return osgEarth::Viewpoint("", longitude, latitude, 0.0, heading, pitch, range);
    }
    /// Looks from there. What is measured does not depend on how many tiles have come.
    void lookFrom(const osgEarth::Viewpoint& there)
    {
        earth->setViewpoint(there);
        if (fullTest())
            settle();
        else
            frames(15);
    }
    void settle() { draw(camera().getViewMatrix()); }
    void frames(int count)
    {
        while (count-- > 0)
            viewer().frame();
    }
    double now() { return viewer().getFrameStamp()->getReferenceTime(); }
    osgGA::EventQueue& queue() { return *viewer().getEventQueue(); }
    void push(const osg::Vec2d& pixel, unsigned int button = 1)
    {
        queue().mouseButtonPress(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), button, now());
        frames(1);
    }
    void drag(const osg::Vec2d& pixel)
    {
        queue().mouseMotion(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), now());
        frames(1);
    }
    void release(const osg::Vec2d& pixel, unsigned int button = 1)
    {
        queue().mouseButtonRelease(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), button,
                                   now());
        frames(1);
    }
    /// Turns the wheel, and waits until the camera has gone.
    void scroll(const osg::Vec2d& pixel, bool closer)
    {
        drag(pixel);
        queue().mouseScroll(closer ? Event::SCROLL_DOWN : Event::SCROLL_UP, now());
        frames(14);
    }
    /// Empty for the sky, and for what is about the near plane.
    std::optional<osg::Vec3d> placeAt(const osg::Vec2d& pixel)
    {
        constexpr double nearest = 100.0;
        const auto hit = DeformedView(*scene(), camera()).pickCurved(pixel.x(), pixel.y());
        if (!hit || hit->distance < nearest) return std::nullopt;
        return hit->world;
    }
    osg::Vec2d pixelOf(const osg::Vec3d& place)
    {
        osg::Vec2d pixel(-1e6, -1e6);
        DeformedView(*scene(), camera()).project(place, pixel);
        return pixel;
    }
    osg::Vec3d eye() { return osg::Matrixd::inverse(camera().getViewMatrix()).getTrans(); }
    osg::Vec2d randomPixel(Random& random)
    {
        return {random.uniform(0.1, 0.9) * WIDTH, random.uniform(0.1, 0.8) * HEIGHT};
    }
    osgEarth::Viewpoint randomView(Random& random)
    {
        return viewpoint(random.uniform(10.2, 10.8), random.uniform(0.2, 0.8), random.uniform(0.0, 360.0),
                         random.uniform(-65.0, -15.0), random.logarithmic(6000.0, 40000.0));
    }

    osg::ref_ptr<EarthManipulator> earth;
};

/// Bends and exaggeration, on a globe and in a projection.
class EarthNavigationIn : public EarthNavigationTest,
                          public testing::WithParamInterface<std::tuple<const char*, const char*>>
{
protected:
    EarthNavigationIn() { setProfile(std::get<1>(GetParam())); }
    static std::string effect() { return std::get<0>(GetParam()); }
};

} // namespace

TEST_P(EarthNavigationIn, DragsTheGroundBelowThePointer)
{
    ASSERT_TRUE(navigate(effect()));
    earth->getSettings()->bindMouse(EarthManipulator::ACTION_EARTH_DRAG, Event::RIGHT_MOUSE_BUTTON);
    const int count = fullTest() ? 60 : 2;
    int held = 0;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(i));
        earth->getSettings()->setLockAzimuthWhilePanning(random.integer(0, 1) == 1);
        lookFrom(randomView(random));
        const osg::Vec2d from = randomPixel(random), to = randomPixel(random);
        const auto place = placeAt(from);
        if (!place || !placeAt(to)) continue;
        // The left button pans, as osgEarth binds it.
        const unsigned int button = random.integer(0, 1) ? 1 : 3;
        push(from, button);
        // Also at the first touch it does not jump.
        EXPECT_LT((pixelOf(*place) - from).length(), 0.5);
        for (const double share : {0.2, 0.5, 0.8, 1.0})
        {
            const osg::Vec2d pointer = from + (to - from) * share;
            drag(pointer);
            EXPECT_LT((pixelOf(*place) - pointer).length(), tolerance) << share;
        }
        release(to, button);
        frames(3);
        EXPECT_LT((pixelOf(*place) - to).length(), tolerance) << "it lets go";
        ++held;
    }
    EXPECT_GE(held, 1 + count / 4);
}

TEST_P(EarthNavigationIn, ZoomsToThePlaceBelowThePointer)
{
    ASSERT_TRUE(navigate(effect()));
    const int count = fullTest() ? 60 : 2;
    int zoomed = 0;
    for (int i = 0; zoomed < count && i < 4 * count; ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(100 + i));
        lookFrom(randomView(random));
        const osg::Vec2d pixel = randomPixel(random);
        auto place = placeAt(pixel);
        if (!place) continue;
        // Where the ground bends, its height on the map counts: the way over the ground is what holds the place in the picture.
        const bool bends = effect().find("Exaggeration") == std::string::npos;
        const auto away = [&]
        {
            if (!bends) return (DeformedView(*scene(), camera()).deform(*place) - eye()).length();
            osgEarth::GeoPoint above, below;
            above.fromWorld(map().getMapSRS(), eye());
            below.fromWorld(map().getMapSRS(), *place);
            return above.z() - below.z();
        };
        for (int turn = 0; turn < 4; ++turn)
        {
            // Finer tiles may have come.
            place = placeAt(pixel);
            ASSERT_TRUE(place);
            const double last = away();
            // The last one goes back.
            scroll(pixel, turn < 3);
            EXPECT_LT((pixelOf(*place) - pixel).length(), tolerance) << turn;
            if (turn < 3)
            {
                EXPECT_LT(away(), 0.95 * last) << turn;
                // Ground that does not bend comes nearer by the share that osgEarth has for the wheel.
                if (!bends)
                {
                    EXPECT_NEAR(away() / last, 0.74, 0.03) << turn;
                }
            }
            else
            {
                EXPECT_GT(away(), 1.05 * last);
            }
        }
        ++zoomed;
    }
    EXPECT_GE(zoomed, 1 + count / 4);
}

TEST_P(EarthNavigationIn, FliesToThePlaceThatIsClicked)
{
    ASSERT_TRUE(navigate(effect()));
    // Tiles that come on the way may lift the camera.
    earth->getSettings()->setTerrainAvoidanceEnabled(false);
    const int count = fullTest() ? 30 : 2;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(200 + i));
        lookFrom(randomView(random));
        // The heights of the ground must not change until the second click.
        settle();
        const osg::Vec2d pixel = randomPixel(random);
        const auto place = placeAt(pixel);
        if (!place) continue;
        push(pixel);
        release(pixel);
        queue().mouseDoubleButtonPress(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), 1,
                                       now());
        frames(1);
        ASSERT_TRUE(earth->isSettingViewpoint());
        // osgEarth flies by the clock.
        for (int wait = 0; wait < 100 && earth->isSettingViewpoint(); ++wait)
        {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            frames(1);
        }
        EXPECT_FALSE(earth->isSettingViewpoint());
        EXPECT_LT((pixelOf(*place) - osg::Vec2d(WIDTH, HEIGHT) * 0.5).length(), tolerance);
    }
}

TEST_P(EarthNavigationIn, StaysAboveTheDeformedGround)
{
    ASSERT_TRUE(navigate(effect()));
    constexpr double margin = 30.0;
    earth->getSettings()->setTerrainAvoidanceMinimumDistance(margin);
    earth->getSettings()->setMinMaxPitch(-89.0, 20.0);
    const auto missing = [&](double metres)
    {
        // A camera that rests looks for new tiles four times a second. It sees another bend after each rise.
        for (int look = 0; look < 3; ++look)
        {
            std::this_thread::sleep_for(std::chrono::milliseconds(300));
            frames(2);
        }
        return AboveGround::rise(*scene(), camera().getViewMatrix(), camera(), metres);
    };
    const int count = fullTest() ? 20 : 2;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(300 + i));
        osgEarth::Viewpoint there = randomView(random);
        there.range() = osgEarth::Distance(3000.0, osgEarth::Units::METERS);
        lookFrom(there);
        settle();
        EXPECT_LT(missing(margin), 0.1);
        const osg::Vec2d pixel = randomPixel(random);
        for (int turn = 0; turn < 8; ++turn)
        {
            scroll(pixel, true);
            EXPECT_LT(missing(margin), 0.5) << "wheel " << turn;
        }
        push(pixel, 2);
        for (double up = 0.1; up < 1.0; up += 0.2)
        {
            drag(pixel - osg::Vec2d(0.0, up * HEIGHT * 0.5));
            EXPECT_LT(missing(margin), 0.5) << "tilt " << up;
        }
        release(pixel, 2);
    }
    // A bend may be none for an eye below the ground; osgEarth waits for an action then.
    if (effect().find("Exaggeration") == std::string::npos) return;
    // Without the setting it may go where it likes.
    earth->getSettings()->setTerrainAvoidanceEnabled(false);
    osgEarth::Viewpoint below = viewpoint(10.5, 0.5, 0.0, -20.0, 5.0);
    below.focalPoint().mutable_value().z() = -500.0;
    lookFrom(below);
    EXPECT_GT(missing(margin), 400.0);
    earth->getSettings()->setTerrainAvoidanceEnabled(true);
    frames(2);
    EXPECT_LT(missing(margin), 0.5);
}

// Coarse tiles span a whole bend, and are drawn straight through the air across it.
TEST_P(EarthNavigationIn, TilesThatComeMoveNothing)
{
    ASSERT_TRUE(navigate(effect()));
    for (int i = 0; i < 4; ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(i));
        earth->setViewpoint(randomView(random));
        const osg::Vec3d wished = earth->getMatrix().getTrans();
        frames(15);
        const auto place = placeAt(osg::Vec2d(WIDTH, HEIGHT) * 0.5);
        ASSERT_TRUE(place);
        osgEarth::GeoPoint below;
        below.fromWorld(map().getMapSRS(), *place);
        // Coarse triangles of the globe are chords of it.
        EXPECT_GT(below.z(), -10000.0);
        EXPECT_LT(below.z(), 1500.0);
        frames(30);
        EXPECT_LT((eye() - wished).length(), 1.0);
    }
}

using Case = std::tuple<const char*, const char*>;
INSTANTIATE_TEST_SUITE_P(, EarthNavigationIn,
                         testing::Values(Case("<verticalExaggeration factor=\"3\"/>", ""),
                                         Case("<verticalExaggeration factor=\"3\"/>", "global-mercator"),
                                         Case("<birdsEyeView/>", ""),
                                         Case("<birdsEyeView/>", "global-mercator"),
                                         Case("<pedestrianView/>", ""),
                                         Case("<pedestrianView/>", "global-mercator")));

namespace
{

class Tethered : public EarthNavigationTest
{
protected:
    /// A node above the ground, degrees and metres.
    void place(double longitude, double latitude, double height)
    {
        osg::Matrixd ground;
        osgEarth::GeoPoint(osgEarth::SpatialReference::get("wgs84"), longitude, latitude, height)
            .createLocalToWorld(ground);
        node->setMatrix(ground);
    }
    const osg::ref_ptr<osg::MatrixTransform> node = new osg::MatrixTransform;
};

bool near(const osg::Matrixd& a, const osg::Matrixd& b, double metres)
{
    bool same = (a.getTrans() - b.getTrans()).length() < metres;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            same = same && std::abs(a(i, k) - b(i, k)) < 1e-6;
    return same;
}

} // namespace

// Without effects, or with effects that are off, it is osgEarth's to the bit.
TEST_F(EarthNavigationTest, IsOsgEarthsWhereNothingIsDeformed)
{
    std::vector<osg::Matrixd> matrices[2];
    for (const bool ours : {false, true})
    {
        ASSERT_TRUE(navigate("<verticalExaggeration factor=\"3\" enabled=\"false\"/>",
                             ours ? new Navigation : new EarthManipulator));
        lookFrom(viewpoint(10.4, 0.4, 30.0, -40.0, 9000.0));
        const auto note = [&]
        {
            matrices[ours ? 1 : 0].push_back(earth->getMatrix());
        };
        note();
        for (const unsigned int button : {1u, 2u, 3u})
        {
            push({100.0, 60.0}, button);
            drag({130.0, 80.0});
            note();
            release({130.0, 80.0}, button);
            note();
        }
        queue().keyPress(Event::KEY_Left, now());
        frames(3);
        queue().keyRelease(Event::KEY_Left, now());
        frames(1);
        note();
    }
    ASSERT_EQ(matrices[0].size(), matrices[1].size());
    for (std::size_t i = 0; i < matrices[0].size(); ++i)
        EXPECT_TRUE(near(matrices[1][i], matrices[0][i], 1.0)) << i;
}

TEST_F(EarthNavigationTest, ObeysSettingsAndBindings)
{
    ASSERT_TRUE(navigate("<verticalExaggeration factor=\"3\"/>"));
    auto& settings = *earth->getSettings();
    const osg::Vec2d from(120.0, 60.0), to(180.0, 90.0);
    const auto start = [&]
    {
        lookFrom(viewpoint(10.4, 0.4, 30.0, -40.0, 9000.0));
    };
    const auto heading = [&]
    {
        return earth->getViewpoint().heading()->as(osgEarth::Units::DEGREES);
    };
    const auto dragged = [&](unsigned int button)
    {
        const auto place = placeAt(from);
        push(from, button);
        drag(to);
        const double off = place ? (pixelOf(*place) - to).length() : 1e6;
        release(to, button);
        return off;
    };
    start();
    EXPECT_LT(dragged(1), tolerance);
    EXPECT_NEAR(heading(), 30.0, 1e-3) << "the azimuth is locked";
    start();
    dragged(2);
    EXPECT_GT(std::abs(heading() - 30.0), 1.0) << "the middle button rotates";
    settings.setMouseSensitivity(0.5);
    start();
    EXPECT_GT(dragged(1), 10.0) << "the sensitivity of panning";
    settings.setMouseSensitivity(1.0);
    settings.bindMouse(EarthManipulator::ACTION_ROTATE, Event::LEFT_MOUSE_BUTTON);
    settings.bindMouse(EarthManipulator::ACTION_PAN, Event::MIDDLE_MOUSE_BUTTON);
    start();
    EXPECT_LT(dragged(2), tolerance) << "another button pans";
    start();
    dragged(1);
    EXPECT_GT(std::abs(heading() - 30.0), 1.0);

    settings.setMinMaxDistance(6000.0, 12000.0);
    settings.setZoomToMouse(false);
    start();
    const auto middle = placeAt(osg::Vec2d(WIDTH, HEIGHT) * 0.5);
    ASSERT_TRUE(middle);
    for (int turn = 0; turn < 4; ++turn)
        scroll(from, true);
    EXPECT_NEAR(earth->getViewpoint().range()->as(osgEarth::Units::METERS), 6000.0, 1.0);
    EXPECT_LT((pixelOf(*middle) - osg::Vec2d(WIDTH, HEIGHT) * 0.5).length(), tolerance);
    for (int turn = 0; turn < 5; ++turn)
        scroll(from, false);
    EXPECT_NEAR(earth->getViewpoint().range()->as(osgEarth::Units::METERS), 12000.0, 1.0);

    settings.setMinMaxDistance(1.0, 1e8);
    start();
    const auto eyeBefore = eye();
    queue().keyPress(Event::KEY_Up, now());
    frames(6);
    queue().keyRelease(Event::KEY_Up, now());
    frames(2);
    EXPECT_GT((eye() - eyeBefore).length(), 50.0) << "keys pan";
}

TEST_F(EarthNavigationTest, KeepsViewpointsAndHome)
{
    ASSERT_TRUE(navigate("<verticalExaggeration factor=\"3\"/>"));
    const osgEarth::Viewpoint there = viewpoint(10.6, 0.3, 75.0, -35.0, 20000.0);
    const osg::ref_ptr<EarthManipulator> plain = new EarthManipulator;
    lookFrom(viewpoint(10.4, 0.4, 30.0, -40.0, 9000.0));
    // Else osgEarth takes a second at least.
    earth->getSettings()->setAutoViewpointDurationEnabled(false);
    earth->setViewpoint(there, 0.2);
    EXPECT_TRUE(earth->isSettingViewpoint());
    frames(2);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    frames(2);
    EXPECT_FALSE(earth->isSettingViewpoint());
    plain->setNode(viewer().getSceneData());
    plain->setViewpoint(there);
    EXPECT_TRUE(near(earth->getMatrix(), plain->getMatrix(), 1e-3));
    settle();
    EXPECT_TRUE(near(earth->getMatrix(), plain->getMatrix(), 1e-3)) << "tiles that come move nothing";
    const osgEarth::Viewpoint now = earth->getViewpoint();
    EXPECT_NEAR(now.heading()->as(osgEarth::Units::DEGREES), 75.0, 1e-6);
    EXPECT_NEAR(now.range()->as(osgEarth::Units::METERS), 20000.0, 1e-3);
    // A view matrix comes back as it was given, with the focus on the ground that is seen.
    const osg::Matrixd matrix = earth->getMatrix();
    earth->setByMatrix(matrix);
    EXPECT_TRUE(near(earth->getMatrix(), matrix, 1e-3));
    const auto middle = placeAt(osg::Vec2d(WIDTH, HEIGHT) * 0.5);
    ASSERT_TRUE(middle);
    const double seen = (DeformedView(*scene(), camera()).deform(*middle) - eye()).length();
    EXPECT_NEAR(earth->getViewpoint().range()->as(osgEarth::Units::METERS), seen, 1e-3 * seen);
    earth->setHomeViewpoint(there);
    queue().keyPress(Event::KEY_Space, this->now());
    frames(2);
    EXPECT_TRUE(near(earth->getMatrix(), plain->getMatrix(), 1e-3));
}

TEST_F(Tethered, FollowsANodeAsOsgEarthDoes)
{
    std::vector<osg::Matrixd> matrices[2];
    for (const bool ours : {false, true})
    {
        ASSERT_TRUE(
            navigate("<verticalExaggeration factor=\"3\"/>", ours ? new Navigation : new EarthManipulator));
        place(10.4, 0.4, 9000.0);
        earth->getSettings()->getBreakTetherActions().push_back(EarthManipulator::ACTION_HOME);
        osgEarth::Viewpoint behind;
        behind.setNode(node);
        behind.heading() = osgEarth::Angle(20.0, osgEarth::Units::DEGREES);
        behind.pitch() = osgEarth::Angle(-25.0, osgEarth::Units::DEGREES);
        behind.range() = osgEarth::Distance(4000.0, osgEarth::Units::METERS);
        earth->setViewpoint(behind);
        const auto note = [&]
        {
            frames(1);
            matrices[ours ? 1 : 0].push_back(osg::Matrixd::inverse(camera().getViewMatrix()));
        };
        note();
        place(10.5, 0.45, 9500.0);
        note();
        EXPECT_TRUE(earth->isTethering());
        push({100.0, 60.0}, 2);
        drag({130.0, 80.0});
        note();
        release({130.0, 80.0}, 2);
        push({100.0, 60.0}, 1);
        drag({120.0, 80.0});
        release({120.0, 80.0}, 1);
        note();
        scroll({100.0, 60.0}, true);
        note();
        // Where the ground rises above it, the picture's camera is lifted, and the tether holds.
        if (ours)
        {
            place(10.4, 0.4, -3000.0);
            frames(2);
            EXPECT_TRUE(earth->isTethering());
            EXPECT_LT(AboveGround::rise(*scene(), camera().getViewMatrix(), camera(), 1.0), 0.5);
            EXPECT_FALSE(near(earth->getMatrix(), osg::Matrixd::inverse(camera().getViewMatrix()), 100.0));
        }
        queue().keyPress(Event::KEY_Space, now());
        frames(2);
        EXPECT_FALSE(earth->isTethering());
    }
    ASSERT_EQ(matrices[0].size(), matrices[1].size());
    for (std::size_t i = 0; i < matrices[0].size(); ++i)
        EXPECT_TRUE(near(matrices[1][i], matrices[0][i], 0.5)) << i;
}

// Panorama maps have a manipulator of their own; osgEarth's holds their ground, too.
TEST_F(EarthNavigationTest, HoldsTheGroundOfPanoramaMaps)
{
    ASSERT_TRUE(navigate("<panoramaMap ripples=\"0\"/>"));
    lookFrom(viewpoint(10.5, 0.4, 0.0, -32.0, 15000.0));
    settle();
    const osg::Vec2d from(130.0, 50.0), to(180.0, 80.0);
    const auto place = placeAt(from);
    ASSERT_TRUE(place);
    push(from);
    drag((from + to) * 0.5);
    drag(to);
    EXPECT_LT((pixelOf(*place) - to).length(), tolerance);
    release(to);
    const auto there = placeAt(to);
    ASSERT_TRUE(there);
    scroll(to, true);
    EXPECT_LT((pixelOf(*there) - to).length(), tolerance);
}

// The ground may rise below a camera that stands still.
TEST_F(EarthNavigationTest, RisesWithTheGround)
{
    ASSERT_TRUE(navigate("<verticalExaggeration factor=\"1\"/>"));
    lookFrom(viewpoint(10.4, 0.4, 30.0, -20.0, 1500.0));
    settle();
    const double before = eye().length();
    dynamic_cast<VerticalExaggeration&>(*scene()->getEffect(0)).setFactor(8.0);
    frames(2);
    EXPECT_GT(eye().length(), before + 1000.0);
    EXPECT_LT(AboveGround::rise(*scene(), camera().getViewMatrix(), camera(), 1.0), 0.5);
    // Where it sinks, the camera may go below the ground that osgEarth has loaded.
    dynamic_cast<VerticalExaggeration&>(*scene()->getEffect(0)).setFactor(0.1);
    double height = 0.0;
    const auto wgs84 = osgEarth::SpatialReference::get("wgs84");
    ASSERT_TRUE(map().getTerrain()->getHeight(wgs84, 10.4, 0.4, &height));
    ASSERT_GT(height, 100.0);
    osgEarth::Viewpoint low = viewpoint(10.4, 0.4, 30.0, -20.0, 10.0);
    low.focalPoint().mutable_value().z() = 0.5 * height;
    lookFrom(low);
    settle();
    const osg::Vec3d lowBefore = eye();
    push({100.0, 60.0}, 2);
    drag({100.0, 62.0});
    release({100.0, 62.0}, 2);
    EXPECT_LT((eye() - lowBefore).length(), 10.0);
}
