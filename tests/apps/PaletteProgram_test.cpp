// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The program osggeofx_palette, as a person calls it.
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/PalettePoints.h>
#include <osgGeoFX/panorama/PanoramaPalette.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>
#include <osg/Image>
#include <osgDB/WriteFile>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

using namespace osgGeoFX;
using geofx::test::ProgramResult;
using geofx::test::TempDir;
namespace fs = std::filesystem;

namespace
{

constexpr int columns = glsl::GEOFX_PALETTE_COLUMNS;
constexpr int rows = glsl::GEOFX_PALETTE_ROWS;
constexpr int band = 20;

class PaletteProgram : public ::testing::Test
{
protected:
    ProgramResult run(std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), geofx::test::builtProgram("osggeofx_palette"));
        geofx::test::ProgramOptions options;
        options.folder = fs::path(_folder.path()).string();
        options.environment = {"DISPLAY=", "LC_ALL=de_DE.UTF-8"};
        return geofx::test::runProgram(arguments, options);
    }

    std::string file(const std::string& name) const { return (fs::path(_folder.path()) / name).string(); }

    osg::ref_ptr<osg::Image> read(const std::string& name) const
    {
        std::string error;
        osg::ref_ptr<osg::Image> palette = readPalette(file(name), error);
        EXPECT_TRUE(palette) << error;
        return palette ? palette : osg::ref_ptr<osg::Image>(new osg::Image);
    }

    /// A painting in which light runs to the right and the classes lie above each other, the first on top.
    void paint(const osg::Image& palette) const
    {
        osg::ref_ptr<osg::Image> painting = new osg::Image, light = new osg::Image, classes = new osg::Image;
        for (osg::Image* image : {painting.get(), light.get(), classes.get()})
            image->allocateImage(columns, rows * band, 1, GL_RGB, GL_UNSIGNED_BYTE);
        for (int y = 0; y < rows * band; ++y)
            for (int x = 0; x < columns; ++x)
            {
                const int row = rows - 1 - y / band;
                std::memcpy(painting->data(x, y), palette.data(x, row), 3);
                std::memset(light->data(x, y), x, 3);
                std::memset(classes->data(x, y), row, 3);
            }
        ASSERT_TRUE(osgDB::writeImageFile(*painting, file("painting.png")));
        ASSERT_TRUE(osgDB::writeImageFile(*light, file("light.png")));
        ASSERT_TRUE(osgDB::writeImageFile(*classes, file("classes.png")));
    }

    TempDir _folder;
};

/// The largest distance of two palettes' colors, 0…1.
double difference(const osg::Image& a, const osg::Image& b, int firstColumn, int lastColumn, int row)
{
    double most = 0.0;
    for (int column = firstColumn; column <= lastColumn; ++column)
        for (int i = 0; i < 3; ++i)
            most = std::max(most, std::abs(a.data(column, row)[i] - b.data(column, row)[i]) / 255.0);
    return most;
}

} // namespace

TEST_F(PaletteProgram, WritesTheReadyOnes)
{
    const std::pair<const char*, osg::ref_ptr<osg::Image>> all[] = {
        {"spring", makePalette(0.25)}, {"winter", makePalette(0.0)}, {"colorblind", makeColorBlindPalette()}};
    for (const auto& [name, expected] : all)
    {
        const ProgramResult result = run({"--ready", name, "-o", "ready.png"});
        ASSERT_EQ(result.exitCode, 0) << result.standardError;
        const osg::ref_ptr<osg::Image> palette = read("ready.png");
        for (int row = 0; row < rows; ++row)
            EXPECT_EQ(difference(*palette, *expected, 0, columns - 1, row), 0.0) << name;
        // The colour-blind palette alone earns no remark.
        EXPECT_EQ(result.standardOutput.find("told apart at a glance") == std::string::npos,
                  std::string(name) == "colorblind")
            << result.standardOutput;
    }
    const ProgramResult judged = run({"ready.png"});
    EXPECT_EQ(judged.exitCode, 0);
    EXPECT_NE(judged.standardOutput.find("protanopia"), std::string::npos);
}

