// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>
#include <osg/Vec2d>

#include <cstddef>
#include <vector>

namespace osgGeoFX
{

/** The heights of a layer in rows from the south, metres, with NaN where there is none, and the layers that
    SurfaceData derives from them. Thread-safe.
    @ingroup closeup */
class OSGGEOFX_EXPORT SurfaceDerivation
{
public:
    /// `heights` is a layer of SurfaceData. `spacing` is in metres, both positive.
    SurfaceDerivation(const osg::Image& heights, const osg::Vec2d& spacing);

    /// The derived layers of these kinds. SurfaceData::derive() describes them.
    osg::ref_ptr<osg::Image> normals() const;
    osg::ref_ptr<osg::Image> slopes() const;
    osg::ref_ptr<osg::Image> aspects() const;
    /// `radius` is in metres.
    osg::ref_ptr<osg::Image> occlusion(double radius) const;

    /// An image with the format of a layer, all 0.
    static osg::ref_ptr<osg::Image> emptyLayer(int width, int height);

private:
    float at(int x, int y) const { return _heights[static_cast<std::size_t>(y) * _width + x]; }
    bool has(int x, int y) const;
    /// Metres per metre to the east and to the north.
    osg::Vec2d gradient(int x, int y) const;
    /// Calls texel(x, y, RGBA) wherever there is a height.
    template<typename Texel>
    osg::ref_ptr<osg::Image> layerOf(const Texel& texel) const;

    int _width, _height;
    osg::Vec2d _spacing;
    std::vector<float> _heights;
};

} // namespace osgGeoFX
