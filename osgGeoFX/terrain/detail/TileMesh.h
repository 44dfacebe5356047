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
    std::vector<Post> corners; ///< three for each triangle, counter-clockwise seen from above
    double deviation = 0.0;    ///< largest distance of a lattice point from its place on the mesh, metres
};

/// A tile's part of the lattices that its mesh is made from.
struct TileLattice
{
    const HeightGrid& heights; ///< the densest heights at hand
    int column = 0, row = 0;   ///< the tile's south-western post
    int intervals = 0;         ///< a power of two
    /// The ground ends at these columns and rows; posts beyond lie on the end, too. They are at least `intervals` if
    /// the ground does not end inside.
    int endColumn = 0, endRow = 0;
    /// The depth of the Earth's curve below the tile's tangent plane at each column and row, metres. It is exact
    /// enough for tiles of some 20 km. Larger tiles have the posts' places instead, row by row, in the tile's frame.
    std::vector<float> dropX, dropY;
    std::vector<osg::Vec3f> places;

    /// The column and the row where the tile's ground ends in the east and in the north.
    int eastColumn() const { return std::min(intervals, endColumn); }
    int northRow() const { return std::min(intervals, endRow); }

    const osg::Vec3f& place(int c, int r) const
    {
        return places[static_cast<std::size_t>(r) * static_cast<std::size_t>(intervals + 1) +
                      static_cast<std::size_t>(c)];
    }

    /// The height above the tangent plane. Straight lines in space are straight in it.
    float height(int c, int r) const
    {
        return heights.at(column + c, row + r) - dropX[static_cast<std::size_t>(c)] -
               dropY[static_cast<std::size_t>(r)];
    }
};

/// The least number of cells of a bent mesh along a tile's edge.
inline int leastCells(int intervals)
{
    return std::min(intervals, 16);
}

/** A right-triangulated irregular network over a tile's lattice: large triangles on even ground, small ones
    elsewhere.

    The error of a post is its distance from the straight line between its neighbours, or that of any post that
    depends on it. Meshes of one tolerance fit together, whichever blocks of the tile they cover. Borders of holes in
    the data are followed post by post. (Evans, Kirkpatrick, Townsend: Right-triangulated irregular networks, 2001.) */
class TileNetwork
{
public:
    /// The lattice must outlive the network.
    explicit TileNetwork(const TileLattice& lattice);

    /** The smallest mesh over a block with all posts whose error is greater than `tolerance` (metres; negative: all
        posts). No edge along an axis is longer than `longest` cells. */
    BlockMesh triangulate(const TileBlock& block, double tolerance, int longest) const;

    /// The errors of a block's posts above a tolerance, metres, the largest first. Posts that every mesh has, such as
    /// those at holes, are left out.
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
