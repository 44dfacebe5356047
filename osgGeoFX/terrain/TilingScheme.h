// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "TileKey.h"

#include <osgGeoFX/geodata/RasterSource.h>

#include <GeographicLib/LocalCartesian.hpp>

#include <osg/Matrixd>
#include <osg/Vec3d>

#include <optional>
#include <vector>

namespace osgGeoFX
{

/** The quadtree's grid: one root tile over the whole extent, 2^level × 2^level tiles on each level, every tile with
    the same number of intervals, so that a parent's posts are every second one of its children's.

    Extents in the grid's CRS. The finest level is at least as dense as the source asks for, and at most one
    interval a tile denser. */
struct TilingScheme
{
    GridCrs crs;
    double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
    int finestLevel = 0;
    int intervalsX = 0, intervalsY = 0; ///< mesh intervals along a tile's edges
    int textureIntervals = 0;           ///< texture intervals along a tile's edges; texels lie on both ends

    int tilesAcross(int level) const { return 1 << level; }

    /// Lattice over `span` × `span` tiles of a level from tile (x, y), with `apron` points more on each side.
    Lattice lattice(int level, int x, int y, int span, int perTileX, int perTileY, int apron = 0) const;

    /// Metres between two mesh posts of a level, the larger of both directions, at the extent's middle.
    double spacingMetres(int level) const;

    /// How far a chord between two posts of a level runs below the ellipsoid at most; 0 on a projected grid.
    double chordSag(int level) const;
};

/** Local frame of a tile: origin on the ellipsoid (or the plane's zero) at the tile's centre, x east, y north, z up.
    Not thread-safe. */
class TileFrame
{
public:
    TileFrame(const TilingScheme& scheme, const TileKey& key);

    /// From the frame to the world.
    osg::Matrixd localToWorld() const;

    /// Position in the frame of a grid point (CRS units) at a height in metres.
    osg::Vec3d position(double x, double y, double height) const;

    /// East, north and up at a grid point, in the frame.
    void axes(double x, double y, osg::Vec3d& east, osg::Vec3d& north, osg::Vec3d& up) const;

private:
    const TilingScheme& _scheme;
    double _centerX, _centerY;
    std::optional<GeographicLib::LocalCartesian> _geodetic;
    mutable std::vector<double> _rotation = std::vector<double>(9); ///< GeographicLib's way to return it
};

} // namespace osgGeoFX
