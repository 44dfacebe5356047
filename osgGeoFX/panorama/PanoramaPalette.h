// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>

#include <string>

namespace osgGeoFX
{

/** Palettes: the colors of panorama maps by class and light (Section 3.2.2 of Brown and Samavati, 2017).

    A palette is an image of 256 x 8 opaque RGBA8 texels, coded in sRGB. The columns are the light, from −1 (turned
    away) over 0 (grazing) to 1 (facing the light). The rows from the bottom are field, hill, cliff, snow, forest
    floor, trees, town and bare ground (GEOFX_PALETTE_... of shaders/lib/painting.glsl). The lit and the shaded ends of
    a row are split complements: yellow-greens over blue-greens to blues, ochres to violets, red-browns to blues. All
    functions are thread-safe and return new images. */

/// Makes the kit's own palette. `season`: 0 is midwinter, 1/4 spring, 1/2 midsummer, 3/4 autumn; only the fraction of
/// other numbers counts. It changes the lit colors of fields, hills, forest floor and trees.
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> makePalette(double season = 0.5);

/// Makes a palette from an image of any width and at least 8 rows. The image has eight bands of equal height; the
/// middle half of each band counts. The template is data/panorama/palette.png. Returns null, with a sentence in
/// `error`, if the image cannot be used.
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> paletteFromImage(const osg::Image& image, std::string& error);

/// The same from a file that osgDB reads. The sentence names the file.
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> readPalette(const std::string& path, std::string& error);

/** Derives a palette from a painting, as the paper does: each color of the painting is assigned to the light that a
    light map of the same ground has there.

    The three images show the same view and may differ in size. `lightMap`: red 0…1 stands for light −1…1. `classMap`:
    red, in 1/255, is a row of the palette, 0…7; pixels with other values are ignored. The range of light has 32 bins;
    the samples of each bin are averaged, and colors are interpolated linearly between the averages. Rows with fewer
    than 16 samples come from makePalette(). Returns null, with a sentence in `error`, if an image has no pixels or no
    class has enough samples. */
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> paletteFromPainting(const osg::Image& painting,
                                                             const osg::Image& lightMap,
                                                             const osg::Image& classMap, std::string& error);

} // namespace osgGeoFX
