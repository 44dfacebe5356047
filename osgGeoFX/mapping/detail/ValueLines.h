// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/raster/LayerPixels.h>

#include <osg/Vec2d>

namespace osgGeoFX
{

/** The distance of each place of a raster of values from the next line of equal value. With it, lines have one width,
    whether values rise fast or slowly.

    Lines are at the multiples of `step` between `low` and `high`, without these. `size` is the raster's width and
    height, metres. The picture is finer than a coarse raster. Distances are metres up to `reach`, as 32-bit floats.
    They are exact near the lines, where it matters. NaN where there is no data. */
osg::ref_ptr<osg::Image> distancesToLines(const LayerPixels& pixels, const osg::Vec2d& size, double step,
                                          double low, double high, double reach);

} // namespace osgGeoFX
