// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The names of the page that osggeofx_panorama and osggeofx_render write.
#include <tools/GlFixture.h>
#include <tools/InventedTerrain.h>
#include <tools/RandomSamples.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <nlohmann/json.hpp>
#include <osg/Vec2d>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>

using geofx::test::ProgramResult;
using geofx::test::TempDir;

namespace fs = std::filesystem;

namespace
{

class WebNamesTest : public geofx::test::GlFixture
{
protected:
    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        geofx::test::inventTerrain("volcano", (_folder / "volcano.tif").string(),
                                   geofx::test::fullTest() ? 301 : 151);
    }
    ProgramResult run(const std::string& program, std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), geofx::test::builtProgram(program));
        geofx::test::ProgramOptions options;
        options.folder = _folder.path().string();
        options.environment = {"DISPLAY=", "LC_ALL=de_DE.UTF-8"};
        return geofx::test::runProgram(arguments, options);
    }
    ProgramResult panorama(std::vector<std::string> arguments)
    {
        arguments.insert(arguments.end(), {"--samples", "0", "--quiet", "--work", "work"});
        return run("osggeofx_panorama", arguments);
    }
    std::string bytes(const std::string& name) const
    {
        std::ifstream stream(_folder / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    }
    nlohmann::json data(const std::string& page, const std::string& key) const
    {
        const std::string text = bytes(page + "/data/" + key + ".js");
        const std::size_t from = text.find('{');
        return from == std::string::npos ? nlohmann::json()
                                         : nlohmann::json::parse(text.substr(from, text.rfind(';') - from));
    }
    /// Names all over the volcano, `count` by `count`, and one along a line.
    void writeNames(int count) const
    {
        const auto at = [](double x, double y) // 0…1 over the terrain
        {
            return nlohmann::json({173.8 + 0.6 * x, -39.6 + 0.6 * y});
        };
        nlohmann::json json = {{"type", "FeatureCollection"}, {"features", nlohmann::json::array()}};
        for (int i = 0; i < count * count; ++i)
            json["features"].push_back(
                {{"type", "Feature"},
                 {"properties",
                  {{"name", "Place " + std::to_string(i)},
                   {"style", i % 3 ? "hut" : "tower"},
                   {"importance", i * 7 % 100},
                   {"ele", 1000 + i}}},
                 {"geometry",
                  {{"type", "Point"},
                   {"coordinates", at((0.5 + i % count) / count, (0.5 + i / count) / count)}}}});
        json["features"].push_back(
            {{"type", "Feature"},
             {"properties", {{"name", "Range"}, {"style", "range"}, {"importance", 50}}},
             {"geometry",
              {{"type", "LineString"},
               {"coordinates", {at(0.2, 0.4), at(0.4, 0.45), at(0.6, 0.45), at(0.8, 0.4)}}}}});
        std::ofstream(_folder / "names.geojson") << json.dump();
        std::ofstream(_folder / "style.json")
            << R"({"names": {"hut": {"manner": "beside", "dot": 2, "size": 11}, "tower": {"size": 13}}})";
        // So small that every name has room.
        std::ofstream(_folder / "tiny.json")
            << R"({"names": {"hut": {"manner": "beside", "dot": 1, "size": 1}, "tower": {"size": 1, "dot": 1}, "range": {"size": 1}}})";
    }

    TempDir _folder;
};

struct Box
{
    double left, top, right, bottom;
    bool meets(const Box& other) const
    {
        return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
    }
};

} // namespace

