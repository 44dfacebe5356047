// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/panorama/detail/StrokeParameters.h>

#include <osg/CoordinateSystemNode>
#include <osg/Vec2d>
#include <osg/Vec3d>

#include <cstdint>

namespace osgGeoFX
{

/// Which random number of a lattice point is wanted.
enum class StrokeChance
{
    East,
    North,
    Cover,
    Cliff,
    Seed,
    Threshold,
    Slope
};

/** The lattice of the whole ground, on which brush strokes stand.

    On a globe its columns are meridians and its rows parallels, `spacing` apart at the reference latitude. On a
    projected terrain they are x and y. A point has a level, counted in halves. It is the point's group, the highest
    power of two that divides both its indices (Figure 10 of the paper). Within a group, points with an odd sum of
    indices are half a level lower. So the points of a level and of all higher ones form a square lattice, upright and
    diagonal in turn, and each half level halves their number.

    Everything follows from indices alone: a place has the same points in every tile and at every time. The number of
    a globe's columns is a multiple of a large power of two, so that the lattice closes at the date line. Immutable;
    thread-safe. */
class StrokeLattice
{
public:
    /// The highest level, in halves. Higher points belong to it.
    static constexpr int highest = 32;

    /// `ellipsoid` is null for a projected terrain.
    StrokeLattice(const StrokeParameters& parameters, const osg::EllipsoidModel* ellipsoid);

    /// The column and row of a place of the world, in steps of the lattice with fractions, and its height in metres.
    osg::Vec3d coordinates(const osg::Vec3d& world) const;
    /// Column and row of a point of the map (degrees on a globe, else metres), and the inverse.
    osg::Vec2d fromMap(const osg::Vec2d& point) const;
    osg::Vec2d toMap(const osg::Vec2d& place) const;
    bool onGlobe() const { return _ellipsoid.valid(); }
    /// The unit vector away from the ground, in the world.
    osg::Vec3d up(const osg::Vec3d& world) const;

    /// The number of columns of a globe; 0 if columns do not return.
    std::int64_t columns() const { return _columns; }
    /// The column nearest to `other` among those that are the same on the globe.
    double columnNear(double column, double other) const;

    /// The level of a point, in halves, 0…highest.
    static int halfLevel(std::int64_t column, std::int64_t row);
    /// The spacing of the points of a level and above, in steps.
    static double spacingOf(int halfLevel);
    /// The largest distance of strokes of a level from their points, in steps, along columns and along rows.
    double reach(int halfLevel) const { return _jitter * spacingOf(halfLevel); }
    /// A random number, 0 ≤ x < 1, of a point. Columns that are the same on a globe have the same one.
    double chance(std::int64_t column, std::int64_t row, StrokeChance which) const;
    /// The column and row where the point's stroke stands.
    osg::Vec2d place(std::int64_t column, std::int64_t row) const;

private:
    const double _jitter;
    const std::uint64_t _seed;
    const osg::ref_ptr<const osg::EllipsoidModel> _ellipsoid;
    std::int64_t _columns = 0;
    osg::Vec2d _perUnit; ///< steps for each radian or metre
};

} // namespace osgGeoFX
