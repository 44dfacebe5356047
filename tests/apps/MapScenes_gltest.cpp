// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Scene files with names and lines: in the pictures of programs, which are those of the options --labels and --lines, and live.
#include <osgGeoFX/map/MapKeys.h>
#include <osgGeoFX/viewer/Scene.h>
#include <tools/MapProgram.h>

#include <OpenThreads/Thread>
#include <osg/Image>
#include <osg/Math>
#include <osgDB/ReadFile>
#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <vector>

using geofx::test::ProgramResult;

namespace fs = std::filesystem;

namespace
{

class MapScenes : public geofx::test::MapProgram
{
protected:
    void SetUp() override
    {
        MapProgram::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        osgDB::Registry::instance()->getLibraryFilePathList().push_front(GEOFX_BUILD_DIR "/lib");
        _from = placeOf(200, 200);
        const osg::Vec2d to = _from + osg::Vec2d(0.02, 0.0), hut = _from + osg::Vec2d(0.005, 0.01);
        write("names.geojson", namesAt("Zirbenhütte", hut));
        write("lines.geojson", collection(lineFeature("trail", _from, to)));
        write("style.json",
              R"({"lines": {"trail": {"color": "#ff00ff", "width": 14, "least": 14, "hand": 0}},
                 "names": {"hut": {"manner": "beside", "color": "#ff00ff", "halo": "#ff00ff", "size": 40}}})");
        for (const auto& entry : fs::recursive_directory_iterator(file("work")))
            if (entry.path().filename() == "terrain.osgb")
                _terrain = entry.path().lexically_relative(_folder.path()).string();
        ASSERT_FALSE(_terrain.empty());
        // From above, so that all is in sight.
        char text[200];
        std::snprintf(text, sizeof(text),
                      "<homeView longitude='%.6f' latitude='%.6f' height='30000' heading='20' pitch='-90'/>",
                      hut.x(), hut.y());
        _view = text;
        write("plain.geofx", sceneWith(""));
        write("map.geofx", sceneWith("<map style='style.json'><mapNames file='names.geojson'/><mapLines "
                                     "file='lines.geojson'/></map>"));
    }

    static std::string namesAt(const std::string& name, const osg::Vec2d& place)
    {
        return collection(pointFeature(name, "hut", place));
    }

    std::string sceneWith(const std::string& map) const
    {
        return "<geofx version='1'><terrain><database file='" + _terrain + "'/></terrain>\n" + _view +
               "<effects><verticalExaggeration factor='1.5'/></effects>\n" + map + "</geofx>";
    }

    /// What osggeofx_render writes for a scene, and the warnings.
    std::string rendered(const std::string& scene, const std::string& output,
                         std::vector<std::string> more = {}, const std::string& size = "480x270")
    {
        more.insert(more.begin(), {scene, "-o", output, "--size", size});
        const ProgramResult result = run("osggeofx_render", more);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        EXPECT_EQ(result.standardError, "");
        return bytes(output);
    }
    using MapProgram::magentaIn;
    int magentaIn(const std::string& name) const
    {
        const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(file(name));
        EXPECT_TRUE(image) << name;
        return image ? magentaIn(*image) : 0;
    }

    const std::vector<std::string> _options = {"--labels",      "names.geojson", "--lines",
                                               "lines.geojson", "--style",       "style.json"};
    std::string _terrain, _view;
    osg::Vec2d _from;
};

} // namespace

