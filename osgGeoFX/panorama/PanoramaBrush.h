// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>

namespace osgGeoFX
{

/** The painter's hand: an RGBA8 image that repeats without a seam in x and y, for normals, borders and water of
    panorama maps (Sections 3.2.2 and 3.4.2 of Brown and Samavati, 2017).

    Red and green are the slopes of a ground of brush strokes along x and y, −1…1 as 0…1, with mean 0; the strokes run
    along x more than along y. Blue is a noise of strokes and patches, 0…1 with mean 1/2. Alpha is the height of water's
    ripples, 0…1, whose crests run along x. `side` is 64…2048, other numbers are taken for the nearest of these; strokes
    are as large as the side tells them. The same image in every run. Thread-safe. */
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> makeBrushTexture(int side = 512);

} // namespace osgGeoFX
