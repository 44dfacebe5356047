// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Vec2d>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <tuple>

namespace osgGeoFX
{

/// An axis-aligned rectangle of the plane, metres.
struct PlaneBox
{
    osg::Vec2d low, high;

    bool empty() const { return !(low.x() <= high.x() && low.y() <= high.y()); }
    bool overlaps(const PlaneBox& other) const
    {
        return low.x() <= other.high.x() && other.low.x() <= high.x() && low.y() <= other.high.y() &&
               other.low.y() <= high.y();
    }
    bool contains(const PlaneBox& other) const
    {
        return low.x() <= other.low.x() && low.y() <= other.low.y() && high.x() >= other.high.x() &&
               high.y() >= other.high.y();
    }
    PlaneBox grown(double margin) const
    {
        return {low - osg::Vec2d(margin, margin), high + osg::Vec2d(margin, margin)};
    }
    PlaneBox within(const PlaneBox& other) const
    {
        return {{std::max(low.x(), other.low.x()), std::max(low.y(), other.low.y())},
                {std::min(high.x(), other.high.x()), std::min(high.y(), other.high.y())}};
    }
    PlaneBox with(const PlaneBox& other) const
    {
        return {{std::min(low.x(), other.low.x()), std::min(low.y(), other.low.y())},
                {std::max(high.x(), other.high.x()), std::max(high.y(), other.high.y())}};
    }
};

/** A page of the composed mappings: the square from (x, y) to (x + 1, y + 1) of the mappings' plane, in units of
    2^level metres. Squares do not depend on the mappings, so a page stays where it is whatever is added.

    A page has 248 x 248 texels and a border of four more on all sides, which are those of its neighbours. */
struct MappingPage
{
    static constexpr int side = 256, border = 4, inner = side - 2 * border; ///< texels
    static constexpr int finest = -10, coarsest = 26;                       ///< levels

    int level = 0;
    std::int64_t x = 0, y = 0;

    static double sideOf(int level) { return std::ldexp(1.0, level); }
    static double texelOf(int level) { return sideOf(level) / inner; }
    double metres() const { return sideOf(level); }
    double texel() const { return texelOf(level); }
    PlaneBox square() const
    {
        const double size = metres();
        const osg::Vec2d low(static_cast<double>(x) * size, static_cast<double>(y) * size);
        return {low, low + osg::Vec2d(size, size)};
    }
    /// The square with its border.
    PlaneBox whole() const { return square().grown(border * texel()); }
    MappingPage parent() const { return above(1); }
    MappingPage above(int levels) const { return {level + levels, x >> levels, y >> levels}; }
    /// One of the four pages of the next finer level.
    MappingPage child(int index) const { return {level - 1, 2 * x + index % 2, 2 * y + index / 2}; }

    bool operator==(const MappingPage& other) const
    {
        return level == other.level && x == other.x && y == other.y;
    }
    /// The coarsest first.
    bool operator<(const MappingPage& other) const
    {
        return std::make_tuple(-level, y, x) < std::make_tuple(-other.level, other.y, other.x);
    }
};

struct MappingPageHash
{
    std::size_t operator()(const MappingPage& page) const
    {
        const std::size_t mixed = std::hash<std::int64_t>()(page.x * 0x9E3779B97F4A7C15LL + page.y);
        return mixed * 31 + static_cast<std::size_t>(page.level - MappingPage::finest);
    }
};

} // namespace osgGeoFX
