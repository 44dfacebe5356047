// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/TileMesh.h>
#include <osgGeoFX/terrain/detail/TileNode.h>

#include <osg/Array>

#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/** The vertices that the meshes of a tile, or of one of its blocks, share. Posts come first, then the walls' lower
    ends, and the poles.

    Places are rounded to a grid of at most 1/32 m, and of at most 1/1024 of the way from post to post. Finer digits
    are noise, which no compressor can shrink. Not thread-safe. */
class TileVertices
{
public:
    using Post = BlockMesh::Post;

    /// The posts of `block` alone can be used. They get their numbers in the order of the calls.
    TileVertices(const BuildPlan& plan, const TileKey& key, const LevelArrays& arrays, int x, int y,
                 const TileBlock& block);

    /// Adds all posts of the block, row by row from the south-west. If all blocks number their posts in one way,
    /// their index lists look alike, and compressors use this.
    void addAll();
    /// The index of a post.
    std::uint32_t post(const Post& post);
    /// The index of a new vertex below a post, moved by `outX` and `outY` metres to the east and to the north. Final
    /// indices are known only after all posts, so this index is a stand-in until finish().
    std::uint32_t below(const Post& post, double depth, double outX, double outY);
    /// The index of a new vertex on a pole, at a height in metres, with the texture coordinates of a post: a stand-in, too.
    std::uint32_t atPole(const Post& post, bool north, double height);
    /// Puts these vertices behind the posts, and replaces stand-ins by indices.
    void finish(std::vector<std::vector<std::uint32_t>*>& indices);

    /// The largest distance of a vertex from its exact place, metres.
    double rounding() const;

    /// In the tile's frame.
    osg::Vec3d position(const Post& post) const;
    /// The place of a post at height 0, in the tile's frame.
    osg::Vec3d ground(const Post& post) const;
    /// The upward direction at a post, in the tile's frame.
    osg::Vec3d up(const Post& post) const;
    /// A pole at a height in metres, in the tile's frame.
    osg::Vec3d pole(bool north, double height) const;

    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec3bArray> normals = new osg::Vec3bArray(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec2Array> texCoords = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);

private:
    struct Other
    {
        osg::Vec3 vertex;
        std::uint32_t post;
    };

    double gridX(int column) const;
    double gridY(int row) const;
    double slope(const std::vector<float>& values, const Post& post) const;
    osg::Vec3 rounded(const osg::Vec3d& place) const;
    void add(const Post& post);

    const BuildPlan& _plan;
    const TileKey _key;
    const LevelArrays& _arrays;
    const TileFrame _frame;
    const int _x, _y, _intervals;
    const TileBlock _block;
    const double _finestPosts;           ///< from one of the tile's posts to the next
    const double _quantum;               ///< metres, a power of two
    std::vector<std::uint32_t> _indices; ///< of the block's posts, row by row
    std::vector<Post> _posts;
    std::vector<Other> _others;
};

} // namespace osgGeoFX
