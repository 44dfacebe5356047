// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The list of mappings, with events made by hand, in a viewer that never draws.
#include <osgGeoFX/mapping/RouteMapping.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/MappingPanel.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osg/Geode>
#include <osg/Geometry>
#include <osgText/Text>
#include <osgViewer/Viewer>

#include <chrono>
#include <cmath>

using namespace osgGeoFX;
using Event = osgGA::GUIEventAdapter;
using Lines = std::vector<std::string>;

namespace
{

/// Flat ground of 2 × 2 km seen from above, 1 m to a pixel.
class MappingPanelTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        osg::ref_ptr<osg::Geode> ground = new osg::Geode;
        ground->addDrawable(osg::createTexturedQuadGeometry({-1000, -1000, 0}, {2000, 0, 0}, {0, 2000, 0}));
        _scene->addChild(ground);
        _viewer.setSceneData(_scene);
        osg::Camera& camera = *_viewer.getCamera();
        camera.setViewport(0, 0, 1280, 720);
        camera.setViewMatrixAsLookAt({0, 0, 500}, {0, 0, 0}, {0, 1, 0});
        camera.setProjectionMatrixAsOrtho(-640, 640, -360, 360, 1, 1000);
    }

    ProjectiveMapping& add(const std::string& name, int order = 0)
    {
        osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
        mapping->setName(name);
        mapping->setOrder(order);
        _mappings->addMapping(mapping);
        return *mapping;
    }

    /// `a`, `b` and `c` from below, shown, with the topmost selected.
    void showThree()
    {
        _scene->addEffect(_mappings);
        for (const char* name : {"a", "b", "c"})
            add(name);
        ASSERT_TRUE(press(Event::KEY_F9));
    }

    bool send(Event::EventType type, const std::function<void(Event&)>& fill)
    {
        osg::ref_ptr<Event> event = new Event;
        event->setEventType(type);
        fill(*event);
        return _panel->handle(*event, _viewer);
    }

    bool press(int key, int times = 1)
    {
        bool handled = true;
        for (int i = 0; i < times; ++i)
            handled = send(Event::KEYDOWN, [&](Event& event) { event.setKey(key); }) && handled;
        return handled;
    }

    void frame()
    {
        EXPECT_FALSE(send(Event::FRAME, [](Event&) {}));
    }

    bool mouse(Event::EventType type, double x, double y, int modifiers = 0)
    {
        return send(type,
                    [&](Event& event)
                    {
                        event.setX(static_cast<float>(x));
                        event.setY(static_cast<float>(y));
                        event.setButton(Event::LEFT_MOUSE_BUTTON);
                        event.setModKeyMask(modifiers);
                        event.setScrollingMotion(Event::SCROLL_DOWN);
                    });
    }

    bool click(double x, double y, int modifiers = 0)
    {
        const bool handled = mouse(Event::PUSH, x, y, modifiers);
        EXPECT_EQ(mouse(Event::DRAG, x, y + 1.0, modifiers), handled) << "all of a click, or nothing";
        EXPECT_EQ(mouse(Event::RELEASE, x, y, modifiers), handled);
        EXPECT_FALSE(mouse(Event::DRAG, x, y, modifiers));
        return handled;
    }

    /// A text of the picture; null where it does not show.
    const osgText::Text* drawn(const std::string& words)
    {
        for (const osgText::Text* text : texts())
        {
            if (text->getText().createUTF8EncodedString() == words) return text;
        }
        return nullptr;
    }

    std::vector<const osgText::Text*> texts()
    {
        std::vector<const osgText::Text*> found;
        for (unsigned int i = 0; i < picture().getNumChildren(); ++i)
        {
            if (const auto* text = dynamic_cast<const osgText::Text*>(picture().getChild(i)))
                found.push_back(text);
        }
        return found;
    }

    const osg::Camera& overlay() { return *_viewer.getSlave(0)._camera; }
    const osg::Group& picture() { return *overlay().getChild(0)->asGroup(); }
    /// The dark ground of the list.
    osg::BoundingBox ground() const
    {
        const auto& slave = *const_cast<osgViewer::Viewer&>(_viewer).getSlave(0)._camera;
        const auto& corners = static_cast<const osg::Vec3Array&>(
            *slave.getChild(0)->asGroup()->getChild(0)->asGeometry()->getVertexArray());
        return {corners[0], corners[2]};
    }

    std::string selected() { return _panel->selected() ? _panel->selected()->getName() : ""; }

    osg::ref_ptr<ProjectiveMappings> _mappings = new ProjectiveMappings;
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<MappingPanel> _panel = new MappingPanel(*_scene);
    osgViewer::Viewer _viewer;
};

