// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Presets of a scene's effects, the way between them, and the keys that step through them, in a viewer that never draws.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/viewer/PresetKeys.h>
#include <tools/NotifyWatch.h>
#include <tools/WindowEvents.h>

#include <osg/Math>
#include <osg/ValueObject>

#include <limits>
#include <sstream>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// Counts how often an object says that it has changed.
struct Listener final : public PropertyListener
{
    void propertyChanged(PropertyHolder&) override { ++count; }
    int count = 0;
};

/// An application's effect, with a color.
class Painted : public Effect
{
public:
    Painted() = default;
    Painted(const Painted& other, const osg::CopyOp& copy) : Effect(other, copy), _color(other._color) {}
    META_Object(test, Painted);
    const Properties& properties() const override
    {
        static const Properties all = {enabledProperty(),
                                       Property::color("color", "a color").of<&Painted::_color>()};
        return all;
    }

private:
    int _color = 0;
};

class EffectPresetsTest : public WindowEvents
{
protected:
    EffectPresetsTest()
    {
        scene->addEffect(bend);
        scene->addEffect(map);
        scene->addEffect(second);
        map->setEnabled(false);
        second->setEnabled(false);
    }
    PresetBlend begin(const EffectPreset& preset)
    {
        std::string error;
        const auto blend = PresetBlend::begin(*scene, preset, error);
        EXPECT_TRUE(blend) << error;
        return blend.value_or(PresetBlend());
    }
    static void set(const PresetBlend& blend, double share)
    {
        std::string error;
        EXPECT_TRUE(blend.set(share, error)) << error;
    }
    std::string refusal(const std::string& property, const std::string& value)
    {
        std::string error;
        EXPECT_FALSE(PresetBlend::begin(*scene, {"wrong", {{property, value}}}, error));
        EXPECT_EQ(error.empty() ? ' ' : error.back(), '.') << error;
        return error;
    }
    void frameAt(double time)
    {
        send(Event::FRAME, [&](Event& event) { event.setTime(time); });
    }
    bool pressAt(int key, double time)
    {
        return send(Event::KEYDOWN,
                    [&](Event& event)
                    {
                        event.setKey(key);
                        event.setTime(time);
                    });
    }
    osgGA::GUIEventHandler& handler() override { return *keys; }

    osg::ref_ptr<EffectScene> scene = new EffectScene;
    osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    osg::ref_ptr<BirdsEyeView> second = new BirdsEyeView;
    osg::ref_ptr<PresetKeys> keys;
};

} // namespace

TEST_F(EffectPresetsTest, NumbersGoSmoothlyAndOthersSwitchHalfway)
{
    second->setMapUnit(0);
    const PresetBlend blend = begin({"map",
                                     {{"birdsEyeView.focusLine", "0.2"},
                                      {"birdsEyeView.horizonLine", "0.65"},
                                      {"birdsEyeView.curve", "bezier"},
                                      {"birdsEyeView.coverMap", "true"},
                                      {"birdsEyeView.mapUnit", "3"},
                                      {"birdsEyeView.tallest", "300"},
                                      {"birdsEyeView[2].mapUnit", "3"},
                                      {"birdsEyeView[2].focusLine", "0.1"}}});
    EXPECT_EQ(bend->getFocusLine(), 0.4) << "nothing changes before the first step";
    Listener listener;
    bend->addListener(listener);
    set(blend, 0.25);
    // 3t² − 2t³
    EXPECT_NEAR(bend->getFocusLine(), 0.4 - 0.2 * (3.0 / 16.0 - 2.0 / 64.0), 1e-12);
    EXPECT_NEAR(bend->getHorizonLine(), 0.85 - 0.2 * (3.0 / 16.0 - 2.0 / 64.0), 1e-12);
    EXPECT_EQ(bend->getCurve(), PerspectiveBend::ARC_LENGTH);
    EXPECT_FALSE(bend->getCoverMap());
    EXPECT_EQ(bend->getMapUnit(), -1);
    EXPECT_EQ(second->getMapUnit(), 0);
    EXPECT_EQ(bend->getTallest(), -1.0) << "-1 has a meaning of its own";
    EXPECT_EQ(listener.count, 1) << "one step is one change";
    set(blend, 0.75);
    EXPECT_EQ(bend->getCurve(), PerspectiveBend::BEZIER);
    EXPECT_TRUE(bend->getCoverMap());
    EXPECT_EQ(bend->getMapUnit(), 3);
    EXPECT_EQ(second->getMapUnit(), 3) << "never another unit on the way";
    EXPECT_EQ(bend->getTallest(), 300.0);
    set(blend, 1.0);
    EXPECT_EQ(bend->getFocusLine(), 0.2);
    EXPECT_EQ(bend->getHorizonLine(), 0.65);
    EXPECT_EQ(second->getFocusLine(), 0.1);
    EXPECT_EQ(second->getHorizonLine(), 0.85);
    bend->removeListener(listener);
    // It may go back, and past its ends nothing more happens.
    set(blend, -1.0);
    EXPECT_EQ(bend->getFocusLine(), 0.4);
    set(blend, 7.0);
    EXPECT_EQ(bend->getFocusLine(), 0.2);
}

