// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Color tables: the color of a value, and the row that a shader looks into.
#include <osgGeoFX/raster/ColorTable.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace osgGeoFX;
using geofx::test::Random;
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

/// What the shader does with a row, by the formula in ColorTable::row(); 0…255 with fractions.
osg::Vec4d lookUp(const std::vector<osg::Vec4ub>& row, Mode mode, double low, double high, double value)
{
    const auto last = static_cast<int>(row.size()) - 1;
    const auto texel = [&](int i)
    {
        const osg::Vec4ub& t = row[std::min(i, last)];
        return osg::Vec4d(t[0], t[1], t[2], t[3]);
    };
    if (mode == ColorTable::EXACT && (value < low || value > high)) return {};
    const double s = std::clamp((value - low) / (high - low), 0.0, 1.0) * last;
    if (mode != ColorTable::LINEAR) return texel(static_cast<int>(std::floor(s + 0.5)));
    const double fraction = s - std::floor(s);
    return texel(static_cast<int>(s)) * (1.0 - fraction) + texel(static_cast<int>(s) + 1) * fraction;
}

/// The largest difference of two colors' parts, in 1/255.
double difference(const osg::Vec4d& bytes, const osg::Vec4& color)
{
    double most = 0.0;
    for (int i = 0; i < 4; ++i)
        most = std::max(most, std::abs(bytes[i] - 255.0 * static_cast<double>(color[i])));
    return most;
}

std::vector<osg::Vec4ub> rowOf(const ColorTable& table, double low, double high, int width = 1024)
{
    std::vector<osg::Vec4ub> row(width);
    EXPECT_TRUE(table.row(low, high, row.data(), width));
    return row;
}

TEST(ColorTable, LinearMixesAndStaysBeyondItsEnds)
{
    const auto table = makeTable({{20, blue}, {0, red}, {10, green}});
    EXPECT_EQ(table->getStops()[0].value, 0.0); // in order
    EXPECT_EQ(table->at(-5), red);
    EXPECT_EQ(table->at(0), red);
    EXPECT_EQ(table->at(2.5), osg::Vec4(0.75f, 0.25f, 0, 1));
    EXPECT_EQ(table->at(10), green);
    EXPECT_EQ(table->at(15), osg::Vec4(0, 0.5f, 0.5f, 1));
    EXPECT_EQ(table->at(1e300), blue);
    EXPECT_EQ(table->at(std::numeric_limits<double>::infinity()), blue);
    EXPECT_EQ(table->at(-std::numeric_limits<double>::infinity()), red);
    EXPECT_EQ(table->range(), (std::pair<double, double>(0.0, 20.0)));
    // The largest numbers there are.
    EXPECT_EQ(makeTable({{-1.5e308, red}, {1.5e308, blue}})->at(0), osg::Vec4(0.5f, 0, 0.5f, 1));
}

TEST(ColorTable, DoubledStopsAreAJump)
{
    const Stops stops = {{0, red}, {10, red}, {10, clear}, {10, blue}, {20, green}};
    const auto table = makeTable(stops);
    EXPECT_EQ(table->at(std::nextafter(10.0, 0.0)), red);
    EXPECT_EQ(table->at(10), blue);
    EXPECT_EQ(table->at(15), osg::Vec4(0, 0.5f, 0.5f, 1));
    table->setMode(ColorTable::STEPS);
    EXPECT_EQ(table->at(9.99), red);
    EXPECT_EQ(table->at(10), blue);
    // Doubled ends: a color for what lies outside.
    const auto ends = makeTable({{0, red}, {0, green}, {1, green}, {1, blue}});
    EXPECT_EQ(ends->at(-0.001), red);
    EXPECT_EQ(ends->at(0), green);
    EXPECT_EQ(ends->at(1), blue);
}

TEST(ColorTable, NearestExactAndSteps)
{
    const auto table = makeTable({{0, red}, {10, green}, {20, blue}}, ColorTable::NEAREST);
    EXPECT_EQ(table->at(-9), red);
    EXPECT_EQ(table->at(4.99), red);
    EXPECT_EQ(table->at(5), green);
    EXPECT_EQ(table->at(99), blue);

    table->setMode(ColorTable::STEPS);
    EXPECT_EQ(table->at(-9), red);
    EXPECT_EQ(table->at(9.99), red);
    EXPECT_EQ(table->at(10), green);
    EXPECT_EQ(table->at(99), blue);

    table->setMode(ColorTable::EXACT);
    EXPECT_EQ(table->at(10), green);
    EXPECT_EQ(table->at(20), blue);
    for (const double value : {-1.0, 9.9999, 10.0001, 21.0, 1e300, -1e300})
        EXPECT_EQ(table->at(value), clear) << value;
    // What a raster of 32-bit floats holds for 0.1 is the class 0.1.
    EXPECT_TRUE(table->addStop(0.1, blue));
    EXPECT_EQ(table->at(static_cast<double>(0.1f)), blue);
}

