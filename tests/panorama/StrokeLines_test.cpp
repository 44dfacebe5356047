// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Roads, rivers and towns of panorama maps: where lines have marks, and what lies in a town.
#include <osgGeoFX/panorama/StrokeLines.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

using Line = StrokeLines::Line;
using Mark = StrokeLines::Mark;

osg::ref_ptr<StrokeLines> make(std::vector<Line> lines, StrokeLines::Units units = StrokeLines::METRES)
{
    osg::ref_ptr<StrokeLines> result = new StrokeLines;
    EXPECT_TRUE(result->set(units, std::move(lines)));
    return result;
}

std::vector<Mark> allMarks(const StrokeLines& lines, double step, int level = 0)
{
    return lines.marks({-1e9, -1e9}, {1e9, 1e9}, step, level);
}

std::vector<Line> randomLines(Random& random, unsigned int count)
{
    std::vector<Line> lines;
    for (unsigned int i = 0; i < count; ++i)
    {
        Line line;
        line.kind = i % 3 == 0 ? StrokeLines::RIVER : StrokeLines::ROAD;
        line.points.emplace_back(random.uniform(0.0, 1000.0), random.uniform(0.0, 1000.0));
        const int points = 1 + static_cast<int>(random.uniform(1.0, 8.0));
        for (int j = 0; j < points; ++j)
            line.points.push_back(line.points.back() +
                                  osg::Vec2d(random.uniform(-90.0, 90.0), random.uniform(-90.0, 90.0)));
        lines.push_back(line);
    }
    return lines;
}

TEST(StrokeLines, MarksStandAtMultiplesOfTheStep)
{
    // A right angle, whose corner is at no multiple.
    const auto lines = make({{StrokeLines::ROAD, {{0.0, 0.0}, {25.0, 0.0}, {25.0, 60.0}}}});
    const std::vector<Mark> marks = allMarks(*lines, 10.0);
    ASSERT_EQ(marks.size(), 10u);
    for (int k = 0; k < 9; ++k)
    {
        const Mark& mark = marks[static_cast<std::size_t>(k)];
        EXPECT_EQ(mark.index, k);
        const osg::Vec2d place = k < 3 ? osg::Vec2d(10.0 * k, 0.0) : osg::Vec2d(25.0, 10.0 * k - 25.0);
        EXPECT_LT((mark.place - place).length(), 1e-9) << k;
        EXPECT_GT(k < 3 ? mark.along.x() : mark.along.y(), 0.0);
        EXPECT_EQ(k < 3 ? mark.along.y() : mark.along.x(), 0.0);
        EXPECT_EQ(mark.level, k % 2 == 1 ? 0 : k % 4 == 2 ? 1 : k % 8 == 4 ? 2 : 3) << k;
    }
    EXPECT_EQ(marks[9].index, -1);
    EXPECT_LT((marks[9].place - osg::Vec2d(25.0, 60.0)).length(), 1e-9);
    EXPECT_EQ(marks[9].level, 3);
    // Of a line of 85 m no step is longer than 80 m.
    EXPECT_EQ(allMarks(*lines, 10.0, 3).size(), 3u);
    EXPECT_TRUE(allMarks(*lines, 10.0, 4).empty());
    // The shortest lines are not lost on the finest level.
    EXPECT_EQ(allMarks(*make({{StrokeLines::ROAD, {{0.0, 0.0}, {1.0, 0.0}}}}), 10.0).size(), 2u);
}

TEST(StrokeLines, ABoxHasTheSameMarksAsAll)
{
    Random random(61);
    const auto lines = make(randomLines(random, 200));
    const auto identity = [](const Mark& mark)
    {
        return std::make_tuple(mark.line, mark.index, mark.level, mark.place, mark.along);
    };
    for (int level = 0; level < 4; ++level)
    {
        const std::vector<Mark> all = allMarks(*lines, 7.0, level);
        const std::vector<Mark> finest = allMarks(*lines, 7.0);
        EXPECT_EQ(all.size(),
                  static_cast<std::size_t>(std::count_if(finest.begin(), finest.end(),
                                                         [&](const Mark& m) { return m.level >= level; })));
        for (int i = 0; i < (fullTest() ? 3000 : 100); ++i)
        {
            const osg::Vec2d low(random.uniform(-300.0, 1000.0), random.uniform(-300.0, 1000.0));
            const osg::Vec2d high = low + osg::Vec2d(random.uniform(1.0, 400.0), random.uniform(1.0, 400.0));
            std::set<decltype(identity(all[0]))> here, wanted;
            for (const Mark& mark : lines->marks(low, high, 7.0, level))
                EXPECT_TRUE(here.insert(identity(mark)).second);
            for (const Mark& mark : all)
            {
                if (mark.place.x() >= low.x() && mark.place.x() <= high.x() && mark.place.y() >= low.y() &&
                    mark.place.y() <= high.y())
                    wanted.insert(identity(mark));
            }
            ASSERT_EQ(here, wanted);
        }
    }
}

