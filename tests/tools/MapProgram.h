// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <tools/GlFixture.h>
#include <tools/InventedTerrain.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <osg/Image>
#include <osg/Vec2d>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace geofx::test
{

/// The programs that make maps, run in a folder with an invented volcano, as a person runs them.
class MapProgram : public GlFixture
{
protected:
    /// `posts`: of the volcano's DEM, along a side. `width`, `height`: of the pictures, pixels.
    MapProgram(int posts, int width, int height) : _posts(posts), _width(width), _height(height) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        inventTerrain("volcano", file("volcano.tif"), _posts);
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
        arguments.insert(arguments.end(), {"--size", std::to_string(_width) + "x" + std::to_string(_height),
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

    /// The map without names and lines: plain.png, and the recipe plain.json, which spares choosing the view again.
    void makePlain()
    {
        if (std::filesystem::exists(file("plain.json"))) return;
        const ProgramResult result = panorama({"volcano.tif", "-o", "plain.png"});
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
    }
    /// The place that a pixel of the plain map shows, degrees.
    osg::Vec2d placeOf(int x, int y)
    {
        makePlain();
        const ProgramResult result =
            panorama({"plain.json", "-o", "pick.png", "--pick", std::to_string(x) + "," + std::to_string(y)});
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        osg::Vec2d place;
        EXPECT_EQ(std::sscanf(result.standardOutput.c_str(), "%*[^:]: longitude %lf, latitude %lf",
                              &place.x(), &place.y()),
                  2)
            << result.standardOutput;
        return place;
    }
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

private:
    const int _posts, _width, _height;
};

} // namespace geofx::test
