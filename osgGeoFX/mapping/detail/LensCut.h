// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMapping.h>
#include <osgGeoFX/raster/LayerPixels.h>

namespace osgGeoFX
{

/** Cuts out the part of a layer below a lens, in the raster coordinates of the lens.

    `pixels` are those of the content's layer. Colors get the mask's alpha times their own. Values and classes are NaN
    where there is no data and outside the content's raster. */
osg::ref_ptr<osg::Image> cutOutLens(const ProjectiveMapping& lens, const ProjectiveMapping& content,
                                    const LayerPixels& pixels, int side, const osg::Image& mask);

} // namespace osgGeoFX
