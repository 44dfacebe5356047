// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMapping.h>
#include <osgGeoFX/raster/LayerPixels.h>

namespace osgGeoFX
{

/** The part of a layer below a lens, in the lens' own raster coordinates.

    `pixels` are those of the content's layer. Colors take the mask's alpha into their own; values and classes are
    NaN where there are none and outside of the content's raster. */
osg::ref_ptr<osg::Image> cutOutLens(const ProjectiveMapping& lens, const ProjectiveMapping& content,
                                    const LayerPixels& pixels, int side, const osg::Image& mask);

} // namespace osgGeoFX