TEST_F(PaletteProgram, TakesThePaletteOfAPainting)
{
    const osg::ref_ptr<osg::Image> autumn = makePalette(0.75);
    paint(*autumn);
    const ProgramResult whole =
        run({"painting.png", "--light", "light.png", "--classes", "classes.png", "-o", "whole.png"});
    ASSERT_EQ(whole.exitCode, 0) << whole.standardError;
    const osg::ref_ptr<osg::Image> palette = read("whole.png");
    for (int row = 0; row < rows; ++row)
        EXPECT_LT(difference(*palette, *autumn, 0, columns - 1, row), 0.04) << row;

    // Points in the painting, some with the light by hand.
    std::ofstream points(file("points.csv"));
    points << "class,x,y,lightX,lightY,light\n";
    for (int x = 4; x < columns; x += 8)
    {
        points << "trees," << x << ',' << glsl::GEOFX_PALETTE_TREES * band + 10 << ",,,\n";
        points << "\"field\"," << x << ",10,,," << 2.0 * x / (columns - 1) - 1.0 << "\n\n";
    }
    points << "snow,10," << glsl::GEOFX_PALETTE_SNOW * band + 10 << ",200,3,\n";
    points.close();
    const ProgramResult few =
        run({"painting.png", "--light", "light.png", "--points", "points.csv", "-o", "few.png"});
    ASSERT_EQ(few.exitCode, 0) << few.standardError;
    EXPECT_NE(few.standardOutput.find("trees: 32 points.\n"), std::string::npos) << few.standardOutput;
    EXPECT_NE(few.standardOutput.find("snow: 1 points, too few"), std::string::npos) << few.standardOutput;
    const osg::ref_ptr<osg::Image> sampled = read("few.png");
    for (const int row : {glsl::GEOFX_PALETTE_TREES, glsl::GEOFX_PALETTE_FIELD})
        EXPECT_LT(difference(*sampled, *autumn, 4, columns - 5, row), 0.04) << row;
    EXPECT_EQ(difference(*sampled, *makePalette(), 0, columns - 1, glsl::GEOFX_PALETTE_SNOW), 0.0);

    // A hillshade has no black for what is turned away.
    const ProgramResult shaded = run({"painting.png", "--light", "light.png", "--hillshade", "--points",
                                      "points.csv", "-o", "shaded.png"});
    ASSERT_EQ(shaded.exitCode, 0) << shaded.standardError;
    const osg::ref_ptr<osg::Image> half = read("shaded.png");
    const int trees = glsl::GEOFX_PALETTE_TREES;
    for (int column = 140; column < 250; column += 10)
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(half->data(column, trees)[i], autumn->data(2 * (column - 128), trees)[i], 12);
}

TEST_F(PaletteProgram, FaultsAreSentences)
{
    paint(*makePalette());
    const auto expectFault = [&](const std::vector<std::string>& arguments, const std::string& sentence)
    {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 2) << sentence;
        EXPECT_NE(result.standardError.find(sentence), std::string::npos)
            << sentence << " / " << result.standardError;
        EXPECT_FALSE(fs::exists(file("out.png")));
    };
    const auto points = [&](const std::string& text)
    {
        std::ofstream(file("p.csv")) << text;
        return std::vector<std::string>{"painting.png", "--light", "light.png", "--points",
                                        "p.csv",        "-o",      "out.png"};
    };
    expectFault({}, "No painting is given");
    expectFault({"none.png", "--light", "light.png", "--classes", "classes.png", "-o", "out.png"},
                "none.png: does not exist");
    expectFault({"painting.png", "--light", "light.png", "-o", "out.png"}, "give --points, or --classes");
    expectFault({"painting.png", "--points", "none.csv", "-o", "out.png"}, "none.csv: the sample points");
    expectFault(points("class,x\nhill,1\n"), "p.csv: the column \"y\" is missing");
    expectFault(points("class,x,y\n"), "p.csv: has no sample points");
    expectFault(points("class,x,y\nhill,1,2\n\nmoor,1,2\n"), "p.csv:4: the column \"class\" holds \"moor\"");
    expectFault(points("class,x,y\nhill,1,two\n"), "p.csv:2: the column \"y\" holds \"two\"");
    expectFault(points("class,x,y,light\nhill,1,2,1.5\n"), "p.csv:2: the light is 1.5");
    expectFault(points("class,x,y,lightX,lightY\nhill,1,2,3,\n"), "p.csv:2: only one of lightX and lightY");
    expectFault(points("class,x,y\nhill,500,2\nhill,5,2\n"),
                "the point 500, 2 lies outside of the painting of 256 x 160 pixels");
    expectFault(points("class,x,y\nhill,5,2\n"), "No class has as many as 2 samples");
    std::ofstream(file("p.csv")) << "class,x,y\nhill,5,2\nhill,9,2\n";
    expectFault({"painting.png", "--points", "p.csv", "-o", "out.png"}, "not all points have a light");
    expectFault({"--ready", "autumn", "-o", "no/folder/out.png"}, "cannot be written");
    EXPECT_THROW(readPalettePoints(file("nothing.csv")), BuildError);
}
