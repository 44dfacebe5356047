// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/StrokeLattice.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// The finaliser of SplitMix64: every bit of the result depends on every bit of the input.
std::uint64_t mixed(std::uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// The power of two that divides the columns of a globe. It is as high as levels go, as long as rounding the columns
/// to it changes the spacing by a few parts in a hundred only.
std::int64_t roundColumns(double columns)
{
    std::int64_t power = std::int64_t{1} << (StrokeLattice::highest / 2);
    while (power > 1 && columns < 16.0 * static_cast<double>(power))
        power /= 2;
    return std::max<std::int64_t>(std::llround(columns / static_cast<double>(power)), 1) * power;
}

} // namespace

StrokeLattice::StrokeLattice(const StrokeParameters& parameters, const osg::EllipsoidModel* ellipsoid)
    : _jitter(parameters.jitter), _seed(mixed(parameters.seed)), _ellipsoid(ellipsoid)
{
    const double spacing = std::max(parameters.spacing, 1e-3);
    _perUnit.set(1.0 / spacing, 1.0 / spacing);
    if (!ellipsoid) return;
    _perUnit *= ellipsoid->getRadiusEquator();
    const double latitude = std::clamp(parameters.referenceLatitude, -1.5, 1.5);
    _columns = roundColumns(2.0 * osg::PI * std::cos(latitude) * _perUnit.x());
    _perUnit.x() = static_cast<double>(_columns) / (2.0 * osg::PI);
}

osg::Vec3d StrokeLattice::coordinates(const osg::Vec3d& world) const
{
    osg::Vec3d place = world;
    if (_ellipsoid)
    {
        double latitude = 0.0, longitude = 0.0, height = 0.0;
        _ellipsoid->convertXYZToLatLongHeight(world.x(), world.y(), world.z(), latitude, longitude, height);
        place.set(longitude, latitude, height);
    }
    return {place.x() * _perUnit.x(), place.y() * _perUnit.y(), place.z()};
}

osg::Vec2d StrokeLattice::fromMap(const osg::Vec2d& point) const
{
    const double unit = _ellipsoid ? osg::PI / 180.0 : 1.0;
    return {point.x() * unit * _perUnit.x(), point.y() * unit * _perUnit.y()};
}

osg::Vec2d StrokeLattice::toMap(const osg::Vec2d& place) const
{
    const double unit = _ellipsoid ? 180.0 / osg::PI : 1.0;
    return {place.x() / _perUnit.x() * unit, place.y() / _perUnit.y() * unit};
}

osg::Vec3d StrokeLattice::up(const osg::Vec3d& world) const
{
    if (!_ellipsoid) return {0.0, 0.0, 1.0};
    const double a = _ellipsoid->getRadiusEquator(), b = _ellipsoid->getRadiusPolar();
    osg::Vec3d gradient(world.x(), world.y(), world.z() * (a * a) / (b * b));
    gradient.normalize();
    return gradient;
}

double StrokeLattice::columnNear(double column, double other) const
{
    return _columns > 0 ? other + std::remainder(column - other, static_cast<double>(_columns)) : column;
}

int StrokeLattice::halfLevel(std::int64_t column, std::int64_t row)
{
    for (int group = 0; group < highest / 2; ++group)
    {
        const std::int64_t odd = std::int64_t{1} << group;
        if (column & odd || row & odd) return 2 * group + (((column ^ row) & odd) != 0 ? 0 : 1);
    }
    return highest;
}

double StrokeLattice::spacingOf(int halfLevel)
{
    return std::exp2(0.5 * halfLevel);
}

double StrokeLattice::chance(std::int64_t column, std::int64_t row, StrokeChance which) const
{
    if (_columns > 0) column = (column % _columns + _columns) % _columns;
    const std::uint64_t point =
        mixed(static_cast<std::uint64_t>(column) ^ _seed) ^ static_cast<std::uint64_t>(row);
    const std::uint64_t bits = mixed(mixed(point) + static_cast<std::uint64_t>(which));
    return static_cast<double>(bits >> 11) * 0x1p-53;
}

osg::Vec2d StrokeLattice::place(std::int64_t column, std::int64_t row) const
{
    // The range follows the spacing of the point's own level, so that rows look alike at every zoom.
    const double range = 2.0 * reach(halfLevel(column, row));
    return {static_cast<double>(column) + range * (chance(column, row, StrokeChance::East) - 0.5),
            static_cast<double>(row) + range * (chance(column, row, StrokeChance::North) - 0.5)};
}

} // namespace osgGeoFX
