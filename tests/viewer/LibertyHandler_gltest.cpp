// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Liberties by hand, with events made by hand: on a plane and a globe, in a plain view, a bend and a panorama map.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgGeoFX/viewer/LibertyHandler.h>
#include <tools/GlFixture.h>
#include <tools/PanoramaHills.h>

#include <GeographicLib/Geodesic.hpp>
#include <osg/Material>
#include <osg/Math>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>

using namespace osgGeoFX;
using namespace geofx::test;
using Event = osgGA::GUIEventAdapter;

namespace
{

constexpr int WIDTH = 640, HEIGHT = 400;

enum class Kind
{
    PLAIN,
    BEND,
    MAP
};

class LibertyByHand : public GlFixture, public ::testing::WithParamInterface<std::tuple<bool, Kind>>
{
protected:
    LibertyByHand() : GlFixture(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        const Kind kind = std::get<1>(GetParam());
        osg::Camera& camera = *viewer().getCamera();
        camera.setProjectionMatrixAsPerspective(30.0, static_cast<double>(WIDTH) / HEIGHT, 100.0, 1e6);
        _terrain->getOrCreateStateSet()->setAttribute(new osg::Material);
        _scene->addChild(_terrain);
        const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
        map->setRipples(0.0);
        if (kind == Kind::MAP) _scene->addEffect(map);
        const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
        bend->setFocusLine(0.3);
        if (kind == Kind::BEND) _scene->addEffect(bend);
        const osg::ref_ptr<EffectScene> other = new EffectScene;
        other->addEffect(map);
        if (kind != Kind::MAP) other->addChild(_hills.terrain());
        const osg::ref_ptr<PanoramaManipulator> hand =
            new PanoramaManipulator(kind == Kind::MAP ? *_scene : *other, *map);
        hand->setCameraProjection(camera.getProjectionMatrix());
        hand->setWidth(24000.0);
        EXPECT_TRUE(hand->setCenter(_hills.middle()));
        hand->updateCamera(camera);
        if (kind != Kind::MAP) other->removeEffect(map);
        viewer().setSceneData(_scene);
        viewer().addEventHandler(_handler);
        viewer().frame();
    }

    bool send(Event::EventType type, double x, double y, int value = 0)
    {
        const osg::ref_ptr<Event> event = new Event;
        event->setEventType(type);
        event->setX(static_cast<float>(x));
        event->setY(static_cast<float>(y));
        if (type == Event::KEYDOWN)
            event->setKey(value);
        else
            event->setButton(Event::LEFT_MOUSE_BUTTON);
        return _handler->handle(*event, viewer());
    }
    bool press(int key, double x, double y) { return send(Event::KEYDOWN, x, y, key); }

    /// The undeformed ground that a pixel shows.
    std::optional<osg::Vec3d> ground(double x, double y)
    {
        const DeformedView view(*_scene, *viewer().getCamera());
        const auto hit = view.pick(x, y);
        if (!hit) return std::nullopt;
        return hit->world;
    }
    /// How far a place is from the center of a liberty, metres along the ground.
    double away(const RegionalLiberty& liberty, const osg::Vec3d& world)
    {
        if (!std::get<0>(GetParam()))
            return std::hypot(world.x() - liberty.getCenter().x(), world.y() - liberty.getCenter().y());
        double latitude = 0.0, longitude = 0.0, height = 0.0, distance = 0.0;
        osg::EllipsoidModel().convertXYZToLatLongHeight(world.x(), world.y(), world.z(), latitude, longitude,
                                                        height);
        GeographicLib::Geodesic::WGS84().Inverse(osg::RadiansToDegrees(latitude),
                                                 osg::RadiansToDegrees(longitude),
                                                 osg::RadiansToDegrees(liberty.getLatitude()),
                                                 osg::RadiansToDegrees(liberty.getLongitude()), distance);
        return distance;
    }

    void keep(const std::string& name)
    {
        const char* folder = std::getenv("GEOFX_KEEP_PICTURES");
        if (!folder) return;
        const osg::ref_ptr<osg::Image> picture = new osg::Image;
        withContext([&](osg::State&) { picture->readPixels(0, 0, WIDTH, HEIGHT, GL_RGB, GL_UNSIGNED_BYTE); });
        std::string file = name;
        std::replace(file.begin(), file.end(), '/', '-');
        osgDB::writeImageFile(*picture, std::string(folder) + "/" + file + ".png");
    }

    PanoramaHills _hills{std::get<0>(GetParam()) ? std::optional<double>(0.8) : std::nullopt};
    osg::ref_ptr<osg::Node> _terrain = _hills.terrain();
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<LibertyHandler> _handler = new LibertyHandler(*_scene);
};

} // namespace