TEST(ColorTable, NoDataAndEmptyTables)
{
    osg::ref_ptr<ColorTable> table = new ColorTable;
    EXPECT_EQ(table->at(3), clear);
    EXPECT_EQ(table->range(), (std::pair<double, double>(0.0, 1.0)));
    EXPECT_EQ(table->at(std::nan("")), clear);
    EXPECT_TRUE(table->setNoDataColor(green));
    EXPECT_EQ(table->at(std::nan("")), green);
    EXPECT_EQ(rowOf(*table, 0, 1, 8)[3], osg::Vec4ub(0, 0, 0, 0));
}

TEST(ColorTable, RefusesWhatMakesNoSense)
{
    const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
    const auto table = makeTable({{1, red}});
    const unsigned int revision = table->revision();
    EXPECT_FALSE(table->addStop(nan, red));
    EXPECT_FALSE(table->addStop(infinite, red));
    EXPECT_FALSE(table->addStop(0, osg::Vec4(0, 0, std::nanf(""), 1)));
    EXPECT_FALSE(table->addStop(0, osg::Vec4(0, 0, 0, 1.01f)));
    EXPECT_FALSE(table->addStop(0, osg::Vec4(-0.01f, 0, 0, 1)));
    EXPECT_FALSE(table->setStops({{0, red}, {-infinite, red}}));
    EXPECT_FALSE(table->setNoDataColor(osg::Vec4(2, 0, 0, 1)));
    EXPECT_EQ(table->getStops().size(), 1u);
    EXPECT_EQ(table->getNoDataColor(), clear);
    EXPECT_EQ(table->revision(), revision);
    EXPECT_TRUE(table->addStop(0, blue));
    EXPECT_GT(table->revision(), revision);
}

TEST(ColorTable, CopiesHaveEverything)
{
    const auto table = makeTable({{1, red}, {2, blue}}, ColorTable::STEPS);
    table->setNoDataColor(green);
    table->setName("noise");
    const osg::ref_ptr<ColorTable> copy = osg::clone(table.get());
    EXPECT_EQ(copy->getName(), "noise");
    EXPECT_EQ(copy->getMode(), ColorTable::STEPS);
    EXPECT_EQ(copy->getNoDataColor(), green);
    EXPECT_EQ(copy->at(2), blue);
    EXPECT_STREQ(copy->className(), "ColorTable");
}

TEST(ColorTableRow, LinearIsRightWithinAByte)
{
    // Stops an eighth of the range apart, slopes that change by 8 at most.
    for (int sample = 0; sample < 200; ++sample)
    {
        Random random(sample);
        const double low = random.uniform(-1000, 1000), high = low + random.logarithmic(1e-3, 1e5);
        Stops stops;
        for (int i = 0; i <= 8; ++i)
        {
            osg::Vec4 color;
            for (int c = 0; c < 4; ++c)
                color[c] = static_cast<float>(random.uniform(0.0, 0.5));
            stops.push_back({low + (high - low) * (i + random.uniform(-0.1, 0.0)) / 8.0, color});
        }
        // 0.5 within 0.9 / 8 of the range: slopes of 4.5, which may change by 9, a little more than promised.
        const auto table = makeTable(stops);
        const auto row = rowOf(*table, low, high);
        for (int i = 0; i < 500; ++i)
        {
            const double value = random.uniform(low - 0.1 * (high - low), high + 0.1 * (high - low));
            const osg::Vec4 expected = table->at(std::clamp(value, low, high));
            ASSERT_LT(difference(lookUp(row, ColorTable::LINEAR, low, high, value), expected), 1.1);
        }
    }
    for (const std::string& name : ColorTable::names())
    {
        const auto table = ColorTable::named(name, -10, 30);
        const auto row = rowOf(*table, -10, 30);
        double most = 0.0;
        for (double value = -10; value <= 30; value += 0.001)
            most =
                std::max(most, difference(lookUp(row, ColorTable::LINEAR, -10, 30, value), table->at(value)));
        EXPECT_LT(most, 1.0) << name;
    }
}

