// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The panel of the bending curve, with events made by hand, in a viewer that never draws: what lies where, and what hands make of it.
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/CurvePanel.h>
#include <osgGeoFX/viewer/detail/CurveGraph.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomViews.h>
#include <tools/WindowEvents.h>

#include <osg/Geometry>
#include <osgText/Text>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;
using Points = std::vector<osg::Vec2d>;

namespace
{

class CurvePanelTest : public WindowEvents
{
protected:
    void SetUp() override { viewer.setSceneData(_scene); }

    void drag(const osg::Vec2d& from, const osg::Vec2d& to)
    {
        EXPECT_TRUE(mouse(Event::PUSH, from));
        EXPECT_TRUE(mouse(Event::DRAG, (from + to) * 0.5));
        EXPECT_TRUE(mouse(Event::DRAG, to));
        EXPECT_TRUE(mouse(Event::RELEASE, to));
    }

    /// Where the panel shows a height of the picture, measured from what it draws, not from what it says.
    osg::Vec2d placeOf(double distance, double height) const
    {
        return _graph.placeOf(distance, height * _map->getHorizonLine());
    }
    void show()
    {
        _scene->addEffect(_map);
        ASSERT_TRUE(press(Event::KEY_F4));
        frame();
    }

    std::vector<const osgText::Text*> texts()
    {
        std::vector<const osgText::Text*> result;
        for (unsigned int i = 0; i < picture().getNumChildren(); ++i)
            if (const auto* text = dynamic_cast<const osgText::Text*>(picture().getChild(i)))
                result.push_back(text);
        return result;
    }

    osgGA::GUIEventHandler& handler() override { return *_panel; }

    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<PanoramaMap> _map = new PanoramaMap;
    osg::ref_ptr<CurvePanel> _panel = new CurvePanel(*_scene);
    CurveGraph _graph{WIDTH, HEIGHT};
};

} // namespace

TEST_F(CurvePanelTest, SaysWhereThereIsNoMap)
{
    EXPECT_FALSE(mouse(Event::PUSH, {1200.0, 50.0})) << "hidden, it takes nothing";
    EXPECT_FALSE(press(Event::KEY_Delete));
    frame();
    EXPECT_EQ(viewer.getNumSlaves(), 0u);
    EXPECT_TRUE(press(Event::KEY_F4));
    frame();
    EXPECT_EQ(_panel->map(), nullptr);
    const std::vector<std::string> sentence = {"Bending curve", "No panorama map is shown; F11 makes one."};
    EXPECT_EQ(_panel->lines(), sentence);
    EXPECT_EQ(texts().size(), 2u);
    EXPECT_TRUE(click({_graph.panel.left + 50.0, _graph.panel.bottom + 50.0})) << "nothing behind it";
    EXPECT_FALSE(press(Event::KEY_Delete));
    // A map that is off, and one that only paints, are none; the next one counts.
    _map->setEnabled(false);
    _scene->addEffect(_map);
    EXPECT_EQ(_panel->lines(), sentence);
    _map->setEnabled(true);
    EXPECT_EQ(_panel->map(), _map);
    _map->setProjection(false);
    EXPECT_EQ(_panel->map(), nullptr);
    const osg::ref_ptr<PanoramaMap> other = new PanoramaMap;
    _scene->addEffect(other);
    EXPECT_EQ(_panel->map(), other);
    EXPECT_TRUE(press(Event::KEY_F4));
    EXPECT_FALSE(_panel->shown());
    EXPECT_TRUE(_panel->lines().empty());
    EXPECT_EQ(overlay().getNodeMask(), 0u);
}

TEST_F(CurvePanelTest, ShowsTheCurveWhereTheMapHasIt)
{
    for (int sample = 0; sample < 50; ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        _map->setHorizonLine(random.uniform(0.2, 1.0));
        _map->setCurvePoints(random.integer(0, 2) ? randomCurve(random) : Points());
        const CurveState state = CurveState::of(*_map);
        EXPECT_NEAR(state.heightAt(0.0), 0.0, 1e-12);
        EXPECT_NEAR(state.heightAt(1.0), 1.0, 1e-12);
        // Within what straight pieces lose.
        const double distance = random.uniform(0.0, 1.0);
        EXPECT_NEAR(state.heightAt(distance), _map->curveHeight(distance), 0.02);
        for (const osg::Vec2d& point : state.points)
        {
            EXPECT_NEAR(_map->curveHeight(point.x()), point.y(), 1e-12);
            const auto handle = _graph.handleAt(placeOf(point.x(), point.y()), state);
            ASSERT_TRUE(handle);
            EXPECT_EQ(handle->kind, CurveGraph::Handle::POINT);
        }
    }
    // The paper's: straight to D1, which a quarter of the way here; from there a parabola.
    _map->setCurvePoints({});
    _map->setHorizonDistance(4.0);
    _map->setCurveDistance(1.0);
    EXPECT_NEAR(_map->curveHeight(0.25), 0.25 * 2.0 / 1.25, 1e-12);
    EXPECT_NEAR(_map->curveHeight(0.125), 0.125 * 2.0 / 1.25, 1e-12);
}