TEST_P(LibertyByHand, IsTakenAtThePointerSizedAndRemoved)
{
    constexpr double x = 320.5, y = 90.5;
    const auto place = ground(x, y);
    ASSERT_TRUE(place);
    EXPECT_FALSE(press(']', x, y)) << "nothing is edited";
    ASSERT_TRUE(press('k', x, y));
    RegionalLiberty* const liberty = _handler->edited();
    ASSERT_TRUE(liberty);
    ASSERT_EQ(_scene->getEffect(0), liberty) << "before the projection";
    EXPECT_LT(away(*liberty, *place), 1.0);
    EXPECT_GT(liberty->getEnlarge(), 1.0);

    // The outline lies on the ground, as far from the center as the region's border.
    viewer().frame();
    const auto expectOutline = [&]
    {
        const double radius = liberty->getAcross();
        ASSERT_EQ(_handler->outline().size(), 64u);
        int seen = 0, there = 0;
        for (const osg::Vec2d& pixel : _handler->outline())
        {
            const auto below = ground(pixel.x(), pixel.y());
            if (!below) continue;
            ++seen;
            // Some of it is behind hills, and a pixel is many metres far away.
            if (std::abs(away(*liberty, *below) - radius) < 0.05 * radius) ++there;
        }
        EXPECT_GT(seen, 30);
        EXPECT_GE(there, seen / 2);
    };
    expectOutline();

    // A drag from the middle to a place makes the radius the way to it.
    const osg::Vec2d end(x + 60.0, y + 4.0);
    ASSERT_TRUE(send(Event::PUSH, x, y));
    ASSERT_TRUE(send(Event::DRAG, x + 40.0, y + 2.0));
    viewer().frame();
    ASSERT_TRUE(send(Event::DRAG, end.x(), end.y()));
    viewer().frame();
    ASSERT_TRUE(send(Event::RELEASE, end.x(), end.y()));
    const auto border = ground(end.x(), end.y());
    ASSERT_TRUE(border);
    EXPECT_NEAR(away(*liberty, *border), liberty->getAcross(), 0.02 * liberty->getAcross());
    EXPECT_EQ(liberty->getAcross(), liberty->getAlong());
    viewer().frame();
    expectOutline();
    keep(std::string("liberty-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    // Beyond the outline the manipulator has the pointer.
    EXPECT_FALSE(send(Event::PUSH, x - 280.0, y));
    EXPECT_FALSE(send(Event::DRAG, x - 270.0, y));

    const double enlarge = liberty->getEnlarge();
    EXPECT_TRUE(press(']', x, y));
    EXPECT_GT(liberty->getEnlarge(), enlarge);
    EXPECT_TRUE(press('}', x, y));
    EXPECT_GT(liberty->getTurn(), 0.0);
    EXPECT_TRUE(press('\'', x, y));
    EXPECT_GT(liberty->getWiden(), 1.0);
    for (int i = 0; i < 100; ++i)
        press(']', x, y);
    EXPECT_EQ(liberty->getEnlarge(), 5.0);
    for (const int key : {'[', '{', ';'})
        EXPECT_TRUE(press(key, x, y));

    // k ends the editing and begins it again; the middle is where the pointer finds it now.
    osg::Vec2d middle;
    const DeformedView view(*_scene, *viewer().getCamera());
    ASSERT_TRUE(view.project(*place, middle));
    liberty->setEnlarge(1.2);
    liberty->setTurn(0.3);
    ASSERT_TRUE(DeformedView(*_scene, *viewer().getCamera()).project(*place, middle));
    EXPECT_TRUE(press('k', middle.x(), middle.y()));
    EXPECT_FALSE(_handler->edited());
    EXPECT_TRUE(_handler->outline().empty());
    EXPECT_TRUE(press('k', middle.x(), middle.y()));
    EXPECT_EQ(_handler->edited(), liberty);
    const unsigned int count = _scene->getNumEffects();
    EXPECT_TRUE(press(Event::KEY_Delete, middle.x(), middle.y()));
    EXPECT_EQ(_scene->getNumEffects(), count - 1);
    EXPECT_FALSE(_handler->edited());
    EXPECT_TRUE(press(Event::KEY_Delete, middle.x(), middle.y())) << "there is none, and nothing happens";
    EXPECT_EQ(_scene->getNumEffects(), count - 1);
    viewer().frame();
}

TEST_P(LibertyByHand, ASecondOneStandsWhereThePointerIsOnTheFirst)
{
    constexpr double x = 320.5, y = 90.5;
    ASSERT_TRUE(press('k', x, y));
    const osg::ref_ptr<RegionalLiberty> first = _handler->edited();
    first->setRadii(6000.0, 6000.0);
    first->setTurn(0.9);
    first->setWiden(1.6);
    // Beside its middle, where it moves the ground, but not within the outline that is edited.
    _handler->edit(nullptr);
    first->setStrength(0.99);
    const auto place = ground(x + 40.0, y + 6.0);
    ASSERT_TRUE(place);
    const osg::ref_ptr<RegionalLiberty> second = new RegionalLiberty;
    _scene->insertEffect(1, second);
    EXPECT_EQ(_scene->getEffect(0), first);
    EXPECT_EQ(_scene->getEffect(1), second);
    // What the first one has moved is below the pointer.
    const DeformedView view(*_scene, *viewer().getCamera());
    osg::Vec2d pixel;
    ASSERT_TRUE(view.project(*place, pixel));
    EXPECT_LT((pixel - osg::Vec2d(x + 40.0, y + 6.0)).length(), 2.0);
    ASSERT_TRUE(press('k', x + 40.0, y + 6.0));
    EXPECT_EQ(_handler->edited(), first) << "it is within the first";
    ASSERT_TRUE(press(Event::KEY_Delete, x + 40.0, y + 6.0));
    EXPECT_EQ(_scene->getEffect(0), second);
}

INSTANTIATE_TEST_SUITE_P(Views, LibertyByHand,
                         ::testing::Combine(::testing::Bool(),
                                            ::testing::Values(Kind::PLAIN, Kind::BEND, Kind::MAP)),
                         [](const auto& each)
                         {
                             const Kind kind = std::get<1>(each.param);
                             return std::string(std::get<0>(each.param) ? "globe" : "plane") +
                                    (kind == Kind::PLAIN  ? "_plain"
                                     : kind == Kind::BEND ? "_bend"
                                                          : "_map");
                         });
