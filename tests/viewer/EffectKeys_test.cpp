// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The keys for effects, with events made by hand. What keys turn is read from the effects' own tables.
#include <osgGeoFX/viewer/EffectKeys.h>
#include <osgGeoFX/viewer/EffectKinds.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>

using namespace osgGeoFX;
using Event = osgGA::GUIEventAdapter;

namespace
{

/// Counts what handlers ask for.
class Action : public osgGA::GUIActionAdapter
{
public:
    void requestRedraw() override { ++redraws; }
    void requestContinuousUpdate(bool) override {}
    void requestWarpPointer(float, float) override {}

    int redraws = 0;
};

class EffectKeysTest : public ::testing::Test
{
protected:
    Effect& add(const std::string& kind)
    {
        const osg::ref_ptr<Effect> effect = createEffect(kind);
        _scene->addEffect(effect);
        return *effect;
    }

    /// Whether the key is one of ours.
    bool press(int key)
    {
        const osg::ref_ptr<Event> event = new Event;
        event->setEventType(Event::KEYDOWN);
        event->setKey(key);
        const int former = _action.redraws;
        const bool handled = _keys->handle(*event, _action);
        EXPECT_EQ(_action.redraws, handled ? former + 1 : former);
        return handled;
    }

    static std::map<std::string, double> valuesOf(const Effect& effect)
    {
        std::map<std::string, double> values;
        for (const Property& property : effect.properties())
            values[property.name] = effect.getProperty(property.name);
        return values;
    }

    std::string switchedOn() const
    {
        std::string text;
        for (unsigned int i = 0; i < _scene->getNumEffects(); ++i)
            text += _scene->getEffect(i)->getEnabled() ? '1' : '0';
        return text;
    }

    const osg::ref_ptr<EffectScene> _scene = new EffectScene;
    const osg::ref_ptr<EffectKeys> _keys = new EffectKeys(*_scene);
    Action _action;
};

} // namespace

TEST_F(EffectKeysTest, SwitchEffectsOnAndOff)
{
    EXPECT_TRUE(press(Event::KEY_F5)) << "also without any effect";
    EXPECT_TRUE(press(Event::KEY_F6));
    add("birdsEyeView");
    add("pedestrianView");
    add("verticalExaggeration").setEnabled(false);
    for (const char* expected : {"000", "111", "000"})
    {
        press(Event::KEY_F5);
        EXPECT_EQ(switchedOn(), expected);
    }
    for (const char* expected : {"100", "010", "001", "100"})
    {
        press(Event::KEY_F6);
        EXPECT_EQ(switchedOn(), expected);
    }
    press(Event::KEY_F7);
    EXPECT_TRUE(_scene->getDebugBounds());
    press(Event::KEY_F7);
    EXPECT_FALSE(_scene->getDebugBounds());
    press(Event::KEY_F8);
    EXPECT_FALSE(_scene->getCompensation());
    press(Event::KEY_F8);
    EXPECT_TRUE(_scene->getCompensation());
}

TEST_F(EffectKeysTest, TurnTheMainPropertyOfEachKind)
{
    const std::map<std::string, std::pair<std::string, double>> expected = {
        {"birdsEyeView", {"horizonLine", 0.87}}, {"pedestrianView", {"bendAngle", 1.0471975511965976 + 0.05}},
        {"blendedView", {"highHeight", 1725.0}}, {"verticalExaggeration", {"factor", 1.15}},
        {"regionalLiberty", {"enlarge", 1.15}},  {"panoramaMap", {"exaggeration", 2.3}}};
    for (const auto& [kind, turned] : expected)
    {
        SCOPED_TRACE(kind);
        Effect& effect = add(kind);
        const std::map<std::string, double> before = valuesOf(effect);
        EXPECT_TRUE(press(')'));
        std::map<std::string, double> after = valuesOf(effect);
        EXPECT_NEAR(after.at(turned.first), turned.second, 1e-9);
        after[turned.first] = before.at(turned.first);
        EXPECT_EQ(after, before) << "nothing else";
        EXPECT_TRUE(press('('));
        EXPECT_NEAR(valuesOf(effect).at(turned.first), before.at(turned.first), 1e-9) << "and back";
        effect.setEnabled(false);
        const std::map<std::string, double> off = valuesOf(effect);
        press(')');
        EXPECT_EQ(valuesOf(effect), off) << "what is off stays as it is";
    }
}

TEST_F(EffectKeysTest, StayWithinTheRangeAndWithWhatFits)
{
    for (const std::string& kind : effectKinds())
    {
        SCOPED_TRACE(kind);
        for (const int key : {int('('), int(')')})
        {
            Effect& effect = add(kind);
            for (int i = 0; i < 200; ++i)
                press(key);
            int turned = 0;
            for (const Property& property : effect.properties())
            {
                const double value = effect.getProperty(property.name);
                EXPECT_EQ(property.refusal(value), "");
                if (property.keyStep == 0.0) continue;
                ++turned;
                const bool canMove = key == '(' || property.defaultValue != property.maximum;
                EXPECT_TRUE(value != property.defaultValue || !canMove) << value;
                EXPECT_TRUE(key == '(' || value == property.maximum) << value;
            }
            EXPECT_EQ(turned, 1) << "one main property";
            _scene->removeEffect(&effect);
        }
    }
    Effect& bird = add("birdsEyeView");
    for (int i = 0; i < 200; ++i)
        press('(');
    const double step = bird.property("horizonLine")->keyStep;
    EXPECT_GT(bird.getProperty("horizonLine"), bird.getProperty("focusLine"));
    EXPECT_LE(bird.getProperty("horizonLine"), bird.getProperty("focusLine") + step);
}

TEST_F(EffectKeysTest, LeaveEverythingElseToOthers)
{
    add("birdsEyeView");
    for (const int key : {int('a'), int(' '), int('9'), int(Event::KEY_F4), int(Event::KEY_F9)})
        EXPECT_FALSE(press(key));
    const osg::ref_ptr<Event> release = new Event;
    release->setEventType(Event::KEYUP);
    release->setKey(Event::KEY_F5);
    EXPECT_FALSE(_keys->handle(*release, _action));
    EXPECT_EQ(switchedOn(), "1");
}

TEST_F(EffectKeysTest, AreInTheHelp)
{
    const osg::ref_ptr<osg::ApplicationUsage> usage = new osg::ApplicationUsage;
    _keys->getUsage(*usage);
    const osg::ApplicationUsage::UsageMap& bindings = usage->getKeyboardMouseBindings();
    for (const char* key : {"F5", "F6", "F7", "F8", "( and )"})
        EXPECT_EQ(bindings.count(key), 1u) << key;
    EXPECT_EQ(bindings.size(), 5u);
    EXPECT_EQ(bindings.at("( and )"), "Turn horizon line, bend angle, exaggeration");
}
