// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Ramp files: what is read, the sentence for what cannot be, and gdaldem's reading of the same files.
#include <osgGeoFX/raster/ColorRampFile.h>
#include <osgGeoFX/raster/ColorTable.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>

#include <gdal_priv.h>
#include <gdal_utils.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

using namespace osgGeoFX;
using geofx::test::Random;
using geofx::test::TempDir;
using Mode = ColorTable::Mode;
using Stops = ColorTable::Stops;

namespace
{

const osg::Vec4 red(1, 0, 0, 1), green(0, 1, 0, 1), blue(0, 0, 1, 1), clear;

osg::ref_ptr<ColorTable> makeTable(const Stops& stops, Mode mode = ColorTable::LINEAR)
{
    osg::ref_ptr<ColorTable> table = new ColorTable;
    EXPECT_TRUE(table->setStops(stops));
    table->setMode(mode);
    return table;
}

/// The largest difference of a color's parts from bytes, in 1/255.
double difference(const osg::Vec4ub& bytes, const osg::Vec4& color)
{
    double most = 0.0;
    for (int i = 0; i < 4; ++i)
        most = std::max(most, std::abs(bytes[i] - 255.0 * static_cast<double>(color[i])));
    return most;
}

osg::ref_ptr<ColorTable> readText(const std::string& text, const std::string& name = "ramp.txt",
                                  const std::optional<ColorRampFile::Range>& range = std::nullopt)
{
    const TempDir folder;
    std::string error;
    auto table = ColorRampFile::read(folder.write(name, text).string(), range, error);
    EXPECT_TRUE(table) << error;
    return table ? table : osg::ref_ptr<ColorTable>(new ColorTable);
}

osg::Vec4 color255(int r, int g, int b, int a = 255)
{
    return {static_cast<float>(r / 255.0), static_cast<float>(g / 255.0), static_cast<float>(b / 255.0),
            static_cast<float>(a / 255.0)};
}

TEST(ColorRampFile, SeparatorsNamesCommentsAndNoData)
{
    const auto table = readText("\xEF\xBB\xBF# heights\r\n\r\n0 0 0 0\r\n10,10,20,30,40\r\n"
                                "20:red\r\n30\tGrey\t128\r\n  +4e1 , 1 , 2 , 3 # trailing\r\n"
                                "50 9 8 7 255 a label\r\n// not a line\r\nNV 1 2 3 4\r\n-5 brown");
    const Stops& stops = table->getStops();
    ASSERT_EQ(stops.size(), 7u);
    EXPECT_EQ(stops[0].value, -5.0);
    EXPECT_EQ(stops[0].color, color255(191, 127, 63));
    EXPECT_EQ(stops[2].color, color255(10, 20, 30, 40));
    EXPECT_EQ(stops[3].color, red);
    EXPECT_EQ(stops[4].color, color255(191, 191, 191, 128));
    EXPECT_EQ(stops[5].value, 40.0);
    EXPECT_EQ(stops[6].color, color255(9, 8, 7));
    EXPECT_EQ(table->getNoDataColor(), color255(1, 2, 3, 4));
    EXPECT_EQ(table->getMode(), ColorTable::LINEAR);
}

TEST(ColorRampFile, PercentagesAndDoubledKeys)
{
    const auto table =
        readText("0% red\n50% red\n50% blue\n100% blue\n", "r.txt", ColorRampFile::Range(200, 600));
    EXPECT_EQ(table->range(), (std::pair<double, double>(200.0, 600.0)));
    EXPECT_EQ(table->at(399.9), red);
    EXPECT_EQ(table->at(400), blue);
}

TEST(ColorRampFile, GmtTables)
{
    const auto table = readText("# COLOR_MODEL = RGB\n0 255 0 0 10 0 255 0 ; low\n10 0 255 0 20 0 0 255 L\n"
                                "20\t255/0/0\t30\t255/0/0\tB\nN 128\n");
    ASSERT_EQ(table->getStops().size(), 5u);
    EXPECT_EQ(table->at(5), osg::Vec4(0.5f, 0.5f, 0, 1));
    EXPECT_LT(difference(osg::Vec4ub(0, 0, 255, 255), table->at(19.999999)), 0.01);
    EXPECT_EQ(table->at(20), red);
    EXPECT_EQ(table->at(99), red);
    EXPECT_EQ(table->getNoDataColor(), color255(128, 128, 128));

    // By its name, with colors below, above and for no data.
    const auto outside = readText("0 red 1024 red\nB 0/255/0\nF 0 0 255\nN -\n", "t.CPT");
    EXPECT_EQ(outside->at(-1), red);
    EXPECT_EQ(outside->at(-3), green);
    EXPECT_EQ(outside->at(1024), red);
    EXPECT_EQ(outside->at(1027), blue);
    EXPECT_EQ(outside->getNoDataColor(), clear);
    // A row over the table's range has them, too, and the ends' own colors.
    std::vector<osg::Vec4ub> row(1024);
    const auto [low, high] = outside->range();
    EXPECT_TRUE(outside->row(low, high, row.data(), 1024));
    EXPECT_EQ(row.front(), osg::Vec4ub(0, 255, 0, 255));
    EXPECT_EQ(row.back(), osg::Vec4ub(0, 0, 255, 255));
    for (const double end : {0.0, 1024.0})
    {
        const double place = (end - low) / (high - low) * 1023.0;
        EXPECT_EQ(row[static_cast<std::size_t>(std::floor(place))], osg::Vec4ub(255, 0, 0, 255));
        EXPECT_EQ(row[static_cast<std::size_t>(std::ceil(place))], osg::Vec4ub(255, 0, 0, 255));
    }
}

TEST(ColorRampFile, GmtTablesDescendAndHaveNamesOfX11)
{
    const auto table = readText("20 tomato3 10 DarkSlateGray1 # down\n10 gray50 0 #ff8000\n", "t.cpt");
    ASSERT_EQ(table->getStops().size(), 4u);
    EXPECT_EQ(table->at(0), color255(255, 128, 0));
    EXPECT_EQ(table->at(20), color255(205, 80, 57));
    EXPECT_EQ(table->at(10), color255(151, 255, 255));
    EXPECT_LT(difference(osg::Vec4ub(127, 127, 127, 255), table->at(9.999999)), 0.01);
    // Slices that ascend, listed from the top.
    const auto listed = readText("10 red 20 red\n0 blue 10 blue\n", "t.cpt");
    EXPECT_EQ(listed->at(9.9), blue);
    EXPECT_EQ(listed->at(10), red);
    // The names of both formats differ in some colors.
    EXPECT_EQ(readText("0 brown 1 purple\n", "t.cpt")->at(0), color255(165, 42, 42));
    EXPECT_EQ(readText("0 brown\n")->at(0), color255(191, 127, 63));
}

TEST(ColorRampFile, CategoricalGmtTablesAreClasses)
{
    const auto table = readText("1 forestgreen ;Forest\n11 0/0/255 ;Water\n2 #ffff00\nN 128\n", "t.cpt");
    EXPECT_EQ(table->getMode(), ColorTable::EXACT);
    EXPECT_EQ(table->at(1), color255(34, 139, 34));
    EXPECT_EQ(table->at(2), color255(255, 255, 0));
    EXPECT_EQ(table->at(11), blue);
    EXPECT_EQ(table->at(3), clear);
}

TEST(ColorRampFile, TablesThatQgisExports)
{
    const std::string head = "# QGIS Generated Color Map Export File\nINTERPOLATION:";
    const auto mixed = readText(head + "INTERPOLATED\n0,255,0,0,255,0 m\n10,0,0,255,255,10 #m\n");
    EXPECT_EQ(mixed->getMode(), ColorTable::LINEAR);
    EXPECT_EQ(mixed->at(5), osg::Vec4(0.5f, 0, 0.5f, 1));
    const auto classes = readText(head + "EXACT\n1,255,0,0,255,forest: old, mixed\n2,0,0,255,128,water\n");
    EXPECT_EQ(classes->getMode(), ColorTable::EXACT);
    EXPECT_EQ(classes->at(2), color255(0, 0, 255, 128));
    EXPECT_EQ(classes->at(1.5), clear);
    // A color is that of the values up to its own, as QGIS paints them.
    const auto steps = readText(head + "DISCRETE\n10,255,0,0,255,<= 10\n20,0,255,0,255,10 - 20\n"
                                       "inf,0,0,255,255,> 20\n");
    EXPECT_EQ(steps->getMode(), ColorTable::STEPS);
    std::vector<osg::Vec4ub> row(1024);
    const auto [low, high] = steps->range();
    steps->row(low, high, row.data(), 1024);
    const std::pair<double, osg::Vec4> expected[] = {{-5, red},   {10, red},  {11, green},
                                                     {20, green}, {21, blue}, {900, blue}};
    for (const auto& [value, color] : expected)
    {
        EXPECT_EQ(steps->at(value), color) << value;
        const double place = std::clamp((value - low) / (high - low), 0.0, 1.0) * 1023.0;
        EXPECT_LT(difference(row[static_cast<std::size_t>(std::floor(place + 0.5))], color), 1.0) << value;
    }
    const auto ends = readText(head + "DISCRETE\n10,255,0,0,255,a\n20,0,255,0,255,b\n");
    EXPECT_EQ(ends->at(20), green);
    EXPECT_EQ(ends->at(21), clear);
    const auto two = readText(head + "DISCRETE\n10,255,0,0,255,a\ninf,0,255,0,255,b\n");
    EXPECT_EQ(two->at(10), red);
    EXPECT_EQ(two->at(10.1), green);
}

TEST(ColorRampFile, RulesOfGrass)
{
    const auto table = readText("30 255:0:0\n20 blue\n20 0:255:0\n10 green\nnv white\ndefault #00f\nend\n");
    EXPECT_EQ(table->at(20), blue);
    EXPECT_LT(difference(osg::Vec4ub(0, 255, 0, 255), table->at(19.999999)), 0.01);
    EXPECT_EQ(table->at(30), red);
    EXPECT_EQ(table->at(40), blue);
    EXPECT_EQ(table->at(0), blue);
    EXPECT_EQ(table->getNoDataColor(), osg::Vec4(1, 1, 1, 1));
    EXPECT_EQ(readText("0 #ff000080 # half\n")->at(0), color255(255, 0, 0, 128));
    // A lone jump is no list that descends.
    const auto jump = readText("5 255:0:0\n5 0:0:255\n");
    EXPECT_EQ(jump->at(4.9), red);
    EXPECT_EQ(jump->at(5), blue);
}

/// The sentence after the file's name with which a text is refused.
std::string refusal(const std::string& text, const std::string& name = "ramp.txt")
{
    const TempDir folder;
    const std::string file = folder.write(name, text).string();
    std::string error;
    EXPECT_FALSE(ColorRampFile::read(file, std::nullopt, error)) << text;
    EXPECT_EQ(error.rfind(file, 0), 0u) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_EQ(error.empty() ? ' ' : error.back(), '.') << error;
    return error.substr(std::min(file.size(), error.size()));
}

TEST(ColorRampFile, RefusesWithFileLineAndMend)
{
    EXPECT_EQ(refusal("0 red\nx 1 2 3\n"), ":2: the value is \"x\"; write a number, a percentage or nv.");
    EXPECT_EQ(refusal("\n\n5\n"), ":3: \"5\" has no color; write value, red, green, blue.");
    EXPECT_EQ(refusal("5 1 2\n"), ":1: the color is not complete; write value, red, green, blue.");
    EXPECT_EQ(refusal("5 1 2 256\n"), ":1: the color has \"256\"; write a number from 0 to 255.");
    EXPECT_EQ(refusal("5 1 -2 3\n"), ":1: the color has \"-2\"; write a number from 0 to 255.");
    EXPECT_EQ(refusal("5 1 2 3 solid\n"), ":1: the color has \"solid\"; write a number from 0 to 255.");
    EXPECT_EQ(refusal("5 puce\n"),
              ":1: the color \"puce\" is not known; write red, green and blue as numbers, "
              "#rrggbb, or a name of X11 such as darkgreen.");
    EXPECT_EQ(refusal("INTERPOLATION:CUBIC\n"),
              ":1: the interpolation is not known; write INTERPOLATED, DISCRETE or EXACT.");
    EXPECT_EQ(refusal("INTERPOLATION:EXACT\ninf,1,2,3,255,\n"),
              ":2: the value is \"inf\"; write a number, a percentage or nv.");
    EXPECT_EQ(refusal("101% red\n"), ":1: the percentage is \"101%\"; write 0% to 100%.");
    EXPECT_EQ(refusal("50% red\n"),
              ":1: \"50%\" needs the range of the raster's values; give it, or write plain values.");
    for (const char* value : {"nan", "inf", "-inf", "1e999", "0x10", "1.5.2", "%", "+", "+-1"})
        EXPECT_NE(refusal(std::string(value) + " 1 2 3\n").find(":1: the value is "), std::string::npos)
            << value;
    EXPECT_EQ(refusal("# only a comment\n"),
              ": there are no colors; write a line for each value, such as 100 0 128 0.");
    EXPECT_EQ(refusal(""), ": there are no colors; write a line for each value, such as 100 0 128 0.");
    EXPECT_NE(refusal(std::string("\x89PNG\r\n\x1a\n\0\0\0", 11)).find(":1: "), std::string::npos);
    EXPECT_LT(refusal(std::string(100000, 'x') + " red").size(), 150u);
}

TEST(ColorRampFile, RefusesGmtTablesWithFileLineAndMend)
{
    EXPECT_EQ(refusal("# COLOR_MODEL = HSV\n"), ":1: the COLOR_MODEL is not RGB; convert the file to RGB.");
    EXPECT_EQ(refusal("2 1 2 3\n", "t.cpt"),
              ":1: the slice goes from \"2\" to \"2\"; write two different numbers.");
    const char* const order = "the slice does not begin where the one before ends; put the lines in order.";
    EXPECT_EQ(refusal("0 red 1 red\n0.5 red 2 red\n", "t.cpt"), std::string(":2: ") + order);
    EXPECT_EQ(refusal("0 red 1 red\n1 red 2 red\n-1 red 0 red\n", "t.cpt"), std::string(":3: ") + order);
    EXPECT_EQ(refusal("0 red 1 red\n2 red\n", "t.cpt"),
              ":2: the line is a class, and those before are slices; write one kind of lines.");
    EXPECT_EQ(refusal("2 red\n0 red 1 red\n", "t.cpt"),
              ":2: the line is a slice, and those before are classes; write one kind of lines.");
    EXPECT_EQ(refusal("forest red\n", "t.cpt"),
              ":1: the class \"forest\" is not a number; write the raster's values.");
    EXPECT_EQ(refusal("0 red 1\n", "t.cpt"),
              ":1: the line is not z0 color z1 color; write the colors as R G B or R/G/B.");
    EXPECT_EQ(refusal("0 1/2 1 1/2/3\n", "t.cpt"), ":1: the color is not complete; write R G B or R/G/B.");
    EXPECT_EQ(refusal("B\n", "t.cpt"), ":1: the color is not complete; write R G B or R/G/B.");
}

TEST(ColorRampFile, MissingFilesAndFolders)
{
    const TempDir folder;
    std::string error;
    for (const std::string& path : {std::string("/nowhere/ramp.txt"), folder.path().string(), std::string()})
    {
        EXPECT_FALSE(ColorRampFile::read(path, std::nullopt, error));
        EXPECT_NE(error.find(path + ": the color table cannot be read; "), std::string::npos) << error;
    }
    const auto table = makeTable({{0, red}});
    EXPECT_FALSE(ColorRampFile::write(*table, "/nowhere/ramp.txt", error));
    EXPECT_NE(error.find("/nowhere/ramp.txt: the color table cannot be written; "), std::string::npos)
        << error;
    EXPECT_FALSE(ColorRampFile::write(*makeTable({}), (folder / "empty.txt").string(), error));
    EXPECT_NE(error.find("has no stops"), std::string::npos) << error;
}

/// A table with random stops, some of them doubled, in whole 1/255.
Stops randomStops(Random& random)
{
    Stops stops;
    for (int i = random.integer(1, 12); i > 0; --i)
        stops.push_back({random.integer(0, 3) ? random.uniform(-100, 100) : random.integer(-9, 9) * 10.0,
                         color255(random.integer(0, 255), random.integer(0, 255), random.integer(0, 255),
                                  random.integer(0, 255))});
    return stops;
}

TEST(ColorRampFile, WhatIsWrittenReadsTheSame)
{
    const TempDir folder;
    const std::string file = (folder / "ramp.txt").string();
    for (int sample = 0; sample < 100; ++sample)
    {
        Random random(sample);
        const auto table = makeTable(randomStops(random));
        table->setNoDataColor(color255(1, 2, 3, 4));
        std::string error;
        ASSERT_TRUE(ColorRampFile::write(*table, file, error)) << error;
        const auto again = ColorRampFile::read(file, std::nullopt, error);
        ASSERT_TRUE(again) << error;
        EXPECT_EQ(again->getNoDataColor(), table->getNoDataColor());
        ASSERT_EQ(again->getStops().size(), table->getStops().size());
        for (std::size_t i = 0; i < again->getStops().size(); ++i)
        {
            EXPECT_EQ(again->getStops()[i].value, table->getStops()[i].value);
            EXPECT_EQ(again->getStops()[i].color, table->getStops()[i].color);
        }

        table->setMode(ColorTable::STEPS);
        ASSERT_TRUE(ColorRampFile::write(*table, file, error)) << error;
        const auto steps = ColorRampFile::read(file, std::nullopt, error);
        ASSERT_TRUE(steps) << error;
        for (int i = 0; i < 50; ++i)
        {
            const double value = i % 2 ? random.uniform(-120, 120) : random.integer(-10, 10) * 10.0;
            ASSERT_EQ(steps->at(value), table->at(value)) << value;
        }
    }
}

TEST(ColorRampFile, TheModeIsACommentForGdaldem)
{
    const TempDir folder;
    const auto comment = [&](Mode mode)
    {
        std::string error, line;
        const std::string file = (folder / "ramp.txt").string();
        EXPECT_TRUE(ColorRampFile::write(*makeTable({{0, red}}, mode), file, error)) << error;
        std::ifstream stream(file);
        std::getline(stream, line);
        return line;
    };
    EXPECT_NE(comment(ColorTable::NEAREST).find(" -nearest_color_entry"), std::string::npos);
    EXPECT_NE(comment(ColorTable::EXACT).find(" -exact_color_entry"), std::string::npos);
    EXPECT_EQ(comment(ColorTable::LINEAR).find(" -"), std::string::npos);
}

/// The colors that gdaldem gives for values, by GDAL's own reading of the file.
std::vector<osg::Vec4ub> gdaldemColors(const std::string& file, Mode mode, const std::vector<float>& values)
{
    GDALAllRegister();
    const int count = static_cast<int>(values.size());
    GDALDatasetUniquePtr source(
        GetGDALDriverManager()->GetDriverByName("MEM")->Create("", count, 1, 1, GDT_Float32, nullptr));
    source->GetRasterBand(1)->SetNoDataValue(-9999.0);
    std::vector<float> copy = values;
    EXPECT_EQ(source->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, count, 1, copy.data(), count, 1, GDT_Float32,
                                                 0, 0),
              CE_None);
    std::vector<const char*> arguments = {"-of", "MEM", "-alpha"};
    if (mode == ColorTable::NEAREST) arguments.push_back("-nearest_color_entry");
    arguments.push_back(nullptr);
    GDALDEMProcessingOptions* options =
        GDALDEMProcessingOptionsNew(const_cast<char**>(arguments.data()), nullptr);
    GDALDatasetUniquePtr result(GDALDataset::FromHandle(
        GDALDEMProcessing("", source.get(), "color-relief", file.c_str(), options, nullptr)));
    GDALDEMProcessingOptionsFree(options);
    std::vector<osg::Vec4ub> colors(values.size());
    if (!result) return {};
    EXPECT_EQ(result->RasterIO(GF_Read, 0, 0, count, 1, colors.data(), count, 1, GDT_Byte, 4, nullptr, 4, 0,
                               1, nullptr),
              CE_None);
    return colors;
}

