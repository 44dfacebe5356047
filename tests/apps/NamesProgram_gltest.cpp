// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Names on the pictures of osggeofx_panorama and osggeofx_render, as a person asks for them.
#include <tools/MapProgram.h>

#include <osg/Image>
#include <osgDB/ReadFile>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

using geofx::test::ProgramResult;

namespace fs = std::filesystem;

namespace
{

class NamesProgram : public geofx::test::MapProgram
{
protected:
    void writeNames(const std::string& features) const { write("names.geojson", collection(features)); }
};

} // namespace

// A name lies where --pick says that its place is: in the SVG file, and in the picture.
TEST_F(NamesProgram, LiesWhereThePlaceIsPicked)
{
    const osg::Vec2d place = placeOf(225, 188);
    writeNames(pointFeature("Hütte <&>", "hut", place));
    write(
        "style.json",
        R"({"names": {"hut": {"manner": "beside", "dot": 4, "color": "#ff00ff", "halo": "#ff00ff", "size": 26}}})");
    const ProgramResult vectors = panorama({"plain.json", "-o", "map.png", "--labels", "names.geojson",
                                            "--style", "style.json", "--svg", "names.svg"});
    ASSERT_EQ(vectors.exitCode, 0) << vectors.standardError;
    EXPECT_EQ(vectors.standardError, "");
    EXPECT_TRUE(bytes("map.png") == bytes("plain.png")) << "the names are in the SVG file";
    const std::string svg = bytes("names.svg");
    std::smatch match;
    ASSERT_TRUE(std::regex_search(svg, match, std::regex("circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\""))) << svg;
    EXPECT_NEAR(std::stod(match[1]), 225.5, 0.5);
    EXPECT_NEAR(std::stod(match[2]), 188.5, 0.5);
    EXPECT_NE(svg.find("Hütte &lt;&amp;&gt;</text>"), std::string::npos);
    EXPECT_NE(svg.find("xlink:href=\"map.png\""), std::string::npos);

    const ProgramResult raster =
        panorama({"plain.json", "-o", "named.png", "--labels", "names.geojson", "--style", "style.json"});
    ASSERT_EQ(raster.exitCode, 0) << raster.standardError;
    const osg::ref_ptr<osg::Image> plain = osgDB::readRefImageFile(file("plain.png"));
    const osg::ref_ptr<osg::Image> named = osgDB::readRefImageFile(file("named.png"));
    ASSERT_TRUE(plain && named);
    int dot = 0, far = 0;
    for (unsigned int y = 0; y < HEIGHT; ++y)
    {
        for (unsigned int x = 0; x < WIDTH; ++x)
        {
            if (plain->getColor(x, y) == named->getColor(x, y)) continue;
            const double dx = x + 0.5 - 225.5, dy = HEIGHT - 1 - static_cast<int>(y) + 0.5 - 188.5;
            // The dot is 4 pixels at a height of 900.
            dot += std::hypot(dx, dy) < 2.0 ? 1 : 0;
            far += dx < -60.0 || dx > 60.0 || std::abs(dy) > 12.0 ? 1 : 0;
        }
    }
    EXPECT_GE(dot, 3);
    EXPECT_EQ(far, 0);

    // A recipe has the names, too.
    const ProgramResult again =
        run("osggeofx_panorama", {"named.json", "-o", "again.png", "--work", "work", "--quiet"});
    ASSERT_EQ(again.exitCode, 0) << again.standardError;
    EXPECT_TRUE(bytes("again.png") == bytes("named.png"));
}

TEST_F(NamesProgram, IsOnPicturesOfAnyScene)
{
    const osg::Vec2d place = placeOf(240, 180);
    writeNames(pointFeature("Middle", "hut", place));
    char view[120];
    std::snprintf(view, sizeof(view), "%.6f,%.6f,60000,0,-90", place.x(), place.y());
    std::string terrain;
    for (const auto& entry : fs::recursive_directory_iterator(file("work")))
        if (entry.path().filename() == "terrain.osgb") terrain = entry.path().string();
    ASSERT_FALSE(terrain.empty());
    const auto draw = [&](const std::string& output, std::vector<std::string> more)
    {
        more.insert(more.begin(), {terrain, "-o", output, "--size", "400x300", "--view", view});
        const ProgramResult result = run("osggeofx_render", more);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        return osgDB::readRefImageFile(file(output));
    };
    const osg::ref_ptr<osg::Image> plain = draw("a.png", {}),
                                   named = draw("b.png", {"--labels", "names.geojson"});
    ASSERT_TRUE(plain && named);
    int near = 0, far = 0;
    for (unsigned int y = 0; y < 300; ++y)
    {
        for (unsigned int x = 0; x < 400; ++x)
        {
            if (plain->getColor(x, y) == named->getColor(x, y)) continue;
            const bool close = std::abs(static_cast<double>(x) - 200.0) < 60.0 &&
                               std::abs(static_cast<double>(y) - 150.0) < 40.0;
            (close ? near : far) += 1;
        }
    }
    EXPECT_GT(near, 30);
    EXPECT_EQ(far, 0);
}

TEST_F(NamesProgram, FaultsAreSentences)
{
    writeNames(pointFeature("Elsewhere", "", {100.0, -80.0}));
    const auto faultOf = [&](std::vector<std::string> more)
    {
        more.insert(more.begin(), {"plain.json", "-o", "map.png"});
        const ProgramResult result = panorama(more);
        EXPECT_EQ(result.exitCode, 2) << result.standardError;
        EXPECT_FALSE(fs::exists(file("map.png")));
        return result.standardError;
    };
    EXPECT_NE(faultOf({"--labels", "names.geojson"}).find("lie beside the terrain"), std::string::npos);
    EXPECT_NE(faultOf({"--labels", "none.gpkg"}).find("none.gpkg"), std::string::npos);
    EXPECT_NE(faultOf({"--svg", "names.svg"}).find("--labels"), std::string::npos);
    write("style.json", R"({"names": {"peak": {"size": 12}}})");
    EXPECT_NE(faultOf({"--style", "style.json"}).find("give some with --labels"), std::string::npos);
    write("style.json", R"({"names": {"peak": {"size": -3}}})");
    EXPECT_NE(faultOf({"--labels", "names.geojson", "--style", "style.json"})
                  .find("\"size\" must be a number from"),
              std::string::npos);
    write("style.json", R"({"names": {"peak": {"colour": "#ffffff"}}})");
    EXPECT_NE(faultOf({"--labels", "names.geojson", "--style", "style.json"}).find("\"colour\" is not known"),
              std::string::npos);
    write("style.json", "{");
    EXPECT_NE(faultOf({"--labels", "names.geojson", "--style", "style.json"}).find("is no style file"),
              std::string::npos);
    write("style.json", R"({"nameField": 3})");
    EXPECT_NE(
        faultOf({"--labels", "names.geojson", "--style", "style.json"}).find("\"nameField\" must be a text"),
        std::string::npos);
    EXPECT_NE(faultOf({"--label-field", "nom"}).find("give some with --labels"), std::string::npos);
    EXPECT_NE(faultOf({"--labels", "names.geojson", "--label-field", "nom"}).find("no field \"nom\""),
              std::string::npos);
    write("font.ttf", "no font");
    EXPECT_NE(faultOf({"--labels", "names.geojson", "--font", "font.ttf"}).find("is not a font"),
              std::string::npos);
}
