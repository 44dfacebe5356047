// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The names and lines of scene files: what <map> says, where they stand in the scene, and what is said of those that cannot be had.
#include <geofx/SceneFile.h>
#include <osgGeoFX/map/MapContents.h>
#include <osgGeoFX/map/MapReader.h>
#include <osgGeoFX/viewer/Scene.h>
#include <tools/EngineElements.h>
#include <tools/GeofxPlugins.h>
#include <tools/HeightMesh.h>
#include <tools/NotifyWatch.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <osg/CoordinateSystemNode>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgUtil/Optimizer>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace
{

namespace fs = std::filesystem;
using osgGeoFX::EffectScene;
using osgGeoFX::MapContents;
using osgGeoFX::MapLabels;
using osgGeoFX::MapLines;
using osgGeoFX::parseScene;
using osgGeoFX::SceneResult;

double heightAt(double x, double y)
{
    return 700.0 + 0.02 * x - 0.01 * y;
}

std::string collection(const std::string& features)
{
    return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32604"}},)"
           R"("features":[)" +
           features + "]}";
}

std::string point(const std::string& name, const std::string& style, int x, int y)
{
    return R"({"type":"Feature","properties":{"name":")" + name + R"(","style":")" + style +
           R"("},"geometry":{"type":"Point","coordinates":[)" + std::to_string(x) + "," + std::to_string(y) +
           "]}}";
}

