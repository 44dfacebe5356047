// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Array>
#include <osg/BoundingBox>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/Transform>
#include <osg/Vec3d>
#include <osg/observer_ptr>
#include <osg/ref_ptr>

#include <optional>
#include <string>

namespace osgGeoFX
{

/** The description that a terrain database of osggeofx_build has in its root node.

    In a geocentric database, extents are degrees (east may exceed 180 across the antimeridian). In a projected one,
    they are metres in its coordinate system. Heights are metres. It is a plain value; reading changes nothing.

    @ingroup paging */
struct OSGGEOFX_EXPORT TerrainInfo
{
    int format = 0; ///< format of the database; see newestFormat
    bool geocentric = false;
    double west = 0.0;
    double south = 0.0;
    double east = 0.0;
    double north = 0.0;
    double minHeight = 0.0;
    double maxHeight = 0.0;
    double pixelsPerRadian = 0.0; ///< resolution of the screen on which LOD ranges keep `pixelError`
    double pixelError = 0.0;      ///< the bound of the error, pixels
    int levels = 0;
    int tileCells = 0;    ///< the least number of cells along an edge of a tile's mesh; 0: unknown
    std::string vertical; ///< the vertical datum
    osg::observer_ptr<const osg::Node> root; ///< the node that holds the description

    /// The share of posts that lie in voids of the elevation and were filled from around them, of the finest posts that
    /// have a height; 0…1.
    double filledShare = 0.0;
    /// The places of filled posts: their share in each cell of the extent, as a byte from 0 to 255, and at least 1
    /// wherever a post was filled. The cells go row by row from the south-western one, with at most 1,024 cells a side.
    /// Null if nothing was filled.
    osg::ref_ptr<const osg::UByteArray> filledMask;
    int filledMaskColumns = 0; ///< cells in a row of the mask

    /// The share of filled posts, 0…1, in the mask's cell at a place. The place is in the extent's coordinates. 0
    /// outside.
    double filledAt(double x, double y) const;

    /// The format that this library reads and builds.
    static constexpr int newestFormat = 2;

    /// Reads the description of the first terrain root at or below `node`. Nodes below an osg::LOD are not searched.
    /// Empty if there is no root. Empty, with a sentence in `error`, if the database has another format or an
    /// incomplete description.
    static std::optional<TerrainInfo> read(const osg::Node* node, std::string& error);
};

/// The name and the box of a terrain tile. The transform above its geometry carries them.
/// @ingroup paging
struct OSGGEOFX_EXPORT TileInfo
{
    int level = 0;
    int x = 0;
    int y = 0;
    osg::Vec3d boxMin; ///< the box in the tile's local frame, metres
    osg::Vec3d boxMax;
    int cells = 0; ///< number of cells along an edge of the lattice of its meshes; 0: unknown

    /// Whether the node is a tile's transform, according to its name.
    static bool isTile(const osg::Node& node);
    /// The coarse tile that a node shows from afar, if the node also has finer tiles; otherwise null.
    static const osg::Transform* coarseOf(const osg::LOD& node);
    /// Reads a tile's transform; empty if the node is not one.
    static std::optional<TileInfo> read(const osg::Node& node);
    /// Reads the box of a tile's transform without a check of its name. False if it has none.
    static bool readBox(const osg::Transform& tile, osg::BoundingBoxd& box);
    /// The tile that a mesh of a block belongs to; null for other geometries.
    static const osg::Transform* tileOf(const osg::Geometry& mesh);
    /// The ground of a tile as one geometry with one list of triangles. It has the finest meshes without walls, copies
    /// of their vertices, and their state. If the tile consists of a single geometry, the result is that geometry. Null
    /// if the tile has none. No other thread may change the tile meanwhile.
    static osg::ref_ptr<osg::Geometry> ground(const osg::Transform& tile);
    /// The first mesh of a tile, as an example of all its meshes; null if it has none.
    static const osg::Geometry* firstMesh(const osg::Transform& tile);
    /// Two numbers for each child of a tile's block: the length of the longest edge of its ground, metres, and the
    /// number of its mesh's indices that belong to the ground. The indices of walls follow them. Both numbers are 0 for
    /// a child that holds finer blocks. Null if the node is not a block of a tile.
    static const osg::Vec2Array* meshesOf(const osg::LOD& block);
    /// How many of a geometry's indices, from the first, belong to the ground. If it is the mesh of a block, the others
    /// belong to walls; all indices of any other geometry belong to the ground, and the result is the largest number.
    static unsigned int groundIndices(const osg::Geometry& geometry);
};

/** The LOD scale at which a database keeps its error bound on a screen. It is never above 1, which would make the
    database coarser.

    `pixelsPerRadian` is viewport height / (2·tan(vertical field of view / 2)). */
OSGGEOFX_EXPORT float lodScaleFor(const TerrainInfo& info, double pixelsPerRadian);

/// Pixels per radian at the center of an image. `height`: of the image, pixels. `fieldOfView`: vertical, radians.
OSGGEOFX_EXPORT double pixelsPerRadian(double height, double fieldOfView);

} // namespace osgGeoFX
