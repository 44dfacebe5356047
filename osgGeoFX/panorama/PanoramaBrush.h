// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>

namespace osgGeoFX
{

/** Makes the brush texture of panorama maps (Sections 3.2.2 and 3.4.2 of Brown and Samavati, 2017): an RGBA8 image of
    brush strokes that repeats without a seam in x and y. PanoramaMap uses it for normals, borders and water.

    Red and green are the slopes of the painted strokes along x and y: 0…1 stands for −1…1, with mean 0. The strokes
    run along x more than along y. Blue is a noise of strokes and patches, 0…1 with mean 1/2. Alpha is the height of
    the water's ripples, 0…1; their crests run along x. `side` is the width and height in texels, 64…2048; other values
    are clamped. The size of the strokes grows with `side`. Every run gives the same image. Thread-safe. */
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> makeBrushTexture(int side = 512);

} // namespace osgGeoFX