std::string line(const std::string& style, int x)
{
    return R"({"type":"Feature","properties":{"style":")" + style +
           R"("},"geometry":{"type":"LineString","coordinates":[[)" + std::to_string(x) + ",500],[" +
           std::to_string(x) + ",4500]]}}";
}

/// A folder with a terrain on a plane, around the origin, and with names and lines.
class SceneMap : public geofx::test::GeofxPlugins
{
protected:
    void SetUp() override
    {
        const geofx::test::HeightMesh ground{heightAt};
        const osg::ref_ptr<osg::CoordinateSystemNode> root =
            new osg::CoordinateSystemNode("WKT", geofx::test::wktOf(32604));
        root->addChild(ground.mesh(80));
        ASSERT_TRUE(osgDB::writeNodeFile(*root, (_folder / "terrain.osgb").string()));
        _folder.write("names.geojson",
                      collection(point("Hut", "hut", 1200, 2300) + "," + point("Town", "town", -3000, 1700)));
        _folder.write("lines.geojson", collection(line("river", 2000)));
    }

    /// A scene whose <map> is on line 3, and what is in it on line 4.
    fs::path scene(const std::string& attributes, const std::string& inside,
                   const std::string& effects = "<effects><verticalExaggeration factor='2'/></effects>") const
    {
        return _folder.write("a.geofx", textOf(attributes, inside, effects));
    }
    static std::string textOf(const std::string& attributes, const std::string& inside,
                              const std::string& effects = "")
    {
        return "<geofx version='1'><terrain><database file='terrain.osgb'/></terrain>\n" + effects +
               "<background color='#ff0033'/>\n<map " + attributes + ">\n" + inside + "</map></geofx>";
    }

    osg::ref_ptr<osg::Node> read(const fs::path& file)
    {
        osg::ref_ptr<osg::Node> node;
        const auto messages = _watch.messagesOf([&] { node = osgDB::readRefNodeFile(file.string()); });
        EXPECT_TRUE(node);
        EXPECT_EQ(messages, std::vector<std::string>());
        return node;
    }
    void expectFault(const fs::path& file, const std::string& begins, const std::string& holds)
    {
        const std::string message = messageOf(file);
        EXPECT_NE(message.find("a.geofx:" + begins), std::string::npos) << message;
        EXPECT_NE(message.find(holds), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }

    geofx::test::TempDir _folder;
    geofx::test::NotifyWatch _watch;
};

template<class Kind>
Kind* childOf(osg::Node& node)
{
    osg::Group& group = *node.asGroup();
    for (unsigned int i = 0; i < group.getNumChildren(); ++i)
        if (auto* const found = dynamic_cast<Kind*>(group.getChild(i))) return found;
    return nullptr;
}

const std::string both = "<mapNames file='names.geojson'/><mapLines file='lines.geojson'/>";

} // namespace

TEST_F(SceneMap, SaysWhichFilesAndHowTheyLook)
{
    const SceneResult result = parseScene(
        textOf(
            "style='s.json' font='Noto Sans, DejaVu Sans' fontFile='f.ttf'",
            "<mapNames file='a.gpkg' layer='peaks'/><mapLines file='r.geojson'/><mapNames file='/b.gpkg'/>"),
        "a.geofx", "/scenes");
    ASSERT_TRUE(result.scene) << testing::PrintToString(result.errors);
    ASSERT_TRUE(result.scene->map);
    const osgGeoFX::SceneMap& map = *result.scene->map;
    EXPECT_EQ(map.style->path, "/scenes/s.json");
    EXPECT_EQ(map.fontFile->path, "/scenes/f.ttf");
    EXPECT_EQ(map.font, "Noto Sans, DejaVu Sans");
    ASSERT_EQ(map.names.size(), 2u);
    EXPECT_EQ(map.names[0].file.path + "|" + map.names[0].layer, "/scenes/a.gpkg|peaks");
    EXPECT_EQ(map.names[1].file.path + "|" + map.names[1].layer, "/b.gpkg|");
    ASSERT_EQ(map.lines.size(), 1u);
    EXPECT_EQ(map.lines[0].file.path, "/scenes/r.geojson");
    EXPECT_EQ(map.lines[0].file.place.line, 4);

    for (const char* wrong : {"<map/>", "<map><mapNames/></map>", "<map><mapNames file=''/></map>",
                              "<map><peaks file='a'/></map>", "<map><mapNames file='a' size='2'/></map>",
                              "<map color='red'><mapNames file='a'/></map>",
                              "<map><mapNames file='a'/></map><map><mapNames file='a'/></map>"})
    {
        const SceneResult refused =
            parseScene("<geofx version='1'><terrain><database file='terrain.osgb'/></terrain>\n" +
                           std::string(wrong) + "</geofx>",
                       "a.geofx", "/scenes");
        EXPECT_FALSE(refused.scene) << wrong;
        ASSERT_FALSE(refused.errors.empty()) << wrong;
        EXPECT_EQ(refused.errors[0].rfind("a.geofx:2: <", 0), 0u) << refused.errors[0];
    }
    // An engine's terrain is not there yet when its file is read.
    const SceneResult engine =
        geofx::test::parseMap("<map><geofx version='1'><terrain><engine/></terrain>\n<map><mapNames "
                              "file='a'/></map></geofx></map>");
    EXPECT_FALSE(engine.scene);
    ASSERT_EQ(engine.errors.size(), 1u);
    EXPECT_EQ(engine.errors[0].rfind("x.earth:2: <map>: names and lines are put on terrains", 0), 0u)
        << engine.errors[0];
}

TEST_F(SceneMap, NamesStandBesideTheSceneAndLinesBelowIt)
{
    for (const char* const effects : {"<effects><verticalExaggeration factor='2'/></effects>", ""})
    {
        const osg::ref_ptr<osg::Node> node = read(scene("", both, effects));
        ASSERT_TRUE(node);
        EXPECT_EQ(node->getName(), "osgGeoFX scene");
        const auto* const below = childOf<EffectScene>(*node);
        const auto* const labels = childOf<MapLabels>(*node);
        ASSERT_TRUE(below && labels);
        auto* const lines = childOf<MapLines>(const_cast<EffectScene&>(*below));
        ASSERT_TRUE(lines);
        EXPECT_TRUE(labels->isShown() && lines->isShown());

        // On the ground, which has no effect yet.
        const auto& names = const_cast<MapLabels*>(labels)->getNames()->names();
        ASSERT_EQ(names.size(), 2u);
        for (const osgGeoFX::MapName& name : names)
        {
            const osg::Vec2d place =
                name.text == "Hut" ? osg::Vec2d(1200.0, 2300.0) : osg::Vec2d(-3000.0, 1700.0);
            ASSERT_EQ(name.places.size(), 1u);
            EXPECT_LT((name.places[0] - osg::Vec3d(place, heightAt(place.x(), place.y()))).length(), 1.0)
                << name.text;
        }
        ASSERT_EQ(lines->lines().size(), 1u);
        for (const osg::Vec3d& place : lines->lines()[0].places)
        {
            EXPECT_NEAR(place.x(), 2000.0, 0.1);
            EXPECT_NEAR(place.z(), heightAt(place.x(), place.y()), 1.0);
        }

        // Programs find the scene, and what it wishes.
        std::string error;
        const std::optional<osgGeoFX::Scene> adopted = osgGeoFX::Scene::adopt(node, error);
        ASSERT_TRUE(adopted) << error;
        EXPECT_EQ(adopted->effects, below);
        EXPECT_EQ(adopted->node, node);
        EXPECT_EQ(adopted->settings.background, osg::Vec4(1.0f, 0.0f, 0.2f, 1.0f));
    }
    // Lines alone need nothing beside the scene.
    const osg::ref_ptr<osg::Node> lines = read(scene("", "<mapLines file='lines.geojson'/>"));
    ASSERT_TRUE(lines && dynamic_cast<EffectScene*>(lines.get()));
    EXPECT_TRUE(childOf<MapLines>(*lines));
}

TEST_F(SceneMap, LooksAsItsStyleFileAndFontsSay)
{
    _folder.write("style.json", R"({"names": {"hut": {"size": 33}}, "lines": {"river": {"width": 7}}})");
    const osg::ref_ptr<osg::Node> node = read(scene("style='style.json' font='DejaVu Serif'", both));
    ASSERT_TRUE(node);
    MapContents map = MapContents::take(*node);
    EXPECT_EQ(map.styles.names["hut"].text.size, 33.0);
    EXPECT_EQ(map.styles.names["hut"].text.font.rfind("DejaVu Serif,", 0), 0u)
        << map.styles.names["hut"].text.font;
    EXPECT_EQ(map.styles.lines["river"].width, 7.0);
    EXPECT_NE(osgGeoFX::usualLineStyles()["river"].width, 7.0);
}

// What a program of pictures takes is what it would have read itself.
TEST_F(SceneMap, ProgramsTakeItOut)
{
    const osg::ref_ptr<osg::Node> node = read(scene("", both));
    ASSERT_TRUE(node);
    const MapContents map = MapContents::take(*node);
    EXPECT_FALSE(childOf<MapLabels>(*node));
    auto* const effects = childOf<EffectScene>(*node);
    ASSERT_TRUE(effects);
    EXPECT_FALSE(childOf<MapLines>(*effects));
    EXPECT_TRUE(MapContents::take(*node).empty());
    EXPECT_EQ(MapContents().digest(), "");

    osgGeoFX::MapReader reader(*node, *effects);
    MapContents again;
    std::vector<std::string> notices;
    std::string error;
    ASSERT_TRUE(reader.readNames((_folder / "names.geojson").string(), "", "", error)) << error;
    ASSERT_TRUE(reader.readLines((_folder / "lines.geojson").string(), "", "", error)) << error;
    ASSERT_TRUE(reader.place(again, notices, error)) << error;
    EXPECT_EQ(notices, std::vector<std::string>());
    ASSERT_EQ(again.names.size(), map.names.size());
    // A set has the most important ones first; these two have no importance.
    for (std::size_t i = 0; i < map.names.size(); ++i)
    {
        EXPECT_EQ(again.names[i].text, map.names[i].text);
        EXPECT_EQ(again.names[i].places, map.names[i].places);
    }
    EXPECT_EQ(again.digest(), map.digest());
    MapContents other = map;
    other.names[0].text += "x";
    EXPECT_NE(other.digest(), map.digest());
    other = map;
    other.styles.lines["river"].width += 0.001;
    EXPECT_NE(other.digest(), map.digest());
    other = map;
    other.lines[0].places[1].z() += 1e-6;
    EXPECT_NE(other.digest(), map.digest());

    // And shows it again.
    const osg::ref_ptr<osg::Node> shown = map.addTo(*effects, *node);
    EXPECT_NE(shown, node);
    EXPECT_TRUE(childOf<MapLabels>(*shown));
    EXPECT_TRUE(childOf<MapLines>(*effects));
    EXPECT_EQ(MapContents::take(*shown).digest(), map.digest());
}

// osgviewer optimizes what it has read; lines far from the world's origin must keep their own.
TEST_F(SceneMap, OsgsOptimizerLeavesItAsItIs)
{
    const osg::ref_ptr<osg::Node> node = read(scene("", both));
    ASSERT_TRUE(node);
    osgUtil::Optimizer().optimize(node);
    auto* const effects = childOf<EffectScene>(*node);
    ASSERT_TRUE(effects && childOf<MapLabels>(*node));
    struct Counter : public osg::NodeVisitor
    {
        Counter() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::MatrixTransform& found) override
        {
            moved += found.getMatrix().getTrans().length() > 1000.0 ? 1 : 0;
            traverse(found);
        }
        int moved = 0;
    } counter;
    auto* const lines = childOf<MapLines>(*effects);
    ASSERT_TRUE(lines);
    lines->accept(counter);
    EXPECT_GT(counter.moved, 0);
}

