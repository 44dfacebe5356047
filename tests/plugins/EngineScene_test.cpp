// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The scene that is a part of an engine's file, as the engine's own reader has read it.
#include <geofx/SceneFile.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <tools/EngineElements.h>

#include <gtest/gtest.h>

#include <string>

using namespace geofx::test;
using osgGeoFX::parseScene;
using osgGeoFX::SceneResult;

namespace
{

const std::string engine = "<terrain><engine/></terrain>";

/// The only sentence about a map.
std::string sentenceOf(const SceneResult& result)
{
    EXPECT_FALSE(result.scene);
    EXPECT_EQ(result.errors.size(), 1u) << ::testing::PrintToString(result.errors);
    return result.errors.empty() ? std::string() : result.errors.front();
}

TEST(EngineScene, IsAPartOfAnEnginesFile)
{
    const std::string map =
        "<map name='x'>\n  <Options Foo='bar'/>\n  <Extensions>\n    <geofx version='1'>\n"
        "      <terrain><engine minHeight='-5' maxHeight='900' culling='open'/></terrain>\n"
        "      <effects>\n        <birdsEyeView focusLine='0.4'/>\n      </effects>\n"
        "    </geofx>\n  </Extensions>\n</map>\n";
    const SceneResult read = parseMap(map);
    ASSERT_TRUE(read.scene) << ::testing::PrintToString(read.errors);
    ASSERT_TRUE(read.scene->engine);
    EXPECT_EQ(read.scene->engine->culling, osgGeoFX::EffectScene::OPEN);
    EXPECT_EQ(read.scene->ground.minHeight, -5.0);
    EXPECT_EQ(read.scene->ground.maxHeight, 900.0);
    ASSERT_EQ(read.scene->effects.size(), 1u);
    EXPECT_STREQ(read.scene->effects[0]->className(), "BirdsEyeView");

    const auto errorOf = [](const std::string& text)
    {
        const SceneResult result = parseMap(text);
        EXPECT_FALSE(result.scene);
        EXPECT_EQ(result.errors.size(), 1u) << ::testing::PrintToString(result.errors);
        return result.errors.empty() ? std::string() : result.errors.front();
    };
    // The engine's tiles do not say what lies on the ground.
    std::string covered = map;
    covered.replace(covered.find("focusLine='0.4'"), 15, "coverMap='true'");
    EXPECT_NE(errorOf(covered).find("bends without coverMap"), std::string::npos) << errorOf(covered);
    // Lines are those of the whole file.
    std::string wrong = map;
    wrong.replace(wrong.find("focusLine"), 9, "focusLane");
    EXPECT_EQ(errorOf(wrong).rfind("x.earth:7: <birdsEyeView>:", 0), 0u) << errorOf(wrong);
    const auto mapWith = [](const std::string& inside)
    {
        return "<map><geofx version='1'>" + inside + "</geofx></map>";
    };
    EXPECT_NE(
        errorOf(mapWith("<terrain><database file='terrain.osgb'/></terrain>")).find("expected: <engine/>"),
        std::string::npos);
    EXPECT_NE(errorOf(mapWith(engine + "<sun azimuth='0' elevation='5'/>")).find("<sky>"), std::string::npos);
    EXPECT_NE(errorOf(mapWith(engine + "<background color='#ffffff'/>")).find("<background>"),
              std::string::npos);
    EXPECT_NE(
        errorOf(mapWith(engine + "<homeView longitude='0' latitude='0' height='9' heading='0' pitch='0'/>"))
            .find("<viewpoints>"),
        std::string::npos);
    // A scene file has a terrain of its own.
    const SceneResult alone = parseScene("<geofx version='1'>" + engine + "</geofx>", "x.geofx", "/scenes");
    EXPECT_FALSE(alone.scene);
    ASSERT_EQ(alone.errors.size(), 1u);
    EXPECT_NE(alone.errors[0].find(".earth"), std::string::npos);
}

// The engine's reader makes names lower case, and an attribute is a child like an element.
TEST(EngineScene, HasEachPropertyOfEachEffect)
{
    for (const std::string& kind : osgGeoFX::effectKinds())
    {
        SCOPED_TRACE(kind);
        const osg::ref_ptr<osgGeoFX::Effect> effect = osgGeoFX::createEffect(kind);
        std::string element = "<" + kind;
        for (const osgGeoFX::Property& property : effect->properties())
            element += " " + property.name + "='" + property.text(property.get(*effect)) + "'";
        const std::string effects = "<effects>\n" + element + "/></effects>";
        const SceneResult file = parseScene(
            "<geofx version='1'><terrain><database file='t.osgb'/></terrain>" + effects + "</geofx>",
            "x.geofx", "/maps");
        const SceneResult map = parseMap("<map><geofx version='1'>" + engine + effects + "</geofx></map>");
        ASSERT_TRUE(file.scene) << ::testing::PrintToString(file.errors);
        ASSERT_TRUE(map.scene) << ::testing::PrintToString(map.errors);
        ASSERT_EQ(map.scene->effects.size(), 1u);
        for (const osgGeoFX::Property& property : effect->properties())
            EXPECT_EQ(property.get(*map.scene->effects[0]), property.get(*file.scene->effects[0]))
                << property.name;
    }
}

// Presets and elements within elements, in their order.
TEST(EngineScene, HasWhatStandsWithinItsElements)
{
    const std::string effects = R"(<effects><projectiveMappings>
      <layer name="a" file="a.tif"/><layer name="b" file="b.tif"/>
      <transfer name="red" source="constant" constantColor="#e01010"/>
      <mapping layer="b" opacity="0.25" west="1" south="2" east="3" north="4"/>
      <mapping layer="a" transfer="red" longitude="5" latitude="6" uX="35" vY="40"/></projectiveMappings></effects>
      <presets><preset name="Half"><set property="projectiveMappings.opacity" value="0.5"/></preset></presets>)";
    const SceneResult map = parseMap("<map><geofx version='1'>" + engine + effects + "</geofx></map>");
    ASSERT_TRUE(map.scene) << ::testing::PrintToString(map.errors);
    ASSERT_EQ(map.scene->mappings.size(), 1u);
    const osgGeoFX::SceneMappings& mappings = map.scene->mappings[0];
    ASSERT_EQ(mappings.layers.size(), 2u);
    EXPECT_EQ(mappings.layers[1].file.path, "/maps/b.tif");
    ASSERT_EQ(mappings.mappings.size(), 2u);
    EXPECT_EQ(mappings.mappings[0].mapping->getOpacity(), 0.25);
    ASSERT_TRUE(mappings.mappings[0].box && mappings.mappings[1].point);
    EXPECT_EQ(mappings.mappings[0].box->north, 4.0);
    EXPECT_EQ(mappings.mappings[1].point->latitude, 6.0);
    ASSERT_EQ(map.scene->presets.size(), 1u);
    EXPECT_EQ(map.scene->presets[0].settings[0].second, "0.5");
}

