// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>

namespace osgGeoFX
{

/** Makes a painted sky for panorama maps, after Berann: warm haze at the horizon, banks of cumulus with flat bases,
    wisps above them, and a deep blue at the top, all in visible strokes. The clouds are lit from the upper left and
    are violet-blue in the shade.

    The image is opaque RGBA8, coded in sRGB, of `width` x `height` texels (64…8192 x 32…2048; other values are
    clamped). The lowest row is the horizon. The image repeats without a seam in x, so that it can turn with the
    heading. The size of the clouds follows the height: a full turn of 16 heights (4096 x 256) fills two widths of a
    picture whose top fifth is sky. `seed` arranges the clouds. `season` is that of makePalette(): winter is paler,
    autumn warmer. The time is linear in the number of texels. Every run gives the same image. Thread-safe. */
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> makeSky(int width = 4096, int height = 256, unsigned seed = 1,
                                                 double season = 0.5);

} // namespace osgGeoFX
