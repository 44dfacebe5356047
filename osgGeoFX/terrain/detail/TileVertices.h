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

/** Vertices that the meshes of a tile, or of one of its blocks, share: posts first, then what lies below them as the
    walls' lower ends.

    Places are rounded to a grid of at most 1/32 m, and of at most 1/1024 of the way from post to post: all else is noise,
    which no compressor can shrink. Not thread-safe. */
class TileVertices
{
public:
    using Post = BlockMesh::Post;

    /// Posts may be those of `block` alone; they are there in the order in which they are asked for.
    TileVertices(const BuildPlan& plan, const TileKey& key, const LevelArrays& arrays, int x, int y,
                 const TileBlock& block);

    /// All posts of the block, row by row from the south-west. Where all blocks number theirs in one way, their index
    /// lists look alike, which compressors use.
    void addAll();
    /// The index of a post.
    std::uint32_t post(const Post& post);
    /// The index of a new vertex below a post, `outX` and `outY` metres to the east and to the north of it. Final indices
    /// are known only when all posts are: until finish() this one is a stand-in.
    std::uint32_t below(const Post& post, double depth, double outX, double outY);
    /// Puts what lies below behind the posts, and turns stand-ins into indices.
    void finish(std::vector<std::vector<std::uint32_t>*>& indices);

    /// How far a vertex may lie from its place, metres.
    double rounding() const;

    /// In the tile's frame.
    osg::Vec3d position(const Post& post) const;
    /// Where a post's height is counted from, in the tile's frame.
    osg::Vec3d ground(const Post& post) const;
    /// Upwards at a post, in the tile's frame.
    osg::Vec3d up(const Post& post) const;

    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec3bArray> normals = new osg::Vec3bArray(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec2Array> texCoords = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);

private:
    struct Low
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
    std::vector<Low> _low;
};

} // namespace osgGeoFX
