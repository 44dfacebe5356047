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

/** The ground of a tile at all posts of its lattice. The tile's finest meshes leave out posts where the ground is
    even. Such posts are interpolated on the triangles. Thread-safe for tiles that nobody changes meanwhile.

    @ingroup paging */
class OSGGEOFX_EXPORT TilePosts
{
public:
    /// Reads a tile. Empty if the node is not a tile of the kit's databases, or if the tile does not tell its lattice.
    static std::optional<TilePosts> read(const osg::Transform& tile);

    /// The number of cells along an edge.
    int cells() const { return _cells; }
    /// The position of a post, metres, in the tile's frame. Columns count from the west and rows from the south, 0 …
    /// cells(). All three coordinates are not a number if there is no ground.
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
