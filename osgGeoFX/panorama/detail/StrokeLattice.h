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

/// Which random number of a lattice point is asked for.
enum class StrokeChance
{
    East,
    North,
    Cover,
    Cliff,
    Seed,
    Threshold
};

/** The lattice of the whole ground on which brush strokes stand.

    On a globe its columns are meridians and its rows parallels, `spacing` apart at the reference latitude; on a projected
    terrain x and y. A point has a level, in halves: its group, the highest power of two that divides both its indices (Figure
    10 of the paper), and within a group those with an odd sum of indices half a level below the others. So the points of a
    level and all higher ones are a square lattice, upright and diagonal in turn, and each half level halves their number.

    All follows from indices alone: a place has the same points in every tile and at every time. A globe has as many columns
    as a large power of two divides, so that the lattice closes at the date line. Immutable; thread-safe. */
class StrokeLattice
{
public:
    /// The highest level, in halves; what is above belongs to it.
    static constexpr int highest = 32;

    /// `ellipsoid` is null for a projected terrain.
    StrokeLattice(const StrokeParameters& parameters, const osg::EllipsoidModel* ellipsoid);

    /// Column, row (both with fractions, at the steps of the lattice) and height in metres of a place of the world.
    osg::Vec3d coordinates(const osg::Vec3d& world) const;
    /// Column and row of a point of the map: degrees on a globe, else metres; and back.
    osg::Vec2d fromMap(const osg::Vec2d& point) const;
    osg::Vec2d toMap(const osg::Vec2d& place) const;
    bool onGlobe() const { return _ellipsoid.valid(); }
    /// Unit vector away from the ground, in the world.
    osg::Vec3d up(const osg::Vec3d& world) const;

    /// How many columns a globe has; 0 where columns do not return.
    std::int64_t columns() const { return _columns; }
    /// The column nearest to another one among those that are the same on the globe.
    double columnNear(double column, double other) const;

    /// Level of a point, in halves, 0…highest.
    static int halfLevel(std::int64_t column, std::int64_t row);
    /// Spacing of the points of a level and above, in steps.
    static double spacingOf(int halfLevel);
    /// How far strokes of a level stand from their points at most, in steps, along columns and along rows.
    double reach(int halfLevel) const { return _jitter * spacingOf(halfLevel); }
    /// A random number, 0 ≤ x < 1, of a point; the same for columns that are the same on a globe.
    double chance(std::int64_t column, std::int64_t row, StrokeChance which) const;
    /// Where the point's stroke stands: column and row.
    osg::Vec2d place(std::int64_t column, std::int64_t row) const;

private:
    const double _jitter;
    const std::uint64_t _seed;
    const osg::ref_ptr<const osg::EllipsoidModel> _ellipsoid;
    std::int64_t _columns = 0;
    osg::Vec2d _perUnit; ///< steps for each radian or metre
};

} // namespace osgGeoFX