Lines linesOf(std::initializer_list<const char*> names)
{
    Lines lines = {"1 of " + std::to_string(names.size())};
    for (const char* name : names)
        lines.push_back("on\t" + std::string(name) + "\t0\t100 %\tnormal");
    return lines;
}

} // namespace

TEST_F(MappingPanelTest, DoesNothingWithoutAnEffect)
{
    EXPECT_FALSE(_panel->hasEffect());
    EXPECT_FALSE(press(Event::KEY_F9));
    EXPECT_FALSE(press(Event::KEY_Down));
    EXPECT_FALSE(click(1200, 700));
    frame();
    EXPECT_FALSE(_panel->shown());
    EXPECT_TRUE(_panel->lines().empty());
    EXPECT_EQ(_viewer.getNumSlaves(), 0u);

    _scene->addEffect(_mappings);
    EXPECT_TRUE(_panel->hasEffect());
    EXPECT_TRUE(press(Event::KEY_F9));
    EXPECT_EQ(_panel->lines(), Lines{"0 of 0"});
    for (const int key : {Event::KEY_Up, Event::KEY_Page_Down, Event::KEY_End})
        EXPECT_TRUE(press(key));
    EXPECT_FALSE(press(Event::KEY_Return)) << "there is nothing to switch";
    frame();
    EXPECT_EQ(_panel->selected(), nullptr);
    _scene->removeEffect(_mappings);
    frame();
    EXPECT_FALSE(_panel->shown());
    EXPECT_EQ(overlay().getNodeMask(), 0u);
}

TEST_F(MappingPanelTest, KeysAreOthersWhileItIsHidden)
{
    _scene->addEffect(_mappings);
    ProjectiveMapping& mapping = add("a");
    const unsigned int revision = mapping.revision();
    for (const int key :
         {int(Event::KEY_Up), int(Event::KEY_Return), int('+'), int(','), int(Event::KEY_Left)})
        EXPECT_FALSE(press(key)) << key;
    EXPECT_EQ(mapping.revision(), revision);
    EXPECT_TRUE(press(Event::KEY_F9));
    EXPECT_EQ(selected(), "a");
    EXPECT_FALSE(press(' ')) << "home of the camera manipulators";
    EXPECT_FALSE(press('s'));
    EXPECT_TRUE(press(Event::KEY_F9));
    EXPECT_EQ(selected(), "");
    EXPECT_FALSE(press(Event::KEY_Return));
    EXPECT_TRUE(mapping.getEnabled());
}

TEST_F(MappingPanelTest, ListsTheTopmostFirst)
{
    showThree();
    EXPECT_EQ(_panel->lines(), linesOf({"c", "b", "a"}));
    _mappings->getMapping(0)->setOrder(2);
    _mappings->getMapping(2)->setOrder(-7);
    frame();
    EXPECT_EQ(_panel->lines(), (Lines{"3 of 3", "on\ta\t2\t100 %\tnormal", "on\tb\t0\t100 %\tnormal",
                                      "on\tc\t-7\t100 %\tnormal"}))
        << "c stays selected";
    // Of two effects the later one colors over the other.
    osg::ref_ptr<ProjectiveMappings> later = new ProjectiveMappings;
    later->addMapping(new ProjectiveMapping);
    later->getMapping(0)->setOrder(-1000);
    _scene->addEffect(later);
    frame();
    EXPECT_EQ(_panel->lines()[0], "4 of 4");
    EXPECT_EQ(_panel->lines()[1], "on\tmapping 1\t-1000\t100 %\tnormal");
}

TEST_F(MappingPanelTest, CallsMappingsByWhatTheyShow)
{
    _scene->addEffect(_mappings);
    ProjectiveMapping& mapping = add("");
    const auto name = [&]
    {
        frame();
        return _panel->lines()[1];
    };
    press(Event::KEY_F9);
    EXPECT_EQ(name(), "on\tmapping 1\t0\t100 %\tnormal");
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->setFileName("/data/rasters/noise.tif");
    mapping.setLayer(new DataLayer(image));
    EXPECT_EQ(name(), "on\tnoise.tif\t0\t100 %\tnormal");
    mapping.getLayer()->setName("noise at night");
    EXPECT_EQ(name(), "on\tnoise at night\t0\t100 %\tnormal");
    mapping.setName("L\u00e4rm");
    EXPECT_EQ(name(), "on\tL\u00e4rm\t0\t100 %\tnormal");
}

