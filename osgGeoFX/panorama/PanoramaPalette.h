// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>

#include <string>

namespace osgGeoFX
{

/** The colours of panorama maps by class and light (Section 3.2.2 of Brown and Samavati, 2017).

    A palette is an image of 256 x 8 opaque RGBA8 texels, sRGB-coded: its columns are light from −1 (turned away) over 0
    (grazed) to 1 (faced), its rows from the bottom field, hill, cliff, snow, forest floor, trees, town and bare ground
    (GEOFX_PALETTE_... of shaders/lib/painting.glsl). The lit and the shaded ends of a row are split complements: yellow-greens
    over blue-greens to blues, ochres to violets, red-browns to blues. All functions are thread-safe and give new images. */

/// The kit's own palette. `season` is 0…1: 0 midwinter, 1/4 spring, 1/2 midsummer, 3/4 autumn; other numbers are taken
/// without their whole part. It changes fields, hills, forests and trees, where light falls on them.
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> makePalette(double season = 0.5);

/// A palette from an image of any width and at least 8 rows: eight bands of equal height, of which the middle halves count.
/// The template is data/panorama/palette.png. Null, with a sentence in `error`, for what cannot be used.
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> paletteFromImage(const osg::Image& image, std::string& error);

/// The same from a file that osgDB reads. The sentence names the file.
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> readPalette(const std::string& path, std::string& error);

/** The paper's way to a palette: colours of a painting, by how brightly a light map of the same ground shines there.

    The three images show the same view and may differ in size. `lightMap`: red 0…1 is light −1…1; `classMap`: red, in 1/255, is a
    palette's row 0…7, anything else does not count. The samples of 1/32 of the range of light are averaged, and between those
    averages colours run straight. Rows with fewer than 16 samples are those of makePalette(). Null, with a sentence in `error`,
    where an image has no pixels or no class has enough samples. */
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> paletteFromPainting(const osg::Image& painting,
                                                             const osg::Image& lightMap,
                                                             const osg::Image& classMap, std::string& error);

} // namespace osgGeoFX
