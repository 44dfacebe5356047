// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Layers and meshes of osggeofx_panorama and osggeofx_render, as a person asks for them, and put together by the command that they tell.
#include <tools/GlFixture.h>
#include <tools/InventedTerrain.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <nlohmann/json.hpp>
#include <osg/Image>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

using geofx::test::ProgramResult;
using geofx::test::TempDir;

namespace fs = std::filesystem;

namespace
{

class LayersProgram : public geofx::test::GlFixture
{
protected:
    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        geofx::test::inventTerrain("volcano", file("volcano.tif"), 101);
    }

    ProgramResult run(std::vector<std::string> arguments, const std::string& folder = {})
    {
        geofx::test::ProgramOptions options;
        options.folder = folder.empty() ? fs::path(_folder.path()).string() : file(folder);
        options.environment = {"DISPLAY=", "LC_ALL=de_DE.UTF-8"};
        return geofx::test::runProgram(arguments, options);
    }
    ProgramResult panorama(const std::string& source, std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), {geofx::test::builtProgram("osggeofx_panorama"), source,
                                             "--samples", "0", "--quiet", "--work", "work"});
        return run(arguments);
    }
    ProgramResult render(std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), {geofx::test::builtProgram("osggeofx_render"), terrain()});
        return run(arguments);
    }
    /// The terrain that the panorama map was made of.
    std::string terrain() const
    {
        for (const auto& entry : fs::recursive_directory_iterator(file("work")))
            if (entry.path().filename() == "terrain.osgb") return entry.path().string();
        return {};
    }
    /// Puts layers together by the command of layers.json, and compares.
    void expectThePicture(const std::string& folder, const std::string& picture)
    {
        std::ifstream stream(file(folder) + "/layers.json");
        const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
        ASSERT_TRUE(json.is_object());
        std::istringstream words(json["command"].get<std::string>());
        std::vector<std::string> command;
        for (std::string word; words >> word;)
            command.push_back(word);
        const ProgramResult result = run(command, folder);
        ASSERT_EQ(result.exitCode, 0) << result.standardError;
        const osg::ref_ptr<osg::Image> made = osgDB::readRefImageFile(file(folder) + "/picture.png");
        const osg::ref_ptr<osg::Image> expected = osgDB::readRefImageFile(file(picture));
        ASSERT_TRUE(made && expected);
        ASSERT_EQ(made->getTotalSizeInBytes(), expected->getTotalSizeInBytes());
        int most = 0;
        for (unsigned int i = 0; i < made->getTotalSizeInBytes(); ++i)
            most = std::max(most, std::abs(made->data()[i] - expected->data()[i]));
        EXPECT_LE(most, 2);
    }
    std::string file(const std::string& name) const { return (fs::path(_folder.path()) / name).string(); }

    TempDir _folder;
};

} // namespace

TEST_F(LayersProgram, MakesThePictureAgain)
{
    std::ofstream(file("names.geojson"))
        << R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"name":"Middle"},)"
        << R"("geometry":{"type":"Point","coordinates":[)";
    const ProgramResult plain =
        panorama("volcano.tif", {"-o", "plain.png", "--size", "160x90", "--pick", "80,60"});
    ASSERT_EQ(plain.exitCode, 0) << plain.standardError;
    double longitude = 0.0, latitude = 0.0, height = 0.0;
    ASSERT_EQ(std::sscanf(plain.standardOutput.c_str(), "%*[^:]: longitude %lf, latitude %lf, height %lf",
                          &longitude, &latitude, &height),
              3);
    std::ofstream(file("names.geojson"), std::ios::app)
        << std::to_string(longitude) << "," << std::to_string(latitude) << "]}}]}";
    const ProgramResult result =
        panorama("plain.json", {"-o", "map.png", "--size", "160x90", "--labels", "names.geojson", "--layers",
                                "layers", "--mesh", "map.obj", "--pick", "80,60"});
    ASSERT_EQ(result.exitCode, 0) << result.standardError;
    EXPECT_EQ(result.standardError, "");
    EXPECT_EQ(result.standardOutput, plain.standardOutput);
    expectThePicture("layers", "map.png");
    EXPECT_TRUE(fs::exists(file("layers/strokes.png")) && fs::exists(file("layers/labels.png")));
    for (const auto& entry : fs::directory_iterator(file("layers")))
        EXPECT_EQ(entry.path().string().find("unfinished"), std::string::npos) << entry.path();
    // The pixel that was picked has its place: about a pixel's ground in degrees.
    const ProgramResult place =
        run({"oiiotool", "lonlat.tif", "--cut", "1x1+80+60", "--printstats"}, "layers");
    std::istringstream lines(place.standardOutput);
    double foundLongitude = 0.0, foundLatitude = 0.0;
    for (std::string line; std::getline(lines, line);)
        std::sscanf(line.c_str(), " Stats Avg: %lf %lf", &foundLongitude, &foundLatitude);
    EXPECT_NEAR(foundLongitude, longitude, 0.005) << place.standardOutput;
    EXPECT_NEAR(foundLatitude, latitude, 0.005);
    EXPECT_TRUE(osgDB::readRefNodeFile(file("map.obj")));

    // A print, in tiles.
    const ProgramResult print =
        panorama("plain.json", {"-o", "print.png", "--size", "160x90@100dpi", "--labels", "names.geojson",
                                "--layers", "print", "--mesh", "print.osgb"});
    ASSERT_EQ(print.exitCode, 0) << print.standardError;
    expectThePicture("print", "print.png");
    EXPECT_TRUE(fs::exists(file("print.osgb")));

    // Any other view.
    char view[120];
    std::snprintf(view, sizeof(view), "%.6f,%.6f,3000,0,-30", longitude, latitude - 0.05);
    const ProgramResult bent = render({"-o", "bent.png", "--size", "160x90", "--samples", "0", "--view", view,
                                       "--effect", "birdsEyeView focusLine=0.3 horizonLine=0.8", "--labels",
                                       "names.geojson", "--layers", "bent", "--mesh", "bent.obj"});
    ASSERT_EQ(bent.exitCode, 0) << bent.standardError;
    expectThePicture("bent", "bent.png");
    EXPECT_TRUE(fs::exists(file("bent.obj")));

    // Refused before anything is drawn.
    const auto expectRefusal = [&](const std::vector<std::string>& wrong, const std::string& word)
    {
        SCOPED_TRACE(word);
        std::vector<std::string> arguments = {"-o", "refused.png", "--size", "160x90"};
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        for (const bool map : {false, true})
        {
            if (map && wrong.size() > 2) continue;
            const ProgramResult refused = map ? panorama("plain.json", arguments) : render(arguments);
            EXPECT_EQ(refused.exitCode, 2);
            EXPECT_NE(refused.standardError.find(word), std::string::npos) << refused.standardError;
            EXPECT_EQ(std::count(refused.standardError.begin(), refused.standardError.end(), '\n'), 1);
            EXPECT_FALSE(fs::exists(file("refused.png")));
        }
    };
    expectRefusal({"--layers", "names.geojson"}, "\"names.geojson\" is a file; name a folder");
    expectRefusal({"--layers", "none/none"}, "make it first");
    expectRefusal({"--mesh", "mesh.stl"}, ".obj or .osgb");
    expectRefusal({"--mesh", "none/mesh.obj"}, "make it first");
    expectRefusal({"--mesh", "mesh.obj", "--inset"}, "leave --path and --inset out");
}
