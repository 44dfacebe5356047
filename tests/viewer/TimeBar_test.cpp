// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The bar of the layers' time, with events made by hand, in a viewer that never draws: where things are is taken from what it draws.
#include <osgGeoFX/viewer/TimeBar.h>
#include <tools/WindowEvents.h>

#include <osg/Geometry>
#include <osgText/Text>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

class TimeBarTest : public WindowEvents
{
protected:
    void SetUp() override
    {
        _clock->setRange(1000.0, 3000.0);
        _clock->setTime(1500.0);
        frame();
    }
    /// One of the rectangles that are drawn, the lowest first: panel, track, what is past, thumb, and the button's.
    osg::BoundingBoxd rectangle(std::size_t number)
    {
        const auto& vertices =
            static_cast<const osg::Vec3Array&>(*picture().getChild(0)->asGeometry()->getVertexArray());
        osg::BoundingBoxd box;
        for (std::size_t i = 6 * number; i < std::min(6 * number + 6, vertices.size()); ++i)
            box.expandBy(osg::Vec3d(vertices[i]));
        return box;
    }
    osg::Vec2d middle(std::size_t number)
    {
        const osg::Vec3d center = rectangle(number).center();
        return {center.x(), center.y()};
    }
    osg::Vec2d onTrack(double share)
    {
        const osg::BoundingBoxd track = rectangle(1);
        return {track.xMin() + share * (track.xMax() - track.xMin()), track.center().y()};
    }

    osgGA::GUIEventHandler& handler() override { return *_bar; }

    osg::ref_ptr<LayerClock> _clock = new LayerClock;
    osg::ref_ptr<TimeBar> _bar = new TimeBar(*_clock);
};

} // namespace

TEST_F(TimeBarTest, ShowsTimeAndSpeed)
{
    EXPECT_EQ(_bar->text(), "0:25:00\t1 s/s, again and again");
    EXPECT_NEAR(middle(3).x(), onTrack(0.25).x(), 1e-3) << "the thumb";
    EXPECT_NEAR(rectangle(2).xMax(), onTrack(0.25).x(), 1e-3) << "what is past";
    const auto* text = dynamic_cast<const osgText::Text*>(picture().getChild(1));
    ASSERT_TRUE(text);
    EXPECT_EQ(text->getText().createUTF8EncodedString(), "0:25:00");
    // All of it lies in the window.
    EXPECT_GE(rectangle(0).xMin(), 0.0);
    EXPECT_LE(rectangle(0).xMax(), 1280.0);
    _clock->setTime(2500.0);
    _clock->setSpeed(-7200.0 * 3.0);
    _clock->setLoop(false);
    _clock->setPlaying(false);
    frame();
    EXPECT_EQ(_bar->text(), "0:41:40\t-6 h/s, once\tpaused");
    EXPECT_NEAR(middle(3).x(), onTrack(0.75).x(), 1e-3);
}

TEST_F(TimeBarTest, TheHandHasTheTimeAndLetsItGo)
{
    EXPECT_TRUE(mouse(Event::PUSH, onTrack(0.5)));
    EXPECT_NEAR(_clock->getTime(), 2000.0, 1.0);
    EXPECT_FALSE(_clock->getPlaying()) << "while it is held";
    EXPECT_TRUE(mouse(Event::DRAG, onTrack(0.9)));
    EXPECT_NEAR(_clock->getTime(), 2800.0, 1.0);
    EXPECT_TRUE(mouse(Event::DRAG, onTrack(1.7)));
    EXPECT_EQ(_clock->getTime(), 3000.0);
    EXPECT_TRUE(mouse(Event::RELEASE, onTrack(1.7)));
    EXPECT_TRUE(_clock->getPlaying());
    // One that is paused stays so.
    _clock->setPlaying(false);
    EXPECT_TRUE(click(onTrack(0.1)));
    EXPECT_FALSE(_clock->getPlaying());
    EXPECT_NEAR(_clock->getTime(), 1200.0, 1.0);
    // Beside the bar everything is somebody else's.
    EXPECT_FALSE(click({640.0, 600.0}));
    EXPECT_FALSE(mouse(Event::DRAG, onTrack(0.5)));
    EXPECT_TRUE(mouse(Event::SCROLL, onTrack(0.5)));
    EXPECT_FALSE(mouse(Event::SCROLL, {640.0, 600.0}));
}

TEST_F(TimeBarTest, ButtonsAndKeys)
{
    EXPECT_TRUE(click(middle(4)));
    EXPECT_FALSE(_clock->getPlaying());
    frame();
    EXPECT_TRUE(click(middle(4)));
    EXPECT_TRUE(_clock->getPlaying());
    EXPECT_TRUE(press('y'));
    EXPECT_FALSE(_clock->getPlaying());
    EXPECT_TRUE(press('x'));
    EXPECT_EQ(_clock->getSpeed(), 2.0);
    EXPECT_TRUE(press('X'));
    EXPECT_TRUE(press('X'));
    EXPECT_EQ(_clock->getSpeed(), 0.5);
    EXPECT_TRUE(click(onTrack(0.5), Event::RIGHT_MOUSE_BUTTON));
    EXPECT_EQ(_clock->getSpeed(), -0.5);
    const osg::BoundingBoxd panel = rectangle(0);
    EXPECT_TRUE(click({panel.xMax() - 30.0, panel.yMax() - 8.0}));
    EXPECT_FALSE(_clock->getLoop());
    EXPECT_FALSE(press('q'));
}

TEST_F(TimeBarTest, IsHiddenByItsKey)
{
    EXPECT_TRUE(press(Event::KEY_F3));
    EXPECT_FALSE(_bar->shown());
    EXPECT_EQ(_bar->text(), "");
    EXPECT_EQ(viewer.getSlave(0)._camera->getNodeMask(), 0u);
    EXPECT_FALSE(click(onTrack(0.5)));
    EXPECT_TRUE(_clock->getPlaying());
    EXPECT_TRUE(press(Event::KEY_F3));
    frame();
    EXPECT_TRUE(mouse(Event::PUSH, onTrack(0.2)));
    EXPECT_FALSE(_clock->getPlaying());
    EXPECT_TRUE(press(Event::KEY_F3));
    EXPECT_TRUE(_clock->getPlaying()) << "the hand has let go";
    EXPECT_TRUE(press('y')) << "keys work all the same";
    EXPECT_TRUE(press(Event::KEY_F3));
    frame();
    EXPECT_NE(viewer.getSlave(0)._camera->getNodeMask(), 0u);
    EXPECT_TRUE(click(onTrack(0.5)));
}