TEST_F(MapScenes, PicturesAreThoseOfTheOptions)
{
    const std::string plain = rendered("plain.geofx", "plain.png");
    const std::string scene = rendered("map.geofx", "map.png");
    EXPECT_TRUE(scene == rendered("plain.geofx", "options.png", _options));
    EXPECT_FALSE(scene == plain);
    EXPECT_EQ(magentaIn("plain.png"), 0);
    EXPECT_GT(magentaIn("map.png"), 400);

    // As vectors, and as a print in tiles.
    std::vector<std::string> vectors = _options;
    vectors.insert(vectors.end(), {"--svg", "options.svg"});
    EXPECT_TRUE(rendered("map.geofx", "map.png", {"--svg", "map.svg"}) == plain);
    rendered("plain.geofx", "map.png", vectors);
    EXPECT_NE(bytes("map.svg").find("Zirbenhütte</text>"), std::string::npos);
    EXPECT_NE(bytes("map.svg").find("class=\"line trail\""), std::string::npos);
    EXPECT_TRUE(bytes("map.svg") == bytes("options.svg"));
    rendered("map.geofx", "print.tif", {}, "6.4x3.6in@75dpi");
    rendered("plain.geofx", "other.tif", _options, "6.4x3.6in@75dpi");
    EXPECT_GT(magentaIn("print.tif"), 400);
    const osg::ref_ptr<osg::Image> print = osgDB::readRefImageFile(file("print.tif"));
    const osg::ref_ptr<osg::Image> other = osgDB::readRefImageFile(file("other.tif"));
    ASSERT_TRUE(print && other && print->getTotalSizeInBytes() == other->getTotalSizeInBytes());
    EXPECT_EQ(std::memcmp(print->data(), other->data(), print->getTotalSizeInBytes()), 0);

    // The styles of the option are for the scene's, too.
    write("small.json", R"({"names": {"hut": {"size": 12}}, "lines": {"trail": {"width": 3, "least": 3}}})");
    rendered("map.geofx", "small.png", {"--style", "small.json"});
    EXPECT_LT(magentaIn("small.png"), magentaIn("options.png") / 2);
    EXPECT_GT(magentaIn("small.png"), 10);

    // Names of both.
    write("more.geojson", namesAt("Adlerhorst", _from - osg::Vec2d(0.01, 0.01)));
    rendered("map.geofx", "both.png", {"--labels", "more.geojson", "--svg", "both.svg"}, "960x540");
    const std::string both = bytes("both.svg");
    for (const char* const part : {"Zirbenhütte</text>", "Adlerhorst</text>", "class=\"line trail\""})
        EXPECT_NE(both.find(part), std::string::npos) << part;

    // Nothing to style and nothing to write.
    for (const std::vector<std::string>& given :
         {std::vector<std::string>{"--svg", "x.svg"}, {"--style", "style.json"}, {"--font", "Noto Sans"}})
    {
        std::vector<std::string> arguments = {"plain.geofx", "-o", "refused.png"};
        arguments.insert(arguments.end(), given.begin(), given.end());
        const ProgramResult refused = run("osggeofx_render", arguments);
        EXPECT_EQ(refused.exitCode, 2);
        EXPECT_NE(refused.standardError.find("give some with --labels"), std::string::npos)
            << refused.standardError;
        EXPECT_FALSE(fs::exists(file("refused.png")));
    }
}

// A panorama map of a scene file has the scene's names and lines.
TEST_F(MapScenes, PanoramasHaveThemToo)
{
    const auto made = [&](const std::string& scene, const std::string& output, std::vector<std::string> more)
    {
        more.insert(more.begin(), {scene, "-o", output});
        const ProgramResult result = panorama(more);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        return bytes(output);
    };
    EXPECT_TRUE(made("map.geofx", "map.png", {}) == made("plain.geofx", "options.png", _options));
    EXPECT_GT(magentaIn("map.png"), 100);
}

