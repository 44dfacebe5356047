// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "BuildPlan.h"
#include "HeightGrid.h"

#include <osg/Array>
#include <osg/Geometry>
#include <osg/Node>
#include <osg/PrimitiveSet>

#include <vector>

namespace osgGeoFX
{

/// One level's lattices over a unit.
struct LevelArrays
{
    int level = 0;
    HeightGrid heights{0, 0};
    std::vector<float> slopeX, slopeY; ///< smoothed rise to the east and to the north, metres in a metre, at the posts
    int texelColumns = 0, texelRows = 0;
    std::vector<unsigned char> colors;  ///< red, green, blue
    std::vector<unsigned char> classes; ///< empty without land cover
    std::vector<float> textureError;    ///< by tile: size in metres of a texel that hides something, 0 if none does
};

/** Makes the scene graph of a tile: mesh with skirts, normals, base colour, land cover and level-of-detail ranges.
    Not thread-safe: arrays that all whole tiles share are kept between calls. */
class TileNodeFactory
{
public:
    explicit TileNodeFactory(const BuildPlan& plan);

    /// The tile (x, y counted from the arrays' south-west corner); `file` names what holds its children, as seen
    /// from the file that the tile is written to. Null where the tile has no data.
    osg::ref_ptr<osg::Node> create(const TileKey& key, const LevelArrays& arrays, int x, int y,
                                   const std::string& file);

private:
    osg::ref_ptr<osg::Geometry> createGeometry(const TileKey& key, const LevelArrays& arrays, int x, int y) const;
    osg::ref_ptr<osg::StateSet> createState(const LevelArrays& arrays, int x, int y) const;
    osg::ref_ptr<osg::DrawElementsUShort> createElements(const std::vector<bool>& valid) const;

    const BuildPlan& _plan;
    std::vector<int> _edge; ///< posts along the tile's edge, anticlockwise from the south-west, the first one repeated
    osg::ref_ptr<osg::Vec2Array> _texCoords;
    osg::ref_ptr<osg::Vec4Array> _white;
    osg::ref_ptr<osg::DrawElementsUShort> _wholeElements;
};

} // namespace osgGeoFX
