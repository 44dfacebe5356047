// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Values below the pointer and the plot of a layer in time, with events made by hand, in a viewer that never draws.
#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/mapping/LayerWords.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/ProbePanel.h>
#include <osgGeoFX/viewer/detail/SeriesGraph.h>
#include <tools/NotifyWatch.h>
#include <tools/TempDir.h>
#include <tools/WindowEvents.h>

#include <osg/Geometry>
#include <osgText/Text>

#include <chrono>
#include <cmath>
#include <fstream>
#include <sstream>
#include <thread>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

osg::ref_ptr<osg::Image> numbers(float left, float right)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 1, 1, GL_RED, GL_FLOAT);
    reinterpret_cast<float*>(image->data())[0] = left;
    reinterpret_cast<float*>(image->data())[1] = right;
    return image;
}

/// White ground of 1280 x 720 m, a metre for each pixel, with a sequence on the lower half and a still layer on all of it.
class ProbePanelTest : public WindowEvents
{
protected:
    void SetUp() override
    {
        _scene->addChild(osg::createTexturedQuadGeometry({-640, -360, 0}, {1280, 0, 0}, {0, 720, 0}));
        _scene->addEffect(_mappings);
        osg::ref_ptr<DataLayer> still = new DataLayer(numbers(5.0f, 5.0f));
        still->setKind(DataLayer::VALUE);
        add(still, "depth", 0.0, 360.0);
        LayerWords::setUnit(*still, "m");
        std::vector<osg::ref_ptr<osg::Image>> steps;
        for (int i = 0; i < 5; ++i)
            steps.push_back(numbers(static_cast<float>(i * i), static_cast<float>(i * i) + 1.0f));
        // 6, 7, 8, 9 and 12 o'clock.
        const osg::ref_ptr<SequenceSteps> all =
            new ImageSteps(steps, {morning, morning + 3600, morning + 7200, morning + 10800, morning + 21600},
                           DataLayer::VALUE, true);
        _sequence = new LayerSequence(all);
        _sequence->setWaiting(true);
        LayerWords::setUnit(*_sequence->getLayer(), "mm");
        add(_sequence->getLayer(), "rain", -180.0, 180.0);
        LayerPlayer* const player = LayerPlayer::onto(*_scene);
        player->add(_sequence);
        _clock = player->getClock();
        _clock->setPlaying(false);
        _clock->setTime(morning + 5400.0);
        player->update(0.0);
        viewer.getCamera()->setViewMatrixAsLookAt({0, 0, 500}, {0, 0, 0}, {0, 1, 0});
        viewer.getCamera()->setProjectionMatrixAsOrtho(-640, 640, -360, 360, 1, 1000);
        viewer.setSceneData(_scene);
    }
    void add(DataLayer* layer, const std::string& name, double y, double halfHeight)
    {
        const osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
        mapping->setName(name);
        mapping->setLayer(layer);
        mapping->setRectangle({0.0, y}, 640.0, halfHeight);
        _mappings->addMapping(mapping);
    }
    void point(const osg::Vec2d& place)
    {
        EXPECT_FALSE(mouse(Event::MOVE, place));
        std::this_thread::sleep_for(std::chrono::milliseconds(70));
        frame();
    }
    /// All texts in the overlay.
    std::vector<std::string> texts()
    {
        std::vector<std::string> result;
        for (unsigned int g = 0; g < overlay().getNumChildren(); ++g)
        {
            osg::Group& group = *overlay().getChild(g)->asGroup();
            for (unsigned int i = 0; i < group.getNumChildren(); ++i)
                if (const auto* text = dynamic_cast<const osgText::Text*>(group.getChild(i)))
                    result.push_back(text->getText().createUTF8EncodedString());
        }
        return result;
    }
    SeriesGraph graph() { return {WIDTH, HEIGHT, _panel->series()->points(), *_clock, false}; }
    static osg::Vec2d middle(const PixelBox& box)
    {
        return {box.left + 0.5 * box.width, box.bottom + 0.5 * box.height};
    }

    osgGA::GUIEventHandler& handler() override { return *_panel; }

    static constexpr double morning = 1768197600.0; // 2026-01-12T06:00:00Z
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<ProjectiveMappings> _mappings = new ProjectiveMappings;
    osg::ref_ptr<LayerSequence> _sequence;
    osg::ref_ptr<LayerClock> _clock;
    osg::ref_ptr<ProbePanel> _panel = new ProbePanel(*_scene);
};

using Lines = std::vector<std::string>;

} // namespace

