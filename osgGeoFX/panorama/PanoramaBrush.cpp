// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/PanoramaBrush.h>

#include <osgGeoFX/panorama/detail/BakedPaintings.h>
#include <osgGeoFX/panorama/detail/PaintedImages.h>

#include <algorithm>

namespace osgGeoFX
{

osg::ref_ptr<osg::Image> makeBrushTexture(int side)
{
    if (side != UsualPaintings::BRUSH_SIDE) return paintBrush(side);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::copy_n(geofx_bakedBrush, image->getTotalSizeInBytes(), image->data());
    return image;
}

} // namespace osgGeoFX
