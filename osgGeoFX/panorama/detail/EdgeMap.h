// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Image>
#include <osg/Node>
#include <osg/Texture2D>
#include <osgGeoFX/paging/TerrainInfo.h>

#include <optional>

namespace osgGeoFX
{

/** Where a terrain of the kit's databases ends, and what it ends as: in the sea, or in the middle of the land. Made of the coarsest
    tile, which is always at hand: its surface tells where there is data, its cover what is water.

    The sea is water that lies as low as the sea and reaches the data's border; a lake or a river that the border cuts is land.
    Beyond the border it goes on as the border does, and a bay closes. Immutable. */
class EdgeMap : public osg::Referenced
{
public:
    /// Of a terrain's root (TerrainInfo::root). `seaGoesOn`: false where the sea ends at the border, too. Null where it has no coarsest
    /// tile with a cover at unit `coverUnit`.
    static osg::ref_ptr<const EdgeMap> make(const osg::Node& root, const TerrainInfo& info,
                                            unsigned int coverUnit, bool seaGoesOn);

    const TerrainInfo& info() const { return _info; }
    /// Whether what is known ends anywhere: not that of an island within its sea, nor of the whole globe. Without an end there is no image.
    bool ends() const { return _ends; }
    /// Whether most of the border is sea.
    bool island() const { return _island; }
    /// Of the extent's sides the shorter one, metres.
    double size() const { return _size; }
    /// Three floats for each texel, metres. Two to where what is known ends, negative beyond: for the ground, and for what is seen where
    /// there is no ground, where land does not count as known. Then how high the land along the nearest border lies, its mountains smoothed.
    osg::Image* image() const { return _image; }
    osg::Texture2D* texture() const { return _texture; }
    /// The share of the picture that the extent takes across; the same along.
    static double inner();
    /// The land runs out over this share of its size at most.
    static double widest();

protected:
    ~EdgeMap() override;

private:
    EdgeMap() = default;

    TerrainInfo _info;
    bool _ends = false, _island = false;
    double _size = 0.0;
    osg::ref_ptr<osg::Image> _image;
    osg::ref_ptr<osg::Texture2D> _texture;
};

} // namespace osgGeoFX