TEST_F(MappingPanelTest, KeysChangeTheSelectedMapping)
{
    showThree();
    geofx::test::NotifyWatch watch;
    EXPECT_TRUE(press(Event::KEY_Down));
    ProjectiveMapping& b = *_mappings->getMapping(1);
    ASSERT_EQ(_panel->selected(), &b);
    EXPECT_TRUE(press(Event::KEY_Return));
    EXPECT_FALSE(b.getEnabled());
    EXPECT_TRUE(press(Event::KEY_Left, 3));
    EXPECT_NEAR(b.getOpacity(), 0.85, 1e-12);
    EXPECT_EQ(_panel->lines()[2], "off\tb\t0\t85 %\tnormal");
    EXPECT_TRUE(press(Event::KEY_Left, 30));
    EXPECT_EQ(b.getOpacity(), 0.0);
    EXPECT_TRUE(press(Event::KEY_Right, 2));
    EXPECT_NEAR(b.getOpacity(), 0.1, 1e-12);
    EXPECT_TRUE(press(Event::KEY_Right, 30));
    EXPECT_EQ(b.getOpacity(), 1.0);
    EXPECT_TRUE(press('+'));
    EXPECT_EQ(b.getOrder(), 1);
    EXPECT_EQ(_panel->selected(), &b);
    EXPECT_EQ(_panel->lines()[1], "off\tb\t1\t100 %\tnormal") << "it is the topmost now";
    EXPECT_EQ(_panel->lines()[0], "1 of 3");
    EXPECT_TRUE(press('-', 2));
    EXPECT_EQ(_panel->lines()[0], "3 of 3");
    EXPECT_EQ(_panel->lines()[3], "off\tb\t-1\t100 %\tnormal");
    EXPECT_TRUE(press(Event::KEY_Return));
    EXPECT_TRUE(b.getEnabled());
    // To the ends, where setters would refuse more.
    EXPECT_TRUE(watch.messagesOf([&] { press('-', 1100); }).empty());
    EXPECT_EQ(b.getOrder(), -1000);
    EXPECT_TRUE(_mappings->getMapping(0)->getEnabled());
    EXPECT_EQ(_mappings->getMapping(0)->getOpacity(), 1.0);
    EXPECT_EQ(_mappings->getMapping(2)->getOrder(), 0);
}

TEST_F(MappingPanelTest, TurnsThroughTheBlendings)
{
    _scene->addEffect(_mappings);
    ColorTransfer& transfer = *add("a").getTransfer();
    press(Event::KEY_F9);
    const auto blending = [&]
    {
        const std::string line = _panel->lines()[1];
        return line.substr(line.rfind('\t') + 1);
    };
    const Lines names = {"normal", "multiply", "screen", "overlay", "add", "replace", "minimum", "maximum"};
    for (const std::string& name : names)
    {
        EXPECT_EQ(blending(), name);
        EXPECT_TRUE(press('.'));
    }
    EXPECT_EQ(blending(), "normal") << "once round";
    EXPECT_EQ(transfer.getEquation(), ColorTransfer::ADD);
    EXPECT_EQ(transfer.getSourceFactor(), ColorTransfer::SOURCE_ALPHA);
    EXPECT_EQ(transfer.getDestinationFactor(), ColorTransfer::ONE_MINUS_SOURCE_ALPHA);
    for (auto name = names.rbegin(); name != names.rend(); ++name)
    {
        EXPECT_TRUE(press(','));
        EXPECT_EQ(blending(), *name);
    }
    transfer.setBlendFunction(ColorTransfer::DESTINATION_COLOR, ColorTransfer::ZERO);
    EXPECT_EQ(blending(), "custom");
    transfer.setEquation(ColorTransfer::SCREEN);
    EXPECT_EQ(blending(), "screen") << "which uses no factors";
    transfer.setEquation(ColorTransfer::SUBTRACT);
    EXPECT_EQ(blending(), "custom");
    press('.');
    EXPECT_EQ(blending(), "normal");
    transfer.setEquation(ColorTransfer::DISCARD);
    press(',');
    EXPECT_EQ(blending(), "maximum");
}

