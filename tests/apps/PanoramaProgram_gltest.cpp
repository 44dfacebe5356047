// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The program osggeofx_panorama, as a person calls it, on terrains that it has never seen.
#include <tools/GlFixture.h>
#include <tools/InventedTerrain.h>
#include <tools/RandomSamples.h>
#include <tools/RunProgram.h>
#include <tools/SampledCases.h>
#include <tools/TempDir.h>

#include <nlohmann/json.hpp>
#include <osg/Image>
#include <osg/Vec2d>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

using geofx::test::ProgramResult;
using geofx::test::TempDir;

namespace fs = std::filesystem;

namespace
{

class PanoramaProgram : public geofx::test::GlFixture
{
protected:
    ProgramResult run(std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), geofx::test::builtProgram("osggeofx_panorama"));
        geofx::test::ProgramOptions options;
        options.folder = fs::path(_folder.path()).string();
        options.environment = {"DISPLAY=", "LC_ALL=de_DE.UTF-8"};
        return geofx::test::runProgram(arguments, options);
    }

    std::string file(const std::string& name) const { return (fs::path(_folder.path()) / name).string(); }

    void invent(const std::string& name, int samples = geofx::test::fullTest() ? 301 : 151)
    {
        geofx::test::inventTerrain(name, file(name + ".tif"), samples);
    }

    std::string bytes(const std::string& name) const
    {
        std::ifstream stream(file(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    }

    /// Of the maps, pixels.
    const int _width = geofx::test::fullTest() ? 320 : 160, _height = _width * 9 / 16;
    const std::string _size = std::to_string(_width) + "x" + std::to_string(_height);
    TempDir _folder;
};

/// The blank paper beyond the data.
bool isPaper(const osg::Vec4& color)
{
    return color.r() > 0.93f && color.g() > 0.90f && color.b() > 0.82f && color.r() > color.b();
}

} // namespace

TEST_F(PanoramaProgram, MakesAMapOfADemAndTheSameAgain)
{
    invent("volcano");
    const ProgramResult first =
        run({"volcano.tif", "-o", "map.png", "--size", _size, "--explain", "--quiet"});
    ASSERT_EQ(first.exitCode, 0) << first.standardError;
    EXPECT_EQ(first.standardError, "");
    for (const char* word : {"View: ", "Place: ", "Width: ", "Depth: ", "Horizon: ", "Exaggeration: ",
                             "Snow ", "Light: ", "Edges: none of the data's edges is in the picture."})
        EXPECT_NE(first.standardOutput.find(word), std::string::npos) << word;
    const osg::ref_ptr<osg::Image> picture = osgDB::readRefImageFile(file("map.png"));
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->s(), _width);
    EXPECT_EQ(picture->t(), _height);
    const int highest = _height * 5 / 9;
    int paper = 0;
    for (int x = 0; x < _width; ++x)
        for (int y = 0; y < highest; ++y)
            paper += isPaper(picture->getColor(static_cast<unsigned int>(x), static_cast<unsigned int>(y)));
    EXPECT_LT(paper, 0.0009 * _width * highest) << "no blank paper where the ground should be";
    EXPECT_FALSE(fs::exists(file("map.work"))) << "nothing is left behind";

    const nlohmann::json recipe = nlohmann::json::parse(bytes("map.json"));
    EXPECT_EQ(recipe.at("dems").at(0), "volcano.tif");
    EXPECT_GT(recipe.at("view").at("exaggeration").get<double>(), 0.3);
    const ProgramResult again = run({"map.json", "-o", "again.png", "--quiet"});
    ASSERT_EQ(again.exitCode, 0) << again.standardError;
    EXPECT_TRUE(bytes("map.png") == bytes("again.png")) << "the same to the byte";
}

