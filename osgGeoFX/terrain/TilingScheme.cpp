// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "TilingScheme.h"

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

// Longitudes beyond ±180° are the grid's way across the antimeridian.
double turned(double longitude) { return longitude - 360.0 * std::round(longitude / 360.0); }

} // namespace

Lattice TilingScheme::lattice(int level, int x, int y, int span, int perTileX, int perTileY, int apron) const
{
    Lattice result;
    result.dx = (east - west) / (static_cast<double>(tilesAcross(level)) * perTileX);
    result.dy = (north - south) / (static_cast<double>(tilesAcross(level)) * perTileY);
    result.x0 = west + result.dx * (static_cast<double>(x) * perTileX - apron);
    result.y0 = south + result.dy * (static_cast<double>(y) * perTileY - apron);
    result.columns = span * perTileX + 1 + 2 * apron;
    result.rows = span * perTileY + 1 + 2 * apron;
    return result;
}

double TilingScheme::spacingMetres(int level) const
{
    const Lattice l = lattice(level, 0, 0, 1, intervalsX, intervalsY);
    if (!crs.geographic)
        return std::max(l.dx, l.dy) * crs.metresPerUnit;
    // The parallel nearest to the equator is the longest.
    const double latitude = south > 0.0 ? south : north < 0.0 ? north : 0.0;
    const double degree = osg::DegreesToRadians(1.0) * 6378137.0;
    return std::max(l.dx * std::cos(osg::DegreesToRadians(latitude)), l.dy) * degree;
}

double TilingScheme::chordSag(int level) const
{
    if (!crs.geographic)
        return 0.0;
    // The longest chord is a cell's diagonal; beyond a half circle the formula below would shrink again.
    const double diagonal = spacingMetres(level) * std::sqrt(2.0);
    const double angle = std::min(diagonal / 6378137.0, osg::PI);
    return 6378137.0 * (1.0 - std::cos(angle / 2.0));
}

TileFrame::TileFrame(const TilingScheme& scheme, const TileKey& key) : _scheme(scheme)
{
    const double across = scheme.tilesAcross(key.level);
    _centerX = scheme.west + (scheme.east - scheme.west) * ((key.x + 0.5) / across);
    _centerY = scheme.south + (scheme.north - scheme.south) * ((key.y + 0.5) / across);
    if (scheme.crs.geographic)
        _geodetic.emplace(_centerY, turned(_centerX), 0.0);
}

osg::Matrixd TileFrame::localToWorld() const
{
    if (!_geodetic)
        return osg::Matrixd::translate(_centerX * _scheme.crs.metresPerUnit, _centerY * _scheme.crs.metresPerUnit, 0.0);
    double x = 0.0, y = 0.0, z = 0.0;
    std::vector<double>& r = _rotation;
    GeographicLib::Geocentric::WGS84().Forward(_geodetic->LatitudeOrigin(), _geodetic->LongitudeOrigin(), 0.0, x, y, z,
                                               r);
    // GeographicLib's columns are east, north and up; OSG's rows are.
    return osg::Matrixd(r[0], r[3], r[6], 0.0, r[1], r[4], r[7], 0.0, r[2], r[5], r[8], 0.0, x, y, z, 1.0);
}

osg::Vec3d TileFrame::position(double x, double y, double height) const
{
    if (!_geodetic)
        return {(x - _centerX) * _scheme.crs.metresPerUnit, (y - _centerY) * _scheme.crs.metresPerUnit, height};
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