TEST(ColorTableRow, EndsAreExact)
{
    const auto table = makeTable({{-0.1, red}, {0.7, blue}});
    const auto row = rowOf(*table, -0.1, 0.7);
    EXPECT_EQ(row.front(), osg::Vec4ub(255, 0, 0, 255));
    EXPECT_EQ(row.back(), osg::Vec4ub(0, 0, 255, 255));
    // Nothing between low and high.
    for (const double high : {-0.1, -3.0, std::nan(""), std::numeric_limits<double>::infinity()})
        EXPECT_EQ(rowOf(*table, -0.1, high, 4)[3], osg::Vec4ub(255, 0, 0, 255)) << high;
    EXPECT_EQ(rowOf(*table, -0.1, 0.7, 1)[0], osg::Vec4ub(255, 0, 0, 255));
}

/// A color of its own for each class.
osg::Vec4 classColor(int number)
{
    return osg::Vec4(static_cast<float>(number * 37 % 256), static_cast<float>(number),
                     static_cast<float>(number * 101 % 256), 255.0f) /
           255.0f;
}

TEST(ColorTableRow, EveryClassHasItsColor)
{
    Stops stops;
    for (int i = 0; i < 256; ++i)
        stops.push_back({static_cast<double>(i), classColor(i)});
    // Plateaus with jumps, as gdaldem's users write "round to floor".
    Stops jumps;
    for (int i = 0; i < 256; ++i)
    {
        jumps.push_back({static_cast<double>(i), classColor(i)});
        jumps.push_back({static_cast<double>(i + 1), classColor(i)});
    }
    for (const Mode mode : {ColorTable::EXACT, ColorTable::NEAREST, ColorTable::STEPS, ColorTable::LINEAR})
    {
        const auto table = makeTable(mode == ColorTable::LINEAR ? jumps : stops, mode);
        for (const auto& [low, high] : {std::pair(0.0, 255.0), std::pair(-3.0, 259.5), std::pair(0.0, 300.0)})
        {
            const auto row = rowOf(*table, low, high);
            for (int i = 0; i < 256; ++i)
                ASSERT_LT(difference(lookUp(row, mode, low, high, i), classColor(i)), 0.01)
                    << i << " mode " << mode << " up to " << high;
        }
    }
    const auto table = makeTable({{3, red}, {7, blue}}, ColorTable::EXACT);
    const auto row = rowOf(*table, 0, 255);
    for (const double value : {0.0, 2.0, 4.0, 6.5, 8.0, 255.0, -1.0, 256.0})
        EXPECT_LT(difference(lookUp(row, ColorTable::EXACT, 0, 255, value), clear), 0.01) << value;
}

TEST(ColorTableRow, JumpsBlurOnlyBelow)
{
    for (int sample = 0; sample < 200; ++sample)
    {
        Random random(sample);
        const double jump = random.uniform(0.1, 0.9), texel = 1.0 / 1023.0;
        // Above it a steep ramp: 10/255 per texel.
        const auto table = makeTable({{0, red},
                                      {jump, green},
                                      {jump, osg::Vec4(0.4f, 0.4f, 0.6f, 1)},
                                      {jump + 0.0125, osg::Vec4(0.9f, 0.1f, 0.2f, 1)},
                                      {1, red}});
        const auto row = rowOf(*table, 0, 1);
        for (int i = 0; i < 200; ++i)
        {
            const double above = random.uniform(jump, std::min(1.0, jump + 4.0 * texel));
            ASSERT_LT(difference(lookUp(row, ColorTable::LINEAR, 0, 1, above), table->at(above)), 1.0);
            const double under = random.uniform(0.0, jump - 2.0 * texel);
            ASSERT_LT(difference(lookUp(row, ColorTable::LINEAR, 0, 1, under), table->at(under)), 1.0);
        }
        ASSERT_LT(difference(lookUp(row, ColorTable::LINEAR, 0, 1, jump), table->at(jump)), 1.0);
    }
}

TEST(ColorTableRow, JumpsAtATexelsOwnValueBeginThere)
{
    // Tenths are not what floating-point numbers hold.
    for (int texel = 1; texel < 1023; ++texel)
    {
        const double jump = texel * 0.1;
        const auto row = rowOf(*makeTable({{0, red}, {jump, red}, {jump, blue}, {102.3, blue}}), 0, 102.3);
        ASSERT_EQ(row[texel - 1], osg::Vec4ub(255, 0, 0, 255)) << texel;
        ASSERT_EQ(row[texel], osg::Vec4ub(0, 0, 255, 255)) << texel;
    }
}

TEST(ColorTableRow, StepsAndNearestAreRightAwayFromTheirBorders)
{
    for (int sample = 0; sample < 100; ++sample)
    {
        Random random(sample);
        Stops stops;
        for (int i = 0; i < 20; ++i)
            stops.push_back({i + random.uniform(0.0, 0.9), classColor(i)});
        for (const Mode mode : {ColorTable::STEPS, ColorTable::NEAREST})
        {
            const auto table = makeTable(stops, mode);
            const auto row = rowOf(*table, -1, 21);
            for (int i = 0; i < 200; ++i)
            {
                // A step begins with the texel of its value.
                const double value = random.uniform(-1, 21), half = 1.01 * 22 / 1023;
                if (table->at(value - half) != table->at(value + half)) continue;
                ASSERT_LT(difference(lookUp(row, mode, -1, 21, value), table->at(value)), 0.01);
            }
        }
    }
}