// GDAL's reading of a file is the reference: its colors are rounded to bytes (at 0.45), hence the 1. Its exact mode
// is left out: that of 3.6 misses stops.
TEST(ColorRampFile, AgreesWithGdaldem)
{
    const TempDir folder;
    const char* names[] = {"white", "Black", "red",  "green",  "blue",  "yellow", "magenta", "cyan",
                           "AQUA",  "grey",  "gray", "orange", "brown", "purple", "violet",  "indigo"};
    for (int sample = 0; sample < 60; ++sample)
    {
        Random random(sample);
        std::ostringstream text;
        const bool hasNames = sample % 2 == 0;
        const char separator = ",\t: "[sample % 4];
        std::vector<float> values = {-9999.0f, -1000.0f, 1000.0f};
        for (const auto& stop : randomStops(random))
        {
            // As 32-bit floats: GDAL compares the raster's with what it reads.
            const auto value = static_cast<float>(stop.value);
            values.push_back(value);
            text.precision(17);
            text << static_cast<double>(value) << separator;
            if (hasNames)
                text << names[random.integer(0, 15)];
            else
                for (int i = 0; i < 4; ++i)
                    text << (i ? std::string(1, separator) : "") << std::lround(stop.color[i] * 255.0f);
            text << "\n";
        }
        text << "nv" << separator << "10" << separator << "20" << separator << "30" << separator << "40\n";
        for (int i = 0; i < 100; ++i)
            values.push_back(static_cast<float>(random.uniform(-110, 110)));
        const std::string file = folder.write("ramp.txt", text.str()).string();
        std::string error;
        const auto table = ColorRampFile::read(file, std::nullopt, error);
        ASSERT_TRUE(table) << error;
        for (const Mode mode : {ColorTable::LINEAR, ColorTable::NEAREST})
        {
            table->setMode(mode);
            const auto colors = gdaldemColors(file, mode, values);
            ASSERT_EQ(colors.size(), values.size());
            for (std::size_t i = 0; i < values.size(); ++i)
            {
                const auto value = static_cast<double>(values[i]);
                const Stops& stops = table->getStops();
                // On a jump GDAL's versions differ.
                if (std::count_if(stops.begin(), stops.end(),
                                  [&](const auto& s) { return s.value == value; }) > 1)
                    continue;
                const osg::Vec4 mine = table->at(value == -9999.0 ? std::nan("") : value);
                const osg::Vec4ub& theirs = colors[i];
                ASSERT_LE(difference(theirs, mine), 1.0) << value << " mode " << mode << "\n" << text.str();
            }
        }
    }
}

} // namespace