TEST_F(MappingPanelTest, ScrollsThroughTenThousand)
{
    _scene->addEffect(_mappings);
    constexpr int count = 10000;
    for (int i = 0; i < count; ++i)
        add("raster " + std::to_string(i));
    press(Event::KEY_F9);
    EXPECT_EQ(_panel->lines().size(), 13u);
    EXPECT_EQ(_panel->lines()[0], "1 of 10000");
    EXPECT_EQ(_panel->lines()[12], "on\traster 9988\t0\t100 %\tnormal");
    press(Event::KEY_Down, 11);
    EXPECT_EQ(_panel->lines()[1], "on\traster 9999\t0\t100 %\tnormal") << "the selection moves in the window";
    press(Event::KEY_Down);
    EXPECT_EQ(_panel->lines()[1], "on\traster 9998\t0\t100 %\tnormal") << "and then with it";
    press(Event::KEY_Page_Down);
    EXPECT_EQ(_panel->lines()[0], "25 of 10000");
    press(Event::KEY_End);
    EXPECT_EQ(_panel->lines()[0], "10000 of 10000");
    EXPECT_EQ(_panel->lines()[12], "on\traster 0\t0\t100 %\tnormal");
    press(Event::KEY_Down);
    EXPECT_EQ(selected(), "raster 0");
    press(Event::KEY_Page_Up, 2);
    EXPECT_EQ(selected(), "raster 24");
    press(Event::KEY_Home);
    EXPECT_EQ(_panel->lines()[0], "1 of 10000");

    // A place in the list as random as can be, always in sight and always the mapping of that place.
    geofx::test::Random random(7);
    std::size_t row = 0;
    for (int i = 0; i < 2000; ++i)
    {
        const int keys[] = {Event::KEY_Up, Event::KEY_Down, Event::KEY_Page_Up, Event::KEY_Page_Down};
        const int steps[] = {-1, 1, -12, 12};
        const int which = random.integer(0, 3);
        press(keys[which]);
        row = static_cast<std::size_t>(std::clamp(static_cast<int>(row) + steps[which], 0, count - 1));
        const std::string name = "raster " + std::to_string(count - 1 - static_cast<int>(row));
        ASSERT_EQ(selected(), name);
        const Lines lines = _panel->lines();
        ASSERT_EQ(lines[0], std::to_string(row + 1) + " of 10000");
        ASSERT_EQ(std::count(lines.begin(), lines.end(), "on\t" + name + "\t0\t100 %\tnormal"), 1);
    }

    // From the bottom to the top, and the list goes with it.
    press(Event::KEY_End);
    press('+');
    EXPECT_EQ(_panel->lines()[0], "1 of 10000");
    EXPECT_EQ(_panel->lines()[1], "on\traster 0\t1\t100 %\tnormal");

    // What others change is found within a few frames, which cost next to nothing.
    _mappings->getMapping(5000)->setOrder(3);
    frame();
    frame();
    frame();
    EXPECT_EQ(_panel->lines()[1], "on\traster 5000\t3\t100 %\tnormal");
    EXPECT_EQ(selected(), "raster 0");
}

TEST_F(MappingPanelTest, SelectionOutlivesRemovals)
{
    showThree();
    press(Event::KEY_Down);
    EXPECT_EQ(selected(), "b");
    _mappings->removeMapping(_mappings->getMapping(2));
    frame();
    EXPECT_EQ(_panel->lines()[0], "1 of 2");
    EXPECT_EQ(selected(), "b");
    // At once, without a frame between.
    _mappings->removeMapping(_mappings->getMapping(1));
    EXPECT_TRUE(press(Event::KEY_Return));
    EXPECT_EQ(selected(), "a") << "it has taken b's place";
    EXPECT_FALSE(_mappings->getMapping(0)->getEnabled());
    _mappings->removeMappings();
    EXPECT_FALSE(press(Event::KEY_Return));
    EXPECT_EQ(_panel->selected(), nullptr);
    EXPECT_EQ(_panel->lines(), Lines{"0 of 0"});
    add("d");
    frame();
    EXPECT_EQ(selected(), "d");

    for (int i = 0; i < 100; ++i)
        add(std::to_string(i));
    frame();
    press(Event::KEY_End);
    EXPECT_EQ(selected(), "d");
    while (_mappings->getNumMappings() > 5)
        _mappings->removeMapping(_mappings->getMapping(0));
    frame();
    EXPECT_EQ(selected(), "95");
    EXPECT_EQ(_panel->lines(),
              (Lines{"5 of 5", "on\t99\t0\t100 %\tnormal", "on\t98\t0\t100 %\tnormal",
                     "on\t97\t0\t100 %\tnormal", "on\t96\t0\t100 %\tnormal", "on\t95\t0\t100 %\tnormal"}));
    // While hidden, the list keeps nothing alive.
    osg::observer_ptr<ProjectiveMapping> last = _panel->selected();
    press(Event::KEY_F9);
    _mappings->removeMapping(last.get());
    EXPECT_FALSE(last.valid());
    press(Event::KEY_F9);
    EXPECT_EQ(selected(), "96");
}

