// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "HeightGrid.h"

#include <osg/Vec3f>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/// Which posts of a square lattice a tile's mesh takes, and its triangles.
struct TileMesh
{
    struct Post
    {
        int column = 0, row = 0;
    };
    std::vector<Post> posts;
    std::vector<std::uint32_t> triangles; ///< three indices of posts each, anticlockwise seen from above
    std::vector<std::uint32_t>
        edge; ///< posts along the border, anticlockwise from the south-west, the first one repeated
    double deviation = 0.0; ///< largest distance of a lattice point from its place on the mesh, metres
};

/// A tile's part of the lattices from which its mesh is made.
struct TileLattice
{
    const HeightGrid& heights; ///< the densest heights at hand
    int column = 0, row = 0;   ///< the tile's south-western post
    int intervals = 0;         ///< a power of two
    /// The ground ends at these columns and rows (posts beyond lie on the end as well); at least `intervals` where
    /// it does not end inside.
    int endColumn = 0, endRow = 0;
    /// How far the Earth curves away below the tile's tangent plane at each column and row, metres. Near enough for
    /// tiles of some 20 km; larger ones have their posts' places instead, row by row, in the tile's frame.
    std::vector<float> dropX, dropY;
    std::vector<osg::Vec3f> places;

    /// Where the tile's ground ends in the east and in the north.
    int eastColumn() const { return std::min(intervals, endColumn); }
    int northRow() const { return std::min(intervals, endRow); }

    const osg::Vec3f& place(int c, int r) const
    {
        return places[static_cast<std::size_t>(r) * static_cast<std::size_t>(intervals + 1) +
                      static_cast<std::size_t>(c)];
    }

    /// Above the tangent plane, so that what is straight in space is straight here.
    float height(int c, int r) const
    {
        return heights.at(column + c, row + r) - dropX[static_cast<std::size_t>(c)] -
               dropY[static_cast<std::size_t>(r)];
    }
};

/// Slopes (metres in a metre) on a coarser lattice over the same tile.
struct TileSlopes
{
    const std::vector<float>&x, &y;
    int stride = 0;          ///< columns of the lattice
    int column = 0, row = 0; ///< the tile's south-western post
    int intervals = 0;       ///< a power of two, at most the heights'

    float slopeX(int c, int r) const { return x[index(c, r)]; }
    float slopeY(int c, int r) const { return y[index(c, r)]; }

private:
    std::size_t index(int c, int r) const
    {
        return static_cast<std::size_t>(row + r) * static_cast<std::size_t>(stride) +
               static_cast<std::size_t>(column + c);
    }
};

/// Every post of the lattice, row by row from the south-west, and two triangles for each cell that has data.
TileMesh createFullMesh(const TileLattice& lattice);

/// The number of cells that an adaptive mesh has along a tile's edge at least, so that a plain may be bent.
inline int leastCells(int intervals)
{
    return std::min(intervals, 16);
}

/** A right-triangulated irregular network: large triangles where the ground is even, small ones where it is not.

    No lattice point is farther than `tolerance` metres above or below it, and where the slope changes visibly
    triangles are as small as the slopes' lattice, so that light and shade stay as they are on a full mesh. Nowhere are they
    larger than a cell of leastCells(). Borders of holes in the data are followed post by post. (Evans, Kirkpatrick, Townsend: Right-triangulated irregular
    networks, 2001.) */
TileMesh createAdaptiveMesh(const TileLattice& lattice, const TileSlopes& slopes, double tolerance);

} // namespace osgGeoFX
