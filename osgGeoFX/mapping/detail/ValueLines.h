// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/raster/LayerPixels.h>

#include <osg/Vec2d>

namespace osgGeoFX
{

/** How far each place of a raster of values is from the next line of equal value, for lines of one width wherever the values
    rise fast or slowly.

    Lines are at the multiples of `step` between `low` and `high`, without these. `size` is the raster's width and height,
    metres. The picture is finer than the raster where that is coarse. Distances are metres up to `reach`, as 32-bit floats;
    they are true near the lines, where they count. NaN where there are no values. */
osg::ref_ptr<osg::Image> distancesToLines(const LayerPixels& pixels, const osg::Vec2d& size, double step,
                                          double low, double high, double reach);

} // namespace osgGeoFX