TEST_F(MappingPanelTest, TakesClicksOnItsRows)
{
    showThree();
    frame();
    const osg::Vec3 place = drawn("b")->getPosition();
    EXPECT_TRUE(click(static_cast<double>(place.x()) + 3.0, static_cast<double>(place.y()) + 3.0));
    EXPECT_EQ(selected(), "b");
    EXPECT_TRUE(_mappings->getMapping(1)->getEnabled());
    const osg::BoundingBox box = ground();
    const double left = static_cast<double>(box.xMin()) + 18.0;
    EXPECT_TRUE(click(left, static_cast<double>(drawn("a")->getPosition().y())));
    EXPECT_EQ(selected(), "a");
    EXPECT_FALSE(_mappings->getMapping(0)->getEnabled()) << "by the box";
    // The rest of the list takes clicks and does nothing with them.
    EXPECT_TRUE(click(left, static_cast<double>(box.yMin()) + 5.0));
    EXPECT_TRUE(click(left, static_cast<double>(box.yMax()) - 5.0));
    EXPECT_EQ(_panel->lines()[0], "3 of 3");
    EXPECT_FALSE(click(static_cast<double>(box.xMin()) - 2.0, 400.0)) << "beside the list";
    EXPECT_FALSE(mouse(Event::SCROLL, 100.0, 100.0));
    for (int i = 0; i < 20; ++i)
        add("new");
    frame();
    EXPECT_TRUE(mouse(Event::SCROLL, left, static_cast<double>(place.y())));
    EXPECT_EQ(selected(), "a") << "the wheel does not select";
    frame();
    EXPECT_TRUE(mouse(Event::SCROLL, left, static_cast<double>(place.y()), 0));
    for (int i = 0; i < 10; ++i)
        mouse(Event::SCROLL, left, static_cast<double>(place.y()));
    EXPECT_EQ(_panel->lines().back(), "off\ta\t0\t100 %\tnormal") << "it stops at the end";
    frame();
    EXPECT_TRUE(click(static_cast<double>(place.x()), static_cast<double>(drawn("c")->getPosition().y())));
    EXPECT_EQ(selected(), "c") << "in the scrolled list";
}

TEST_F(MappingPanelTest, AltClickSelectsTheTopmostThere)
{
    showThree();
    _mappings->getMapping(0)->setRectangle({0, 0}, 300.0, 300.0);
    _mappings->getMapping(1)->setRectangle({-200, 0}, 50.0, 50.0);
    _mappings->getMapping(2)->setRectangle({5000, 0}, 50.0, 50.0);
    frame();
    EXPECT_FALSE(click(640, 360)) << "without Alt";
    EXPECT_FALSE(click(640, 360, Event::MODKEY_ALT | Event::MODKEY_CTRL)) << "Ctrl flies";
    EXPECT_EQ(selected(), "c");
    EXPECT_TRUE(click(640, 360, Event::MODKEY_ALT));
    EXPECT_EQ(selected(), "a");
    EXPECT_TRUE(click(440, 360, Event::MODKEY_ALT));
    EXPECT_EQ(selected(), "b");
    EXPECT_FALSE(click(100, 360, Event::MODKEY_ALT)) << "no mapping there";
    EXPECT_EQ(selected(), "b");
    _mappings->getMapping(1)->setEnabled(false);
    EXPECT_TRUE(click(440, 360, Event::MODKEY_ALT));
    EXPECT_EQ(selected(), "a");
}