TEST_F(ProbePanelTest, ShowsTheValuesBelowThePointer)
{
    point({320.0, 180.0});
    EXPECT_TRUE(_panel->lines().empty());
    EXPECT_TRUE(press('v'));
    frame();
    // Half past seven, between 1 and 4.
    EXPECT_EQ(_panel->lines(), (Lines{"rain: 2.5 mm", "depth: 5 m"}));
    EXPECT_EQ(texts(), _panel->lines());
    point({960.0, 180.0});
    EXPECT_EQ(_panel->lines(), (Lines{"rain: 3.5 mm", "depth: 5 m"}));
    point({960.0, 600.0});
    EXPECT_EQ(_panel->lines(), (Lines{"depth: 5 m"}));
    // The pointer rests, and the time goes on.
    point({960.0, 180.0});
    _clock->setTime(morning + 7200.0);
    LayerPlayer::of(*_scene)->update(0.0);
    frame();
    EXPECT_EQ(_panel->lines()[0], "rain: 5 mm");
    // The pointer rests, and the camera does not.
    viewer.getCamera()->setViewMatrixAsLookAt({640, 0, 500}, {640, 0, 0}, {0, 1, 0});
    frame();
    EXPECT_TRUE(_panel->lines().empty()) << "beside the ground";
    EXPECT_EQ(overlay().getNodeMask(), 0u);
    EXPECT_TRUE(press('v'));
    EXPECT_FALSE(press('x'));
}

TEST_F(ProbePanelTest, TheBoxStaysInTheWindow)
{
    press('v');
    for (const osg::Vec2d& place : {osg::Vec2d(1.0, 1.0), osg::Vec2d(1279.0, 1.0), osg::Vec2d(1279.0, 340.0)})
    {
        point(place);
        ASSERT_FALSE(_panel->lines().empty());
        const osg::BoundingBox box = picture().getChild(0)->asGeometry()->getBoundingBox();
        EXPECT_GE(box.xMin(), 0.0f);
        EXPECT_GE(box.yMin(), 0.0f);
        EXPECT_LE(box.xMax(), 1280.0f);
        EXPECT_LE(box.yMax(), 720.0f);
        EXPECT_GT(box.xMax() - box.xMin(), 60.0f);
    }
}

TEST_F(ProbePanelTest, PlotsASeriesWithTheClocksTime)
{
    point({320.0, 180.0});
    EXPECT_TRUE(press('V'));
    ASSERT_TRUE(_panel->series());
    _panel->series()->wait();
    frame();
    EXPECT_EQ(_panel->plotLines(), (Lines{"rain (mm)", "2026-01-12 07:30 UTC: 2.5 mm"}));
    const SeriesGraph plot = graph();
    ASSERT_EQ(plot.curves.size(), 1u);
    ASSERT_EQ(plot.curves[0].lines.size(), 1u);
    const std::vector<osg::Vec2d>& line = plot.curves[0].lines[0];
    ASSERT_EQ(line.size(), 5u);
    EXPECT_NEAR(line[0].x(), plot.graph.left, 1e-6);
    EXPECT_NEAR(line[1].x(), plot.graph.left + plot.graph.width / 6.0, 1e-6) << "an hour of six";
    EXPECT_NEAR(line[4].x(), plot.graph.right(), 1e-6);
    // 0 to 16 with a twentieth more at both ends.
    EXPECT_NEAR(line[4].y(), plot.graph.bottom + plot.graph.height * 16.8 / 17.6, 1e-6);
    EXPECT_NEAR(line[2].y(), plot.graph.bottom + plot.graph.height * 4.8 / 17.6, 1e-6);
    const Lines all = texts();
    for (const char* word : {"rain (mm)", "08:00", "12:00", "10", "Save"})
        EXPECT_EQ(std::count(all.begin(), all.end(), word), 1) << word;
    // The clock's time is marked: a box of its own color at a quarter.
    const auto& shapes = *picture().getChild(0)->asGeometry();
    const auto& corners = static_cast<const osg::Vec3Array&>(*shapes.getVertexArray());
    const auto& colors = static_cast<const osg::Vec4Array&>(*shapes.getColorArray());
    osg::BoundingBox mark;
    for (std::size_t i = 0; i < corners.size(); ++i)
        if (colors[i] == osg::Vec4(0.45f, 0.68f, 0.95f, 1.0f)) mark.expandBy(corners[i]);
    EXPECT_NEAR(mark.center().x(), plot.graph.left + plot.graph.width / 4.0, 1.0);
    EXPECT_NEAR(mark.yMin(), plot.graph.bottom, 1.0);
    EXPECT_NEAR(mark.yMax(), plot.graph.top(), 1.0);
    // The hand has the time.
    EXPECT_TRUE(click(plot.placeOf(morning + 10800.0, 8.0)));
    EXPECT_NEAR(_clock->getTime(), morning + 10800.0, 60.0);
    frame();
    EXPECT_EQ(_panel->plotLines()[1], "2026-01-12 09:00 UTC: 9 mm");
    // Another place of the same layer, then where there is none.
    point({960.0, 340.0});
    EXPECT_TRUE(press('V'));
    _panel->series()->wait();
    EXPECT_EQ(*_panel->series()->points()[4].value, 17.0);
    point({960.0, 600.0});
    EXPECT_TRUE(press('V'));
    EXPECT_FALSE(_panel->series());
    frame();
    EXPECT_EQ(overlay().getNodeMask(), 0u);
    EXPECT_FALSE(click(middle(plot.close))) << "what is not shown takes no clicks";
}

