// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/TileMesh.h>
#include <osgGeoFX/terrain/detail/TileTextures.h>

#include <osg/Array>
#include <osg/Geometry>
#include <osg/Node>

#include <vector>

namespace osgGeoFX
{

/// One level's lattices over a unit.
struct LevelArrays
{
    int level = 0;
    int span = 0;             ///< tiles along the unit's edge
    HeightGrid heights{0, 0}; ///< as dense as the unit has them, whatever the level
    std::vector<float> slopeX,
        slopeY; ///< smoothed rise to the east and to the north at the level's posts, metres in a metre
    std::vector<float> texelSlopeX, texelSlopeY; ///< the same at the texels of normals
    int normals = 0;                             ///< intervals of these along a tile's edge
    int texelColumns = 0;
    std::vector<unsigned char> colors;  ///< red, green, blue
    std::vector<unsigned char> classes; ///< empty without land cover
    std::vector<unsigned char> cover;   ///< four bytes each, as shaders/lib/cover.glsl codes them
    std::vector<float>
        textureError; ///< by tile: the size of a texel that hides something, metres; 0 if none does
};

/** Makes the scene graph of a tile: a tree of levels of detail of its blocks (TileBlocks). Each mesh is an
    osg::Geometry over shared vertices. A tile has normals of vertices and of texels, base colors, land cover, and
    what lies on the ground.

    A smallest block of a finest tile has vertices of its own. All other meshes of a tile share theirs. The
    transform's user value "geofx.cells" is the number of cells along an edge of the tile's lattice. If the texture of
    colors is wider than the colors, "geofx.texels" is the number of intervals between their texels along an edge. The
    osg::LOD of a block has an osg::Vec2Array as its user data, which TileInfo::meshesOf() explains. Not thread-safe. */
class TileNodeFactory
{
public:
    explicit TileNodeFactory(const BuildPlan& plan);

    /// Makes a tile, which must have data. x and y are counted from the arrays' south-west corner.
    osg::ref_ptr<osg::Node> create(const TileKey& key, const LevelArrays& arrays, int x, int y);

    /// The textures of all tiles, since the factory was made or since they were last cleared.
    TileTextures& textures() { return _textures; }

private:
    TileLattice createLattice(const TileKey& key, const LevelArrays& arrays, int x, int y) const;
    osg::ref_ptr<osg::StateSet> createState(const TileKey& key, const LevelArrays& arrays, int x, int y);

    const BuildPlan& _plan;
    TileTextures _textures;
};

} // namespace osgGeoFX
