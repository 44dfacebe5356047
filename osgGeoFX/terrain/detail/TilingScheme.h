// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/TileKey.h>

#include <osgGeoFX/geodata/detail/RasterSource.h>

#include <GeographicLib/LocalCartesian.hpp>

#include <osg/Matrixd>
#include <osg/Vec3d>

#include <algorithm>
#include <optional>
#include <vector>

namespace osgGeoFX
{

/** The quadtree's grid: posts on a lattice over the extent, the first on its south-western corner and the last on its
    north-eastern one, as dense as the source asks for; a tile has `intervals` × `intervals` cells, a power of two, and a
    parent's posts are every second one of its children's.

    The quadtree is square, the extent need not be: posts beyond the extent lie on its border, with the border's
    height. So all levels end exactly where the source does, and tiles beyond do not exist. */
struct TilingScheme
{
    GridCrs crs;
    double west = 0.0, south = 0.0, east = 0.0, north = 0.0; ///< extent, in the grid's CRS
    int lastColumn = 0, lastRow = 0; ///< intervals of the finest level over the extent
    int finestLevel = 0;
    int intervals = 0;    ///< cells along a tile's edges
    int texels = 0;       ///< texture intervals along a finest tile's edges; texels lie on both ends
    int textureDepth = 0; ///< levels above the finest that keep the finest texels
    int texelBlock = 1;   ///< texels along a texture's edges are a multiple of it

    /// All around the globe: the last column of posts lies on the first.
    bool wholeCircle() const { return crs.geographic && east - west > 360.0 - 1e-9; }

    int tilesAcross(int level) const { return 1 << level; }
    int step(int level) const
    {
        return 1 << (finestLevel - level);
    } ///< finest posts from post to post of a level

    /// Texels of a level are as dense as those of finest tiles, until a texture would grow beyond its limit.
    bool keepsTexels(int level) const { return level >= finestLevel - textureDepth; }
    int textureIntervals(int level) const { return texels << std::min(finestLevel - level, textureDepth); }

    /// Texels along the edges of a texture: on both ends of its intervals, and what makes whole blocks of them.
    int textureSize(int textureIntervals) const
    {
        return (textureIntervals + texelBlock) / texelBlock * texelBlock;
    }

    /// Normals are as dense as the posts of finest tiles, up to four for each cell of a tile.
    bool keepsNormals(int level) const { return level >= finestLevel - normalDepth; }
    int normalIntervals(int level) const { return intervals << std::min(finestLevel - level, normalDepth); }
    static constexpr int normalDepth = 2; ///< levels above the finest that keep the finest normals

    /// The finest post at a tile's south-western corner.
    int firstColumn(const TileKey& key) const { return key.x * intervals * step(key.level); }
    int firstRow(const TileKey& key) const { return key.y * intervals * step(key.level); }
    bool exists(const TileKey& key) const { return firstColumn(key) < lastColumn && firstRow(key) < lastRow; }

    /// Grid position of a finest post, which may be a fraction; beyond the extent, its border.
    double gridX(double column) const
    {
        return west + (east - west) * (std::min<double>(column, lastColumn) / lastColumn);
    }
    double gridY(double row) const
    {
        return south + (north - south) * (std::min<double>(row, lastRow) / lastRow);
    }

    /// `columns` × `rows` points from a finest post on, `spacing` finest posts apart.
    Lattice lattice(double column, double row, double spacing, int columns, int rows) const;

    /// Metres from post to post of the finest level at a latitude's (geographic: degrees) scale.
    double metresX(double gridYPosition) const;
    double metresY(double gridYPosition) const;

    /// Metres along a tile's edge on a level, the longer one.
    double tileMetres(int level) const;
};

/** Local frame of a tile: origin on the ellipsoid (or the plane's zero) at the tile's center, x east, y north, z up.
    Not thread-safe. */
class TileFrame
{
public:
    TileFrame(const TilingScheme& scheme, const TileKey& key);

    /// Its origin, in the grid's CRS.
    double centerX() const { return _centerX; }
    double centerY() const { return _centerY; }

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