TEST_F(MapScenes, PrintsAreDrawnAnewWhenTheMapChanges)
{
    const std::string size = "6.4x3.6in@75dpi";
    // Tiles of a print that was begun: those of a plan.
    for (const std::vector<std::string>& call :
         {std::vector<std::string>{"map.geofx", "-o", "print.tif", "--size", size, "--plan", "plan"},
          {"--work", "plan", "--quiet", "--unit", "tiles"}})
    {
        const ProgramResult result = run("osggeofx_render", call);
        ASSERT_EQ(result.exitCode, 0) << result.standardError;
    }
    const fs::path tiles = fs::path("plan") / "work" / "tiles";
    const std::string tile = (tiles / "tile-0-0.tif").string();
    ASSERT_GT(magentaIn(tile), 0);
    // They are used again: the print has what somebody has painted onto them.
    geofx::test::ProgramOptions here;
    here.folder = file("");
    ASSERT_EQ(
        geofx::test::runProgram({"oiiotool", tile, "--fill:color=1,0,1", "20x20", "-o", tile}, here).exitCode,
        0);
    fs::copy(file(tiles.string()), file("print.tiles"));
    rendered("map.geofx", "print.tif", {}, size);
    EXPECT_GE(magentaIn("print.tif"), 400);
    EXPECT_FALSE(fs::exists(file("print.tiles")));
    fs::copy(file(tiles.string()), file("print.tiles"));
    write("style.json", R"({"lines": {"trail": {"color": "#00ff00", "width": 14, "least": 14}},
                           "names": {"hut": {"color": "#000000"}}})");
    rendered("map.geofx", "print.tif", {}, size);
    EXPECT_EQ(magentaIn("print.tif"), 0);
}

// As osgviewer shows it: names come when the depths of some frames are known, and fade away.
TEST_F(MapScenes, LiveScenesShowThemAndKeysHideThem)
{
    std::string error;
    const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(file("map.geofx"), error);
    ASSERT_TRUE(scene) << error;
    viewer().setLightingMode(osg::View::HEADLIGHT);
    viewer().getCamera()->setViewMatrix(
        scene->homeViewMatrix(osg::DegreesToRadians(30.0), static_cast<double>(WIDTH) / HEIGHT));
    viewer().getCamera()->setProjectionMatrixAsPerspective(30.0, static_cast<double>(WIDTH) / HEIGHT, 100.0,
                                                           1e6);
    osg::ref_ptr<osg::Image> picture;
    const auto frames = [&]
    {
        // The pager needs some time, and so does fading.
        for (int i = 0; i < 40; ++i)
        {
            picture = render(scene->node);
            OpenThreads::Thread::microSleep(25000);
        }
        return magentaIn(*picture);
    };
    const int both = frames();
    const osg::ref_ptr<osgGeoFX::MapKeys> keys = new osgGeoFX::MapKeys(*scene->node);
    ASSERT_TRUE(keys->hasNames() && keys->hasLines());
    const auto press = [&](int key)
    {
        const osg::ref_ptr<osgGA::GUIEventAdapter> event = new osgGA::GUIEventAdapter;
        event->setEventType(osgGA::GUIEventAdapter::KEYDOWN);
        event->setKey(key);
        EXPECT_TRUE(keys->handle(*event, viewer()));
    };
    press('n');
    const int lines = frames();
    press('r');
    const int nothing = frames();
    press('n');
    const int names = frames();
    press('r');
    EXPECT_EQ(nothing, 0);
    EXPECT_GT(lines, 100);
    EXPECT_GT(names, 100);
    EXPECT_GT(both, std::max(lines, names));
    EXPECT_LE(both, lines + names);
    EXPECT_EQ(frames(), both);
}

