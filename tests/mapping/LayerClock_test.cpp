// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The time of layers: it plays, pauses, turns round and begins again; dates as the calendar has them.
#include <osgGeoFX/mapping/LayerClock.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomSamples.h>

#include <osg/FrameStamp>
#include <osg/Group>
#include <osgUtil/UpdateVisitor>

#include <gtest/gtest.h>

#include <ctime>

using namespace osgGeoFX;
using geofx::test::Random;

namespace
{

osg::ref_ptr<LayerClock> clockOf(double begin, double end, double speed)
{
    osg::ref_ptr<LayerClock> clock = new LayerClock;
    EXPECT_TRUE(clock->setRange(begin, end));
    EXPECT_TRUE(clock->setTime(begin));
    EXPECT_TRUE(clock->setSpeed(speed));
    return clock;
}

double timeAt(LayerClock& clock, double program)
{
    clock.advance(program);
    return clock.getTime();
}

} // namespace

TEST(LayerClock, GoesOnWithTheProgramAndBeginsAgain)
{
    const osg::ref_ptr<LayerClock> clock = clockOf(100.0, 160.0, 10.0);
    EXPECT_EQ(clock->getTime(), 100.0);
    EXPECT_DOUBLE_EQ(timeAt(*clock, 0.0), 100.0);
    EXPECT_DOUBLE_EQ(timeAt(*clock, 2.5), 125.0);
    EXPECT_DOUBLE_EQ(timeAt(*clock, 6.0), 160.0) << "the end is shown";
    EXPECT_DOUBLE_EQ(timeAt(*clock, 6.5), 105.0);
    EXPECT_DOUBLE_EQ(timeAt(*clock, 19.0), 110.0) << "three times around";
}

TEST(LayerClock, StaysAtItsEndWithoutALoop)
{
    const osg::ref_ptr<LayerClock> clock = clockOf(0.0, 60.0, 10.0);
    clock->setLoop(false);
    EXPECT_DOUBLE_EQ(timeAt(*clock, 7.0), 60.0);
    clock->setSpeed(-10.0);
    EXPECT_DOUBLE_EQ(timeAt(*clock, 8.0), 50.0);
    EXPECT_DOUBLE_EQ(timeAt(*clock, 20.0), 0.0);
}

TEST(LayerClock, FramesOfAFilmHaveTheirTimesInAnyOrder)
{
    for (const double first : {0.0, 3.0})
    {
        const osg::ref_ptr<LayerClock> clock = clockOf(0.0, 100.0, 4.0);
        EXPECT_DOUBLE_EQ(timeAt(*clock, first), 4.0 * first);
        EXPECT_DOUBLE_EQ(timeAt(*clock, 5.0), 20.0);
        EXPECT_DOUBLE_EQ(timeAt(*clock, 1.0), 4.0);
    }
}

TEST(LayerClock, ChangesByHandCountFromNowOn)
{
    const osg::ref_ptr<LayerClock> clock = clockOf(0.0, 1000.0, 1.0);
    timeAt(*clock, 50.0);
    clock->setSpeed(10.0);
    EXPECT_DOUBLE_EQ(clock->getTime(), 50.0) << "no jump";
    EXPECT_DOUBLE_EQ(timeAt(*clock, 51.0), 60.0);
    clock->setPlaying(false);
    EXPECT_DOUBLE_EQ(timeAt(*clock, 70.0), 60.0);
    EXPECT_DOUBLE_EQ(timeAt(*clock, 90.0), 60.0);
    clock->setTime(500.0);
    EXPECT_DOUBLE_EQ(clock->getTime(), 500.0);
    EXPECT_DOUBLE_EQ(timeAt(*clock, 91.0), 500.0) << "still paused";
    clock->setPlaying(true);
    EXPECT_DOUBLE_EQ(timeAt(*clock, 93.0), 520.0) << "since the last frame";
    clock->setLoop(false);
    clock->setTime(5e6);
    EXPECT_DOUBLE_EQ(timeAt(*clock, 94.0), 1000.0) << "within the range";
}

