// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/raster/ColorTable.h>

#include <osg/Group>
#include <osg/Vec2d>
#include <osgText/Font>

#include <map>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// What a legend says and how large it is. Sizes are pixels, colours sRGB-coded, 0…1.
struct LegendStyle
{
    std::string title; ///< UTF-8, as all texts
    std::string unit;  ///< behind the title
    double width = 300.0;
    double barHeight = 16.0;
    double textSize = 14.0;
    osg::ref_ptr<osgText::Font> font; ///< null: OSG's own
    osg::Vec4 textColor = {0.1f, 0.1f, 0.1f, 1.0f};
    osg::Vec4 background = {1.0f, 1.0f, 1.0f, 0.85f};
    int mostTicks = 6;
    /// Texts for values, in the place of numbers: names of classes, for instance.
    std::map<double, std::string> names;
};

/** Round numbers from low to high: steps of 1, 2 or 5 times a power of ten, `most` of them at most and where there is room two
    at least. None where low is not below high. */
OSGGEOFX_EXPORT std::vector<double> roundTicks(double low, double high, int most);
/// A tick as it is written beside others that are `step` apart: no more digits than are needed to tell them apart.
OSGGEOFX_EXPORT std::string tickText(double value, double step);

/** A legend for a table's colours from low to high, to be put into a camera that draws pixels: title and unit, a bar with the
    map's own colours over a checkered ground (so that opacity can be seen), and ticks at round numbers. For a table of the
    mode EXACT there is a field with its name for each stop from low to high, one below the other.

    It stands on the origin, x to the right and y up. Its size is in the user values "width" and "height" (double), pixels.
    Null, with a warning, where low is not below high or a size is not within 1…10000. */
OSGGEOFX_EXPORT osg::ref_ptr<osg::Group> makeLegend(const ColorTable& colors, double low, double high,
                                                    const LegendStyle& style);

} // namespace osgGeoFX