TEST_F(SceneMap, FaultsAreSentencesWithTheirPlace)
{
    expectFault(scene("", "<mapNames file='none.geojson'/>"), "4: <mapNames>: ", "does not exist");
    expectFault(scene("", "<mapLines file='none.geojson'/>"), "4: <mapLines>: ", "does not exist");
    expectFault(scene("style='none.json'", both), "3: <map>: ", "attribute \"style\"");
    expectFault(scene("fontFile='none.ttf'", both), "3: <map>: ", "attribute \"fontFile\"");
    _folder.write("bare.geojson",
                  collection(R"({"type":"Feature","properties":{"name":"Nowhere"},"geometry":null})"));
    expectFault(scene("", "\n<mapNames file='bare.geojson'/>"),
                "5: <mapNames>: ", "bare.geojson: it has no feature with a name and a place");
    expectFault(scene("", both + "\n<mapLines file='bare.geojson'/>"),
                "5: <mapLines>: ", "bare.geojson: it has no lines");
    expectFault(scene("", "<mapNames file='names.geojson' layer='none'/>"), "4: <mapNames>: ", "none");
    _folder.write("text.geojson", "no vectors");
    expectFault(scene("", "<mapNames file='text.geojson'/>"), "4: <mapNames>: ", "text.geojson");
    _folder.write("style.json", R"({"names": {"hut": {"colour": "#ffffff"}}})");
    expectFault(scene("style='style.json'", both), "3: <map>: ", "\"colour\" is not known; there are font");
    _folder.write("style.json", "{");
    expectFault(scene("style='style.json'", both), "3: <map>: ", "is no style file");
    _folder.write("font.ttf", "no font");
    expectFault(scene("fontFile='font.ttf'", both), "3: <map>: ", "is not a font");
    _folder.write("away.geojson", collection(point("Away", "", 400000, 400000)));
    expectFault(scene("", "<mapNames file='away.geojson'/>"),
                "3: <map>: ", "All 1 names lie beside the terrain");
    _folder.write("away.geojson", collection(line("river", 400000)));
    expectFault(scene("", "<mapLines file='away.geojson'/>"),
                "3: <map>: ", "All 1 lines lie beside the terrain");
}

TEST_F(SceneMap, WhatLiesBesideTheTerrainIsSaidAndLeftOut)
{
    _folder.write("names.geojson",
                  collection(point("Hut", "hut", 1200, 2300) + "," + point("Away", "", 400000, 0)));
    osg::ref_ptr<osg::Node> node;
    const auto messages = _watch.messagesOf(
        [&] { node = osgDB::readRefNodeFile(scene("", "<mapNames file='names.geojson'/>").string()); });
    ASSERT_TRUE(node);
    ASSERT_EQ(messages.size(), 1u) << testing::PrintToString(messages);
    EXPECT_NE(messages[0].find("a.geofx:3: <map>: 1 of 2 names lie beside the terrain and are left out."),
              std::string::npos)
        << messages[0];
    EXPECT_EQ(MapContents::take(*node).names.size(), 1u);
}

TEST_F(SceneMap, StandsInTheOutermostScene)
{
    const fs::path inner = scene("", both);
    fs::rename(inner, _folder / "inner.geofx");
    const fs::path outer = _folder.write(
        "a.geofx", "<geofx version='1'><terrain><database file='inner.geofx'/></terrain></geofx>");
    const std::string message = messageOf(outer);
    EXPECT_NE(message.find("inner.geofx:3: <map>: this scene is the terrain of another one"),
              std::string::npos)
        << message;
    // By itself it is read.
    EXPECT_TRUE(read(_folder / "inner.geofx"));
}

TEST_F(SceneMap, WithoutThePluginASentenceSaysWhatToDo)
{
    // A folder with osgdb_geofx alone.
    const fs::path scene = this->scene("", both);
    fs::path found;
    for (const auto& entry : fs::recursive_directory_iterator(GEOFX_BUILD_DIR "/lib"))
        if (entry.path().filename() == "osgdb_geofx.so") found = entry.path();
    ASSERT_FALSE(found.empty());
    const fs::path plugins = _folder / "lib" / found.parent_path().filename();
    fs::create_directories(plugins);
    fs::create_symlink(found, plugins / "osgdb_geofx.so");
    // The kit finds plugins beside its library, so the library lies there, too.
    const fs::path libraries = found.parent_path().parent_path();
    for (const auto& entry : fs::directory_iterator(libraries))
        if (!entry.is_directory())
            fs::create_symlink(entry.path(), _folder / "lib" / entry.path().filename());
    geofx::test::ProgramOptions options;
    options.environment = {"OSG_LIBRARY_PATH=" + (_folder / "lib").string(),
                           "LD_LIBRARY_PATH=" + (_folder / "lib").string()};
    const auto alone =
        geofx::test::runProgram({geofx::test::builtProgram("read_scene"), scene.string()}, options);
    EXPECT_EQ(alone.exitCode, 1);
    EXPECT_NE(
        alone.standardError.find("a.geofx:3: <map>: names and lines are put onto scenes by the OSG plugin "
                                 "osgdb_geofxmaps, which was not found"),
        std::string::npos)
        << alone.standardError;
    // The same with it, but without the one that reads vector data.
    fs::create_symlink(found.parent_path() / "osgdb_geofxmaps.so", plugins / "osgdb_geofxmaps.so");
    const auto without =
        geofx::test::runProgram({geofx::test::builtProgram("read_scene"), scene.string()}, options);
    EXPECT_EQ(without.exitCode, 1);
    EXPECT_NE(without.standardError.find("a.geofx:4: <mapNames>: "), std::string::npos)
        << without.standardError;
    EXPECT_NE(without.standardError.find("osgdb_geofxdata, which reads vector data, was not found"),
              std::string::npos)
        << without.standardError;
    // With both.
    fs::create_symlink(found.parent_path() / "osgdb_geofxdata.so", plugins / "osgdb_geofxdata.so");
    const auto all =
        geofx::test::runProgram({geofx::test::builtProgram("read_scene"), scene.string()}, options);
    EXPECT_EQ(all.exitCode, 0) << all.standardError;
    EXPECT_EQ(all.standardError, "");
}

// OSG's files keep all but names and lines, and OSG says which classes it leaves out.
TEST_F(SceneMap, FilesOfOsgKeepTheRest)
{
    const osg::ref_ptr<osg::Node> node = read(scene("", both));
    ASSERT_TRUE(node);
    for (const char* const name : {"a.osgt", "a.osgb"})
    {
        SCOPED_TRACE(name);
        const std::string saved = (_folder / name).string();
        osg::ref_ptr<osg::Node> again;
        const auto messages = _watch.messagesOf(
            [&]
            {
                EXPECT_TRUE(osgDB::writeNodeFile(*node, saved));
                again = osgDB::readRefNodeFile(saved);
            });
        EXPECT_TRUE(std::any_of(messages.begin(), messages.end(),
                                [](const std::string& message)
                                { return message.find("osgGeoFX::MapLabels") != std::string::npos; }))
            << testing::PrintToString(messages);
        ASSERT_TRUE(again);
        const auto* const effects = childOf<EffectScene>(*again);
        ASSERT_TRUE(effects);
        ASSERT_EQ(effects->getNumEffects(), 1u);
        EXPECT_EQ(effects->getEffect(0)->getProperty("factor"), 2.0);
        EXPECT_TRUE(childOf<osg::CoordinateSystemNode>(const_cast<EffectScene&>(*effects)));
        EXPECT_TRUE(MapContents::take(*again).empty());
    }
}