TEST(LayerClock, RangesGrow)
{
    const osg::ref_ptr<LayerClock> clock = new LayerClock;
    clock->include(300.0, 400.0);
    EXPECT_EQ(clock->getBegin(), 300.0);
    EXPECT_EQ(clock->getTime(), 300.0);
    clock->include(200.0, 350.0);
    EXPECT_EQ(clock->getBegin(), 200.0);
    EXPECT_EQ(clock->getEnd(), 400.0);
    EXPECT_EQ(clock->getTime(), 200.0) << "it was at the begin";
    clock->setTime(310.0);
    clock->include(0.0, 500.0);
    EXPECT_EQ(clock->getTime(), 310.0);
    geofx::test::NotifyWatch watch;
    EXPECT_FALSE(watch.messagesOf([&] { EXPECT_FALSE(clock->setRange(2.0, 1.0)); }).empty());
    EXPECT_EQ(clock->getEnd(), 500.0);
}

TEST(LayerClock, TextsAreDatesOfTheCalendar)
{
    const osg::ref_ptr<LayerClock> clock = new LayerClock;
    EXPECT_EQ(clock->text(90.5), "90.5 s");
    EXPECT_EQ(clock->text(37230.0), "10:20:30");
    EXPECT_EQ(clock->text(HUGE_VAL), "inf s");
    EXPECT_EQ(clock->text(-1e300), "-1e+300 s");
    clock->setDated(true);
    Random random(7);
    for (int i = 0; i < 2000; ++i)
    {
        const auto seconds = static_cast<std::time_t>(60.0 * std::floor(random.uniform(-1e8, 1e8)));
        std::tm date{};
        gmtime_r(&seconds, &date);
        char text[64];
        std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &date);
        ASSERT_EQ(clock->text(static_cast<double>(seconds)), text);
        const std::optional<double> read = LayerClock::parseDate(text);
        ASSERT_TRUE(read) << text;
        ASSERT_EQ(*read, static_cast<double>(seconds)) << text;
    }
    EXPECT_EQ(LayerClock::parseDate("1970-01-02").value_or(-1.0), 86400.0);
    EXPECT_EQ(LayerClock::parseDate("1970-01-01T00:00:01.5Z").value_or(-1.0), 1.5);
    EXPECT_EQ(LayerClock::parseDate("1970-1-2 6:5").value_or(-1.0), 86400.0 + 6 * 3600.0 + 300.0);
    for (const char* zone : {"+10:00", " +10:00", "+1000", " +10"})
        EXPECT_EQ(LayerClock::parseDate("1970-01-02 06:00" + std::string(zone)).value_or(-1.0),
                  86400.0 - 4 * 3600.0)
            << zone;
    for (const char* wrong :
         {"", "1970", "1970-13-01", "1970-01-01T", "1970-01-01 25:00", "1970-01-01 10:00 CET", "1970-02-31",
          "1970-01-01 24:30", "1970-01-01 06::", "1970-01-01 06:00 +10:00 or so", "1970-01-01 06:00 +"})
        EXPECT_FALSE(LayerClock::parseDate(wrong)) << wrong;
}

TEST(LayerPlayer, DrivesWhatFollowsItInTheUpdateTraversal)
{
    const osg::ref_ptr<LayerClock> clock = clockOf(0.0, 100.0, 2.0);
    const osg::ref_ptr<LayerPlayer> player = new LayerPlayer(clock);
    std::vector<double> times;
    player->add([&](double time) { times.push_back(time); });
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addUpdateCallback(player);
    EXPECT_EQ(LayerPlayer::of(*scene), player);
    const osg::ref_ptr<osg::Group> other = new osg::Group;
    EXPECT_EQ(LayerPlayer::of(*other), nullptr);
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(stamp);
    for (const double time : {0.0, 1.5, 4.0})
    {
        stamp->setSimulationTime(time);
        scene->accept(visitor);
    }
    EXPECT_EQ(times, (std::vector<double>{0.0, 3.0, 8.0}));
}
