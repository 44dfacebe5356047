// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The list of effects and their properties: what it lists, and what keys and clicks do to any effect of the kit.
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/EffectPanel.h>

#include <gtest/gtest.h>
#include <osgViewer/Viewer>

#include <tuple>

using namespace osgGeoFX;
using Event = osgGA::GUIEventAdapter;

namespace
{

class EffectPanelTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        _viewer.getCamera()->setViewport(0, 0, 900, 700);
        _viewer.setSceneData(_scene);
    }

    bool send(Event::EventType type, int key = 0, int modifiers = 0, double x = 0.0, double y = 0.0)
    {
        const osg::ref_ptr<Event> event = new Event;
        event->setEventType(type);
        event->setKey(key);
        event->setModKeyMask(modifiers);
        event->setButton(Event::LEFT_MOUSE_BUTTON);
        event->setX(static_cast<float>(x));
        event->setY(static_cast<float>(y));
        event->setScrollingMotion(Event::SCROLL_DOWN);
        return _panel->handle(*event, _viewer);
    }
    bool press(int key, int modifiers = 0) { return send(Event::KEYDOWN, key, modifiers); }

    /// Selects the row that begins so.
    void select(const std::string& name)
    {
        press(Event::KEY_Home);
        for (int i = 0; i < 300; ++i)
        {
            const std::string count = _panel->lines().at(0);
            const std::size_t row = static_cast<std::size_t>(std::stoi(count)) - 1;
            const std::size_t shown = std::min(row, PanelPicture::rows - 1);
            if (_panel->lines().at(1 + shown).rfind(name + "\t", 0) == 0) return;
            press(Event::KEY_Down);
        }
        FAIL() << name;
    }

    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<EffectPanel> _panel = new EffectPanel(*_scene);
    osgViewer::Viewer _viewer;
};

} // namespace

TEST_F(EffectPanelTest, DoesNothingWhileHiddenOrWithoutEffects)
{
    EXPECT_FALSE(press(Event::KEY_F10));
    EXPECT_FALSE(_panel->shown());
    _scene->addEffect(createEffect("birdsEyeView"));
    for (const int key : {int(Event::KEY_Up), int(Event::KEY_Left), int(Event::KEY_Return), int('.')})
        EXPECT_FALSE(press(key));
    EXPECT_TRUE(_panel->lines().empty());
    EXPECT_TRUE(press(Event::KEY_F10));
    EXPECT_TRUE(_panel->shown());
    EXPECT_FALSE(press('x'));
    EXPECT_TRUE(press(Event::KEY_F10));
    EXPECT_FALSE(_panel->shown());
    press(Event::KEY_F10);
    _scene->removeEffect(_scene->getEffect(0));
    send(Event::FRAME);
    EXPECT_FALSE(_panel->shown()) << "the last effect has gone";
}

TEST_F(EffectPanelTest, ListsEveryPropertyOfEveryEffect)
{
    std::size_t count = 0;
    for (const std::string& kind : effectKinds())
    {
        const osg::ref_ptr<Effect> effect = createEffect(kind);
        _scene->addEffect(effect);
        count += effect->properties().size();
        for (const PropertyHolder::Part& part : effect->parts())
            count += part.object->properties().size();
    }
    press(Event::KEY_F10);
    EXPECT_EQ(_panel->lines().at(0), "1 of " + std::to_string(count));
    EXPECT_EQ(_panel->lines().at(1), "birdsEyeView\ttrue\t");
    EXPECT_EQ(_panel->lines().at(2), "  curve\tarcLength\t");
    EXPECT_EQ(_panel->lines().at(3), "  planeHeight\t0\tmetres");
    EXPECT_EQ(_panel->lines().size(), 1 + PanelPicture::rows);
    select("  birdsEyeView");
    select("  lightAzimuth");
    // What others change is shown, and what is selected stays so.
    const std::string before = _panel->lines().at(0);
    _scene->removeEffect(_scene->getEffect(0));
    send(Event::FRAME);
    EXPECT_NE(_panel->lines().at(0), before);
    press(Event::KEY_Right);
    EXPECT_NEAR(_scene->getEffect(_scene->getNumEffects() - 1)->getProperty("lightAzimuth"),
                osg::DegreesToRadians(-55.0), 1e-12);
}

TEST_F(EffectPanelTest, KeysTurnTheSelectedPropertyAlone)
{
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    _scene->addEffect(map);
    press(Event::KEY_F10);
    select("  season");
    for (const auto& [key, modifiers, value] :
         {std::tuple(int(Event::KEY_Right), 0, 0.55), std::tuple(int(Event::KEY_Left), 0, 0.5),
          std::tuple(int('.'), 0, 0.505), std::tuple(int(','), 0, 0.5),
          std::tuple(int(Event::KEY_Right), int(Event::MODKEY_SHIFT), 1.0),
          std::tuple(int(Event::KEY_Right), 0, 1.0), std::tuple(int(Event::KEY_Return), 0, 0.5)})
    {
        EXPECT_TRUE(press(key, modifiers));
        EXPECT_EQ(map->getSeason(), value);
    }
    const osg::ref_ptr<PanoramaMap> plain = new PanoramaMap;
    for (const Property& property : map->properties())
        EXPECT_EQ(property.get(*map), property.get(*plain)) << property.name;
    select("  water");
    press(Event::KEY_Return);
    EXPECT_FALSE(map->getWater());
    press(Event::KEY_Left);
    EXPECT_TRUE(map->getWater());
    select("panoramaMap");
    press(Event::KEY_Return);
    EXPECT_FALSE(map->getEnabled());
    press(Event::KEY_Return);
    // What does not fit the others is refused without a word.
    map->setFirstUnit(4);
    select("  coverUnit");
    for (int i = 0; i < 5; ++i)
        press(Event::KEY_Left);
    EXPECT_EQ(map->getCoverUnit(), 7) << "6 belongs to the three from firstUnit on";
}

