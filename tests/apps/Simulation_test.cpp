// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The simulations of apps/examples: a flood against a search over the cells at each level, a fire against relaxation and by hand.
#include <examples/simulation/Fire.h>
#include <examples/simulation/Flood.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>

using namespace simulation;
using geofx::test::Random;

namespace
{

Field randomField(Random& random, int columns, int rows, double low, double high)
{
    Field field(columns, rows);
    for (float& each : field.cells)
        each = static_cast<float>(random.uniform(low, high));
    return field;
}

/// The cells that water reaches from the sea, one step after the other.
std::vector<bool> reached(const Field& heights, const std::vector<bool>& sea, float level)
{
    std::vector<bool> wet = sea;
    std::deque<int> open;
    for (std::size_t i = 0; i < sea.size(); ++i)
        if (sea[i]) open.push_back(static_cast<int>(i));
    while (!open.empty())
    {
        const int cell = open.front();
        open.pop_front();
        const int column = cell % heights.columns, row = cell / heights.columns;
        for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
        {
            if (!heights.has(column + dx, row + dy)) continue;
            const int next = cell + dx + dy * heights.columns;
            if (wet[static_cast<std::size_t>(next)] || !(heights.at(column + dx, row + dy) < level)) continue;
            wet[static_cast<std::size_t>(next)] = true;
            open.push_back(next);
        }
    }
    return wet;
}

osg::ref_ptr<osg::Image> imageFor(const Field& field)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(field.columns, field.rows, 1, GL_RED, GL_FLOAT);
    return image;
}

float texel(const osg::Image& image, int column, int row)
{
    return *reinterpret_cast<const float*>(
        image.data(static_cast<unsigned int>(column), static_cast<unsigned int>(row)));
}

} // namespace

TEST(Flood, CoversWhatASearchFromTheSeaReaches)
{
    Random random(5);
    for (int i = 0; i < 20; ++i)
    {
        const Field heights = randomField(random, random.integer(1, 30), random.integer(1, 30), -1.0, 8.0);
        std::vector<bool> sea;
        for (std::size_t k = 0; k < heights.cells.size(); ++k)
            sea.push_back(random.integer(0, 30) == 0);
        const Flood flood(heights, [&](int column, int row)
                          { return sea[static_cast<std::size_t>(row * heights.columns + column)]; });
        const osg::ref_ptr<osg::Image> image = imageFor(heights);
        for (const double level : {0.0, 1.3, 3.7, 6.0, 9.0})
        {
            const std::vector<bool> wet = reached(heights, sea, static_cast<float>(level));
            flood.draw(level, *image);
            std::size_t count = 0;
            for (int row = 0; row < heights.rows; ++row)
                for (int column = 0; column < heights.columns; ++column)
                {
                    const auto k = static_cast<std::size_t>(row * heights.columns + column);
                    const float depth = texel(*image, column, row);
                    if (sea[k])
                    {
                        EXPECT_TRUE(std::isnan(depth) || depth == static_cast<float>(level));
                        continue;
                    }
                    ASSERT_EQ(depth > 0.0f, wet[k]) << level;
                    if (!(depth > 0.0f)) continue;
                    ++count;
                    EXPECT_FLOAT_EQ(depth, static_cast<float>(level) - heights.at(column, row));
                }
            EXPECT_EQ(flood.flooded(level), count);
        }
    }
}

TEST(Flood, WhatLiesBehindARidgeStaysDryUntilTheRidgeIsUnder)
{
    // From the left: sea, beach, ridge, polder.
    Field heights(4, 1);
    heights.cells = {-2.0f, 1.0f, 5.0f, -3.0f};
    const Flood flood(heights, [](int column, int) { return column == 0; });
    EXPECT_EQ(flood.flooded(4.9), 1u);
    EXPECT_EQ(flood.flooded(5.1), 3u);
    EXPECT_EQ(flood.levels().at(3, 0), 5.0f);
    // Cells that touch by a corner alone keep water off.
    heights = Field(2, 2, 9.0f);
    heights.at(0, 0) = heights.at(1, 1) = 0.0f;
    EXPECT_EQ(Flood(heights, [](int column, int row) { return column == 0 && row == 0; }).flooded(3.0), 0u);
}

