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

/** The grid of the quadtree. Posts lie on a lattice over the extent, as dense as the source asks for. The first lies
    on the south-western corner, the last on the north-eastern one. A tile has `intervals` × `intervals` cells, a
    power of two. The posts of a parent are every second post of its children.

    The quadtree is square, and the extent need not be. Posts beyond the extent lie on its border, with the border's
    height. So all levels end exactly where the source does, and tiles beyond do not exist. */
struct TilingScheme
{
    GridCrs crs;
    double west = 0.0, south = 0.0, east = 0.0, north = 0.0; ///< extent, in the grid's CRS
    int lastColumn = 0, lastRow = 0; ///< intervals of the finest level over the extent
    int finestLevel = 0;
    /// The finest level of a build with the first elevation and the first colors alone. Denser sources add levels below
    /// it, and leave all above as they are.
    int anchorLevel = 0;
    int intervals = 0; ///< cells along a tile's edges
    int texels = 0;    ///< texture intervals along the edges of the anchor's tiles; texels lie on both ends
    int textureDepth = 0; ///< levels above the anchor that keep its texels
    int textureHalvings =
        0;              ///< levels below the anchor whose tiles have half the intervals of those above them
    int texelBlock = 1; ///< the number of texels along a texture's edge is a multiple of it

    /// Whether the grid goes around the globe: the last column of posts lies on the first.
    bool wholeCircle() const { return crs.geographic && east - west > 360.0 - 1e-9; }

    int tilesAcross(int level) const { return 1 << level; }
    int step(int level) const
    {
        return 1 << (finestLevel - level);
    } ///< finest posts from post to post of a level

    int textureIntervals(int level) const
    {
        return level > anchorLevel ? texels >> std::min(level - anchorLevel, textureHalvings)
                                   : texels << std::min(anchorLevel - level, textureDepth);
    }
    /// Whether the texels of a level are as dense as those of the level below it.
    bool keepsTexels(int level) const { return textureIntervals(level) == 2 * textureIntervals(level + 1); }

    /// The texels along an edge of a texture: one more than its intervals, rounded up to whole blocks.
    int textureSize(int textureIntervals) const
    {
        return (textureIntervals + texelBlock) / texelBlock * texelBlock;
    }

    /// Levels above a unit's lattice that keep the normals of its posts: a tile has up to four for each cell.
    static constexpr int normalDepth = 2;

    /// The finest post at a tile's south-western corner.
    int firstColumn(const TileKey& key) const { return key.x * intervals * step(key.level); }
    int firstRow(const TileKey& key) const { return key.y * intervals * step(key.level); }
    bool exists(const TileKey& key) const { return firstColumn(key) < lastColumn && firstRow(key) < lastRow; }
    /// Whether the extent ends on a tile's side: 0 south, 1 east, 2 north, 3 west.
    bool endsAt(const TileKey& key, int side) const;

    /// The grid position of a finest post; fractions are allowed. Beyond the extent it is that of the border.
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

    /// Metres from post to post of the finest level, at the scale of a latitude (geographic: degrees).
    double metresX(double gridYPosition) const;
    double metresY(double gridYPosition) const;

    /// The length of a tile's edge on a level, the longer one, metres.
    double tileMetres(int level) const;
};

/** The local frame of a tile. Its origin is at the tile's center, on the ellipsoid or at height 0 of the plane. x
    points east, y north, z up. Not thread-safe. */
class TileFrame
{
public:
    TileFrame(const TilingScheme& scheme, const TileKey& key);

    /// The origin in the grid's CRS.
    double centerX() const { return _centerX; }
    double centerY() const { return _centerY; }

    /// The matrix from the frame to the world.
    osg::Matrixd localToWorld() const;

    /// The position in the frame of a grid point (CRS units) at a height in metres.
    osg::Vec3d position(double x, double y, double height) const;

    /// East, north and up at a grid point, in the frame.
    void axes(double x, double y, osg::Vec3d& east, osg::Vec3d& north, osg::Vec3d& up) const;

private:
    const TilingScheme& _scheme;
    double _centerX, _centerY;
    std::optional<GeographicLib::LocalCartesian> _geodetic;
    mutable std::vector<double> _rotation = std::vector<double>(9); ///< GeographicLib returns it this way
};

} // namespace osgGeoFX