TEST(ColorTableRow, FinerOnesAreRightWithinAFractionOfAByte)
{
    const auto table = makeTable({{0, red}, {10, green}, {20, blue}});
    std::vector<osg::Vec4us> fine(1024);
    EXPECT_TRUE(table->row(0, 20, fine.data(), 1024));
    const std::vector<osg::Vec4ub> coarse = rowOf(*table, 0, 20);
    for (int i = 0; i < 1024; ++i)
    {
        const osg::Vec4 color = table->at(20.0 * i / 1023.0);
        for (int part = 0; part < 4; ++part)
        {
            EXPECT_NEAR(fine[i][part], 65535.0 * static_cast<double>(color[part]), 0.51);
            EXPECT_NEAR(coarse[i][part], fine[i][part] / 257.0, 0.51);
        }
    }
}

TEST(ColorTableRow, SaysWhereStopsAreTooClose)
{
    std::vector<osg::Vec4ub> row(16);
    const auto table = makeTable({{0, red}, {100, green}, {101, blue}, {200, red}}, ColorTable::EXACT);
    EXPECT_FALSE(table->row(0, 200, row.data(), 16));
    EXPECT_TRUE(table->row(90, 105, row.data(), 16));
    EXPECT_TRUE(makeTable({{0, red}, {100, red}, {100, blue}, {200, red}})->row(0, 200, row.data(), 16));
}

TEST(ColorTable, ReadyOnes)
{
    EXPECT_EQ(ColorTable::names().size(), 6u);
    for (const std::string& name : ColorTable::names())
    {
        const auto table = ColorTable::named(name, 100, 200);
        ASSERT_TRUE(table) << name;
        EXPECT_EQ(table->range(), (std::pair<double, double>(100.0, 200.0))) << name;
    }
    for (const char* name : {"viridis", "magma", "cividis"})
    {
        const auto table = ColorTable::named(name);
        EXPECT_GE(table->getStops().size(), 16u);
        // Their lightness grows steadily.
        double before = -1.0;
        for (double value = 0.0; value <= 1.0; value += 0.01)
        {
            const osg::Vec4 c = table->at(value);
            const double lightness =
                static_cast<double>(0.2126f * std::pow(c[0], 2.2f) + 0.7152f * std::pow(c[1], 2.2f) +
                                    0.0722f * std::pow(c[2], 2.2f));
            EXPECT_GT(lightness, before) << name << " at " << value;
            before = lightness;
        }
    }
    EXPECT_LT(difference(osg::Vec4d(0x44, 0x01, 0x54, 255), ColorTable::named("viridis")->at(0)), 0.01);
    EXPECT_LT(difference(osg::Vec4d(127.5, 127.5, 127.5, 255), ColorTable::named("greys")->at(0.5)), 0.01);
    EXPECT_FALSE(ColorTable::named("rainbow"));
    EXPECT_FALSE(ColorTable::named("greys", 0, std::nan("")));
}

TEST(ColorTable, Legend)
{
    const auto table = makeTable({{0, red}, {10, blue}});
    const auto wide = table->legend(0, 10, 64, 8);
    ASSERT_TRUE(wide);
    EXPECT_EQ(wide->s(), 64);
    EXPECT_EQ(wide->t(), 8);
    EXPECT_EQ(wide->getColor(0u, 5u), red);
    EXPECT_EQ(wide->getColor(63u, 0u), blue);
    const auto high = table->legend(0, 10, 8, 64);
    EXPECT_EQ(high->getColor(7u, 0u), red);
    EXPECT_EQ(high->getColor(7u, 63u), blue);

    const auto classes = makeTable({{1, red}, {2, green}, {50, blue}, {99, red}}, ColorTable::EXACT);
    const auto fields = classes->legend(1, 50, 30, 2);
    for (unsigned int x = 0; x < 30; ++x)
        EXPECT_EQ(fields->getColor(x, 1u), x < 10 ? red : x < 20 ? green : blue) << x;
    EXPECT_EQ(classes->legend(200, 300, 3, 3)->getColor(1u, 1u), clear);
    for (const auto& [width, height] : {std::pair(0, 5), std::pair(5, -1), std::pair(16385, 5)})
        EXPECT_FALSE(table->legend(0, 10, width, height));
}

} // namespace