// osgEarth's parser is lenient, so what stands around a scene need not be well-formed.
TEST(EngineScene, HasItsLinesInMalformedMaps)
{
    const std::string wrong =
        "<geofx version='1'>" + engine + "<effects>\n<birdsEyeView focusLane='1'/></effects></geofx>";
    for (const std::string& map :
         {"<map>\n<xi:include href='a.xml'/>\n" + wrong + "</map>",
          "<map a='1' a='2'>\n<b c=d>\n" + wrong + "</map>",
          "<map>\n<name>This & that</name>\n" + wrong + "</map>",
          "<!DOCTYPE map SYSTEM 'http://127.0.0.1:9/map.dtd'>\n<map>\n" + wrong + "</map>"})
    {
        const SceneResult result = osgGeoFX::parseEngineScene(engineElement(wrong), map, "x.earth", "/maps");
        EXPECT_EQ(sentenceOf(result).rfind("x.earth:4: <birdsEyeView>: the attribute \"focuslane\"", 0), 0u)
            << result.errors[0];
    }
    // An included file begins with the scene itself.
    const SceneResult included = osgGeoFX::parseEngineScene(engineElement(wrong), wrong, "part.xml", "/maps");
    EXPECT_EQ(sentenceOf(included).rfind("part.xml:2: ", 0), 0u);
    // A map from a string, or whose text is not the one that was read.
    const SceneResult noFile = osgGeoFX::parseEngineScene(engineElement(wrong), "", "", "/maps");
    EXPECT_EQ(sentenceOf(noFile).rfind("<birdsEyeView>: the attribute", 0), 0u) << noFile.errors[0];
    const SceneResult other =
        osgGeoFX::parseEngineScene(engineElement(wrong), "<geofx><effects/></geofx>", "x.earth", "/maps");
    EXPECT_EQ(sentenceOf(other).rfind("x.earth: <birdsEyeView>: ", 0), 0u) << other.errors[0];
}

TEST(EngineScene, MayNameItsSchemaAndMustBeUtf8)
{
    const SceneResult schema =
        parseMap("<map><geofx version='1' xmlns:xsi='http://www.w3.org/2001/XMLSchema-instance' "
                 "xsi:noNamespaceSchemaLocation='geofx.xsd'>" +
                 engine + "</geofx></map>");
    EXPECT_TRUE(schema.scene) << ::testing::PrintToString(schema.errors);
    osgGeoFX::SceneElement scene =
        engineElement("<geofx version='1'>" + engine + "<effects><birdsEyeView/></effects></geofx>");
    scene.children.back().children[0].children.push_back({"focusline", "\xe4", {}});
    EXPECT_NE(sentenceOf(osgGeoFX::parseEngineScene(scene, "", "x.earth", "/maps")).find("is not UTF-8"),
              std::string::npos);
    // A newer version, and text where elements are due.
    EXPECT_NE(
        sentenceOf(parseMap("<map><geofx version='9'>" + engine + "</geofx></map>")).find("A newer osgGeoFX"),
        std::string::npos);
    EXPECT_NE(sentenceOf(parseMap("<map><geofx version='1'>words" + engine + "</geofx></map>"))
                  .find("text stands inside"),
              std::string::npos);
}

} // namespace