TEST(Fire, IsTheShortestWayFromWhereItBegan)
{
    Random random(9);
    for (int i = 0; i < 3; ++i)
    {
        Fire::Ground ground;
        ground.heights = randomField(random, 14, 11, 0.0, 60.0);
        ground.speeds = randomField(random, 14, 11, 0.01, 0.2);
        for (float& speed : ground.speeds.cells)
            if (random.integer(0, 4) == 0) speed = 0.0f;
        ground.cell = 30.0;
        ground.wind.set(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        ground.speeds.at(5, 5) = 0.1f;
        const Fire fire(ground, 5, 5);
        // Any fire from a cell that burns comes to its neighbors as soon as one that begins there, and no sooner by any other.
        for (int row = 0; row < 11; ++row)
            for (int column = 0; column < 14; ++column)
            {
                if (column == 5 && row == 5) continue;
                float best = never;
                for (int y = -2; y <= 2; ++y)
                    for (int x = -2; x <= 2; ++x)
                    {
                        const int steps = std::abs(x) + std::abs(y);
                        const bool near = steps == 1 || (std::abs(x) == 1 && std::abs(y) == 1) || steps == 3;
                        if (!near || !fire.times().has(column + x, row + y)) continue;
                        if (fire.times().at(column + x, row + y) == never) continue;
                        const Fire one(ground, column + x, row + y);
                        best = std::min(best,
                                        fire.times().at(column + x, row + y) + one.times().at(column, row));
                    }
                const float time = fire.times().at(column, row);
                if (time == never)
                    EXPECT_EQ(best, never) << column << ", " << row;
                else
                    EXPECT_NEAR(time, best, 1e-3f * time) << column << ", " << row;
            }
    }
}

TEST(Fire, IsFasterUphillAndWithTheWindAndStopsAtWater)
{
    Fire::Ground ground;
    ground.heights = Field(101, 101);
    ground.speeds = Field(101, 101, 0.1f);
    ground.cell = 10.0;
    const Fire level(ground, 50, 50);
    // A circle, but for the sixteen directions: at most 2.8 % late between two of them.
    for (int i = 0; i < 64; ++i)
    {
        const double angle = 2.0 * 3.14159265 * i / 64.0;
        const int x = static_cast<int>(std::lround(40.0 * std::cos(angle)));
        const int y = static_cast<int>(std::lround(40.0 * std::sin(angle)));
        const double expected = std::hypot(x, y) * 10.0 / 0.1;
        EXPECT_GE(level.times().at(50 + x, 50 + y), 0.999 * expected);
        EXPECT_LE(level.times().at(50 + x, 50 + y), 1.029 * expected);
    }
    for (int row = 0; row < 101; ++row)
        for (int column = 0; column < 101; ++column)
            ground.heights.at(column, row) = 2.0f * static_cast<float>(column); // a fifth
    const Fire slope(ground, 50, 50);
    const double factor = std::exp(3.533 * std::pow(0.2, 1.2));
    EXPECT_NEAR(slope.times().at(90, 50), 4000.0 / factor, 10.0);
    EXPECT_NEAR(slope.times().at(10, 50), 4000.0 * factor, 60.0);
    ground.heights = Field(101, 101);
    ground.wind.set(0.0, 2.0);
    const Fire wind(ground, 50, 50);
    EXPECT_NEAR(wind.times().at(50, 90), 4000.0 / 3.0, 10.0);
    EXPECT_NEAR(wind.times().at(50, 10), 4000.0 * 3.0, 30.0);
    for (int row = 0; row < 101; ++row)
        ground.speeds.at(60, row) = 0.0f;
    const Fire river(ground, 50, 50);
    EXPECT_EQ(river.times().at(61, 50), never) << "no step leads over it";
    EXPECT_LT(river.times().at(59, 50), never);
}

TEST(Fire, DrawsForHowLongCellsBurn)
{
    Fire::Ground ground;
    ground.heights = Field(5, 1);
    ground.speeds = Field(5, 1, 1.0f);
    ground.cell = 10.0;
    const Fire fire(ground, 0, 0);
    const osg::ref_ptr<osg::Image> image = imageFor(ground.heights);
    const unsigned int count = image->getModifiedCount();
    fire.draw(25.0, *image);
    EXPECT_NE(image->getModifiedCount(), count);
    EXPECT_EQ(texel(*image, 0, 0), 25.0f);
    EXPECT_EQ(texel(*image, 2, 0), 5.0f);
    EXPECT_EQ(texel(*image, 3, 0), -5.0f) << "it comes";
    fire.draw(-4000.0, *image);
    EXPECT_TRUE(std::isnan(texel(*image, 0, 0)));
    EXPECT_EQ(fire.burnt(25.0), 3u);
    EXPECT_EQ(Fire(ground, 7, 0).burnt(1e9), 0u) << "it begins nowhere";
}

TEST(Fire, LandCoverSaysWhatBurns)
{
    EXPECT_EQ(fireSpeed(1), 0.0) << "the sea";
    EXPECT_EQ(fireSpeed(20), 0.0) << "a freeway";
    EXPECT_GT(fireSpeed(9), fireSpeed(10));
    EXPECT_GT(fireSpeed(10), fireSpeed(11));
}