TEST_F(EffectPanelTest, ButtonsStandBelowTheEffects)
{
    int pressed = 0;
    _panel->addButton("Make a map", [&] { ++pressed; });
    EXPECT_TRUE(press(Event::KEY_F10)) << "even without effects";
    EXPECT_EQ(_panel->lines().at(0), "1 of 1");
    EXPECT_EQ(_panel->lines().at(1), "Make a map\t\t");
    for (const int key : {int(Event::KEY_Left), int(Event::KEY_Right), int('.'), int(',')})
        press(key);
    EXPECT_EQ(pressed, 0);
    EXPECT_TRUE(press(Event::KEY_Return));
    EXPECT_EQ(pressed, 1);
    // The selection stays with the button when effects come and go before it.
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    _scene->addEffect(map);
    send(Event::FRAME);
    press(Event::KEY_Return);
    EXPECT_EQ(pressed, 2);
    _scene->removeEffect(map);
    send(Event::FRAME);
    press(Event::KEY_Return);
    EXPECT_EQ(pressed, 3);
    // A click on its box presses it, one on its text does not.
    int clicked = 0;
    for (double x = 10.0; x < 300.0; x += 4.0)
        for (double y = 690.0; y > 500.0; y -= 4.0)
        {
            send(Event::PUSH, 0, 0, x, y);
            send(Event::RELEASE, 0, 0, x, y);
            clicked += pressed > 3 && x > 150.0 ? 1 : 0;
            if (x < 150.0) continue;
            pressed = 3;
        }
    EXPECT_EQ(clicked, 0);
}

TEST_F(EffectPanelTest, StepsSuitAllProperties)
{
    for (const std::string& kind : effectKinds())
    {
        const osg::ref_ptr<Effect> effect = createEffect(kind);
        for (const Property& property : effect->properties())
        {
            SCOPED_TRACE(kind + "." + property.name);
            for (const double steps : {-10.0, -1.0, -0.1, 0.1, 1.0, 10.0})
            {
                const double value = EffectPanel::stepped(property, property.defaultValue, steps);
                EXPECT_EQ(property.refusal(value), "") << steps;
                const bool atEnd =
                    property.defaultValue == (steps < 0.0 ? property.minimum : property.maximum);
                const bool isSwitch =
                    property.kind == Property::Kind::Flag || property.kind == Property::Kind::Choice;
                if (isSwitch || atEnd) continue;
                EXPECT_EQ(value < property.defaultValue, steps < 0.0) << steps;
                // Few digits, as a person would type them.
                EXPECT_LT(property.text(value).size(), 12u) << property.text(value);
            }
        }
    }
    const osg::ref_ptr<BirdsEyeView> view = new BirdsEyeView;
    const Property& curve = *view->property("curve");
    EXPECT_EQ(EffectPanel::stepped(curve, 2.0, 1.0), 0.0) << "choices go round";
    EXPECT_EQ(EffectPanel::stepped(curve, 0.0, -1.0), 2.0);
}

TEST_F(EffectPanelTest, TakesClicksOnItsRows)
{
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    _scene->addEffect(map);
    press(Event::KEY_F10);
    send(Event::FRAME);
    // Somewhere in the upper left corner lie its rows; beside it nothing is taken.
    EXPECT_FALSE(send(Event::PUSH, 0, 0, 890.0, 690.0));
    bool switched = false;
    int rows = 0;
    std::string last;
    for (double y = 690.0; y > 300.0 && !switched; y -= 4.0)
    {
        EXPECT_TRUE(send(Event::PUSH, 0, 0, 30.0, y) || y > 680.0 || y < 500.0);
        send(Event::RELEASE, 0, 0, 30.0, y);
        const std::string now = _panel->lines().at(0);
        if (now != last) ++rows;
        last = now;
        switched = rows > 3;
    }
    EXPECT_TRUE(switched);
    EXPECT_TRUE(send(Event::SCROLL, 0, 0, 60.0, 600.0));
    EXPECT_EQ(_panel->lines().at(1).find("panoramaMap"), std::string::npos) << "scrolled away";
    EXPECT_FALSE(send(Event::SCROLL, 0, 0, 890.0, 100.0));
    const osg::ref_ptr<osg::ApplicationUsage> usage = new osg::ApplicationUsage;
    _panel->getUsage(*usage);
    EXPECT_EQ(usage->getKeyboardMouseBindings().count("F10"), 1u);
}
