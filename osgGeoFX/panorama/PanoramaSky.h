// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>

namespace osgGeoFX
{

/** A painted sky for panorama maps, after Berann's: warm haze at the horizon, banks of cumulus with flat bases, lit from
    the upper left and violet-blue in the shade, wisps above, a deep blue at the top; in visible strokes.

    RGBA8, opaque, sRGB-coded, `width` x `height` texels (64…8192 x 32…2048, other numbers are taken for the nearest of
    these), the horizon in the lowest row. It repeats without a seam in x, so that it may turn with the heading. Things are
    as large as the height tells them: a full turn of 16 heights (4096 x 256) is meant to fill two widths of a picture
    whose top fifth is sky. `seed` arranges the clouds; `season` is that of makePalette(): winter is paler, autumn warmer.
    The time is linear in the number of texels. The same image in every run. Thread-safe. */
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> makeSky(int width = 4096, int height = 256, unsigned seed = 1,
                                                 double season = 0.5);

} // namespace osgGeoFX