// The page has the names that the picture of the same view has, each at its place there: those of an SVG file, which is made another way.
TEST_F(WebNamesTest, AreThoseOfThePicture)
{
    writeNames(16);
    const ProgramResult web =
        panorama({"volcano.tif", "-o", "web.png", "--size", "640x360", "--labels", "names.geojson", "--style",
                  "tiny.json", "--svg", "names.svg", "--web", "page", "--title", "Volcano"});
    ASSERT_EQ(web.exitCode, 0) << web.standardError;
    EXPECT_EQ(web.standardError, "");
    EXPECT_FALSE(fs::exists(_folder / "web.plain.tif"));
    std::map<std::string, osg::Vec2d> expected;
    const std::string svg = bytes("names.svg");
    const std::regex entry("<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"[^>]*>\\s*<text[^>]*>(Place [0-9]+)<");
    for (auto i = std::sregex_iterator(svg.begin(), svg.end(), entry); i != std::sregex_iterator(); ++i)
        expected[(*i)[3]].set(std::stod((*i)[1]), std::stod((*i)[2]));
    ASSERT_GT(expected.size(), 60u) << svg.substr(0, 2000);
    ASSERT_LT(expected.size(), 230u) << "some must be hidden";
    const nlohmann::json names = data("page", "names");
    std::set<std::string> found;
    bool range = false;
    for (const auto& name : names["names"])
    {
        const std::string text = name["text"];
        if (text == "Range")
        {
            range = name["curve"].size() > 4 && !name.contains("height");
            continue;
        }
        found.insert(text);
        EXPECT_EQ(name["height"], 1000 + std::stoi(text.substr(6))) << "as the data say";
        const int index = std::stoi(text.substr(6));
        EXPECT_NEAR(name["place"][0].get<double>(), 173.8 + 0.6 * (0.5 + index % 16) / 16, 1e-5);
        EXPECT_NEAR(name["place"][1].get<double>(), -39.6 + 0.6 * (0.5 + index / 16) / 16, 1e-5);
        if (!expected.count(text)) continue;
        EXPECT_NEAR(name["at"][0].get<double>(), expected[text].x(), 0.02) << text;
        EXPECT_NEAR(name["at"][1].get<double>(), expected[text].y(), 0.02) << text;
    }
    EXPECT_TRUE(range);
    // The page's depths are those of the ground; in the picture strokes hide a few names more.
    std::size_t missing = 0, more = 0;
    for (const auto& [text, place] : expected)
        missing += found.count(text) ? 0 : 1;
    for (const std::string& text : found)
        more += expected.count(text) ? 0 : 1;
    EXPECT_LE(missing, 2u);
    EXPECT_LE(more, expected.size() / 8);
}

// At no zoom do two names overlap; each zoom has room for more; and the most important ones come first.
TEST_F(WebNamesTest, HaveRoomAtEachZoom)
{
    writeNames(16);
    const ProgramResult web = panorama({"volcano.tif", "-o", "web.png", "--size", "800x450", "--labels",
                                        "names.geojson", "--style", "style.json", "--web", "page"});
    ASSERT_EQ(web.exitCode, 0) << web.standardError;
    const nlohmann::json picture = data("page", "picture"), names = data("page", "names")["names"];
    EXPECT_EQ(picture["title"], "web");
    const int zoom = picture["zoom"], last = 4 * (zoom + 1);
    ASSERT_EQ(zoom, 2);
    std::size_t former = 0, first = 0;
    for (int step = 0; step <= last; ++step)
    {
        const double scale = std::exp2(step / 4.0 - zoom);
        std::vector<Box> boxes;
        bool best = false;
        for (const auto& name : names)
        {
            if (name.contains("curve")) continue;
            int times = 0;
            for (const auto& shown : name["shown"])
            {
                if (step < shown[0] || step > shown[1]) continue;
                ++times;
                const double left = name["at"][0].get<double>() * scale + shown[2].get<double>(),
                             top = name["at"][1].get<double>() * scale + shown[3].get<double>();
                boxes.push_back(
                    {left, top, left + name["size"][0].get<double>(), top + name["size"][1].get<double>()});
                EXPECT_GE(left, -0.1);
                EXPECT_GE(top, -0.1);
                EXPECT_LE(boxes.back().right, 800 * scale + 0.1);
                EXPECT_LE(boxes.back().bottom, 450 * scale + 0.1);
            }
            EXPECT_LE(times, 1) << name["text"];
            best = best || (times == 1 && name == names[0]);
        }
        for (std::size_t i = 0; i < boxes.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_FALSE(boxes[i].meets(boxes[k])) << "step " << step;
        EXPECT_TRUE(best || step < 4) << "step " << step;
        EXPECT_GE(boxes.size() * 10, former * 9) << "step " << step;
        former = boxes.size();
        if (step == 4) first = former;
    }
    EXPECT_GT(former, 2 * first);
    // None comes and goes: a name that is shown at a zoom is shown at nearly all that are nearer.
    std::size_t gaps = 0;
    for (const auto& name : names)
        for (std::size_t i = 0; i < name["shown"].size(); ++i)
            gaps += (i + 1 < name["shown"].size() ? name["shown"][i + 1][0].get<int>() : last + 1) >
                            name["shown"][i][1].get<int>() + 1
                        ? 1
                        : 0;
    EXPECT_LE(gaps, names.size() / 10);
}

// A picture that is drawn in tiles has the same page, without a name on it.
TEST_F(WebNamesTest, ArePartOfPrintsAndOfOtherScenes)
{
    writeNames(8);
    const ProgramResult print =
        panorama({"volcano.tif", "-o", "print.png", "--size", "640x360@100dpi", "--labels", "names.geojson",
                  "--style", "style.json", "--web", "printed"});
    ASSERT_EQ(print.exitCode, 0) << print.standardError;
    const ProgramResult once = panorama({"volcano.tif", "-o", "once.png", "--size", "640x360", "--labels",
                                         "names.geojson", "--style", "style.json", "--web", "once"});
    ASSERT_EQ(once.exitCode, 0) << once.standardError;
    EXPECT_EQ(data("printed", "names"), data("once", "names"));
    EXPECT_EQ(data("printed", "places"), data("once", "places"));
    for (const char* const tile : {"0/0/0", "2/1/0", "2/2/1"})
        EXPECT_TRUE(bytes(std::string("printed/tiles/") + tile + ".jpg") ==
                    bytes(std::string("once/tiles/") + tile + ".jpg"));
    // Without names the tiles are the same: none is drawn onto them.
    const ProgramResult plain =
        panorama({"volcano.tif", "-o", "plain.png", "--size", "640x360", "--web", "plain"});
    ASSERT_EQ(plain.exitCode, 0) << plain.standardError;
    EXPECT_TRUE(bytes("plain/tiles/0/0/0.jpg") == bytes("once/tiles/0/0/0.jpg"));
    EXPECT_TRUE(data("plain", "names")["names"].empty());
    EXPECT_FALSE(bytes("plain.png") == bytes("once.png"));

    std::string terrain;
    for (const auto& file : fs::recursive_directory_iterator(_folder / "work"))
        if (file.path().filename() == "terrain.osgb") terrain = file.path().string();
    const ProgramResult scene =
        run("osggeofx_render",
            {terrain, "-o", "scene.png", "--size", "400x300", "--view", "174.1,-39.3,60000,0,-90", "--labels",
             "names.geojson", "--style", "style.json", "--web", "scene"});
    ASSERT_EQ(scene.exitCode, 0) << scene.standardError;
    EXPECT_GT(data("scene", "names")["names"].size(), 5u);
    EXPECT_GT(data("scene", "places")["columns"].get<int>(), 100);
}

TEST_F(WebNamesTest, RefusesBeforeItDraws)
{
    fs::create_directory(_folder / "mine");
    std::ofstream(_folder / "mine/letter.txt") << "mine";
    const ProgramResult result =
        panorama({"volcano.tif", "-o", "map.png", "--size", "640x360", "--web", "mine"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_NE(result.standardError.find("--web"), std::string::npos) << result.standardError;
    EXPECT_NE(result.standardError.find("no page of osgGeoFX"), std::string::npos) << result.standardError;
    EXPECT_FALSE(fs::exists(_folder / "map.png"));
    EXPECT_FALSE(fs::exists(_folder / "work"));
    std::ofstream(_folder / "path.csv")
        << "time,lon,lat,alt,heading,pitch\n0,174,-38.7,9000,0,-30\n1,174,-38.7,9000,9,-30\n";
    const ProgramResult path = run("osggeofx_render", {"volcano.tif", "-o", "f%02d.png", "--path", "path.csv",
                                                       "--frames", "2", "--web", "new"});
    EXPECT_EQ(path.exitCode, 2);
    EXPECT_NE(path.standardError.find("leave --path out"), std::string::npos) << path.standardError;
}