TEST_F(MappingPanelTest, DrawsInsideItsBoxAndOnlyWhatIsNew)
{
    showThree();
    _mappings->getMapping(1)->setName(std::string(70, 'W') + " and more");
    frame();
    const osg::Group* before = &picture();
    frame();
    EXPECT_EQ(&picture(), before) << "nothing has changed";
    _mappings->getMapping(0)->setOpacity(0.5);
    frame();
    EXPECT_NE(&picture(), before);
    EXPECT_TRUE(drawn("50 %"));
    EXPECT_TRUE(drawn("1 of 3"));

    double textOf720 = 0.0;
    for (const auto& [width, height] : {std::pair(1280, 720), {640, 480}, {1920, 1080}, {3840, 2160}})
    {
        _viewer.getCamera()->setViewport(10, 20, width, height);
        frame();
        EXPECT_EQ(overlay().getViewport()->width(), width);
        EXPECT_EQ(overlay().getViewport()->y(), 20);
        const osg::BoundingBox box = ground();
        EXPECT_GE(box.xMin(), 0.0f);
        EXPECT_GE(box.yMin(), 0.0f);
        EXPECT_LT(box.xMax(), static_cast<float>(width));
        EXPECT_LT(box.yMax(), static_cast<float>(height));
        const osgText::Text* name = nullptr;
        for (const osgText::Text* text : texts())
        {
            const osg::BoundingBox& bound = text->getBoundingBox();
            EXPECT_GE(bound.xMin(), box.xMin()) << text->getText().createUTF8EncodedString();
            EXPECT_LE(bound.xMax(), box.xMax()) << text->getText().createUTF8EncodedString();
            EXPECT_GE(bound.yMin(), box.yMin());
            EXPECT_LE(bound.yMax(), box.yMax());
            if (text->getText().createUTF8EncodedString().substr(0, 2) == "WW") name = text;
        }
        ASSERT_TRUE(name);
        const std::string words = name->getText().createUTF8EncodedString();
        EXPECT_EQ(words.substr(words.size() - 3), "...");
        EXPECT_LT(name->getBoundingBox().xMax(), drawn("order")->getBoundingBox().xMin());
        if (height == 720) textOf720 = static_cast<double>(name->getCharacterHeight());
        if (height == 2160)
        {
            EXPECT_NEAR(static_cast<double>(name->getCharacterHeight()), 3.0 * textOf720, 2.0);
        }
    }
    press(Event::KEY_F9);
    EXPECT_EQ(overlay().getNodeMask(), 0u);
    press(Event::KEY_F9);
    frame();
    EXPECT_NE(overlay().getNodeMask(), 0u);
    EXPECT_EQ(_viewer.getNumSlaves(), 1u);
}

TEST_F(MappingPanelTest, RoutesAreRowsAboveMappingsOfTheirOrder)
{
    showThree();
    const osg::ref_ptr<RouteMapping> route = new RouteMapping;
    route->setWayPoints({{-300, 100}, {300, 100}});
    _mappings->addRoute(route);
    press(Event::KEY_Home);
    const auto rowOf = [&]
    {
        for (const std::string& line : _panel->lines())
            if (line.find("\troute") != std::string::npos) return line;
        return std::string();
    };
    ASSERT_EQ(_panel->lines().size(), 5u) << "a row, and none for its mappings";
    EXPECT_EQ(_panel->lines()[1], "on\troute 1\t0\t100 %\troute");
    EXPECT_FALSE(_panel->selected()) << "it is no mapping";
    press(Event::KEY_Return);
    EXPECT_FALSE(route->getEnabled());
    EXPECT_EQ(route->getNumMappings(), 0u);
    press(Event::KEY_Return);
    press(Event::KEY_Left);
    press('.');
    EXPECT_EQ(route->getOpacity(), 0.95);
    press('-');
    EXPECT_EQ(route->getOrder(), -1);
    route->setName("hike");
    EXPECT_EQ(rowOf(), "on\thike\t-1\t95 %\troute");
    EXPECT_EQ(_panel->lines()[4], rowOf()) << "the lowest now";
    // A click on its line, above the mappings.
    route->setOrder(0);
    press(Event::KEY_End);
    EXPECT_TRUE(_panel->selected());
    EXPECT_TRUE(click(640.0, 460.0, Event::MODKEY_ALT));
    press(Event::KEY_Return);
    EXPECT_FALSE(route->getEnabled());
}
