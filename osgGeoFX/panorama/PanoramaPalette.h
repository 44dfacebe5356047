// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>
#include <osg/Vec3d>

#include <cstddef>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Palettes: the colors of panorama maps by class and light (Section 3.2.2 of Brown and Samavati, 2017).

    A palette is an image of 256 x 8 opaque RGBA8 texels, coded in sRGB. The columns are the light, from −1 (turned
    away) over 0 (grazing) to 1 (facing the light). The rows from the bottom are field, hill, cliff, snow, forest
    floor, trees, town and bare ground (GEOFX_PALETTE_... of shaders/lib/painting.glsl). The lit and the shaded ends of
    a row are split complements: the light is warm, and the shade violet. All
    functions are thread-safe and return new images. */

/// Makes the kit's own palette. `season`: 0 is midwinter, 1/4 spring, 1/2 midsummer, 3/4 autumn; only the fraction of
/// other numbers counts. It changes the lit colors of fields, hills, forest floor and trees.
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> makePalette(double season = 0.5);

/// How people see: most of them; or without the cones for long waves (red), or for middle ones (green).
enum class ColorVision
{
    USUAL,
    PROTANOPIA,
    DEUTERANOPIA
};

/// Makes a palette that color-blind readers can read: its classes differ by at least 10 in CIEDE2000 from each other
/// at every light, for each ColorVision. It is that of a clear summer day.
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> makeColorBlindPalette();

/// Two classes of a palette, 0…7, at the light (−1…1) where a reader with this vision can tell them apart the least;
/// and how different they look there, in CIEDE2000. 1 is just to be seen side by side; 10 is seen at a glance.
struct PaletteContrast
{
    int row = 0;
    int otherRow = 0;
    double light = 0.0;
    double difference = 0.0;
};

/// Finds that of a palette of 256 x 8 texels. Colors are seen as by the simulation of Machado, Oliveira and Fernandes
/// (2009).
OSGGEOFX_EXPORT PaletteContrast leastContrast(const osg::Image& palette, ColorVision vision);

/// Makes a palette from an image of any width and at least 8 rows. The image has eight bands of equal height; the
/// middle half of each band counts. The template is data/panorama/palette.png. Returns null, with a sentence in
/// `error`, if the image cannot be used.
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> paletteFromImage(const osg::Image& image, std::string& error);

/// The same from a file that osgDB reads. The sentence names the file.
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> readPalette(const std::string& path, std::string& error);

/// A color of a painting, coded in sRGB, 0…1; of one class (a row of the palette, 0…7), at one light (−1…1).
struct PaletteSample
{
    int row = 0;
    double light = 0.0;
    osg::Vec3d color;
};

/** Makes a palette from samples, as the paper does. The range of light has 32 bins; the samples of each bin are
    averaged, and colors are interpolated linearly between the averages. Beyond the darkest and the lightest average a
    row goes on as that of makePalette() does. Rows with fewer than `least` samples come from makePalette(); samples of
    other rows are ignored. Returns null, with a sentence in `error`, if no row has enough samples. */
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> paletteFromSamples(const std::vector<PaletteSample>& samples,
                                                            std::size_t least, std::string& error);

/** Derives a palette from a painting, as the paper does: each color of the painting is assigned to the light that a
    light map of the same ground has there.

    The three images show the same view and may differ in size. `lightMap`: red 0…1 stands for light −1…1. `classMap`:
    red, in 1/255, is a row of the palette, 0…7; pixels with other values are ignored. The palette is made as by
    paletteFromSamples() with at least 16 samples for a row. Returns null, with a sentence in `error`, if an image has
    no pixels or no class has enough samples. */
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> paletteFromPainting(const osg::Image& painting,
                                                             const osg::Image& lightMap,
                                                             const osg::Image& classMap, std::string& error);

} // namespace osgGeoFX
