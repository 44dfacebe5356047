// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/RegionOfInterest.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

/// What the tests of regions of interest share.
namespace geofx::test
{

using osg::Vec2d;
using osgGeoFX::RegionOfInterest;
using Region = osg::ref_ptr<RegionOfInterest>;
using Line = std::vector<Vec2d>;

inline Region makeRegion(RegionOfInterest::Shape shape, double width = 2000.0, double depth = 2000.0,
                         int side = 64)
{
    Region region = new RegionOfInterest;
    EXPECT_TRUE(region->setShape(shape));
    EXPECT_TRUE(region->setSize(width, depth));
    EXPECT_TRUE(region->setMaskSide(side));
    return region;
}

inline Vec2d halfOf(const RegionOfInterest& region)
{
    const double smaller = std::min(region.getWidth(), region.getDepth());
    return {region.getWidth() / smaller, region.getDepth() / smaller};
}

/// Mask and distance in a texel.
inline Vec2d texelOf(const osg::Image& mask, int column, int row)
{
    float values[2];
    std::memcpy(values, mask.data(column, row), sizeof(values));
    return {static_cast<double>(values[0]), static_cast<double>(values[1])};
}

inline double toSegment(const Vec2d& p, const Vec2d& a, const Vec2d& b)
{
    const Vec2d d = b - a;
    const double t = d.length2() > 0.0 ? std::clamp((p - a) * d / d.length2(), 0.0, 1.0) : 0.0;
    return (p - a - d * t).length();
}

inline double areaOf(const Line& line)
{
    double area = 0.0;
    for (std::size_t i = 0; i < line.size(); ++i)
    {
        const Vec2d &a = line[i], &b = line[(i + 1) % line.size()];
        area += (a.x() * b.y() - a.y() * b.x()) / 2.0;
    }
    return area;
}

inline double areaOf(const std::vector<Line>& lines)
{
    double area = 0.0;
    for (const Line& line : lines)
        area += areaOf(line);
    return area;
}

/// Whether the lines are what contours() says of them, but for the shape.
inline void expectGoodLines(const RegionOfInterest& region, const std::vector<Line>& lines, double step)
{
    const Vec2d half = halfOf(region);
    for (const Line& line : lines)
    {
        ASSERT_GE(line.size(), 3u);
        for (std::size_t i = 0; i < line.size(); ++i)
        {
            const Vec2d part = osg::componentMultiply(line[(i + 1) % line.size()] - line[i], half);
            EXPECT_LE(part.length(), step * (1.0 + 1e-9));
            EXPECT_GT(part.length(), 0.0);
            EXPECT_LE(std::abs(line[i].x()), 1.0);
            EXPECT_LE(std::abs(line[i].y()), 1.0);
        }
    }
}

using Grey = std::function<double(double, double)>;

/// A grey image of a function of −1…1, by means over each texel.
inline osg::ref_ptr<osg::Image> greyImage(int width, int height, const Grey& grey,
                                          GLenum type = GL_UNSIGNED_BYTE)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_LUMINANCE, type);
    for (int row = 0; row < height; ++row)
    {
        for (int column = 0; column < width; ++column)
        {
            const double value = grey((2.0 * column + 1.0) / width - 1.0, (2.0 * row + 1.0) / height - 1.0);
            if (type == GL_FLOAT)
                *reinterpret_cast<float*>(image->data(column, row)) = static_cast<float>(value);
            else
                *image->data(column, row) =
                    static_cast<unsigned char>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
        }
    }
    return image;
}

/// A disc with an edge as wide as a texel.
inline Grey disc(double radius, int side)
{
    return [=](double x, double y)
    {
        return 0.5 + (radius - std::hypot(x, y)) * side / 2.0;
    };
}

inline Region imageRegion(osg::Image* image, int side = 64, double width = 2000.0, double depth = 2000.0)
{
    Region region = makeRegion(RegionOfInterest::IMAGE, width, depth, side);
    EXPECT_TRUE(region->setImage(image));
    return region;
}

inline const Vec2d sizes[] = {{2000, 2000}, {3000, 1000}, {700, 2500}, {1e5, 1e3}};

} // namespace geofx::test
