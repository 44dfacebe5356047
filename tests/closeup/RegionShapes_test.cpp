// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The shape library of regions of interest: distances against brute force, masks and borders.
#include <closeup/RegionSamples.h>
#include <osgGeoFX/closeup/RegionOfInterest.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

using geofx::test::areaOf;
using geofx::test::expectGoodLines;
using geofx::test::fullTest;
using geofx::test::halfOf;
using geofx::test::Line;
using geofx::test::makeRegion;
using geofx::test::Random;
using geofx::test::Region;
using geofx::test::sizes;
using geofx::test::texelOf;
using geofx::test::toSegment;
using osg::Vec2d;
using osgGeoFX::RegionOfInterest;

namespace
{

/// Odd-even by a ray along y, where the library's runs along x.
bool isWithin(const Vec2d& p, const Line& corners)
{
    bool inside = false;
    for (std::size_t i = 0, k = corners.size() - 1; i < corners.size(); k = i++)
    {
        const Vec2d &a = corners[i], &b = corners[k];
        if ((a.x() > p.x()) != (b.x() > p.x()) &&
            p.y() < a.y() + (b.y() - a.y()) * (p.x() - a.x()) / (b.x() - a.x()))
            inside = !inside;
    }
    return inside;
}

double signedDistance(const Vec2d& p, const Line& corners)
{
    double least = 1e30;
    for (std::size_t i = 0; i < corners.size(); ++i)
        least = std::min(least, toSegment(p, corners[i], corners[(i + 1) % corners.size()]));
    return isWithin(p, corners) ? least : -least;
}

/// Compares the picture's distances with those to a polygon with corners in −1…1.
void expectDistances(const RegionOfInterest& region, Line corners, double tolerance)
{
    const Vec2d half = halfOf(region);
    for (Vec2d& corner : corners)
        corner = osg::componentMultiply(corner, half);
    const osg::ref_ptr<const osg::Image> mask = region.mask();
    const int side = region.getMaskSide();
    double worst = 0.0;
    for (int row = 0; row < side; ++row)
    {
        for (int column = 0; column < side; ++column)
        {
            const Vec2d place((2.0 * column + 1.0) / side - 1.0, (2.0 * row + 1.0) / side - 1.0);
            const double distance = signedDistance(osg::componentMultiply(place, half), corners);
            worst = std::max(worst, std::abs(texelOf(*mask, column, row).y() - std::max(distance, -2.0)));
        }
    }
    EXPECT_LT(worst, tolerance);
}

/// A closed curve as many short lines.
Line sampled(int count, const std::function<Vec2d(double)>& curve)
{
    Line line;
    for (int i = 0; i < count; ++i)
        line.push_back(curve(2.0 * osg::PI * i / count));
    return line;
}

Line star(int points, double inner)
{
    Line line;
    for (int i = 0; i < 2 * points; ++i)
    {
        const double radius = i % 2 ? inner : 1.0;
        line.push_back({radius * std::sin(osg::PI * i / points), radius * std::cos(osg::PI * i / points)});
    }
    return line;
}

TEST(RegionShapes, EllipsesHaveTrueDistances)
{
    for (const Vec2d& size : sizes)
    {
        SCOPED_TRACE(size.x());
        const auto ellipse = sampled(4000, [](double a) { return Vec2d(std::cos(a), std::sin(a)); });
        const bool isLong = size.x() > 10000.0;
        expectDistances(*makeRegion(RegionOfInterest::ELLIPSE, size.x(), size.y(), 32), ellipse,
                        isLong ? 1e-3 : 2e-5);
    }
    // The longest region there is has the distances of a strip.
    const Region strip = makeRegion(RegionOfInterest::ELLIPSE, 2e6, 1.0, 16);
    EXPECT_NEAR(strip->maskAt({0.0, 1.0 / 16}).y(), 1.0 - 1.0 / 16, 0.01);
}

TEST(RegionShapes, RectanglesHaveTrueDistances)
{
    for (const Vec2d& size : sizes)
    {
        SCOPED_TRACE(size.x());
        const Line square = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        expectDistances(*makeRegion(RegionOfInterest::RECTANGLE, size.x(), size.y()), square, 1e-6);
        const Region round = makeRegion(RegionOfInterest::ROUNDED, size.x(), size.y(), 32);
        for (const double rounding : {0.0, 0.3, 1.0})
        {
            round->setRounding(rounding);
            const Vec2d half = halfOf(*round);
            const auto corner = [&](double a)
            {
                const Vec2d middle((half.x() - rounding) * (std::cos(a) > 0 ? 1 : -1),
                                   (half.y() - rounding) * (std::sin(a) > 0 ? 1 : -1));
                const Vec2d p = middle + Vec2d(std::cos(a), std::sin(a)) * rounding;
                return Vec2d(p.x() / half.x(), p.y() / half.y());
            };
            // Half a step on, so that no sample lies between two corners.
            expectDistances(*round, sampled(4000, [&](double a) { return corner(a + osg::PI / 4000); }),
                            1e-3);
        }
    }
}

TEST(RegionShapes, PolygonsAndStarsHaveTrueDistances)
{
    const int count = fullTest() ? 400 : 20;
    for (int sample = 0; sample < count; ++sample)
    {
        SCOPED_TRACE(sample);
        Random random(sample);
        const Vec2d& size = sizes[sample % 4];
        Line corners;
        // They cross themselves.
        for (int i = random.integer(3, 60); i > 0; --i)
            corners.push_back({random.uniform(-1, 1), random.uniform(-1, 1)});
        const Region polygon = makeRegion(RegionOfInterest::POLYGON, size.x(), size.y(), 48);
        ASSERT_TRUE(polygon->setOutline(corners));
        expectDistances(*polygon, corners, 1e-5);
        const Region region = makeRegion(RegionOfInterest::STAR, size.x(), size.y(), 48);
        region->setPoints(random.integer(3, 64));
        region->setInnerRadius(random.uniform(0.05, 1.0));
        expectDistances(*region, star(region->getPoints(), region->getInnerRadius()), 1e-5);
    }
    // One point of a star is in front, and it is as deep as the region.
    const Region region = makeRegion(RegionOfInterest::STAR, 2000, 2000, 256);
    EXPECT_GT(region->maskAt({0.0, 0.95}).y(), 0.0);
    EXPECT_LT(region->maskAt({0.0, -0.95}).y(), 0.0);
}

TEST(RegionShapes, AWayToAHoleIsNoBorder)
{
    // In along y = 0, around the hole, and out again.
    const Line keyhole = {{-1, -1},    {1, -1},    {1, 0},   {0.5, 0}, {0.5, -0.5}, {-0.5, -0.5},
                          {-0.5, 0.5}, {0.5, 0.5}, {0.5, 0}, {1, 0},   {1, 1},      {-1, 1}};
    const Region region = makeRegion(RegionOfInterest::POLYGON);
    ASSERT_TRUE(region->setOutline(keyhole));
    EXPECT_NEAR(region->maskAt({0.75, 0.0}).y(), 0.25, 0.02);
    EXPECT_EQ(region->maskAt({0.75, 0.0}).x(), 1.0);
    EXPECT_NEAR(region->maskAt({0.0, 0.0}).y(), -0.5, 0.02);
    const std::vector<Line> lines = region->contours(0.1);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_NEAR(areaOf(lines), 3.0, 0.03);
    EXPECT_LT(std::min(areaOf(lines[0]), areaOf(lines[1])), 0.0); // the hole's runs the other way
}

TEST(RegionShapes, SharpMasksRampOverOneTexelOnEachSide)
{
    // A polygon whose upright edges lie on x = ±0.4, in a region where texels are not square.
    for (const Vec2d& size : {sizes[0], sizes[1], sizes[2]})
    {
        const Region region = makeRegion(RegionOfInterest::POLYGON, size.x(), size.y(), 50);
        ASSERT_TRUE(region->setOutline({{-0.4, -0.4}, {0.4, -0.4}, {0.4, 0.4}, {-0.4, 0.4}}));
        const osg::ref_ptr<const osg::Image> mask = region->mask();
        // x = 0.4 lies between the texels 34 and 35, y = 0.4 likewise.
        for (const bool upright : {true, false})
        {
            const auto at = [&](int i)
            {
                return upright ? texelOf(*mask, i, 25).x() : texelOf(*mask, 25, i).x();
            };
            EXPECT_NEAR(at(33), 1.0, 1e-4);
            EXPECT_NEAR(at(34), 0.75, 1e-4);
            EXPECT_NEAR(at(35), 0.25, 1e-4);
            EXPECT_NEAR(at(36), 0.0, 1e-4);
        }
        EXPECT_NEAR(region->maskAt({0.4, 0.0}).x(), 0.5, 1e-4);
    }
    // On the region's own border too.
    for (const Vec2d& size : {sizes[0], sizes[1], sizes[2]})
    {
        const Region region = makeRegion(RegionOfInterest::ROUNDED, size.x(), size.y());
        region->setRounding(0.0);
        EXPECT_NEAR(region->maskAt({-1, 0}).x(), 0.75, 1e-4);
        EXPECT_NEAR(region->maskAt({0, 1}).x(), 0.75, 1e-4);
    }
    const osg::ref_ptr<const osg::Image> full = makeRegion(RegionOfInterest::RECTANGLE)->mask();
    for (int row = 0; row < 64; ++row)
        for (int column = 0; column < 64; ++column)
            ASSERT_EQ(texelOf(*full, column, row).x(), 1.0);
}

TEST(RegionShapes, SoftMasksGrowFromTheBorder)
{
    for (const auto shape : {RegionOfInterest::ELLIPSE, RegionOfInterest::RECTANGLE,
                             RegionOfInterest::ROUNDED, RegionOfInterest::POLYGON, RegionOfInterest::STAR})
    {
        const Region region = makeRegion(shape, 3000, 1000);
        for (const double softness : {0.05, 0.3, 1.0})
        {
            region->setSoftness(softness);
            const osg::ref_ptr<const osg::Image> mask = region->mask();
            for (int row = 0; row < 64; ++row)
            {
                for (int column = 0; column < 64; ++column)
                {
                    const Vec2d texel = texelOf(*mask, column, row);
                    ASSERT_NEAR(texel.x(), std::clamp(texel.y() / softness, 0.0, 1.0), 1e-6);
                }
            }
        }
    }
}

TEST(RegionShapes, MaskAtIsWhatAShaderInterpolates)
{
    const Region region = makeRegion(RegionOfInterest::STAR, 1500, 1000, 33);
    const osg::ref_ptr<const osg::Image> mask = region->mask();
    EXPECT_EQ(mask->getPixelFormat(), static_cast<GLenum>(GL_RG));
    EXPECT_EQ(mask->getDataType(), static_cast<GLenum>(GL_FLOAT));
    ASSERT_EQ(mask->s(), 33);
    ASSERT_EQ(mask->t(), 33);
    Random random(1);
    for (int i = 0; i < 2000; ++i)
    {
        const Vec2d place(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        const double s = (place.x() + 1.0) / 2.0 * 33 - 0.5, t = (place.y() + 1.0) / 2.0 * 33 - 0.5;
        const auto x = static_cast<int>(std::floor(s)), y = static_cast<int>(std::floor(t));
        Vec2d expected;
        for (int k = 0; k < 4; ++k)
        {
            const int column = x + k % 2, row = y + k / 2;
            expected += texelOf(*mask, std::clamp(column, 0, 32), std::clamp(row, 0, 32)) *
                        ((1.0 - std::abs(s - column)) * (1.0 - std::abs(t - row)));
        }
        const Vec2d found = region->maskAt(place);
        ASSERT_NEAR(found.x(), expected.x(), 1e-9);
        // Beyond the outermost texels the distance goes on to the region's edge (CloseUpShaders_test).
        const bool between = x >= 0 && y >= 0 && x < 32 && y < 32;
        ASSERT_NEAR(found.y(), expected.y(),
                    between ? 1e-9 : 1.5 / 33); // a texel and a half of the smaller side
        ASSERT_LE(found.y(), expected.y() + 1e-9);
    }
    const Region full = makeRegion(RegionOfInterest::RECTANGLE);
    EXPECT_EQ(full->maskAt({1.0, -1.0}).x(), 1.0);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Vec2d& place :
         {Vec2d(1.0001, 0), Vec2d(0, -1.0001), Vec2d(nan, 0), Vec2d(0, nan), Vec2d(1e300, 0)})
        EXPECT_EQ(full->maskAt(place), Vec2d(0.0, -2.0));
}

TEST(RegionShapes, BordersAreClosedAndGoAroundTheShape)
{
    using Roi = RegionOfInterest;
    const double fifth = osg::PI / 5.0;
    for (const Vec2d& size : {sizes[0], sizes[1], sizes[2]})
    {
        const Vec2d half = size / std::min(size.x(), size.y());
        const std::pair<Roi::Shape, double> shapes[] = {
            {Roi::ELLIPSE, osg::PI},
            {Roi::RECTANGLE, 4.0},
            {Roi::ROUNDED, 4.0 - (4.0 - osg::PI) * 0.3 * 0.3 / (half.x() * half.y())},
            {Roi::POLYGON, 4.0},
            {Roi::STAR, 5.0 * 0.45 * std::sin(fifth)}};
        for (const auto& [shape, area] : shapes)
        {
            for (const double step : {0.001, 0.05, 1.0})
            {
                SCOPED_TRACE(std::to_string(shape) + " " + std::to_string(size.x()));
                const Region region = makeRegion(shape, size.x(), size.y(), 256);
                const std::vector<Line> lines = region->contours(step);
                ASSERT_EQ(lines.size(), 1u);
                EXPECT_NEAR(areaOf(lines), area, 0.01 * area);
                expectGoodLines(*region, lines, step);
                // The line is where a shader finds the distance 0.
                for (const Vec2d& place : lines[0])
                {
                    const bool isInner = std::max(std::abs(place.x()), std::abs(place.y())) < 1.0 - 1.0 / 256;
                    ASSERT_NEAR(region->maskAt(place).y(), 0.0, isInner ? 0.002 : 0.02);
                }
            }
        }
    }
    // The border of a rectangle is the region's, whatever the mask's resolution.
    for (const Line& line : makeRegion(Roi::RECTANGLE, 3000, 1000, 16)->contours(0.3))
        for (const Vec2d& place : line)
            EXPECT_GT(std::max(std::abs(place.x()), std::abs(place.y())), 1.0 - 1.0 / 16);
    const Region region = makeRegion(Roi::ELLIPSE, 2000, 2000, 16);
    for (const double step : {-5.0, 0.0, std::numeric_limits<double>::quiet_NaN()})
        expectGoodLines(*region, region->contours(step), 0.001);
    EXPECT_EQ(region->contours(1e9), region->contours(1.0));
}

} // namespace
