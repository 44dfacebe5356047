// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/PanoramaSky.h>

#include <osgGeoFX/panorama/detail/BakedPaintings.h>
#include <osgGeoFX/panorama/detail/PaintedImages.h>

#include <algorithm>

namespace osgGeoFX
{

osg::ref_ptr<osg::Image> makeSky(int width, int height, unsigned seed, double season)
{
    using Usual = UsualPaintings;
    if (width != Usual::SKY_WIDTH || height != Usual::SKY_HEIGHT || seed != Usual::SEED ||
        season != Usual::SEASON)
        return paintSky(width, height, seed, season);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::copy_n(geofx_bakedSky, image->getTotalSizeInBytes(), image->data());
    return image;
}

} // namespace osgGeoFX