// A recipe in another size is the same picture, so its strokes grow with it; those that were asked for stay.
TEST_F(PanoramaProgram, StrokesOfARecipeGrowWithTheSize)
{
    invent("volcano", 101);
    const auto make = [&](const std::string& source, const std::string& name, const std::string& size,
                          const std::vector<std::string>& more)
    {
        std::vector<std::string> arguments = {source,      "-o", name + ".png", "--size", size,
                                              "--samples", "0",  "--quiet",     "--work", "work"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        const nlohmann::json map = nlohmann::json::parse(bytes(name + ".json")).at("map");
        return osg::Vec2d(std::stod(map.value("strokeSize", "0")),
                          std::stod(map.value("strokeSpacing", "0")));
    };
    const osg::Vec2d small = make("volcano.tif", "small", "160x360", {});
    ASSERT_GT(small.x(), 1.0);
    const osg::Vec2d large = make("small.json", "large", "320x720", {});
    EXPECT_NEAR(large.x(), 2.0 * small.x(), 0.01);
    EXPECT_NEAR(large.y(), 2.0 * small.y(), 0.01);
    EXPECT_EQ(make("small.json", "own", "320x720", {"--set", "strokeSize=3"}).x(), 3.0);
    if (!geofx::test::fullTest()) return;
    // Of the usual height recipes do not name them.
    const osg::Vec2d usual = make("volcano.tif", "usual", "200x900", {});
    EXPECT_EQ(usual.x(), 0.0);
    EXPECT_NEAR(make("usual.json", "half", "100x450", {}).x(), 1.25 * small.x(), 0.01);
}

TEST_F(PanoramaProgram, TakesLibertiesWhereTheyAreAskedFor)
{
    invent("alps");
    const std::vector<std::string> size = {"--size", _size, "--explain", "--quiet", "--work", "work"};
    const auto map = [&](std::vector<std::string> arguments)
    {
        arguments.insert(arguments.end(), size.begin(), size.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        EXPECT_EQ(result.standardError, "");
        return result.standardOutput;
    };
    const std::string plain = map({"alps.tif", "-o", "plain.png"});
    EXPECT_FALSE(nlohmann::json::parse(bytes("plain.json")).contains("liberties"));
    EXPECT_EQ(plain.find(" is enlarged "), std::string::npos);

    const std::string explained = map({"--liberties", "alps.tif", "-o", "map.png"});
    const nlohmann::json recipe = nlohmann::json::parse(bytes("map.json"));
    const std::size_t count = recipe.at("liberties").size();
    ASSERT_GT(count, 0u);
    // A sentence for each, and the same view.
    std::size_t named = 0;
    for (const char* const what : {" is enlarged by ", " is widened by ", " is turned by "})
        for (std::size_t at = explained.find(what); at != std::string::npos;
             at = explained.find(what, at + 1))
            ++named;
    EXPECT_EQ(named, count) << explained;
    EXPECT_EQ(recipe.at("view"), nlohmann::json::parse(bytes("plain.json")).at("view"));
    EXPECT_FALSE(bytes("map.png") == bytes("plain.png"));
    map({"map.json", "-o", "again.png"});
    EXPECT_TRUE(bytes("map.png") == bytes("again.png")) << "the same to the byte";
    EXPECT_EQ(nlohmann::json::parse(bytes("again.json")).at("liberties"), recipe.at("liberties"));

    // One by hand, where the picture looks.
    const osg::Vec2d base(recipe.at("view").at("place").at(0).get<double>(),
                          recipe.at("view").at("place").at(1).get<double>());
    const std::string own =
        map({"plain.json", "-o", "own.png", "--liberty",
             std::to_string(base.x()) + "," + std::to_string(base.y()) + " radius=6000 enlarge=1.5 turn=10"});
    const nlohmann::json byHand = nlohmann::json::parse(bytes("own.json")).at("liberties");
    ASSERT_EQ(byHand.size(), 1u);
    EXPECT_EQ(byHand[0].at("enlarge"), "1.5");
    EXPECT_EQ(byHand[0].at("along"), "6000");
    EXPECT_EQ(byHand[0].at("turn"), "10");
    EXPECT_NE(own.find("enlarge=1.5"), std::string::npos);
    EXPECT_FALSE(bytes("own.png") == bytes("plain.png"));
}

TEST_F(PanoramaProgram, KeepsTheNameOfAReadyPalette)
{
    invent("hills", 101);
    const std::vector<std::string> size = {"--size", "64x48", "--quiet"};
    const auto map = [&](std::vector<std::string> arguments)
    {
        arguments.insert(arguments.end(), size.begin(), size.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
    };
    map({"hills.tif", "-o", "map.png", "--palette", "colorblind"});
    EXPECT_EQ(nlohmann::json::parse(bytes("map.json")).at("palette"), "colorblind");
    map({"map.json", "-o", "again.png"});
    EXPECT_TRUE(bytes("map.png") == bytes("again.png"));
    map({"hills.tif", "-o", "summer.png"});
    EXPECT_FALSE(bytes("map.png") == bytes("summer.png"));
}

TEST_F(PanoramaProgram, TakesATerrainThatIsThere)
{
    invent("volcano");
    const ProgramResult first =
        run({"volcano.tif", "-o", "map.png", "--size", "96x54", "--work", "kept", "--quiet"});
    ASSERT_EQ(first.exitCode, 0) << first.standardError;
    const ProgramResult second =
        run({"kept/ground/terrain.osgb", "-o", "own.png", "--size", "96x54", "--quiet"});
    ASSERT_EQ(second.exitCode, 0) << second.standardError;
    EXPECT_FALSE(fs::exists(file("own.work")));
    const nlohmann::json recipe = nlohmann::json::parse(bytes("own.json"));
    EXPECT_EQ(recipe.at("terrain"), "kept/ground/terrain.osgb");
    EXPECT_EQ(recipe.at("geocentric"), true);
    EXPECT_FALSE(recipe.contains("dems"));
    const ProgramResult again = run({"own.json", "-o", "again.png", "--quiet"});
    ASSERT_EQ(again.exitCode, 0) << again.standardError;
    EXPECT_TRUE(bytes("own.png") == bytes("again.png"));
    const ProgramResult none = run({"none.osgb", "-o", "none.png"});
    EXPECT_EQ(none.exitCode, 2);
    EXPECT_NE(none.standardError.find("none.osgb"), std::string::npos) << none.standardError;
}

TEST_F(PanoramaProgram, TakesWishes)
{
    invent("feet");
    const ProgramResult result =
        run({"feet.tif",   "-o",       "map.png",       "--size",         "160x120",       "--view-from",
             "north-east", "--width",  "20000",         "--exaggeration", "1.5",           "--palette",
             "autumn",     "--set",    "strokes=false", "--set",          "snowLine=1500", "--pick",
             "80,100",     "--recipe", "own.json",      "--work",         "kept",          "--quiet"});
    ASSERT_EQ(result.exitCode, 0) << result.standardError;
    const nlohmann::json recipe = nlohmann::json::parse(bytes("own.json"));
    EXPECT_NEAR(
        std::remainder(recipe.at("view").at("heading").get<double>() - 225.0 * M_PI / 180.0, 2.0 * M_PI), 0.0,
        1e-9);
    EXPECT_EQ(recipe.at("view").at("viewRadius"), 10000.0);
    EXPECT_EQ(recipe.at("view").at("exaggeration"), 1.5);
    EXPECT_EQ(recipe.at("map").at("season"), "0.75");
    EXPECT_EQ(recipe.at("map").at("strokes"), "false");
    EXPECT_EQ(recipe.at("map").at("snowLine"), "1500");
    double longitude = 0.0, latitude = 0.0, height = 0.0;
    ASSERT_EQ(std::sscanf(result.standardOutput.c_str(), "80,100: longitude %lf, latitude %lf, height %lf",
                          &longitude, &latitude, &height),
              3)
        << result.standardOutput;
    EXPECT_GT(height, 100.0);
    EXPECT_LT(height, 4000.0) << "metres, though the file has feet";
    EXPECT_TRUE(fs::exists(file("kept/ground/terrain.osgb")));
}

TEST_F(PanoramaProgram, AStripAllAroundMeetsItself)
{
    invent("alps", 301);
    // The same pixel of the height of the picture at both ends, some of them ground.
    const auto strip = [&](const std::string& from, const std::string& name, const std::string& pick)
    {
        std::vector<std::string> arguments = {from, "-o", name, "--pick", pick, "--work", "kept", "--quiet"};
        if (from == "alps.tif")
            for (const char* more : {"--around", "360", "--size", "480x96", "--samples", "0"})
                arguments.emplace_back(more);
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        EXPECT_EQ(result.standardError, "");
        osg::Vec2d place;
        double height = 0.0;
        EXPECT_EQ(std::sscanf(result.standardOutput.substr(result.standardOutput.find(':')).c_str(),
                              ": longitude %lf, latitude %lf, height %lf", &place.x(), &place.y(), &height),
                  3)
            << result.standardOutput;
        return place;
    };
    const osg::Vec2d left = strip("alps.tif", "map.png", "0,95");
    const nlohmann::json recipe = nlohmann::json::parse(bytes("map.json"));
    EXPECT_NEAR(recipe.at("view").at("horizontalAngle").get<double>(), 2.0 * M_PI, 1e-12);
    const osg::Vec2d right = strip("map.json", "again.png", "479,95");
    EXPECT_TRUE(bytes("map.png") == bytes("again.png")) << "the same to the byte";
    const osg::Vec2d middle = strip("map.json", "again.png", "240,95");
    EXPECT_LT((left - right).length(), 0.1 * (left - middle).length());

    // What the ends show fits together as neighbours within the picture do.
    const osg::ref_ptr<osg::Image> picture = osgDB::readRefImageFile(file("map.png"));
    ASSERT_TRUE(picture);
    const auto apart = [&](unsigned int a, unsigned int b)
    {
        double sum = 0.0;
        for (unsigned int y = 0; y < 96; ++y)
            sum += static_cast<double>((picture->getColor(a, y) - picture->getColor(b, y)).length());
        return sum / 96.0;
    };
    double usual = 0.0;
    for (unsigned int x = 0; x + 1 < 480; ++x)
        usual += apart(x, x + 1) / 479.0;
    EXPECT_LT(apart(479, 0), 2.0 * usual);
    EXPECT_GT(apart(120, 0), 2.0 * usual);
}

TEST_F(PanoramaProgram, RefusesInASentence)
{
    invent("nowhere", 50);
    invent("hills", 60);
    const auto expectRefusal = [&](const std::vector<std::string>& arguments, const std::string& word)
    {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 2);
        EXPECT_NE(result.standardError.find(word), std::string::npos) << result.standardError;
        EXPECT_EQ(std::count(result.standardError.begin(), result.standardError.end(), '\n'), 1)
            << result.standardError;
        EXPECT_FALSE(fs::exists(file("map.png")));
    };
    expectRefusal({"nowhere.tif", "-o", "map.png", "--quiet"}, "georeference");
    expectRefusal({"none.tif", "-o", "map.png", "--quiet"}, "none.tif");
    expectRefusal({"hills.tif", "-o", "no/map.png", "--quiet"}, "no/map.png");
    expectRefusal({"hills.tif", "-o", "map.png", "--view-from", "up"}, "--view-from up");
    expectRefusal({"hills.tif", "-o", "map.png", "--size", "huge"}, "--size huge");
    expectRefusal({"hills.tif", "-o", "map.png", "--set", "snowline=1"}, "snowline");
    expectRefusal({"hills.tif", "-o", "map.png", "--palette", "none.png"}, "none.png");
    expectRefusal({"hills.tif", "-o", "map.png", "--liberties=2"}, "--liberties=2");
    expectRefusal({"hills.tif", "-o", "map.png", "--liberty", "7.6 enlarge=2"}, "names no center");
    expectRefusal({"hills.tif", "-o", "map.png", "--liberty", "7.6,46 enlarge=9"}, "enlarge");
    expectRefusal({"hills.tif", "-o", "map.png", "--liberty", "7.6,46 bigger=2"}, "bigger");
    std::ofstream(file("wrong.json")) << "{}";
    expectRefusal({"wrong.json", "-o", "map.png"}, "wrong.json");
}

class HardlyTerrain : public PanoramaProgram, public testing::WithParamInterface<const char*>
{
};

TEST_P(HardlyTerrain, HasASensibleMap)
{
    const std::string name = GetParam();
    invent(name, name == "tiny" ? 10 : 120);
    const ProgramResult result = run({name + ".tif", "-o", "map.png", "--size", "160x90", "--quiet"});
    ASSERT_EQ(result.exitCode, 0) << result.standardError;
    const osg::ref_ptr<osg::Image> picture = osgDB::readRefImageFile(file("map.png"));
    ASSERT_TRUE(picture);
    // Ground below, sky above.
    const osg::Vec4 ground = picture->getColor(80u, 30u), sky = picture->getColor(80u, 87u);
    EXPECT_FALSE(isPaper(ground));
    EXPECT_GT(sky.b(), sky.r());
}

INSTANTIATE_TEST_SUITE_P(
    Terrains, HardlyTerrain,
    testing::ValuesIn(geofx::test::sampledCases<const char*>({"flat", "cliff", "sea", "tiny", "atoll"}, 2)),
    [](const auto& each) { return std::string(each.param); });
