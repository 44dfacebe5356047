// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Transform>
#include <osg/Vec3d>

#include <cstddef>
#include <optional>
#include <vector>

namespace osgGeoFX
{

/** The ground of a tile at all posts of its lattice. Its finest meshes leave posts out where the ground is even; those lie on the
    triangles. Thread-safe for tiles that nobody changes meanwhile. */
class OSGGEOFX_EXPORT TilePosts
{
public:
    /// Nothing where the node is not a tile of the kit's databases, or one that does not tell its lattice.
    static std::optional<TilePosts> read(const osg::Transform& tile);

    /// Along an edge.
    int cells() const { return _cells; }
    /// A post, by columns from the west and rows from the south, 0 … cells(): metres, in the tile's frame. Not a number (all three
    /// coordinates) where there is no ground.
    const osg::Vec3d& at(int column, int row) const { return _places[index(column, row)]; }

private:
    explicit TilePosts(int cells);
    std::size_t index(int column, int row) const
    {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(_cells + 1) +
               static_cast<std::size_t>(column);
    }

    int _cells;
    std::vector<osg::Vec3d> _places;
};

} // namespace osgGeoFX
