// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "TileNode.h"

#include <osg/Array>

#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/** A tile's vertices, which all its meshes share: posts first, then what lies below them as the walls' lower ends.

    Not thread-safe. */
class TileVertices
{
public:
    using Post = BlockMesh::Post;

    /// A finest tile has all its posts, row by row from the south-west, whether a mesh uses them or not; another one
    /// those that are asked for, in the order in which they are.
    TileVertices(const BuildPlan& plan, const TileKey& key, const LevelArrays& arrays, int x, int y);

    /// The index of a post.
    std::uint32_t post(const Post& post);
    /// The index of a new vertex below a post, `outX` and `outY` metres to the east and to the north of it. Final indices
    /// are known only when all posts are: until finish() this one is a stand-in.
    std::uint32_t below(const Post& post, double depth, double outX, double outY);
    /// Puts what lies below behind the posts, and turns stand-ins into indices.
    void finish(std::vector<std::vector<std::uint32_t>*>& indices);

    /// In the tile's frame.
    osg::Vec3d position(const Post& post) const;
    /// Where a post's height is counted from, in the tile's frame.
    osg::Vec3d ground(const Post& post) const;
    /// Upwards at a post, in the tile's frame.
    osg::Vec3d up(const Post& post) const;

    std::size_t posts() const { return _posts.size(); }
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec3sArray> normals = new osg::Vec3sArray(osg::Array::BIND_PER_VERTEX);
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
    void add(const Post& post);

    const BuildPlan& _plan;
    const TileKey _key;
    const LevelArrays& _arrays;
    const TileFrame _frame;
    const int _x, _y, _intervals;
    const double _finestPosts;           ///< from one of the tile's posts to the next
    std::vector<std::uint32_t> _indices; ///< of the tile's posts, row by row
    std::vector<Post> _posts;
    std::vector<Low> _low;
};

} // namespace osgGeoFX