TEST_F(CurvePanelTest, AClickOnTheCurveMakesAPointThatCanBeDragged)
{
    show();
    const double before = _map->curveHeight(0.5);
    EXPECT_TRUE(mouse(Event::PUSH, placeOf(0.5, before)));
    ASSERT_EQ(_map->getCurvePoints().size(), 1u);
    EXPECT_NEAR(_map->getCurvePoints()[0].x(), 0.5, 1e-6);
    EXPECT_NEAR(_map->getCurvePoints()[0].y(), before, 0.01) << "the curve stays where it is";
    // It is held already, and the map follows at once.
    EXPECT_TRUE(mouse(Event::DRAG, placeOf(0.4, 0.35)));
    EXPECT_NEAR(_map->getCurvePoints()[0].x(), 0.4, 1e-6);
    EXPECT_NEAR(_map->getCurvePoints()[0].y(), 0.35, 1e-6);
    EXPECT_TRUE(mouse(Event::RELEASE, placeOf(0.4, 0.35)));
    EXPECT_FALSE(mouse(Event::DRAG, placeOf(0.6, 0.6))) << "no longer held";
    EXPECT_EQ(_panel->lines()[0], "Bending curve\t1 of 6 points");
    EXPECT_EQ(_panel->lines()[1], "point 1: 40 % of the way, 35 % of the horizon's height");

    drag(placeOf(0.4, 0.35), placeOf(0.45, 0.3));
    EXPECT_NEAR(_map->getCurvePoints()[0].x(), 0.45, 1e-6);
    // Beside the curve there is nothing to take hold of, and nothing for the camera.
    EXPECT_TRUE(click(placeOf(0.2, 0.9)));
    EXPECT_EQ(_map->getCurvePoints().size(), 1u);
    EXPECT_FALSE(click({100.0, 500.0})) << "the camera's";
}

TEST_F(CurvePanelTest, PointsStayInOrderWhereverHandsGo)
{
    show();
    NotifyWatch watch;
    for (int sample = 0; sample < sampleCount() / 20; ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        SCOPED_TRACE(sample);
        ASSERT_TRUE(_map->setCurvePoints(randomCurve(random)));
        const Points points = _map->getCurvePoints();
        const auto which = static_cast<std::size_t>(random.integer(0, static_cast<int>(points.size()) - 1));
        const osg::Vec2d to(random.uniform(-100.0, 1400.0), random.uniform(-100.0, 800.0));
        // Nothing is refused, so nothing is said.
        EXPECT_TRUE(
            watch.messagesOf([&] { drag(placeOf(points[which].x(), points[which].y()), to); }).empty());
        const Points now = _map->getCurvePoints();
        ASSERT_EQ(now.size(), points.size());
        osg::Vec2d last;
        for (const osg::Vec2d& point : now)
        {
            EXPECT_GE(point.x(), last.x() + 0.001);
            EXPECT_GE(point.y(), last.y());
            last = point;
        }
        EXPECT_LE(last.x(), 0.999);
        EXPECT_LE(last.y(), 1.0);
        int moved = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            moved += now[i] != points[i] ? 1 : 0;
        EXPECT_LE(moved, 1) << "only what is held moves";
    }
    // As far as the neighbours let it.
    ASSERT_TRUE(_map->setCurvePoints({{0.3, 0.4}, {0.5, 0.6}, {0.7, 0.8}}));
    drag(placeOf(0.5, 0.6), placeOf(0.9, 0.1));
    EXPECT_NEAR(_map->getCurvePoints()[1].x(), 0.69, 1e-9);
    EXPECT_NEAR(_map->getCurvePoints()[1].y(), 0.4, 1e-9);
}

TEST_F(CurvePanelTest, RemovesPoints)
{
    show();
    const Points three = {{0.3, 0.4}, {0.5, 0.6}, {0.7, 0.8}};
    ASSERT_TRUE(_map->setCurvePoints(three));
    EXPECT_TRUE(click(placeOf(0.5, 0.6), Event::RIGHT_MOUSE_BUTTON));
    EXPECT_EQ(_map->getCurvePoints(), (Points{three[0], three[2]}));
    EXPECT_FALSE(press(Event::KEY_Delete)) << "none is selected";
    EXPECT_TRUE(click(placeOf(0.7, 0.8)));
    EXPECT_EQ(_map->getCurvePoints(), (Points{three[0], three[2]})) << "a click alone moves nothing";
    EXPECT_TRUE(press(Event::KEY_Delete));
    EXPECT_EQ(_map->getCurvePoints(), Points{three[0]});
    EXPECT_TRUE(click(placeOf(0.5, _map->curveHeight(0.5)), Event::RIGHT_MOUSE_BUTTON)) << "only the curve";
    EXPECT_EQ(_map->getCurvePoints(), Points{three[0]});
    // Reset takes all of them, and the horizon's own exaggeration.
    ASSERT_TRUE(_map->setHorizonExaggeration(4.0));
    ASSERT_TRUE(_map->setExaggeration(3.0));
    EXPECT_TRUE(click({_graph.reset.left + 5.0, _graph.reset.bottom + 5.0}));
    EXPECT_TRUE(_map->getCurvePoints().empty());
    EXPECT_EQ(_map->getHorizonExaggeration(), -1.0);
    EXPECT_EQ(_map->getExaggeration(), 3.0);
}