// Ground behind a close-up has no name in SVG and PDF files either, and names of the ground that it shows lie on it.
TEST_F(MapScenes, NamesOfVectorsKnowCloseUps)
{
    const double metre = 1.0 / 111320.0;
    const osg::Vec2d middle = _from;
    const auto beside = [&](double east, double north)
    {
        return middle + osg::Vec2d(east * metre / std::cos(osg::DegreesToRadians(middle.y())), north * metre);
    };
    const osg::Vec2d region = beside(-3000.0, 0.0);
    write("names.geojson", collection(pointFeature("Riding", "hut", region) + "," +
                                      pointFeature("Hidden", "hut", beside(2500.0, 300.0)) + "," +
                                      pointFeature("Open", "hut", beside(-500.0, 3500.0))));
    write("style.json", R"({"names": {"hut": {"manner": "beside", "dot": 4, "size": 40}}})");
    const auto sceneOf = [&](bool hasCloseUp)
    {
        char text[1000];
        std::snprintf(
            text, sizeof(text),
            "<geofx version='1'><terrain><database file='%s'/></terrain>\n<homeView longitude='%.6f' "
            "latitude='%.6f' height='30000' heading='0' pitch='-90'/>\n<effects><closeUps "
            "enabled='%s'><closeUp offsetX='5000' offsetHeight='5000'><region longitude='%.6f' "
            "latitude='%.6f' width='3000' depth='3000'/></closeUp></closeUps></effects>\n"
            "<map style='style.json'><mapNames file='names.geojson'/></map></geofx>",
            _terrain.c_str(), middle.x(), middle.y(), hasCloseUp ? "true" : "false", region.x(), region.y());
        return std::string(text);
    };
    write("with.geofx", sceneOf(true));
    write("without.geofx", sceneOf(false));
    const auto dotsIn = [&](const std::string& scene)
    {
        rendered(scene, "map.png", {"--svg", "map.svg"});
        const std::string svg = bytes("map.svg");
        std::map<std::string, double> places;
        const std::regex dot(R"x(circle cx="([0-9.]+)")x"), text(R"x(>([A-Z][a-z]+)</text>)x");
        std::vector<double> dots;
        for (std::sregex_iterator i(svg.begin(), svg.end(), dot), end; i != end; ++i)
            dots.push_back(std::stod((*i)[1]));
        std::vector<std::string> names;
        for (std::sregex_iterator i(svg.begin(), svg.end(), text), end; i != end; ++i)
            names.push_back((*i)[1]);
        EXPECT_EQ(dots.size(), names.size()) << svg;
        for (std::size_t i = 0; i < std::min(dots.size(), names.size()); ++i)
            places[names[i]] = dots[i];
        return places;
    };
    const std::map<std::string, double> without = dotsIn("without.geofx"), with = dotsIn("with.geofx");
    ASSERT_EQ(without.size(), 3u);
    ASSERT_EQ(with.size(), 2u);
    EXPECT_EQ(with.count("Hidden"), 0u);
    EXPECT_NEAR(with.at("Open"), without.at("Open"), 0.1);
    EXPECT_LT(without.at("Riding"), 210.0);
    EXPECT_NEAR(with.at("Riding"), without.at("Hidden"), 12.0);
    // The place that is written is the place of the text, too.
    const auto textOf = [&](const std::string& scene)
    {
        rendered(scene, "map.pdf", {}, "6.4x3.6in@75dpi");
        geofx::test::ProgramOptions options;
        options.folder = fs::path(_folder.path()).string();
        return geofx::test::runProgram({"/usr/bin/pdftotext", "-bbox", "map.pdf", "-"}, options)
            .standardOutput;
    };
    const auto wordAt = [&](const std::string& text, const std::string& word)
    {
        std::smatch match;
        const bool isThere = std::regex_search(
            text, match,
            std::regex("xMin=\"([0-9.]+)\" yMin=\"[0-9.]+\" xMax=\"([0-9.]+)\"[^>]*>" + word + "<"));
        return isThere ? 0.5 * (std::stod(match[1]) + std::stod(match[2])) : -1.0;
    };
    const std::string bare = textOf("without.geofx"), lifted = textOf("with.geofx");
    for (const char* const name : {"Riding", "Hidden", "Open"})
        EXPECT_GT(wordAt(bare, name), 0.0) << name << " in " << bare;
    EXPECT_EQ(wordAt(lifted, "Hidden"), -1.0) << lifted;
    EXPECT_NEAR(wordAt(lifted, "Open"), wordAt(bare, "Open"), 1.0);
    // From pixels to points.
    EXPECT_NEAR(wordAt(lifted, "Riding") - wordAt(bare, "Riding"),
                (with.at("Riding") - without.at("Riding")) * 72.0 / 75.0, 1.0);
}
