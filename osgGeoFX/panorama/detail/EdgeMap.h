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

/** Where the terrain of a database ends, and how: in the sea, or within the land. It is made of the coarsest tile,
    which is always loaded. The tile's surface tells where there is data, and its cover tells where there is water.

    The sea is water at sea level that reaches the border of the data. A lake or a river that the border cuts counts
    as land. Beyond the border the sea goes on as the border does, and bays close. Immutable. */
class EdgeMap : public osg::Referenced
{
public:
    /// Makes the map of a terrain's root (TerrainInfo::root). `seaGoesOn`: false if the sea ends at the border, too.
    /// Null without a coarsest tile that has a cover at unit `coverUnit`.
    static osg::ref_ptr<const EdgeMap> make(const osg::Node& root, const TerrainInfo& info,
                                            unsigned int coverUnit, bool seaGoesOn);

    const TerrainInfo& info() const { return _info; }
    /// Whether the known ground ends anywhere. That of an island within its sea does not, and that of the whole globe
    /// does not. Without an end there is no image.
    bool ends() const { return _ends; }
    /// Whether most of the border is sea.
    bool island() const { return _island; }
    /// The shorter side of the extent, metres.
    double size() const { return _size; }
    /// Three floats for each texel, metres. The first two are distances to the end of what is known, negative beyond.
    /// The first is for the ground. The second is for places without ground, where land does not count as known. The
    /// third is the height of the land along the nearest border, with smoothed mountains.
    osg::Image* image() const { return _image; }
    osg::Texture2D* texture() const { return _texture; }
    /// The share of the image's width, and of its height, that the extent takes.
    static double inner();
    /// The largest share of its size over which the land runs out.
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
