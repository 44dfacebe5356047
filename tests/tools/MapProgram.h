// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <tools/GlFixture.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <osg/Image>
#include <osg/Vec2d>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace geofx::test
{

/** The programs that make maps, run in a folder with an invented volcano, as a person runs them.

    The folder begins as a copy of the one that the test volcano_map makes (tests/smoke/CMakeLists.txt): volcano.tif, of
    201 posts along a side; work, the terrain that was built of it; plain.png, its map without names and lines; and the
    recipe plain.json, which spares choosing the view again. */
class MapProgram : public GlFixture
{
protected:
    /// The size of plain.png, pixels.
    static constexpr int WIDTH = 480, HEIGHT = 270;

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        const std::filesystem::path map = GEOFX_BUILD_DIR "/test-data/volcano";
        ASSERT_TRUE(std::filesystem::exists(map / "plain.png"))
            << map << " is not there; make it with ctest -R volcano_map";
        std::filesystem::copy(map, _folder.path(), std::filesystem::copy_options::recursive);
    }

    ProgramResult run(const std::string& program, std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), builtProgram(program));
        ProgramOptions options;
        options.folder = std::filesystem::path(_folder.path()).string();
        options.environment = {"DISPLAY=", "LC_ALL=de_DE.UTF-8"};
        return runProgram(arguments, options);
    }
    /// With the terrain that was built before.
    ProgramResult panorama(std::vector<std::string> arguments)
    {
        arguments.insert(arguments.end(), {"--size", std::to_string(WIDTH) + "x" + std::to_string(HEIGHT),
                                           "--samples", "0", "--quiet", "--work", "work"});
        return run("osggeofx_panorama", arguments);
    }

    std::string file(const std::string& name) const
    {
        return (std::filesystem::path(_folder.path()) / name).string();
    }
    void write(const std::string& name, const std::string& content) const
    {
        std::ofstream(file(name)) << content;
    }
    std::string bytes(const std::string& name) const
    {
        std::ifstream stream(file(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    }
    /// Vector data as GeoJSON has them: a place with a name, a straight line, and a file of such features.
    static std::string pointFeature(const std::string& name, const std::string& style,
                                    const osg::Vec2d& place)
    {
        char text[400];
        std::snprintf(text, sizeof(text),
                      R"({"type":"Feature","properties":{"name":"%s","style":"%s"},)"
                      R"("geometry":{"type":"Point","coordinates":[%.8f,%.8f]}})",
                      name.c_str(), style.c_str(), place.x(), place.y());
        return text;
    }
    static std::string lineFeature(const std::string& style, const osg::Vec2d& from, const osg::Vec2d& to)
    {
        char text[400];
        std::snprintf(text, sizeof(text),
                      R"({"type":"Feature","properties":{"highway":"%s","name":"Way & <way>"},)"
                      R"("geometry":{"type":"LineString","coordinates":[[%.8f,%.8f],[%.8f,%.8f]]}})",
                      style.c_str(), from.x(), from.y(), to.x(), to.y());
        return text;
    }
    static std::string collection(const std::string& features)
    {
        return R"({"type":"FeatureCollection","features":[)" + features + "]}";
    }

    /// The places that pixels of the plain map show, degrees. The map is the same for all tests, so each place is picked once.
    std::vector<osg::Vec2d> placesOf(const std::vector<std::array<int, 2>>& pixels)
    {
        static std::map<std::vector<std::array<int, 2>>, std::vector<osg::Vec2d>> known;
        const auto [places, isNew] = known.try_emplace(pixels);
        if (isNew) places->second = picked(pixels);
        return places->second;
    }
    std::vector<osg::Vec2d> picked(const std::vector<std::array<int, 2>>& pixels)
    {
        std::vector<std::string> arguments = {"plain.json", "-o", "pick.png"};
        for (const auto& [x, y] : pixels)
            arguments.insert(arguments.end(), {"--pick", std::to_string(x) + "," + std::to_string(y)});
        const ProgramResult result = panorama(arguments);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        std::vector<osg::Vec2d> places(pixels.size());
        std::istringstream lines(result.standardOutput);
        std::string line;
        for (osg::Vec2d& place : places)
        {
            std::getline(lines, line);
            EXPECT_EQ(
                std::sscanf(line.c_str(), "%*[^:]: longitude %lf, latitude %lf", &place.x(), &place.y()), 2)
                << result.standardOutput;
        }
        return places;
    }
    osg::Vec2d placeOf(int x, int y) { return placesOf({{x, y}})[0]; }
    /// Whether a pixel, from the upper left, has the color that tests give to names and lines.
    static bool isMagenta(const osg::Image& image, int x, int y)
    {
        const unsigned char* const pixel =
            image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(image.t() - 1 - y));
        return pixel[0] > 180 && pixel[1] < 90 && pixel[2] > 180;
    }

    static int magentaIn(const osg::Image& image)
    {
        int count = 0;
        for (int y = 0; y < image.t(); ++y)
            for (int x = 0; x < image.s(); ++x)
                count += isMagenta(image, x, y) ? 1 : 0;
        return count;
    }

    TempDir _folder;
};

} // namespace geofx::test
