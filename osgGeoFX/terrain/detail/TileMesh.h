// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/HeightGrid.h>

#include <osg/Vec3f>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/// A square part of a tile's lattice: `size` cells from a south-western post on. Its place is a multiple of its size,
/// which is a power of two.
struct TileBlock
{
    int column = 0, row = 0, size = 0;
};

/// Triangles over a block.
struct BlockMesh
{
    struct Post
    {
        int column = 0, row = 0; ///< of the tile's lattice
    };
    std::vector<Post> corners; ///< three for each triangle, anticlockwise seen from above
    double deviation = 0.0;    ///< largest distance of a lattice point from its place on the mesh, metres
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

/// The number of cells that a bent mesh has along a tile's edge at least.
inline int leastCells(int intervals)
{
    return std::min(intervals, 16);
}

/** A right-triangulated irregular network over a tile's lattice: large triangles where the ground is even, small ones
    where it is not.

    A post's error is how far the ground's straight line between its neighbours misses it, or any post that depends on
    it. Meshes of one tolerance fit together, whichever blocks of the tile they cover. Borders of holes in the data are
    followed post by post. (Evans, Kirkpatrick, Townsend: Right-triangulated irregular networks, 2001.) */
class TileNetwork
{
public:
    /// The lattice must outlive the network.
    explicit TileNetwork(const TileLattice& lattice);

    /** The least mesh over a block that has all posts whose error is greater than `tolerance` (metres; all posts where
        it is negative), and no edge along an axis longer than `longest` cells. */
    BlockMesh triangulate(const TileBlock& block, double tolerance, int longest) const;

    /// The errors of the posts in a block that are greater than a tolerance, the largest first, metres; those that
    /// every mesh has, as at holes, are left out.
    std::vector<float> errors(const TileBlock& block, double tolerance) const;

    const TileLattice& lattice() const { return _lattice; }

private:
    struct Splitter;
    using Post = BlockMesh::Post;

    float& error(int c, int r) { return _errors[index(c, r)]; }
    float error(int c, int r) const { return _errors[index(c, r)]; }
    std::size_t index(int c, int r) const
    {
        return static_cast<std::size_t>(r) * static_cast<std::size_t>(_lattice.intervals + 1) +
               static_cast<std::size_t>(c);
    }
    float edgeError(int c, int r, int dc, int dr) const;
    void gatherErrors();
    double deviation(Post a, Post b, Post c) const;

    const TileLattice& _lattice;
    std::vector<float> _errors;
};

} // namespace osgGeoFX