TEST(StrokeLines, DegreesAreMetresOnTheGlobe)
{
    // A thousandth of a degree is 111.19 m from south to north, and half of it from west to east at 60°.
    for (const bool east : {false, true})
    {
        const osg::Vec2d way = east ? osg::Vec2d(0.02, 0.0) : osg::Vec2d(0.0, 0.02);
        const osg::Vec2d from(179.99, east ? 60.0 : 59.99);
        const auto lines = make({{StrokeLines::ROAD, {from, from + way}}}, StrokeLines::DEGREES);
        const double length = east ? 1112.0 : 2223.9;
        EXPECT_NEAR(static_cast<double>(allMarks(*lines, 10.0).size()), length / 10.0 + 1.5, 1.0);
    }
    // Across the date line it is not around the globe.
    const auto across = make({{StrokeLines::ROAD, {{539.99, 0.0}, {-179.99, 0.0}}}}, StrokeLines::DEGREES);
    const std::vector<osg::Vec2d>& points = across->getLines()[0].points;
    EXPECT_NEAR(std::abs(points[1].x() - points[0].x()), 0.02, 1e-9);
    EXPECT_LE(std::abs(points[0].x()), 180.0);
}

TEST(StrokeLines, TownsHaveAnInsideAndHoles)
{
    const std::vector<osg::Vec2d> ring = {{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}, {0.0, 10.0}, {0.0, 0.0}};
    std::vector<osg::Vec2d> holed = ring;
    for (const osg::Vec2d& point : {osg::Vec2d(3.0, 3.0), osg::Vec2d(7.0, 3.0), osg::Vec2d(7.0, 7.0),
                                    osg::Vec2d(3.0, 7.0), osg::Vec2d(3.0, 3.0), osg::Vec2d(0.0, 0.0)})
        holed.push_back(point);
    // A second one over the hole's right part and beyond; a road is no town.
    const auto lines = make({{StrokeLines::TOWN, holed},
                             {StrokeLines::TOWN, {{6.0, 4.0}, {12.0, 4.0}, {12.0, 6.0}, {6.0, 6.0}}},
                             {StrokeLines::ROAD, {{-50.0, -50.0}, {50.0, -50.0}, {0.0, 50.0}}}});
    const auto wanted = [](const osg::Vec2d& p)
    {
        const auto in = [&](double west, double south, double east, double north)
        {
            return p.x() > west && p.x() < east && p.y() > south && p.y() < north;
        };
        return (in(0.0, 0.0, 10.0, 10.0) && !in(3.0, 3.0, 7.0, 7.0)) || in(6.0, 4.0, 12.0, 6.0);
    };
    Random random(62);
    for (int i = 0; i < (fullTest() ? 3000 : 100); ++i)
    {
        const osg::Vec2d low(random.uniform(-3.0, 10.0), random.uniform(-3.0, 10.0));
        const osg::Vec2d high = low + osg::Vec2d(random.uniform(0.1, 6.0), random.uniform(0.1, 6.0));
        const StrokeLines::Towns towns(*lines, low, high);
        for (int j = 0; j < 50; ++j)
        {
            const osg::Vec2d place(random.uniform(low.x(), high.x()), random.uniform(low.y(), high.y()));
            ASSERT_EQ(towns.contain(place), wanted(place)) << place.x() << " " << place.y();
        }
    }
    EXPECT_TRUE(StrokeLines::Towns(*lines, {20.0, 20.0}, {30.0, 30.0}).empty());
    EXPECT_TRUE(allMarks(*lines, 1.0).front().line == 2u);
}

TEST(StrokeLines, WhatIsNoLineIsRefusedAndChangesNothing)
{
    const auto lines = make({{StrokeLines::ROAD, {{0.0, 0.0}, {1.0, 0.0}}}});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(lines->set(StrokeLines::METRES, {{StrokeLines::ROAD, {{0.0, 0.0}}}}));
    EXPECT_FALSE(lines->set(StrokeLines::METRES, {{StrokeLines::ROAD, {{0.0, 0.0}, {nan, 0.0}}}}));
    EXPECT_FALSE(lines->set(StrokeLines::DEGREES, {{StrokeLines::TOWN, {{0.0, 0.0}, {0.0, 91.0}}}}));
    EXPECT_EQ(lines->getUnits(), StrokeLines::METRES);
    EXPECT_EQ(lines->getLines().size(), 1u);
    EXPECT_TRUE(lines->set(StrokeLines::METRES, {{StrokeLines::ROAD, {{5.0, 5.0}, {5.0, 5.0}}}}));
    EXPECT_EQ(allMarks(*lines, 1.0).size(), 1u); // of no length, but no harm
    EXPECT_TRUE(lines->set(StrokeLines::DEGREES, {}));
    EXPECT_TRUE(allMarks(*lines, 1.0).empty());
    EXPECT_TRUE(allMarks(*make({}), 1.0).empty());
}

} // namespace
