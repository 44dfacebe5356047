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

/** What a terrain database of osggeofx_build says about itself, read from its root node.

    Extents are degrees in a geocentric database (east may exceed 180 across the antimeridian), else metres in
    its projected coordinate system; heights are metres. A plain value; reading changes nothing. */
struct OSGGEOFX_EXPORT TerrainInfo
{
    int format = 0;
    bool geocentric = false;
    double west = 0.0;
    double south = 0.0;
    double east = 0.0;
    double north = 0.0;
    double minHeight = 0.0;
    double maxHeight = 0.0;
    double pixelsPerRadian = 0.0; ///< of the screen on which LOD ranges keep the error bound
    double pixelError = 0.0;      ///< that bound
    int levels = 0;
    int tileCells = 0;                       ///< that a tile's mesh has along its edge at least; 0: not known
    std::string vertical;                    ///< vertical datum
    osg::observer_ptr<const osg::Node> root; ///< the node that says so

    /// Of the finest posts that have a height, those in voids of the elevation that were filled from around them, 0…1.
    double filledShare = 0.0;
    /// Where they lie: that share for each cell of the extent, a byte from 0 to 255 and more than 0 wherever anything was filled; the
    /// south-western cell first, row by row, at most 1,024 cells a side. Null where nothing was.
    osg::ref_ptr<const osg::UByteArray> filledMask;
    int filledMaskColumns = 0;

    /// The share of filled posts, 0…1, of the mask's cell at a place in the extent's coordinates; 0 outside.
    double filledAt(double x, double y) const;

    /// The format that this library reads and builds.
    static constexpr int newestFormat = 2;

    /// Of the first terrain root at or below `node`. Nothing where there is none; nothing, with a sentence in
    /// `error`, where it is of another format or incomplete.
    static std::optional<TerrainInfo> read(const osg::Node* node, std::string& error);
};

/// The name and box of a terrain tile, carried by the transform above its geometry.
struct OSGGEOFX_EXPORT TileInfo
{
    int level = 0;
    int x = 0;
    int y = 0;
    osg::Vec3d boxMin; ///< in the tile's local frame
    osg::Vec3d boxMax;
    int cells = 0; ///< along an edge of the lattice that its meshes are made of; 0 where it does not tell

    /// Whether the node is a tile's transform, by its name.
    static bool isTile(const osg::Node& node);
    /// The tile that a node shows from afar, where it has finer ones; else null.
    static const osg::Transform* coarseOf(const osg::LOD& node);
    static std::optional<TileInfo> read(const osg::Node& node);
    /// The box of a tile's transform, without a look at its name; false where it has none.
    static bool readBox(const osg::Transform& tile, osg::BoundingBoxd& box);
    /// The tile that a mesh of a block belongs to; null for other geometries.
    static const osg::Transform* tileOf(const osg::Geometry& mesh);
    /// The ground of a tile as one geometry with one list of triangles: its finest meshes without walls, with copies of
    /// their vertices and with their state. Of a tile that is made of a single geometry that one. Null where the tile has
    /// none. No other thread may change the tile meanwhile.
    static osg::ref_ptr<osg::Geometry> ground(const osg::Transform& tile);
    /// The first mesh of a tile, which stands for all of them; null where it has none.
    static const osg::Geometry* firstMesh(const osg::Transform& tile);
    /// Of each child of a tile's block: how long the longest edge of its ground is, metres, and how many of its mesh's
    /// indices are the ground's; walls follow. Both are 0 for finer blocks. Null where the node is not a block of a tile.
    static const osg::Vec2Array* meshesOf(const osg::LOD& block);
};

/** The LOD scale at which a database keeps its error bound on a screen: never above 1, which would coarsen it.

    `pixelsPerRadian` is viewport height / (2·tan(vertical field of view / 2)). */
OSGGEOFX_EXPORT float lodScaleFor(const TerrainInfo& info, double pixelsPerRadian);

/// Pixels per radian at the centre of an image, from its height in pixels and vertical field of view in radians.
OSGGEOFX_EXPORT double pixelsPerRadian(double height, double fieldOfView);

} // namespace osgGeoFX