TEST_F(CurvePanelTest, HasRoomForSixPoints)
{
    show();
    for (int i = 1; i <= 7; ++i)
    {
        const double distance = i / 8.0;
        EXPECT_TRUE(click(placeOf(distance, _map->curveHeight(distance))));
        EXPECT_EQ(_map->getCurvePoints().size(), static_cast<std::size_t>(std::min(i, 6)));
    }
    EXPECT_EQ(_panel->lines()[0], "Bending curve\t6 of 6 points");
}

TEST_F(CurvePanelTest, DragsTheExaggerations)
{
    show();
    EXPECT_EQ(_panel->lines()[3], "at the horizon\tas at the base");
    const auto at = [](const CurveGraph::Box& scale, double share)
    {
        return osg::Vec2d(scale.left + share * scale.width, scale.bottom + 0.5 * scale.height);
    };
    drag(at(_graph.nearScale, 0.3), at(_graph.nearScale, 0.5));
    EXPECT_NEAR(_map->getExaggeration(), 20.0 * 0.25, 0.011);
    EXPECT_EQ(_map->getHorizonExaggeration(), -1.0);
    drag(at(_graph.farScale, 0.5), at(_graph.farScale, 0.2));
    EXPECT_NEAR(_map->getHorizonExaggeration(), 20.0 * 0.04, 0.011);
    EXPECT_EQ(_panel->lines()[3], "at the horizon\t× 0.80");
    drag(at(_graph.farScale, 0.2), at(_graph.farScale, 7.0));
    EXPECT_EQ(_map->getHorizonExaggeration(), 20.0) << "to the end, however far the hand goes";
    drag(at(_graph.nearScale, 0.5), {0.0, 700.0});
    EXPECT_EQ(_map->getExaggeration(), 0.0);
    EXPECT_TRUE(click(at(_graph.farScale, 0.4), Event::RIGHT_MOUSE_BUTTON));
    EXPECT_EQ(_map->getHorizonExaggeration(), -1.0);
    // The handle stands where the value is.
    for (const double value : {0.0, 0.5, 2.0, 20.0})
    {
        CurveState state = CurveState::of(*_map);
        _graph.drag({CurveGraph::Handle::NEAR_SCALE}, _graph.placeOf(_graph.nearScale, value), state);
        EXPECT_NEAR(state.exaggeration, value, 0.006);
    }
}

TEST_F(CurvePanelTest, DrawsInsideItsBoxAndOnlyWhatIsNew)
{
    show();
    ASSERT_TRUE(_map->setCurvePoints({{0.3, 0.4}, {0.5, 0.6}}));
    frame();
    const osg::Group* before = &picture();
    frame();
    EXPECT_EQ(&picture(), before) << "nothing has changed";
    _map->setSeason(0.1);
    frame();
    EXPECT_EQ(&picture(), before) << "nothing that it shows";
    _map->setHorizonLine(0.7);
    frame();
    EXPECT_NE(&picture(), before);
    for (const auto& [width, height] : {std::pair(1280, 720), {640, 480}, {1920, 1080}, {3840, 2160}})
    {
        viewer.getCamera()->setViewport(10, 20, width, height);
        frame();
        const CurveGraph graph(width, height);
        EXPECT_GE(graph.panel.left, 0.0);
        EXPECT_LT(graph.panel.bottom + graph.panel.height, height);
        std::vector<osg::BoundingBox> boxes;
        for (const osgText::Text* text : texts())
        {
            const osg::BoundingBox& bound = text->getBoundingBox();
            const std::string words = text->getText().createUTF8EncodedString();
            EXPECT_GE(static_cast<double>(bound.xMin()), graph.panel.left) << words;
            EXPECT_LE(static_cast<double>(bound.xMax()), graph.panel.left + graph.panel.width) << words;
            EXPECT_GE(static_cast<double>(bound.yMin()), graph.panel.bottom) << words;
            EXPECT_LE(static_cast<double>(bound.yMax()), graph.panel.bottom + graph.panel.height) << words;
            for (const osg::BoundingBox& other : boxes)
                EXPECT_TRUE(bound.xMax() <= other.xMin() || other.xMax() <= bound.xMin() ||
                            bound.yMax() <= other.yMin() || other.yMax() <= bound.yMin())
                    << words << " lies on another text";
            boxes.push_back(bound);
        }
        EXPECT_EQ(boxes.size(), 12u);
        const osg::BoundingBox& shapes = picture().getChild(0)->asDrawable()->getBoundingBox();
        EXPECT_NEAR(static_cast<double>(shapes.xMax()), graph.panel.left + graph.panel.width, 1.0);
        EXPECT_NEAR(static_cast<double>(shapes.yMin()), graph.panel.bottom, 1.0);
    }
}