TEST_F(EffectPresetsTest, ColorsAreMixedAndDirectionsGoTheShorterWay)
{
    const osg::ref_ptr<Painted> painted = new Painted;
    scene->addEffect(painted);
    std::string error;
    ASSERT_TRUE(painted->setProperty("color", 0x204080, error)) << error;
    ASSERT_TRUE(map->setPropertyText("lightAzimuth", "170", error)) << error;
    ASSERT_TRUE(map->setPropertyText("horizontalAngle", "0", error)) << error;
    const PresetBlend blend = begin({"x",
                                     {{"painted.color", "#406000"},
                                      {"panoramaMap.lightAzimuth", "-150"},
                                      {"panoramaMap.horizontalAngle", "360"}}});
    set(blend, 0.5);
    EXPECT_EQ(painted->getProperty("color"), 0x305040);
    EXPECT_NEAR(osg::RadiansToDegrees(map->getProperty("lightAzimuth")), -170.0, 1e-9) << "over the south";
    EXPECT_NEAR(osg::RadiansToDegrees(map->getProperty("horizontalAngle")), 180.0, 1e-9) << "an arc";
    set(blend, 1.0);
    EXPECT_EQ(painted->getProperty("color"), 0x406000);
    EXPECT_NEAR(osg::RadiansToDegrees(map->getProperty("lightAzimuth")), -150.0, 1e-9);
    EXPECT_NEAR(osg::RadiansToDegrees(map->getProperty("horizontalAngle")), 360.0, 1e-9);
}

TEST_F(EffectPresetsTest, CaptureAllAndComeBack)
{
    const osg::ref_ptr<BlendedView> blended = new BlendedView;
    scene->addEffect(blended);
    blended->getPedestrianView()->setBendAngle(0.5);
    second->setFocusLine(0.33);
    const EffectPreset before = EffectPreset::of(*scene, "before");
    blended->getPedestrianView()->setBendAngle(1.2);
    blended->setHighHeight(9000.0);
    second->setFocusLine(0.11);
    second->setEnabled(true);
    bend->setFocusLine(0.22);
    set(begin(before), 1.0);
    EXPECT_NEAR(blended->getPedestrianView()->getBendAngle(), 0.5, 1e-12);
    EXPECT_EQ(blended->getHighHeight(), 1500.0);
    EXPECT_EQ(second->getFocusLine(), 0.33);
    EXPECT_FALSE(second->getEnabled());
    EXPECT_EQ(bend->getFocusLine(), 0.4);

    // A scene keeps them.
    EffectPreset::write(*scene, {before, {"Übersicht \"2\"", {{"birdsEyeView.focusLine", "0.3"}}}});
    const osg::ref_ptr<EffectScene> copy = osg::clone(scene.get(), osg::CopyOp::DEEP_COPY_ALL);
    std::string error;
    const std::vector<EffectPreset> read = EffectPreset::read(*copy, error);
    ASSERT_EQ(read.size(), 2u) << error;
    EXPECT_EQ(read[0].settings, before.settings);
    EXPECT_EQ(read[1].name, "Übersicht \"2\"");
    const osg::ref_ptr<EffectScene> other = new EffectScene;
    EXPECT_TRUE(EffectPreset::read(*other, error).empty());
    EXPECT_EQ(error, "");
    scene->setUserValue("geofx.presets", std::string("{\"x\": "));
    EXPECT_TRUE(EffectPreset::read(*scene, error).empty());
    EXPECT_NE(error.find("geofx.presets"), std::string::npos);
}