TEST_F(ProbePanelTest, SavesATableAndCloses)
{
    const TempDir folder;
    _panel->setFolder(folder.path().string());
    point({320.0, 180.0});
    press('V');
    _panel->series()->wait();
    frame();
    const SeriesGraph plot = graph();
    for (const char* name : {"rain.csv", "rain-2.csv"})
    {
        EXPECT_TRUE(click(middle(plot.save)));
        const std::string file = (folder / name).string();
        EXPECT_EQ(_panel->plotLines()[1], "written: " + file);
        std::stringstream written;
        written << std::ifstream(file).rdbuf();
        EXPECT_EQ(written.str(), "time,rain (mm)\n2026-01-12T06:00:00Z,0\n2026-01-12T07:00:00Z,1\n"
                                 "2026-01-12T08:00:00Z,4\n2026-01-12T09:00:00Z,9\n2026-01-12T12:00:00Z,16\n");
    }
    _panel->setFolder((folder / "none").string());
    NotifyWatch watch;
    EXPECT_EQ(watch.messagesOf([&] { EXPECT_TRUE(click(middle(plot.save))); }).size(), 1u);
    EXPECT_NE(_panel->plotLines()[1].find("cannot be written"), std::string::npos);
    EXPECT_TRUE(click(middle(plot.close)));
    EXPECT_FALSE(_panel->series());
}

TEST(SeriesGraph, TicksAreRoundTimes)
{
    using Times = std::vector<double>;
    EXPECT_EQ(SeriesGraph::roundTimes(1768197600.0, 1768197600.0 + 86400.0, 6),
              (Times{1768197600.0, 1768219200.0, 1768240800.0, 1768262400.0, 1768284000.0}))
        << "every six hours";
    EXPECT_EQ(SeriesGraph::roundTimes(90.0, 1200.0, 4), (Times{300.0, 600.0, 900.0, 1200.0}))
        << "five minutes";
    EXPECT_EQ(SeriesGraph::roundTimes(0.0, 4.0, 5), (Times{0.0, 1.0, 2.0, 3.0, 4.0}));
    const Times years = SeriesGraph::roundTimes(0.0, 86400.0 * 3650.0, 5);
    ASSERT_GE(years.size(), 3u);
    EXPECT_LE(years.size(), 5u);
    EXPECT_EQ(std::fmod(years[1], 86400.0), 0.0);
}

TEST(SeriesGraph, GapsAndClassesAreDrawnAsTheyAre)
{
    const osg::ref_ptr<LayerClock> clock = new LayerClock;
    std::vector<LayerSeries::Point> points(5);
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = {10.0 * static_cast<double>(i), true, 2.0 * static_cast<double>(i), std::nullopt};
    points[2].value.reset();
    const SeriesGraph values(1280.0, 720.0, points, *clock, false);
    ASSERT_EQ(values.curves.size(), 1u);
    ASSERT_EQ(values.curves[0].lines.size(), 2u) << "nothing is drawn across a gap";
    EXPECT_EQ(values.curves[0].lines[0].size(), 2u);
    EXPECT_EQ(*values.valueAt(5.0), 1.0);
    EXPECT_EQ(*values.valueAt(14.0), 2.0) << "the nearer one, as the layer shows it";
    EXPECT_FALSE(values.valueAt(16.0));
    EXPECT_EQ(*values.valueAt(99.0), 8.0);
    const SeriesGraph classes(1280.0, 720.0, points, *clock, true);
    const std::vector<osg::Vec2d>& steps = classes.curves[0].lines[0];
    ASSERT_EQ(steps.size(), 4u);
    EXPECT_EQ(steps[1].x(), steps[2].x());
    EXPECT_NEAR(steps[1].x(), classes.placeOf(5.0, 0.0).x(), 1e-9);
    EXPECT_EQ(*classes.valueAt(4.0), 0.0);
    EXPECT_EQ(*classes.valueAt(6.0), 2.0);
    // Colors have three.
    for (LayerSeries::Point& point : points)
        point = {point.time, true, std::nullopt, osg::Vec4d(1.0, 0.5, 0.0, 1.0)};
    const SeriesGraph colors(1280.0, 720.0, points, *clock, false);
    ASSERT_EQ(colors.curves.size(), 3u);
    EXPECT_NEAR(colors.curves[0].lines[0][0].y(), colors.graph.top(), 1e-6);
    EXPECT_NEAR(colors.curves[2].lines[0][0].y(), colors.graph.bottom, 1e-6);
}
