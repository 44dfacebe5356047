// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/TilingScheme.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

const double WGS84_A = GeographicLib::Constants::WGS84_a(), WGS84_F = GeographicLib::Constants::WGS84_f();

// A grid that crosses the antimeridian has longitudes beyond ±180°.
double turned(double longitude)
{
    return longitude - 360.0 * std::round(longitude / 360.0);
}

} // namespace

Lattice TilingScheme::lattice(double column, double row, double spacing, int columns, int rows) const
{
    Lattice result;
    const double dx = (east - west) / lastColumn, dy = (north - south) / lastRow;
    result.x0 = west + dx * column;
    result.y0 = south + dy * row;
    result.dx = dx * spacing;
    result.dy = dy * spacing;
    result.columns = columns;
    result.rows = rows;
    return result;
}

bool TilingScheme::endsAt(const TileKey& key, int side) const
{
    const int width = intervals * step(key.level);
    switch (side)
    {
    case 0:
        return key.y == 0;
    case 1:
        return firstColumn(key) + width >= lastColumn;
    case 2:
        return firstRow(key) + width >= lastRow;
    default:
        return key.x == 0;
    }
}

double TilingScheme::metresX(double y) const
{
    const double dx = (east - west) / lastColumn;
    if (!crs.geographic) return dx * crs.metresPerUnit;
    // Not at the poles, where slopes to the east would be divided by 0.
    const double latitude = osg::DegreesToRadians(std::clamp(y, -89.9, 89.9));
    const double e2 = WGS84_F * (2.0 - WGS84_F);
    const double sine = std::sin(latitude);
    return osg::DegreesToRadians(dx) * WGS84_A * std::cos(latitude) / std::sqrt(1.0 - e2 * sine * sine);
}

double TilingScheme::metresY(double y) const
{
    const double dy = (north - south) / lastRow;
    if (!crs.geographic) return dy * crs.metresPerUnit;
    const double e2 = WGS84_F * (2.0 - WGS84_F);
    const double sine = std::sin(osg::DegreesToRadians(y));
    const double w2 = 1.0 - e2 * sine * sine;
    return osg::DegreesToRadians(dy) * WGS84_A * (1.0 - e2) / (w2 * std::sqrt(w2));
}

double TilingScheme::tileMetres(int level) const
{
    // The parallel nearest to the equator is the longest.
    const double widest = crs.geographic ? std::clamp(0.0, south, north) : south;
    return std::max(metresX(widest), metresY(widest)) * intervals * step(level);
}

TileFrame::TileFrame(const TilingScheme& scheme, const TileKey& key) : _scheme(scheme)
{
    const double width = static_cast<double>(scheme.intervals) * scheme.step(key.level);
    _centerX = 0.5 * (scheme.gridX(scheme.firstColumn(key)) + scheme.gridX(scheme.firstColumn(key) + width));
    _centerY = 0.5 * (scheme.gridY(scheme.firstRow(key)) + scheme.gridY(scheme.firstRow(key) + width));
    if (scheme.crs.geographic) _geodetic.emplace(_centerY, turned(_centerX), 0.0);
}

osg::Matrixd TileFrame::localToWorld() const
{
    if (!_geodetic)
        return osg::Matrixd::translate(_centerX * _scheme.crs.metresPerUnit,
                                       _centerY * _scheme.crs.metresPerUnit, 0.0);
    double x = 0.0, y = 0.0, z = 0.0;
    std::vector<double>& r = _rotation;
    GeographicLib::Geocentric::WGS84().Forward(_geodetic->LatitudeOrigin(), _geodetic->LongitudeOrigin(), 0.0,
                                               x, y, z, r);
    // East, north and up are columns for GeographicLib, and rows for OSG.
    return osg::Matrixd(r[0], r[3], r[6], 0.0, r[1], r[4], r[7], 0.0, r[2], r[5], r[8], 0.0, x, y, z, 1.0);
}

osg::Vec3d TileFrame::position(double x, double y, double height) const
{
    if (!_geodetic)
        return {(x - _centerX) * _scheme.crs.metresPerUnit, (y - _centerY) * _scheme.crs.metresPerUnit,
                height};
    osg::Vec3d p;
    _geodetic->Forward(y, turned(x), height, p.x(), p.y(), p.z());
    return p;
}

void TileFrame::axes(double x, double y, osg::Vec3d& east, osg::Vec3d& north, osg::Vec3d& up) const
{
    if (!_geodetic)
    {
        east.set(1.0, 0.0, 0.0);
        north.set(0.0, 1.0, 0.0);
        up.set(0.0, 0.0, 1.0);
        return;
    }
    double px = 0.0, py = 0.0, pz = 0.0;
    std::vector<double>& r = _rotation;
    _geodetic->Forward(y, turned(x), 0.0, px, py, pz, r);
    east.set(r[0], r[3], r[6]);
    north.set(r[1], r[4], r[7]);
    up.set(r[2], r[5], r[8]);
}

} // namespace osgGeoFX