TEST_F(EffectPresetsTest, RefuseWhatTheSceneHasNot)
{
    EXPECT_NE(refusal("pedestrianView.bendAngle", "3").find("birdsEyeView, panoramaMap, birdsEyeView"),
              std::string::npos);
    EXPECT_NE(refusal("birdsEyeView[3].focusLine", "0.3").find("has not"), std::string::npos);
    EXPECT_NE(refusal("birdsEyeView[x].focusLine", "0.3").find("birdsEyeView[2].focusLine"),
              std::string::npos);
    EXPECT_NE(refusal("birdsEyeView[].focusLine", "0.3").find("birdsEyeView[2].focusLine"),
              std::string::npos);
    EXPECT_NE(refusal("birdsEyeView[", "0.3").find("birdsEyeView[2].focusLine"), std::string::npos);
    EXPECT_NE(refusal("birdsEyeView", "0.3").find("names no property"), std::string::npos);
    EXPECT_NE(refusal("birdsEyeView.focusLane", "0.3").find("no property \"focusLane\""), std::string::npos);
    EXPECT_NE(refusal("birdsEyeView.focusLine", "1.5").find("focusLine"), std::string::npos);
    EXPECT_EQ(bend->getFocusLine(), 0.4);
    // Values that do not fit each other stay; others are set.
    const PresetBlend blend =
        begin({"x", {{"birdsEyeView.focusLine", "0.9"}, {"birdsEyeView.contextTilt", "0.5"}}});
    std::string error;
    EXPECT_FALSE(blend.set(1.0, error));
    EXPECT_NE(error.find("focusLine must lie below horizonLine"), std::string::npos) << error;
    EXPECT_EQ(bend->getFocusLine(), 0.4);
    EXPECT_EQ(bend->getContextTilt(), 0.5);
}

TEST_F(EffectPresetsTest, KeysStepThroughThemInTime)
{
    keys = new PresetKeys(*scene);
    EXPECT_FALSE(keys->hasPresets());
    EXPECT_FALSE(pressAt('p', 0.0));
    EffectPreset::write(*scene, {{"map", {{"birdsEyeView.focusLine", "0.2"}}},
                                 {"skyline", {{"birdsEyeView.focusLine", "0.6"}}},
                                 {"wrong", {{"lens.size", "1"}}}});
    keys = new PresetKeys(*scene, 2.0);
    ASSERT_TRUE(keys->hasPresets());
    EXPECT_FALSE(pressAt('x', 10.0));
    EXPECT_TRUE(pressAt('p', 10.0));
    EXPECT_EQ(keys->text(), "map");
    frameAt(11.0);
    EXPECT_NEAR(bend->getFocusLine(), 0.3, 1e-12);
    EXPECT_TRUE(keys->blending());
    // On the way, back by one: to the last from the first, and that one is wrong.
    EXPECT_TRUE(pressAt('P', 11.0));
    EXPECT_NE(keys->text().find("lens.size"), std::string::npos);
    frameAt(12.0);
    EXPECT_NEAR(bend->getFocusLine(), 0.3, 1e-12);
    EXPECT_TRUE(pressAt('P', 12.0));
    EXPECT_EQ(keys->text(), "skyline");
    frameAt(12.0);
    EXPECT_NEAR(bend->getFocusLine(), 0.3, 1e-12) << "from where it is";
    frameAt(14.5);
    EXPECT_EQ(bend->getFocusLine(), 0.6);
    EXPECT_FALSE(keys->blending());
    EXPECT_EQ(overlay().getNodeMask(), ~0u);
    frameAt(15.5);
    EXPECT_EQ(keys->text(), "");
    EXPECT_EQ(overlay().getNodeMask(), 0u);
    // What is changed by hand then stays.
    bend->setFocusLine(0.5);
    frameAt(16.0);
    EXPECT_EQ(bend->getFocusLine(), 0.5);
}
